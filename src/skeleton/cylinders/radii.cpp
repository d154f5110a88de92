#include "skeleton/cylinders/radii.h"

#include <algorithm>
#include <cmath>

#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr double kThinnest = 0.001;       // metres
constexpr double kTipAllowance = 0.0028;  // metres: an unmeasured twig's tip
constexpr double kSlenderness = 0.02;     // unmeasured radius over the distance to the tip, at most
constexpr double kThinTip = 0.002;        // the same, at least, as far as the points allow
constexpr double kThinSlenderness = 0.005;
// Standard deviations. The median length of a normal vector is .67 of them in 1D, 1.18 in 2D.
constexpr double kNoiseMedian = 0.67;
constexpr double kMadToSigma = 1.4826;
constexpr size_t kLeastMeasured = 8;  // stations that the noise and the slenderness are estimated from
constexpr double kTaper = 1.5;        // thin wood tapers so much faster than what can be measured
constexpr double kEndStretch = 20.0;  // radii: nearer to a tip, a measured branch is a stump
constexpr double kSoftWeight = 0.05;  // of an unmeasured station beside a measured one
constexpr double kCut = 0.03;         // metres: no wood ends by itself so thick
constexpr double kAlike = 0.25;       // of the radius
constexpr double kCutScatter = 0.2;   // likewise, of the points on what was cut
constexpr double kBase = 6.0;         // radii of the base: how far up its flare may reach
constexpr int kMedianWindow = 4;      // stations to each side
constexpr size_t kBranchesPerTask = 64;

struct Block {
    double value;
    double weight;
    size_t count;
};

// Weighted least squares fit of a sequence that never rises.
std::vector<double> falling_fit(const std::vector<double>& values, const std::vector<double>& weights) {
    std::vector<Block> blocks;
    for (size_t i = 0; i < values.size(); i++) {
        Block block{values[i], weights[i], 1};
        while (!blocks.empty() && blocks.back().value < block.value) {
            const Block& last = blocks.back();
            const double weight = last.weight + block.weight;
            block.value = (last.value * last.weight + block.value * block.weight) / weight;
            block.weight = weight;
            block.count += last.count;
            blocks.pop_back();
        }
        blocks.push_back(block);
    }
    std::vector<double> fitted;
    fitted.reserve(values.size());
    for (const Block& block : blocks)
        fitted.insert(fitted.end(), block.count, block.value);
    return fitted;
}

// Each radius becomes the median of those of its own kind (measured or not) around it.
void running_median(std::vector<Station>& stations) {
    std::vector<double> radius(stations.size());
    std::vector<double> near;
    const int count = static_cast<int>(stations.size());
    for (int i = 0; i < count; i++) {
        near.clear();
        // The same to both sides, lest a base loses its flare.
        const int reach = std::min(kMedianWindow, std::max(1, std::min(i, count - 1 - i)));
        for (int j = std::max(0, i - reach); j <= std::min(count - 1, i + reach); j++)
            if (stations[j].measured == stations[i].measured && stations[j].radius > 0.0)
                near.push_back(stations[j].radius);
        radius[i] = 0.0;
        if (near.empty()) continue;
        std::sort(near.begin(), near.end());
        radius[i] = 0.5 * (near[near.size() / 2] + near[(near.size() - 1) / 2]);
    }
    for (int i = 0; i < count; i++)
        stations[i].radius = radius[i];
}

// The median distance of noisy points to a thin twig's axis is mostly noise, and squares add. (A scanner's
// noise lies along its beams, and seen from several stations it is between that of a line and that of a
// plane.)
double without_noise(double median, double noise, double to_tip) {
    const double square = median * median - kNoiseMedian * kNoiseMedian * noise * noise;
    const double least = kThinTip + kThinSlenderness * to_tip;
    return std::max(std::min(median, least), square > 0.0 ? std::sqrt(square) : 0.0);
}

// How thick this tree's branches are for their length, as the measured stations tell: the median of radius
// over the distance to the tip.
double slenderness_of(const std::vector<std::vector<Station>>& axes) {
    std::vector<double> seen;
    for (const std::vector<Station>& stations : axes) {
        double to_tip = 0.0;
        for (size_t i = stations.size(); i-- > 1;) {
            to_tip += glm::distance(stations[i].position, stations[i - 1].position);
            const Station& station = stations[i - 1];
            if (station.measured && to_tip > kEndStretch * station.radius)
                seen.push_back(station.radius / to_tip);
        }
    }
    if (seen.size() < kLeastMeasured) return kSlenderness;
    const auto middle = seen.begin() + static_cast<ptrdiff_t>(seen.size() / 2);
    std::nth_element(seen.begin(), middle, seen.end());
    return std::clamp(kTaper * *middle, kThinSlenderness, kSlenderness);
}

// A base narrows evenly between stations whose radius was measured. values: by station.
void span_stem_base(const std::vector<Station>& stations, std::vector<double>& values) {
    size_t last = stations.size();
    double way = 0.0;   // from the base,
    double from = 0.0;  // and there to the last measured station
    for (size_t i = 0; i < stations.size() && way < kBase * values[0]; i++) {
        if (i > 0) way += glm::distance(stations[i].position, stations[i - 1].position);
        if (!stations[i].measured) continue;
        double at = from;
        for (size_t j = last + 1; j < i; j++) {
            at += glm::distance(stations[j].position, stations[j - 1].position);
            values[j] =
                std::max(values[j], values[last] + (values[i] - values[last]) * (at - from) / (way - from));
        }
        last = i;
        from = way;
    }
}

