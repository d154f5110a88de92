#include "growth/section_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "geometry/portable_math.h"
#include "geometry/quantile.h"
#include "growth/section.h"

namespace treerec::growth {

namespace {

constexpr double kDirection = 1.2;   // longest edges from one direction to the next, about,
constexpr double kOfColumns = 0.75;  // and of the map's columns no more
constexpr double kFewest = 8.0, kMost = 32.0;
constexpr double kApart = 0.5, kApartEdges = 1.5;  // radii, and longest edges, between sections
constexpr double kMostSections = 160.0;
// Penalties where lengths are told in radii: of bends around, slopes along, and of what is not a circle. They
// leave waves of some 10 to a round, and along of some 2 or 10 radii.
constexpr double kBend = 1e-4, kSlope = 0.1, kLongSlope = 30.0, kRound = 2e-3;
constexpr double kCircle = 0.01;                  // of a circle's radius and middle
constexpr double kSmoother[] = {0.1, 1.0, 10.0};  // times bends and slopes
constexpr double kLeastGain = 0.12, kLongGain = 0.6;
constexpr double kNearGain = 0.05, kNear = 4.0;  // of what lies so many radii about a section
constexpr double kFewCells = 64.0;
constexpr double kHuber = 2.0, kTukey = 6.0;  // deviations
constexpr int kHuberTurns = 4, kTukeyTurns = 2;
constexpr double kLeastDeviation = 0.003, kNormalDeviation = 1.4826;
constexpr double kMostWeight = 4.0;  // of a cell: points that lie together tell the same
constexpr size_t kBlock = 2;         // cells to a side, that are left out together
constexpr int kMostIterations = 200;
constexpr double kExact = 1e-5;
constexpr double kLeastShare = 0.25, kMostShare = 3.5;

struct Tap {
    uint32_t unknown = 0;
    double weight = 0.0;
};

// Sum of squares over unknowns, each of a few of them.
class LeastSquares {
  public:
    explicit LeastSquares(size_t unknowns) : unknowns_(unknowns) {}

    void add(std::span<const Tap> taps, double value, double weight) {
        if (!(weight > 0.0)) return;
        for (const Tap& tap : taps)
            taps_.push_back(tap);
        ends_.push_back(taps_.size());
        values_.push_back(value);
        weights_.push_back(weight);
    }

    // Conjugate gradients, preconditioned by the diagonal, from x on.
    void solve(std::vector<double>& x, const Progress* progress) const {
        std::vector<double> diagonal(unknowns_, 1e-12), right(unknowns_, 0.0), product;
        size_t begin = 0;
        for (size_t row = 0; row < ends_.size(); row++) {
            for (size_t i = begin; i < ends_[row]; i++) {
                diagonal[taps_[i].unknown] += weights_[row] * taps_[i].weight * taps_[i].weight;
                right[taps_[i].unknown] += weights_[row] * taps_[i].weight * values_[row];
            }
            begin = ends_[row];
        }
        multiply(x, product);
        std::vector<double> rest(unknowns_), way(unknowns_);
        double square = 0.0, first = 0.0;
        for (size_t i = 0; i < unknowns_; i++) {
            rest[i] = right[i] - product[i];
            way[i] = rest[i] / diagonal[i];
            square += rest[i] * way[i];
            first += right[i] * right[i] / diagonal[i];
        }
        for (int iteration = 0; iteration < kMostIterations; iteration++) {
            if (!(square > kExact * kExact * first)) return;
            if (progress) progress->check();
            multiply(way, product);
            double along = 0.0;
            for (size_t i = 0; i < unknowns_; i++)
                along += way[i] * product[i];
            if (!(along > 0.0)) return;
            const double step = square / along;
            double next = 0.0;
            for (size_t i = 0; i < unknowns_; i++) {
                x[i] += step * way[i];
                rest[i] -= step * product[i];
                next += rest[i] * rest[i] / diagonal[i];
            }
            for (size_t i = 0; i < unknowns_; i++)
                way[i] = rest[i] / diagonal[i] + next / square * way[i];
            square = next;
        }
    }

  private:
    void multiply(const std::vector<double>& x, std::vector<double>& product) const {
        product.assign(unknowns_, 0.0);
        size_t begin = 0;
        for (size_t row = 0; row < ends_.size(); row++) {
            double sum = 0.0;
            for (size_t i = begin; i < ends_[row]; i++)
                sum += taps_[i].weight * x[taps_[i].unknown];
            sum *= weights_[row];
            for (size_t i = begin; i < ends_[row]; i++)
                product[taps_[i].unknown] += taps_[i].weight * sum;
            begin = ends_[row];
        }
    }

