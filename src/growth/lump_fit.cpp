#include "growth/lump_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/quantile.h"
#include "growth/feature.h"

namespace treerec::growth {

namespace {

constexpr double kLeastShare = 0.06;  // of the wood's radius: lower lumps are bark
constexpr double kSure = 5.0;         // standard deviations of the smoothed map
constexpr double kSmoothed = 0.3;     // of a cell's deviation is left by smoothing
constexpr double kPart = 0.5;         // metres of a branch whose noise is told together
constexpr double kFewPoints = 8.0;    // about a cell, of which nothing is told
constexpr double kNormalDeviation = 1.4826;
constexpr double kKept = 0.6;         // of the least height that a lump keeps when all are fitted together
constexpr double kKnownShare = 0.5;   // of a lump that the scan must show
constexpr double kExplains = 0.2;     // of the residual's square within it that it must explain
constexpr double kHighest = 1.0;      // radii of the wood: higher ones are something else
constexpr size_t kMostLumps = 64;     // of a branch
constexpr double kLeastRadius = 1.5;  // longest edges, of a lump's radius and of a dent's sides,
constexpr double kLeastCells = 2.5;   // and cells
constexpr double kMostRadius = 1.5;   // radii of the wood
constexpr double kLadder = 1.2;       // from one radius tried to the next
constexpr double kInner[] = {0.0, 0.3, 0.6};  // of the radius
constexpr double kMostWeight = 4.0;           // of a cell: points that lie together tell the same
constexpr int kSweeps = 8;
constexpr double kDeep = 0.25;                   // of the wood's radius: less deep dents are bark
constexpr double kWidest = 2.2, kDeepest = 1.5;  // radii
constexpr double kRim = 0.6;                     // of a dent's rim that the scan must show

// The wood's radius while a proposed burl grows, of that of the end, on average: what is there lies nearer
// together about the wood.
constexpr double kYounger = 0.5 * (1.0 + kLumpFrom);

// Calls take(cell, share of the height) for all cells within a lump, known or not.
template <typename Take>
void each_cell_of(const BarkMap& map, const Lump& lump, Take take) {
    const double middle = (lump.along - map.begin) / map.step - 0.5;
    const double reach = lump.radius / map.step;
    const auto low = static_cast<size_t>(std::max(std::ceil(middle - reach), 0.0));
    const double high = std::min(std::floor(middle + reach), static_cast<double>(map.rows) - 1.0);
    if (high < 0.0) return;
    const double columns = static_cast<double>(map.columns);
    for (size_t row = low; row <= static_cast<size_t>(high); row++) {
        const double along = map.along(row) - lump.along;
        const double wide = 2.0 * kYounger * map.radius[row];
        for (size_t column = 0; column < map.columns; column++) {
            const double round =
                std::remainder((static_cast<double>(column) + 0.5) / columns - lump.around, 1.0);
            const double across = wide * std::sin(kPi * std::abs(round));
            const double share =
                burl_growth(lump.radius, lump.inner, 1.0, std::sqrt(along * along + across * across));
            if (share > 0.0) take(map.cell(row, column), share);
        }
    }
}

class Fit {
  public:
    Fit(const BarkMap& map, double longest, const Progress* progress)
        : map_(map),
          longest_(longest),
          progress_(progress),
          rest_(map.height),
          banned_(map.height.size(), 0),
          apart_(map.height.size(), 0.0) {}

    Lumps find() {
        Lumps found;
        smooth(true);
        set_least();
        pursue(found.lumps);
        fit_together(found.lumps);
        find_dents(found.dents);
        std::stable_sort(found.lumps.begin(), found.lumps.end(),
                         [](const Lump& a, const Lump& b) { return a.height > b.height; });
        return found;
    }

  private:
    bool known(size_t cell) const { return !std::isnan(map_.height[cell]); }
    double weight(size_t cell) const { return std::min(static_cast<double>(map_.count[cell]), kMostWeight); }
    double least_size() const { return std::max(kLeastRadius * longest_, kLeastCells * map_.step); }
    size_t rows_within(double metres) const { return static_cast<size_t>(std::ceil(metres / map_.step)); }

