#include "growth/twist_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/portable_math.h"

namespace treerec::growth {

namespace {

constexpr double kMostTwist = 6.0;      // radians a metre
constexpr double kTwistStep = 0.02;     // likewise, between those that are tried
constexpr double kFarthest = 2.0;       // metres, and
constexpr double kFarthestShare = 0.4;  // of the map's length, between rows that are compared
constexpr size_t kNearest = 2;          // rows: neighbours share what points scatter
constexpr double kKnown = 0.5;          // of a row and of a pair of rows that the scan must show
constexpr size_t kFewestRows = 12;
constexpr double kAlike = 0.35;     // correlation of rows turned by the twist,
constexpr double kBetter = 0.15;    // by how much it is above that of no twist,
constexpr double kUnique = 0.1;     // and of the best one elsewhere
constexpr double kLobe = 0.8;       // radians by which the farthest rows are turned apart: another twist
constexpr double kLeastTurn = 0.6;  // radians over the map's length, of a twist that is worth telling
constexpr double kHalves = 0.25;    // by which the halves' twists may differ, of the whole's

// Rows whose middle and first harmonic are taken off: those are the axis's, and the radius's.
struct Rows {
    size_t columns = 0;
    double step = 0.0;
    std::vector<std::vector<double>> heights;  // NaN: not known; empty: too little is
};

bool take_off_circle(std::vector<double>& row) {
    const size_t columns = row.size();
    double a[3][4] = {};
    size_t known = 0;
    for (size_t c = 0; c < columns; c++) {
        if (std::isnan(row[c])) continue;
        known++;
        const double angle = 2.0 * kPi * (static_cast<double>(c) + 0.5) / static_cast<double>(columns);
        const SineCosine turn = portable_sine_cosine(angle);
        const double basis[4] = {1.0, turn.cosine, turn.sine, row[c]};
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 4; k++)
                a[i][k] += basis[i] * basis[k];
    }
    if (static_cast<double>(known) < kKnown * static_cast<double>(columns)) return false;
    for (int i = 0; i < 3; i++) {  // the normal equations, whose matrix is positive: no pivots
        if (!(a[i][i] > 1e-9)) return false;
        for (int j = i + 1; j < 3; j++)
            for (int k = 3; k >= i; k--)
                a[j][k] -= a[j][i] / a[i][i] * a[i][k];
    }
    std::array<double, 3> fit{};
    for (int i = 2; i >= 0; i--) {
        fit[static_cast<size_t>(i)] = a[i][3];
        for (int k = i + 1; k < 3; k++)
            fit[static_cast<size_t>(i)] -= a[i][k] * fit[static_cast<size_t>(k)];
        fit[static_cast<size_t>(i)] /= a[i][i];
    }
    for (size_t c = 0; c < columns; c++) {
        const double angle = 2.0 * kPi * (static_cast<double>(c) + 0.5) / static_cast<double>(columns);
        const SineCosine turn = portable_sine_cosine(angle);
        row[c] -= fit[0] + fit[1] * turn.cosine + fit[2] * turn.sine;
    }
    return true;
}

Rows rows_of(const BarkMap& map, size_t begin, size_t end) {
    Rows rows{map.columns, map.step, {}};
    for (size_t r = begin; r < end; r++) {
        std::vector<double> row(
            map.height.begin() + static_cast<std::ptrdiff_t>(map.cell(r, 0)),
            map.height.begin() + static_cast<std::ptrdiff_t>(map.cell(r, 0) + map.columns));
        if (!take_off_circle(row)) row.clear();
        rows.heights.push_back(std::move(row));
    }
    return rows;
}

// By lag in rows and shift in columns: the correlation of all rows so far apart, turned so. Pairs of rows
// count by how much they stand out, so that lone ridges are not lost among flat rows.
class Correlations {
  public:
    explicit Correlations(const Rows& rows) : columns_(rows.columns), step_(rows.step) {
        const size_t count = rows.heights.size();
        const double far = std::min(kFarthest, kFarthestShare * static_cast<double>(count) * rows.step);
        const auto most = static_cast<size_t>(far / rows.step);
        for (size_t lag = kNearest; lag <= most; lag++) {
            std::vector<double> by_shift(columns_, 0.0);
            for (size_t shift = 0; shift < columns_; shift++) {
                double product = 0.0, low = 0.0, high = 0.0;
                for (size_t r = 0; r + lag < count; r++) {
                    const std::vector<double>&a = rows.heights[r], &b = rows.heights[r + lag];
                    if (a.empty() || b.empty()) continue;
                    double own_product = 0.0, own_low = 0.0, own_high = 0.0;
                    size_t known = 0;
                    for (size_t c = 0; c < columns_; c++) {
                        const double x = a[c], y = b[(c + shift) % columns_];
                        if (std::isnan(x) || std::isnan(y)) continue;
                        known++;
                        own_product += x * y;
                        own_low += x * x;
                        own_high += y * y;
                    }
                    if (static_cast<double>(known) < kKnown * static_cast<double>(columns_)) continue;
                    product += own_product;
                    low += own_low;
                    high += own_high;
                }
                by_shift[shift] = low > 0.0 && high > 0.0 ? product / std::sqrt(low * high) : 0.0;
            }
            lags_.push_back(std::move(by_shift));
        }
    }

    bool empty() const { return lags_.empty(); }
    // Metres between the farthest rows that are compared.
    double farthest() const { return static_cast<double>(lags_.size() + kNearest - 1) * step_; }
    double at(double twist) const {
        double sum = 0.0;
        for (size_t i = 0; i < lags_.size(); i++) {
            const double turn = twist * static_cast<double>(i + kNearest) * step_ / (2.0 * kPi);
            const double shift = (turn - std::floor(turn)) * static_cast<double>(columns_);
            const size_t low = static_cast<size_t>(shift) % columns_;
            const double part = shift - std::floor(shift);
            sum += glm::mix(lags_[i][low], lags_[i][(low + 1) % columns_], part);
        }
        return sum / static_cast<double>(lags_.size());
    }
    double best() const {
        double best = 0.0, most = -2.0;
        for (double twist = -kMostTwist; twist <= kMostTwist; twist += kTwistStep)
            if (const double alike = at(twist); alike > most) {
                most = alike;
                best = twist;
            }
        return best;
    }

  private:
    size_t columns_;
    double step_;
    std::vector<std::vector<double>> lags_;
};

}  // namespace

std::optional<double> fit_twist(const BarkMap& map) {
    if (map.rows < kFewestRows || map.columns < 3) return std::nullopt;
    const Correlations whole(rows_of(map, 0, map.rows));
    if (whole.empty()) return std::nullopt;
    const double twist = whole.best(), alike = whole.at(twist);
    const double length = static_cast<double>(map.rows) * map.step;
    if (std::abs(twist) * length < kLeastTurn || alike < kAlike || alike - whole.at(0.0) < kBetter)
        return std::nullopt;
    const double lobe = kLobe / whole.farthest();
    for (double other = -kMostTwist; other <= kMostTwist; other += kTwistStep)
        if (std::abs(other - twist) > lobe && whole.at(other) > alike - kUnique) return std::nullopt;
    for (const size_t half : {size_t{0}, map.rows / 2}) {
        const Correlations part(rows_of(map, half, half + map.rows / 2));
        if (part.empty() || std::abs(part.best() - twist) > std::max(kHalves * std::abs(twist), lobe))
            return std::nullopt;
    }
    return twist;
}

}  // namespace treerec::growth