    const size_t unknowns_;
    std::vector<Tap> taps_;
    std::vector<size_t> ends_;  // by row
    std::vector<double> values_, weights_;
};

class Fit {
  public:
    Fit(const BarkMap& map, double longest, Along along, const Progress* progress)
        : map_(map),
          progress_(progress),
          slope_(along == Along::kLong ? kLongSlope : kSlope),
          least_(along == Along::kLong ? kLongGain : kLeastGain) {
        std::vector<double> radii = map.radius;
        wood_ = quantile(radii, 0.5);
        const double columns = static_cast<double>(map.columns),
                     length = map.step * static_cast<double>(map.rows);
        directions_ = static_cast<size_t>(
            std::clamp(std::round(std::min(2.0 * kPi * wood_ / (kDirection * longest), kOfColumns * columns)),
                       kFewest, kMost));
        const double apart = std::max({kApart * wood_, kApartEdges * longest, length / kMostSections});
        count_ = static_cast<size_t>(std::max(std::round(length / apart), 1.0)) + 1;
        apart_ = length / static_cast<double>(count_ - 1);
        for (size_t i = 0; i < map.height.size(); i++)
            if (!std::isnan(map.height[i])) cells_.push_back(i);
        value_.resize(map.height.size(), 0.0);
        for (const size_t cell : cells_)
            value_[cell] = map.height[cell] / map.radius[cell / map.columns];
    }

    SectionFit fit() {
        SectionFit result;
        if (static_cast<double>(cells_.size()) < kFewCells) return result;
        double best = least_, smoother = 0.0;
        std::vector<std::array<double, 2>> near_best;
        for (const double one : kSmoother) {
            const double gain = cross_validated(one);
            if (gain <= best) continue;
            best = gain;
            smoother = one;
            near_best = near_;
        }
        if (!(smoother > 0.0)) return result;
        result.gain = best;
        const std::vector<double> shares = fit_to(cells_, smoother);
        const size_t reach = static_cast<size_t>(std::ceil(kNear * wood_ / apart_));
        for (size_t i = 0; i < count_; i++) {
            // Where a branch is seen badly what others of its parts gain tells nothing.
            double before = 0.0, after = 0.0;
            for (size_t k = i - std::min(i, reach); k <= std::min(i + reach, count_ - 1); k++) {
                before += near_best[k][0];
                after += near_best[k][1];
            }
            const bool nearer = after < (1.0 - kNearGain) * before;
            FittedSection section;
            section.along = map_.begin + static_cast<double>(i) * apart_;
            for (size_t d = 0; d < directions_; d++)
                section.shares.push_back(
                    nearer ? std::clamp(1.0 + shares[i * directions_ + d], kLeastShare, kMostShare) : 1.0);
            result.sections.push_back(std::move(section));
        }
        return result;
    }

  private:
    // The sections beside a row, and how much of the upper one.
    std::pair<size_t, double> between(size_t row) const {
        const double at = (map_.along(row) - map_.begin) / apart_;
        const size_t low = std::min(static_cast<size_t>(at), count_ - 2);
        return {low, at - static_cast<double>(low)};
    }
    double turn(size_t cell) const {
        return (static_cast<double>(cell % map_.columns) + 0.5) / static_cast<double>(map_.columns);
    }

    // As BranchSections goes from direction to direction.
    std::array<Tap, 8> taps_of(size_t cell) const {
        const auto [low, up] = between(cell / map_.columns);
        const double at = turn(cell) * static_cast<double>(directions_);
        const size_t first = std::min(static_cast<size_t>(at), directions_ - 1);
        const double t = at - static_cast<double>(first);
        const double cubic[] = {0.5 * t * (t * (2.0 - t) - 1.0), 1.0 + t * t * (1.5 * t - 2.5),
                                0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)};
        std::array<Tap, 8> taps;
        for (size_t k = 0; k < 4; k++) {
            const size_t direction = (first + directions_ + k - 1) % directions_;
            taps[k] = {static_cast<uint32_t>(low * directions_ + direction), (1.0 - up) * cubic[k]};
            taps[4 + k] = {static_cast<uint32_t>((low + 1) * directions_ + direction), up * cubic[k]};
        }
        return taps;
    }
    // A circle whose middle is off the axis by a little: unknowns by section are 1, cosine and sine.
    std::array<Tap, 6> circle_taps(size_t cell) const {
        const auto [low, up] = between(cell / map_.columns);
        const double angle = 2.0 * kPi * turn(cell);
        const double parts[] = {1.0, portable::cos(angle), portable::sin(angle)};
        std::array<Tap, 6> taps;
        for (size_t k = 0; k < 3; k++) {
            taps[k] = {static_cast<uint32_t>(3 * low + k), (1.0 - up) * parts[k]};
            taps[3 + k] = {static_cast<uint32_t>(3 * low + 3 + k), up * parts[k]};
        }
        return taps;
    }
    template <typename Taps>
    static double sum(const Taps& taps, const std::vector<double>& x) {
        double value = 0.0;
        for (const Tap& tap : taps)
            value += tap.weight * x[tap.unknown];
        return value;
    }

