#include "skeleton/branches/thickness.h"

#include <algorithm>
#include <array>

namespace treerec {

namespace {

constexpr std::array<double, 2> kTrials = {6.0, 1.5};  // times the scale
constexpr double kFineScale = 0.8;                     // the final cut of thin wood
constexpr double kRingScale = 0.4;    // of the radius: the point spacing to assume on thick wood
constexpr double kOnSurface = 1.3;    // times the radius
constexpr double kLeastRadius = 1.0;  // trial spacings: a thinner circle is believed to a finer trial only
constexpr size_t kConfirmations = 3;
constexpr size_t kReference = 5;   // circles
constexpr double kSwelling = 1.5;  // times the radius below
constexpr double kBeyond = 2.0;    // radii
constexpr double kStretch = 6.0;   // radii: a longer stretch between two circles stays unknown

// The median of the last kReference values; 0 where there are fewer.
double recent_median(const std::vector<double>& values) {
    if (values.size() < kReference) return 0.0;
    std::array<double, kReference> recent;
    std::copy(values.end() - kReference, values.end(), recent.begin());
    std::nth_element(recent.begin(), recent.begin() + kReference / 2, recent.end());
    return recent[kReference / 2];
}

// The radii of one branch.
struct Belief {
    std::vector<double> radius;  // by station; 0 where unknown
    std::vector<double> limit;   // what wood below the station allows; 0 where unknown
};

// Wood does not grow thicker outward, so a circle much wider than those below it goes round several branches.
// limit: at the branch's base, 0 where unknown.
Belief believed_radii(const std::vector<Station>& stations, double limit) {
    Belief belief;
    belief.limit.resize(stations.size());
    belief.radius.assign(stations.size(), 0.0);
    std::vector<double>& radius = belief.radius;
    std::vector<double> seen;
    size_t last = stations.size();
    double arc = 0.0;
    for (size_t i = 0; i < stations.size(); i++) {
        if (i > 0) arc += glm::distance(stations[i].position, stations[i - 1].position);
        belief.limit[i] = limit;
        if (!stations[i].measured) continue;
        if (limit > 0.0 && stations[i].radius > kSwelling * limit) continue;
        radius[i] = stations[i].radius;
        seen.push_back(radius[i]);
        if (const double median = recent_median(seen); median > 0.0) limit = median;
        belief.limit[i] = limit;
        if (last < i && arc < kStretch * std::max(radius[i], radius[last]))
            std::fill(radius.begin() + static_cast<ptrdiff_t>(last) + 1,
                      radius.begin() + static_cast<ptrdiff_t>(i), std::min(radius[i], radius[last]));
        last = i;
        arc = 0.0;
    }
    // A stem's cut ends show no whole rings, so the outermost circles count a little beyond themselves.
    auto extend = [&](size_t from, ptrdiff_t step, size_t to) {
        const double known = radius[from];
        for (double way = 0.0; from != to; from = static_cast<size_t>(static_cast<ptrdiff_t>(from) + step)) {
            const size_t next = static_cast<size_t>(static_cast<ptrdiff_t>(from) + step);
            way += glm::distance(stations[from].position, stations[next].position);
            if (way > kBeyond * known) return;
            radius[next] = known;
        }
    };
    size_t first = 0;
    while (first < radius.size() && radius[first] == 0.0)
        first++;
    if (first == radius.size()) return belief;
    extend(first, -1, 0);
    extend(last, 1, radius.size() - 1);
    return belief;
}

}  // namespace

LocalScale follow_thickness(const LocalScale& scale, const std::vector<Vec3>& points, const PointGraph& graph,
                            const PathTree& paths, const DVec3& root, const ThicknessOptions& options,
                            Progress& progress) {
    const size_t count = points.size();
    std::vector<float> ring(count, 0.0f);  // the spacing that thick wood asks for
    auto scaled = [&](double factor) {
        std::vector<float> spacing(count);
        for (size_t v = 0; v < count; v++)
            spacing[v] = std::max(static_cast<float>(factor) * scale.spacing[v], ring[v]);
        LocalScale result;
        result.set_spacing(std::move(spacing));
        return result;
    };
    AxisOptions axis_options = options.axes;
    axis_options.rounds = 1;
    axis_options.confirmations = kConfirmations;
    for (const double factor : kTrials) {
        if (options.axes.left_out.has(Pass::kThickness)) break;
        if (factor != kTrials.front() && options.axes.left_out.has(Pass::kSecondTrial)) break;
        const LocalScale trial = scaled(factor);
        const Slices slices = cut_slices(points, graph, trial, paths, root, progress);
        progress.check();
        std::vector<SkeletonBranch> branches =
            branches_of_slices(slices, points, trial, options.branches, progress);
        const std::vector<std::vector<Station>> axes =
            fit_axes(branches, slices, points, trial, axis_options, progress);
        std::vector<Belief> beliefs(branches.size());
        for (size_t l = 0; l < branches.size(); l++) {
            progress.check();
            const int32_t parent = branches[l].parent;
            beliefs[l] =
                believed_radii(axes[l], parent < 0 ? 0.0 : beliefs[parent].limit[branches[l].attach]);
            const std::vector<double>& radius = beliefs[l].radius;
            auto raise = [&](int32_t slice, size_t station) {
                const double r = radius[station];
                for (const uint32_t v : slices.points_of(static_cast<size_t>(slice)))
                    if (r > kLeastRadius * factor * scale.spacing[v] &&
                        glm::distance(DVec3(points[v]), axes[l][station].position) <
                            kOnSurface * r + trial.spacing[v])
                        ring[v] = std::max(ring[v], static_cast<float>(kRingScale * r));
            };
            for (size_t i = 0; i < branches[l].slices.size(); i++)
                raise(branches[l].slices[i], i);
            for (size_t a = 0; a < branches[l].absorbed.size(); a++)
                raise(branches[l].absorbed[a], static_cast<size_t>(branches[l].absorbed_at[a]));
        }
    }
    LocalScale result = scaled(kFineScale);
    result.radius.resize(count);
    for (size_t v = 0; v < count; v++)
        result.radius[v] = ring[v] / static_cast<float>(kRingScale);
    return result;
}

}  // namespace treerec
