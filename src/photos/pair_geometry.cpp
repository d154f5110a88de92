#include "photos/pair_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/random.h"
#include "geometry/symmetric_eigen.h"

namespace treerec {

namespace {

constexpr size_t kSample = 8;
constexpr int kMostTrials = 5000;
constexpr double kSure = 0.999;  // that one sample had no wrong match in it
constexpr int kPolishings = 4;   // fits to all that agree
constexpr int kBetweenChecks = 256;

using Row = std::array<double, 9>;

// Places moved and scaled so that their mean is 0 and their usual distance from it the square root of two.
struct Normal {
    DVec2 middle{0.0};
    double scale = 1.0;
    DVec2 of(const DVec2& p) const { return scale * (p - middle); }
    DMat3 matrix() const {
        return DMat3(scale, 0.0, 0.0, 0.0, scale, 0.0, -scale * middle.x, -scale * middle.y, 1.0);
    }
};

Normal normal_of(std::span<const PlacePair> matches, DVec2 PlacePair::*place) {
    Normal normal;
    for (const PlacePair& match : matches)
        normal.middle += match.*place;
    normal.middle /= static_cast<double>(matches.size());
    double away = 0.0;
    for (const PlacePair& match : matches)
        away += glm::distance(match.*place, normal.middle);
    away /= static_cast<double>(matches.size());
    if (away > 0.0) normal.scale = std::sqrt(2.0) / away;
    return normal;
}

Row row_of(const PlacePair& m) {
    return {m.other.x * m.one.x,
            m.other.x * m.one.y,
            m.other.x,
            m.other.y * m.one.x,
            m.other.y * m.one.y,
            m.other.y,
            m.one.x,
            m.one.y,
            1.0};
}

// What eight rows have in common as 0, by elimination with full pivoting; false where they are fewer in
// truth.
bool null_of(std::array<Row, kSample> rows, Row& solution) {
    std::array<size_t, 9> columns{};
    for (size_t i = 0; i < 9; i++)
        columns[i] = i;
    for (size_t step = 0; step < kSample; step++) {
        size_t row = step, column = step;
        for (size_t i = step; i < kSample; i++)
            for (size_t j = step; j < 9; j++)
                if (std::abs(rows[i][j]) > std::abs(rows[row][column])) {
                    row = i;
                    column = j;
                }
        if (!(std::abs(rows[row][column]) > 1e-9)) return false;
        std::swap(rows[step], rows[row]);
        if (column != step) {
            for (Row& each : rows)
                std::swap(each[step], each[column]);
            std::swap(columns[step], columns[column]);
        }
        for (size_t i = step + 1; i < kSample; i++) {
            const double times = rows[i][step] / rows[step][step];
            for (size_t j = step; j < 9; j++)
                rows[i][j] -= times * rows[step][j];
        }
    }
    Row ordered{};
    ordered[8] = 1.0;
    for (size_t step = kSample; step-- > 0;) {
        double sum = 0.0;
        for (size_t j = step + 1; j < 9; j++)
            sum += rows[step][j] * ordered[j];
        ordered[step] = -sum / rows[step][step];
    }
    for (size_t i = 0; i < 9; i++)
        solution[columns[i]] = ordered[i];
    return true;
}

// DMat3 is by columns: column j of the result holds f's entries (0..2, j).
DMat3 matrix_of(const Row& f) {
    DMat3 matrix;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            matrix[j][i] = f[static_cast<size_t>(3 * i + j)];
    return matrix;
}

SymmetricEigen<3> right_vectors(const DMat3& matrix) {
    const DMat3 square = glm::transpose(matrix) * matrix;
    SquareMatrix<3> asked;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            asked[i][j] = square[i][j];
    return symmetric_eigen(asked);
}

DVec3 vector_of(const SymmetricEigen<3>& eigen, size_t i) {
    const auto v = eigen.vector(i);
    return DVec3(v[0], v[1], v[2]);
}

// The nearest matrix of rank 2.
DMat3 of_rank_two(const DMat3& matrix) {
    const SymmetricEigen<3> eigen = right_vectors(matrix);
    const DVec3 way = vector_of(eigen, eigen.smallest());
    return matrix - glm::outerProduct(matrix * way, way);
}

// The nearest essential matrix: both singular values that are not 0 become their mean.
DMat3 of_equal_values(const DMat3& matrix) {
    const SymmetricEigen<3> eigen = right_vectors(matrix);
    const size_t least = eigen.smallest();
    DMat3 sum(0.0);
    double values = 0.0;
    for (size_t i = 0; i < 3; i++) {
        if (i == least) continue;
        const DVec3 right = vector_of(eigen, i), left = matrix * right;
        const double value = glm::length(left);
        if (!(value > 0.0)) return matrix;
        values += value;
        sum += glm::outerProduct(left / value, right);
    }
    return 0.5 * values * sum;
}

class Agreement {
  public:
    Agreement(std::span<const PlacePair> matches, const PairGeometryOptions& options)
        : one_(normal_of(matches, &PlacePair::one)),
          other_(normal_of(matches, &PlacePair::other)),
          calibrated_(options.calibrated) {
        for (const PlacePair& match : matches)
            places_.push_back({one_.of(match.one), other_.of(match.other)});
        const double scaled = options.tolerance * std::sqrt(one_.scale * other_.scale);
        most_ = scaled * scaled;
    }