    template <typename Take>
    void each_cell(const Lump& lump, Take take) const {
        each_cell_of(map_, lump, take);
    }

    // smoothed_: by a Gaussian of one cell. first: apart_ and banned_, too.
    void smooth(bool first = false) {
        static constexpr double kKernel[] = {1.0, 0.6065, 0.1353};
        smoothed_.assign(rest_.size(), std::numeric_limits<double>::quiet_NaN());
        const auto columns = static_cast<std::ptrdiff_t>(map_.columns);
        const auto rows = static_cast<std::ptrdiff_t>(map_.rows);
        for (std::ptrdiff_t row = 0; row < rows; row++)
            for (std::ptrdiff_t column = 0; column < columns; column++) {
                const size_t at = static_cast<size_t>(row * columns + column);
                if (!known(at)) continue;
                double sum = 0.0, weights = 0.0, points = 0.0;
                for (std::ptrdiff_t r = std::max<std::ptrdiff_t>(row - 2, 0);
                     r <= std::min(row + 2, rows - 1); r++)
                    for (std::ptrdiff_t c = column - 2; c <= column + 2; c++) {
                        const size_t other = static_cast<size_t>(r * columns + (c + columns) % columns);
                        if (!known(other)) continue;
                        const double w =
                            weight(other) * kKernel[std::abs(r - row)] * kKernel[std::abs(c - column)];
                        sum += w * rest_[other];
                        weights += w;
                        points += map_.count[other];
                    }
                smoothed_[at] = sum / weights;
                // Beside what is around it alone.
                const double others = weights - weight(at);
                if (first) {
                    apart_[at] = others > 0.0 ? std::abs(rest_[at] - smoothed_[at]) * weights / others
                                              : std::numeric_limits<double>::quiet_NaN();
                    if (points < kFewPoints) banned_[at] = 1;
                }
            }
    }

    void set_least() {
        const size_t part = std::max<size_t>(rows_within(kPart), 1);
        std::vector<double> apart;
        for (size_t begin = 0; begin < map_.rows; begin += part) {
            const size_t end = std::min(begin + part, map_.rows);
            apart.clear();
            for (size_t i = begin * map_.columns; i < end * map_.columns; i++)
                if (known(i) && !std::isnan(apart_[i])) apart.push_back(apart_[i]);
            const double noise =
                apart.empty() ? 0.0 : kSure * kSmoothed * kNormalDeviation * quantile(apart, 0.5);
            for (size_t row = begin; row < end; row++)
                least_.push_back(std::max(kLeastShare * map_.radius[row], noise));
        }
    }

    struct Explained {
        double height = 0.0, gain = 0.0;  // gain: of the residual's weighted square
        bool seen = false;
    };
    Explained explain(const Lump& lump) const {
        double pr = 0.0, pp = 0.0, rr = 0.0, all = 0.0, seen = 0.0;
        each_cell(lump, [&](size_t cell, double share) {
            all += share;
            if (!known(cell)) return;
            seen += share;
            const double w = weight(cell);
            pr += w * share * rest_[cell];
            pp += w * share * share;
            rr += w * rest_[cell] * rest_[cell];
        });
        Explained found;
        if (!(pp > 0.0)) return found;
        found.height = pr / pp;
        found.gain = pr * std::max(found.height, 0.0);
        found.seen = seen >= kKnownShare * all && found.gain >= kExplains * rr;
        return found;
    }