    // Of a cell: its part of the bark, more of what has several points.
    double weight_of(size_t cell) const {
        const double area = map_.step / wood_ * 2.0 * kPi / static_cast<double>(map_.columns);
        return area * std::min(static_cast<double>(map_.count[cell]), kMostWeight) / kMostWeight;
    }

    template <typename TapsOf, typename Penalise>
    std::vector<double> robust(const std::vector<size_t>& cells, const std::vector<double>& values,
                               size_t unknowns, TapsOf taps_of_cell, Penalise penalise) const {
        std::vector<double> x(unknowns, 0.0), apart, doubt(cells.size(), 1.0);
        for (int turn = 0; turn < kHuberTurns + kTukeyTurns; turn++) {
            LeastSquares squares(unknowns);
            for (size_t i = 0; i < cells.size(); i++)
                squares.add(taps_of_cell(cells[i]), values[i], doubt[i] * weight_of(cells[i]));
            penalise(squares);
            squares.solve(x, progress_);
            apart.clear();
            std::vector<double> rest;
            for (size_t i = 0; i < cells.size(); i++) {
                rest.push_back(std::abs(values[i] - sum(taps_of_cell(cells[i]), x)));
                apart.push_back(rest.back());
            }
            const double deviation = std::max(kNormalDeviation * quantile(apart, 0.5), kLeastDeviation);
            for (size_t i = 0; i < cells.size(); i++) {
                const double off = rest[i] / deviation, far = std::min(off / kTukey, 1.0);
                doubt[i] = turn < kHuberTurns ? std::min(kHuber / std::max(off, kHuber), 1.0)
                                              : (1.0 - far * far) * (1.0 - far * far);
            }
        }
        return x;
    }

    // Shares less one, by section and direction.
    std::vector<double> fit_to(const std::vector<size_t>& cells, double smoother) const {
        std::vector<double> values;
        for (const size_t cell : cells)
            values.push_back(value_[cell]);
        const double high = apart_ / wood_, round = 2.0 * kPi;
        const std::vector<double> circles = robust(
            cells, values, 3 * count_, [&](size_t cell) { return circle_taps(cell); },
            [&](LeastSquares& squares) {
                for (uint32_t i = 0; i < 3 * count_; i++) {
                    squares.add(std::array<Tap, 1>{Tap{i, 1.0}}, 0.0, kCircle * high * round);
                    if (i + 3 < 3 * count_)
                        squares.add(std::array<Tap, 2>{Tap{i + 3, 1.0}, Tap{i, -1.0}}, 0.0,
                                    smoother * slope_ * round / high);
                }
            });
        for (size_t i = 0; i < cells.size(); i++)
            values[i] -= sum(circle_taps(cells[i]), circles);
        const double wide = round / static_cast<double>(directions_);
        std::vector<double> shares = robust(
            cells, values, count_ * directions_, [&](size_t cell) { return taps_of(cell); },
            [&](LeastSquares& squares) {
                for (size_t i = 0; i < count_; i++)
                    for (size_t d = 0; d < directions_; d++) {
                        const auto at = [&](size_t section, size_t direction, double weight) {
                            return Tap{static_cast<uint32_t>(section * directions_ + direction % directions_),
                                       weight};
                        };
                        squares.add(std::array<Tap, 1>{at(i, d, 1.0)}, 0.0, kRound * high * wide);
                        squares.add(std::array<Tap, 3>{at(i, d, 1.0), at(i, d + 1, -2.0), at(i, d + 2, 1.0)},
                                    0.0, smoother * kBend * high / (wide * wide * wide));
                        if (i + 1 < count_)
                            squares.add(std::array<Tap, 2>{at(i + 1, d, 1.0), at(i, d, -1.0)}, 0.0,
                                        smoother * slope_ * wide / high);
                    }
            });
        for (size_t i = 0; i < count_; i++)
            for (size_t d = 0; d < directions_; d++) {
                const double angle = round * static_cast<double>(d) / static_cast<double>(directions_);
                shares[i * directions_ + d] += circles[3 * i] + circles[3 * i + 1] * portable::cos(angle) +
                                               circles[3 * i + 2] * portable::sin(angle);
            }
        return shares;
    }

