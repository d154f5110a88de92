#include "skeleton/cylinders/spline.h"

#include <algorithm>
#include <array>

#include "geometry/parallel.h"

namespace treerec {

namespace {

// Square radians in a metre by which the heading of thin wood drifts: 40 degrees in the root mean square.
constexpr double kDrift = 0.5;
constexpr double kStout = 0.01;    // metres: thicker wood has bends of its own (branches/bends.h)
constexpr double kBeam = 0.003;    // metres: half as wide as a beam is: no station is surer,
constexpr double kUnknown = 0.01;  // metres: and where no points told the scatter, it is so
constexpr double kSure = 1e-5;     // metres: of what stays
constexpr double kMadToSigma = 1.4826;
constexpr double kLeastStep = 0.002;  // metres
constexpr size_t kBranchesPerTask = 64;

// A symmetric system whose matrix has two diagonals beside the main one, with a place on its right side.
class PentadiagonalSystem {
  public:
    explicit PentadiagonalSystem(size_t count) : rows_(count), right_(count, DVec3(0.0)) {}

    void add_place(size_t i, double weight, const DVec3& place) {
        rows_[i][0] += weight;
        right_[i] += weight * place;
    }

    // weight times the square of a x_i + b x_i+1 + c x_i+2.
    void add_turn(size_t i, double weight, double a, double b, double c) {
        rows_[i][0] += weight * a * a;
        rows_[i][1] += weight * a * b;
        rows_[i][2] += weight * a * c;
        rows_[i + 1][0] += weight * b * b;
        rows_[i + 1][1] += weight * b * c;
        rows_[i + 2][0] += weight * c * c;
    }

    // By Cholesky's decomposition without roots.
    std::vector<DVec3> solve() {
        const size_t count = rows_.size();
        for (size_t i = 0; i < count; i++) {
            for (size_t k = 1; k <= 2 && i + k < count; k++) {
                const double share = rows_[i][k] / rows_[i][0];
                for (size_t j = k; j <= 2 && i + j < count; j++)
                    rows_[i + k][j - k] -= share * rows_[i][j];
                right_[i + k] -= share * right_[i];
            }
        }
        for (size_t i = count; i-- > 0;) {
            for (size_t k = 1; k <= 2 && i + k < count; k++)
                right_[i] -= rows_[i][k] * right_[i + k];
            right_[i] /= rows_[i][0];
        }
        return std::move(right_);
    }

  private:
    std::vector<std::array<double, 3>> rows_;  // by row: the main diagonal and the two to its right
    std::vector<DVec3> right_;
};

double deviation_of(const std::vector<Station>& line, size_t i) {
    const bool gap = line[i].bridged || (i + 1 < line.size() && line[i + 1].bridged);
    if (gap || line[i].measured || line[i].radius >= kStout) return kSure;
    return line[i].scatter > 0.0 ? std::max(kBeam, kMadToSigma * line[i].scatter) : kUnknown;
}

// base: where the branch leaves its parent; null for the first.
void smooth_axis(std::vector<Station>& line, const DVec3* base) {
    const size_t first = base ? 1 : 0;
    const size_t count = line.size() + first;
    if (count < 3) return;
    const auto place = [&](size_t i) -> const DVec3& { return i < first ? *base : line[i - first].position; };
    PentadiagonalSystem system(count);
    std::vector<double> steps(count - 1);
    for (size_t i = 0; i < count; i++) {
        const double deviation = i < first ? kSure : deviation_of(line, i - first);
        system.add_place(i, 1.0 / (deviation * deviation), place(i));
        if (i > 0) steps[i - 1] = std::max(kLeastStep, glm::distance(place(i), place(i - 1)));
    }
    for (size_t i = 0; i + 2 < count; i++) {
        const double before = 1.0 / steps[i], after = 1.0 / steps[i + 1];
        const double variance = kDrift * 0.5 * (steps[i] + steps[i + 1]);
        system.add_turn(i, 1.0 / variance, before, -before - after, after);
    }
    const std::vector<DVec3> smooth = system.solve();
    for (size_t i = 0; i < line.size(); i++)
        if (deviation_of(line, i) > kSure) line[i].position = smooth[i + first];
}

}  // namespace

void smooth_axes(const std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes) {
    const auto thin = [&](size_t l) { return axes[l].back().radius < kStout; };
    // A branch begins where its parent has come to lie: by order of branching, each order at once.
    std::vector<int> order(branches.size(), 0);
    int orders = 0;
    for (size_t l = 0; l < branches.size(); l++) {
        if (branches[l].parent >= 0) order[l] = order[static_cast<size_t>(branches[l].parent)] + 1;
        orders = std::max(orders, order[l] + 1);
    }
    std::vector<std::vector<size_t>> of_order(static_cast<size_t>(orders));
    for (size_t l = 0; l < branches.size(); l++)
        if (thin(l)) of_order[static_cast<size_t>(order[l])].push_back(l);
    for (const std::vector<size_t>& some : of_order)
        parallel_for(some.size(), kBranchesPerTask, [&](size_t begin, size_t end) {
            for (size_t k = begin; k < end; k++) {
                const SkeletonBranch& branch = branches[some[k]];
                const DVec3* base =
                    branch.parent < 0
                        ? nullptr
                        : &axes[static_cast<size_t>(branch.parent)][static_cast<size_t>(branch.attach)]
                               .position;
                smooth_axis(axes[some[k]], base);
            }
        });
}

}  // namespace treerec