    // The best of the widths, and of the places up to `step` cells around.
    void improve(Lump& best, double& gain, double step, bool widths) const {
        const Lump from = best;
        const double wood = map_.radius[row_of(from)];
        for (int r = -1; r <= 1; r++)
            for (int c = -1; c <= 1; c++) {
                Lump lump = from;
                lump.along += r * step * map_.step;
                lump.around += c * step / static_cast<double>(map_.columns);
                const auto look = [&] {
                    const Explained found = explain(lump);
                    if (!found.seen || found.gain <= gain) return;
                    gain = found.gain;
                    best = lump;
                    best.height = found.height;
                };
                if (!widths) {
                    look();
                    continue;
                }
                for (double radius = least_size(); radius <= kMostRadius * wood; radius *= kLadder)
                    for (const double inner : kInner) {
                        lump.radius = radius;
                        lump.inner = inner * radius;
                        look();
                    }
            }
    }
    size_t row_of(const Lump& lump) const {
        const double row = std::floor((lump.along - map_.begin) / map_.step);
        return static_cast<size_t>(std::clamp(row, 0.0, static_cast<double>(map_.rows) - 1.0));
    }

    void add(const Lump& lump, double height) {
        each_cell(lump, [&](size_t cell, double share) {
            if (known(cell)) rest_[cell] += share * height;
        });
    }

    void pursue(std::vector<Lump>& lumps) {
        const double thickest = *std::max_element(map_.radius.begin(), map_.radius.end());
        if (least_size() > thickest) return;
        while (lumps.size() < kMostLumps) {
            if (progress_) progress_->check();
            size_t peak = rest_.size();
            double most = 0.0;
            for (size_t i = 0; i < rest_.size(); i++) {
                if (!known(i) || banned_[i]) continue;
                const double over = smoothed_[i] / least_[i / map_.columns];
                if (over < 1.0 || over <= most) continue;
                most = over;
                peak = i;
            }
            if (peak == rest_.size()) return;
            Lump lump;
            lump.along = map_.along(peak / map_.columns);
            lump.around =
                (static_cast<double>(peak % map_.columns) + 0.5) / static_cast<double>(map_.columns);
            double gain = 0.0;
            improve(lump, gain, 1.0, true);
            if (gain > 0.0) improve(lump, gain, 0.5, true);
            if (gain > 0.0) improve(lump, gain, 0.25, false);
            const size_t row = row_of(lump);
            if (!(gain > 0.0) || lump.height < kKept * least_[row] ||
                lump.height > kHighest * map_.radius[row]) {
                banned_[peak] = 1;
                continue;
            }
            banned_[peak] = 1;
            lumps.push_back(lump);
            add(lump, -lump.height);
            smooth();
        }
    }

    // Least squares by turns (Gauss and Seidel); what becomes too low goes.
    void fit_together(std::vector<Lump>& lumps) {
        for (int sweep = 0; sweep < kSweeps; sweep++)
            for (Lump& lump : lumps) {
                if (progress_) progress_->check();
                add(lump, lump.height);
                lump.height = std::max(explain(lump).height, 0.0);
                add(lump, -lump.height);
            }
        for (Lump& lump : lumps) {
            if (lump.height >= kKept * least_[row_of(lump)]) continue;
            add(lump, lump.height);
            lump.height = 0.0;
        }
        std::erase_if(lumps, [](const Lump& lump) { return lump.height <= 0.0; });
        smooth();
    }

    void find_dents(std::vector<Dent>& dents) {
        std::vector<uint8_t> taken(rest_.size(), 0);
        for (;;) {
            if (progress_) progress_->check();
            size_t lowest = rest_.size();
            double most = 1.0;
            for (size_t i = 0; i < rest_.size(); i++) {
                if (!known(i) || taken[i]) continue;
                const double deep =
                    -smoothed_[i] / std::max(kDeep * map_.radius[i / map_.columns], least_[i / map_.columns]);
                if (deep <= most) continue;
                most = deep;
                lowest = i;
            }
            if (lowest == rest_.size()) return;
            measure_dent(lowest, taken, dents);
        }
    }