    bool sample(Random& random, DMat3& found) const {
        std::array<size_t, kSample> chosen{};
        std::array<Row, kSample> rows;
        const auto count = static_cast<uint32_t>(places_.size());
        for (size_t i = 0; i < kSample; i++) {
            do
                chosen[i] = random.below(count);
            while (std::find(chosen.begin(), chosen.begin() + static_cast<ptrdiff_t>(i), chosen[i]) !=
                   chosen.begin() + static_cast<ptrdiff_t>(i));
            rows[i] = row_of(places_[chosen[i]]);
        }
        Row f{};
        if (!null_of(rows, f)) return false;
        found = nearest(f);
        return true;
    }

    DMat3 fitted(const std::vector<uint8_t>& agreeing) const {
        SquareMatrix<9> sum{};
        for (size_t m = 0; m < places_.size(); m++) {
            if (!agreeing[m]) continue;
            const Row row = row_of(places_[m]);
            for (size_t i = 0; i < 9; i++)
                for (size_t j = 0; j < 9; j++)
                    sum[i][j] += row[i] * row[j];
        }
        const SymmetricEigen<9> eigen = symmetric_eigen(sum);
        return nearest(eigen.vector(eigen.smallest()));
    }

    // Which agree, and how well on the whole: the nearer to its line, the more a match counts (Torr and
    // Zisserman, "MLESAC", 2000).
    double mark(const DMat3& f, std::vector<uint8_t>& agreeing) const {
        double score = 0.0;
        for (size_t m = 0; m < places_.size(); m++) {
            const double squared = squared_sampson(f, places_[m]);
            agreeing[m] = squared < most_;
            if (agreeing[m]) score += 1.0 - squared / most_;
        }
        return score;
    }
    size_t size() const { return places_.size(); }

  private:
    DMat3 nearest(const Row& f) const {
        const DMat3 matrix = matrix_of(f);
        if (!calibrated_) return of_rank_two(matrix);
        // That of the places themselves is an essential matrix.
        const DMat3 one = one_.matrix(), back = glm::transpose(other_.matrix());
        return glm::inverse(back) * of_equal_values(back * matrix * one) * glm::inverse(one);
    }

    Normal one_, other_;
    bool calibrated_;
    std::vector<PlacePair> places_;
    double most_ = 0.0;
};

size_t count_of(const std::vector<uint8_t>& agreeing) {
    return static_cast<size_t>(std::count(agreeing.begin(), agreeing.end(), uint8_t{1}));
}

}  // namespace

double squared_sampson(const DMat3& f, const PlacePair& match) {
    const DVec3 one(match.one, 1.0), other(match.other, 1.0);
    const DVec3 line = f * one, back = glm::transpose(f) * other;
    const double error = glm::dot(other, line);
    const double slope = line.x * line.x + line.y * line.y + back.x * back.x + back.y * back.y;
    return slope > 0.0 ? error * error / slope : INFINITY;
}

std::vector<uint8_t> agreeing_on_geometry(std::span<const PlacePair> matches,
                                          const PairGeometryOptions& options, const Progress* progress) {
    std::vector<uint8_t> best(matches.size(), 0);
    if (matches.size() < std::max(options.least, kSample)) return best;
    const Agreement agreement(matches, options);
    Random random(matches.size());
    std::vector<uint8_t> agreeing(matches.size());
    double most = 0.0;
    int needed = kMostTrials;
    for (int trial = 0; trial < needed; trial++) {
        if (progress && trial % kBetweenChecks == 0) progress->check();
        DMat3 f;
        if (!agreement.sample(random, f)) continue;
        double score = agreement.mark(f, agreeing);
        if (score <= most) continue;
        for (int k = 0; k < kPolishings; k++) {
            most = score;
            best = agreeing;
            if (count_of(agreeing) < kSample) break;
            score = agreement.mark(agreement.fitted(agreeing), agreeing);
            if (score <= most) break;
        }
        const double share = static_cast<double>(count_of(best)) / static_cast<double>(matches.size());
        const double well = std::pow(share, static_cast<double>(kSample));
        if (well >= 1.0) break;
        if (well > 0.0)
            needed = static_cast<int>(
                std::min<double>(needed, std::ceil(std::log(1.0 - kSure) / std::log1p(-well))));
    }
    const size_t count = count_of(best);
    if (count < options.least ||
        static_cast<double>(count) < options.least_share * static_cast<double>(matches.size()))
        std::fill(best.begin(), best.end(), uint8_t{0});
    return best;
}

}  // namespace treerec
