// Eigenvalues and eigenvectors of small symmetric matrices.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace treerec {

template <size_t kSize>
using SquareMatrix = std::array<std::array<double, kSize>, kSize>;

template <size_t kSize>
struct SymmetricEigen {
    std::array<double, kSize> values{};  // in no order
    SquareMatrix<kSize> vectors{};       // each column is that of the value with its number, of length 1

    size_t smallest() const {
        size_t best = 0;
        for (size_t i = 1; i < kSize; i++)
            if (values[i] < values[best]) best = i;
        return best;
    }
    std::array<double, kSize> vector(size_t i) const {
        std::array<double, kSize> found{};
        for (size_t k = 0; k < kSize; k++)
            found[k] = vectors[k][i];
        return found;
    }
};

// By cyclic Jacobi rotations (Golub and Van Loan, Matrix Computations, 8.5), until what is beside the
// diagonal is nothing beside its own row and column: the small values of a positive matrix come out as exact
// as the large ones (Demmel and Veselic 1992).
template <size_t kSize>
SymmetricEigen<kSize> symmetric_eigen(SquareMatrix<kSize> a) {
    SymmetricEigen<kSize> found;
    SquareMatrix<kSize>& v = found.vectors;
    for (size_t i = 0; i < kSize; i++)
        v[i][i] = 1.0;
    constexpr int kMostSweeps = 40;
    bool turned = true;
    for (int sweep = 0; turned && sweep < kMostSweeps; sweep++) {
        turned = false;
        for (size_t p = 0; p + 1 < kSize; p++)
            for (size_t q = p + 1; q < kSize; q++) {
                if (std::abs(a[p][q]) <= 1e-15 * std::sqrt(std::abs(a[p][p] * a[q][q]))) continue;
                turned = true;
                const double tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                const double t = (tau >= 0.0 ? 1.0 : -1.0) / (std::abs(tau) + std::sqrt(1.0 + tau * tau));
                const double c = 1.0 / std::sqrt(1.0 + t * t), s = t * c;
                for (size_t k = 0; k < kSize; k++) {
                    const double kp = a[k][p], kq = a[k][q];
                    a[k][p] = c * kp - s * kq;
                    a[k][q] = s * kp + c * kq;
                }
                for (size_t k = 0; k < kSize; k++) {
                    const double pk = a[p][k], qk = a[q][k];
                    a[p][k] = c * pk - s * qk;
                    a[q][k] = s * pk + c * qk;
                }
                for (size_t k = 0; k < kSize; k++) {
                    const double kp = v[k][p], kq = v[k][q];
                    v[k][p] = c * kp - s * kq;
                    v[k][q] = s * kp + c * kq;
                }
            }
    }
    for (size_t i = 0; i < kSize; i++)
        found.values[i] = a[i][i];
    return found;
}

}  // namespace treerec