    // The cells around its lowest that are half as deep.
    void measure_dent(size_t lowest, std::vector<uint8_t>& taken, std::vector<Dent>& dents) const {
        const auto columns = static_cast<std::ptrdiff_t>(map_.columns);
        const auto rows = static_cast<std::ptrdiff_t>(map_.rows);
        struct Place {
            std::ptrdiff_t row, column;  // the column goes on beyond a round
        };
        const double half = 0.5 * smoothed_[lowest];
        std::vector<Place> cells{
            {static_cast<std::ptrdiff_t>(lowest) / columns, static_cast<std::ptrdiff_t>(lowest) % columns}};
        taken[lowest] = 1;
        Place low = cells.front(), high = cells.front();
        std::vector<double> depths;
        size_t rim = 0, unseen = 0;
        for (size_t i = 0; i < cells.size(); i++) {
            const Place at = cells[i];
            depths.push_back(-map_.height[static_cast<size_t>(at.row * columns +
                                                              (at.column % columns + columns) % columns)]);
            low = {std::min(low.row, at.row), std::min(low.column, at.column)};
            high = {std::max(high.row, at.row), std::max(high.column, at.column)};
            for (const Place& way : {Place{1, 0}, Place{-1, 0}, Place{0, 1}, Place{0, -1}}) {
                const Place to{at.row + way.row, at.column + way.column};
                if (to.row < 0 || to.row >= rows) {
                    rim++, unseen++;
                    continue;
                }
                const size_t cell =
                    static_cast<size_t>(to.row * columns + (to.column % columns + columns) % columns);
                if (!known(cell) || smoothed_[cell] > half) {
                    rim++;
                    unseen += known(cell) ? 0 : 1;
                } else if (!taken[cell]) {
                    taken[cell] = 1;
                    cells.push_back(to);
                }
            }
        }
        const size_t row = lowest / map_.columns;
        Dent dent;
        dent.length = static_cast<double>(high.row - low.row + 1) * map_.step;
        dent.width = static_cast<double>(high.column - low.column + 1) * map_.width(row);
        dent.along = map_.begin + 0.5 * static_cast<double>(low.row + high.row + 1) * map_.step;
        const double around =
            0.5 * static_cast<double>(low.column + high.column + 1) / static_cast<double>(columns);
        dent.around = around - std::floor(around);
        dent.depth = std::min(quantile(depths, 0.8), kDeepest * map_.radius[row]);
        const bool small = dent.width < least_size() || dent.length < least_size();
        const bool wide = dent.width > kWidest * map_.radius[row];
        if (small || wide || static_cast<double>(unseen) > (1.0 - kRim) * static_cast<double>(rim)) return;
        dents.push_back(dent);
    }

    const BarkMap& map_;
    const double longest_;
    const Progress* progress_;
    std::vector<double> rest_;  // what no lump explains so far, by cell
    std::vector<double> smoothed_;
    std::vector<uint8_t> banned_;  // where no peak is looked for (any more)
    std::vector<double> apart_;    // metres that a cell's height is off what is around it; NaN: nothing is
    std::vector<double> least_;    // by row: metres that a lump is high at least
};

}  // namespace

Lumps fit_lumps(const BarkMap& map, double longest, const Progress* progress) {
    if (map.rows == 0) return {};
    return Fit(map, longest, progress).find();
}

void take_off(const Lumps& lumps, BarkMap& map) {
    for (const Lump& lump : lumps.lumps)
        each_cell_of(map, lump, [&](size_t cell, double share) { map.height[cell] -= share * lump.height; });
    const double columns = static_cast<double>(map.columns);
    for (const Dent& dent : lumps.dents)
        for (size_t row = 0; row < map.rows; row++) {
            if (std::abs(map.along(row) - dent.along) > 0.5 * dent.length + map.step) continue;
            for (size_t column = 0; column < map.columns; column++) {
                const double round =
                    std::remainder((static_cast<double>(column) + 0.5) / columns - dent.around, 1.0);
                if (std::abs(round) * columns * map.width(row) < 0.5 * dent.width + map.width(row))
                    map.height[map.cell(row, column)] = std::numeric_limits<double>::quiet_NaN();
            }
        }
}

}  // namespace treerec::growth