// The radius of every station before its neighbours limit it, and how sure that is (its weight). to_tip: to
// be filled with the metres from each station to the tip.
void estimate(const std::vector<Station>& stations, double noise, double slenderness, bool last,
              std::vector<double>& values, std::vector<double>& weights, std::vector<double>& to_tip) {
    const size_t count = stations.size();
    values.assign(count, 0.0);
    weights.assign(count, kSoftWeight);
    to_tip.assign(count, 0.0);
    for (size_t i = count; i-- > 1;)
        to_tip[i - 1] = to_tip[i] + glm::distance(stations[i].position, stations[i - 1].position);
    const auto guess = [&](size_t i) { return kTipAllowance + slenderness * to_tip[i]; };
    // Stations that no point tells anything of are as much thicker or thinner than is usual as those are that
    // the points tell of, on the way between these.
    size_t told = count;
    const auto fill_from = [&](size_t next) {
        for (size_t i = told < count ? told + 1 : 0; i < next; i++) {
            const double before = told < count ? values[told] / guess(told) : 0.0;
            const double after = next < count ? values[next] / guess(next) : 0.0;
            double usual = 1.0;
            if (told < count && next < count) {
                const double t = (to_tip[told] - to_tip[i]) / std::max(to_tip[told] - to_tip[next], 1e-12);
                usual = before + t * (after - before);
            } else if (told < count || next < count) {
                usual = std::max(before, after);
            }
            values[i] = usual * guess(i);
        }
    };
    size_t measured = count;  // the last one
    for (size_t i = 0; i < count; i++) {
        const Station& station = stations[i];
        if (station.measured) {
            values[i] = station.radius;
            weights[i] = 1.0;
            measured = i;
        } else if (station.radius > 0.0) {
            double most = thickest_unmeasured(to_tip[i]);
            if (last && measured < count) {
                // Measured wood narrows evenly to the tip; thick wood that does not was cut.
                const double known = stations[measured].radius;
                const bool cut = known >= kCut && station.radius <= (1.0 + kAlike) * known &&
                                 station.scatter > 0.0 && station.scatter <= kCutScatter * known;
                const double left = to_tip[i] / std::max(to_tip[measured], 1e-12);
                most = std::max(most, cut ? known : known * left);
            }
            values[i] = std::min(most, without_noise(station.radius, noise, to_tip[i]));
        } else {
            continue;
        }
        fill_from(i);
        told = i;
    }
    fill_from(count);
}

}  // namespace

double thickest_unmeasured(double to_tip) {
    return kTipAllowance + kSlenderness * to_tip;
}

double noise_of(const std::vector<std::vector<Station>>& axes) {
    std::vector<double> scatter;
    for (const std::vector<Station>& stations : axes)
        for (const Station& station : stations)
            if (station.measured && station.scatter > 0.0) scatter.push_back(station.scatter);
    if (scatter.size() < kLeastMeasured) return 0.0;
    const auto middle = scatter.begin() + static_cast<ptrdiff_t>(scatter.size() / 2);
    std::nth_element(scatter.begin(), middle, scatter.end());
    return kMadToSigma * *middle;
}

void keep_width(std::vector<Station>& stem) {
    size_t last = stem.size();
    while (last > 0 && !stem[last - 1].measured)
        last--;
    for (size_t i = last; last > 0 && i < stem.size(); i++)
        stem[i].radius = stem[last - 1].radius;
}

void infer_radii(std::vector<std::vector<Station>>& axes, const std::vector<SkeletonBranch>& branches,
                 bool last, PassSet left_out) {
    const double noise = left_out.has(Pass::kNoiseOfRadii) ? 0.0 : noise_of(axes);
    const double slenderness = left_out.has(Pass::kOwnSlenderness) ? kSlenderness : slenderness_of(axes);
    const bool ends = last && !left_out.has(Pass::kMeasuredEnds);
    parallel_for(axes.size(), kBranchesPerTask, [&](size_t begin, size_t end) {
        std::vector<double> values;
        std::vector<double> weights;
        std::vector<double> to_tip;
        for (size_t l = begin; l < end; l++) {
            std::vector<Station>& stations = axes[l];
            if (!left_out.has(Pass::kMedianRadii)) running_median(stations);
            estimate(stations, noise, slenderness, ends, values, weights, to_tip);
            if (branches[l].parent < 0 && !left_out.has(Pass::kBaseSpan)) span_stem_base(stations, values);
            const std::vector<double> fitted = falling_fit(values, weights);
            for (size_t i = 0; i < stations.size(); i++)
                stations[i].radius = fitted[i];
        }
    });
    for (size_t l = 0; l < axes.size(); l++) {
        double limit = std::numeric_limits<double>::max();
        if (branches[l].parent >= 0) limit = axes[branches[l].parent][branches[l].attach].radius;
        for (Station& station : axes[l]) {
            limit = std::max(kThinnest, std::min(limit, station.radius));
            station.radius = limit;
        }
    }
}

}  // namespace treerec