    // Half of the bark, in blocks like a chessboard's, tells of the other half.
    double cross_validated(double smoother) {
        near_.assign(count_, {0.0, 0.0});
        std::vector<size_t> halves[2];
        for (const size_t cell : cells_)
            halves[(cell / map_.columns / kBlock + cell % map_.columns / kBlock) % 2].push_back(cell);
        double before = 0.0, after = 0.0;
        for (int half = 0; half < 2; half++) {
            const std::vector<double> shares = fit_to(halves[half], smoother);
            for (const size_t cell : halves[1 - half]) {
                const double round = weight_of(cell) * std::abs(value_[cell]);
                const double fitted = weight_of(cell) * std::abs(value_[cell] - sum(taps_of(cell), shares));
                const auto [low, up] = between(cell / map_.columns);
                std::array<double, 2>& near = near_[up < 0.5 ? low : low + 1];
                near[0] += round;
                near[1] += fitted;
                before += round;
                after += fitted;
            }
        }
        return before > 0.0 ? 1.0 - after / before : 0.0;
    }

    const BarkMap& map_;
    const Progress* progress_;
    const double slope_, least_;
    double wood_ = 0.0;  // metres
    size_t directions_ = 0, count_ = 0;
    double apart_ = 0.0;  // metres, of sections
    std::vector<size_t> cells_;
    std::vector<std::array<double, 2>> near_;  // by section: what cells are off round wood, and off the fit
    std::vector<double> value_;                // by cell: height over the radius there
};

// Sections between which the one of two indices is told least well by a straight way, and by how much.
std::pair<size_t, double> farthest(const std::vector<FittedSection>& sections, size_t low, size_t high) {
    std::pair<size_t, double> worst{low, 0.0};
    for (size_t i = low + 1; i < high; i++) {
        const double t =
            (sections[i].along - sections[low].along) / (sections[high].along - sections[low].along);
        for (size_t d = 0; d < sections[i].shares.size(); d++) {
            const double off = std::abs(sections[i].shares[d] -
                                        glm::mix(sections[low].shares[d], sections[high].shares[d], t));
            if (off > worst.second) worst = {i, off};
        }
    }
    return worst;
}

}  // namespace

SectionFit fit_sections(const BarkMap& map, double longest, Along along, const Progress* progress) {
    if (map.rows < 2) return {};
    return Fit(map, longest, along, progress).fit();
}

// Douglas and Peucker 1973.
std::vector<FittedSection> thinned(std::vector<FittedSection> sections, double tolerance) {
    if (sections.size() < 3) return sections;
    std::vector<uint8_t> kept(sections.size(), 0);
    kept.front() = kept.back() = 1;
    std::vector<std::pair<size_t, size_t>> parts{{0, sections.size() - 1}};
    while (!parts.empty()) {
        const auto [low, high] = parts.back();
        parts.pop_back();
        const auto [at, off] = farthest(sections, low, high);
        if (off <= tolerance) continue;
        kept[at] = 1;
        parts.emplace_back(low, at);
        parts.emplace_back(at, high);
    }
    std::vector<FittedSection> left;
    for (size_t i = 0; i < sections.size(); i++)
        if (kept[i]) left.push_back(std::move(sections[i]));
    return left;
}

std::vector<double> heights_of(const BarkMap& map, const std::vector<FittedSection>& sections) {
    BranchSections shape;
    for (const FittedSection& section : sections)
        shape.add(section.along, 0.0, section.shares);
    std::vector<double> heights(map.height.size(), 0.0);
    for (size_t row = 0; row < map.rows; row++) {
        const BranchSections::Height height = shape.height(map.along(row));
        for (size_t column = 0; column < map.columns; column++)
            heights[map.cell(row, column)] =
                map.radius[row] *
                (shape.share(height, (static_cast<double>(column) + 0.5) / static_cast<double>(map.columns)) -
                 1.0);
    }
    return heights;
}

}  // namespace treerec::growth
