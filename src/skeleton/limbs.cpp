#include "skeleton/limbs.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>

namespace treerec {

namespace {

constexpr double kSurfaceFactor = 1.3;   // times the radius: still the parent's own surface
constexpr double kSurfaceMargin = 1.0;   // and so many point spacings more: a strip's radius is too small
constexpr double kSparseBranch = 3.0;    // point spacings that a branch must at least reach out
constexpr double kWoodLinearity = 0.45;  // mean linearity of a limb's points: no leaves above,
constexpr double kLeafLinearity = 0.30;  // nothing but leaves below
constexpr int kSmoothWindow = 2;         // stations to each side

// First figures for each slice, before any fit.
struct SliceShape {
    std::vector<double> radius;   // mean distance of the points from their centre
    std::vector<double> spacing;  // mean local spacing of the points
    std::vector<double> longest;  // metres to the farthest tip above
    std::vector<int32_t> first_child;
    std::vector<int32_t> next_sibling;
};

SliceShape measure_slices(const Slices& slices, const std::vector<Vec3>& points, const LocalScale& scale) {
    const size_t count = slices.size();
    SliceShape shape;
    shape.radius.assign(count, 0.0);
    shape.spacing.assign(count, 0.0);
    shape.longest.assign(count, 0.0);
    shape.first_child.assign(count, -1);
    shape.next_sibling.assign(count, -1);
    std::vector<double> wood(count, 0.0);  // metres of all chains above
    for (size_t s = count; s-- > 1;) {
        double sum = 0.0;
        double spacing = 0.0;
        for (const uint32_t v : slices.points_of(s)) {
            sum += glm::distance(DVec3(points[v]), slices.centre[s]);
            spacing += scale.spacing[v];
        }
        const double members = static_cast<double>(slices.points_of(s).size());
        shape.radius[s] = sum / members;
        shape.spacing[s] = spacing / members;
        const size_t p = static_cast<size_t>(slices.parent[s]);
        shape.longest[p] =
            std::max(shape.longest[p], shape.longest[s] + glm::distance(slices.centre[s], slices.centre[p]));
        shape.next_sibling[s] = shape.first_child[p];
        shape.first_child[p] = static_cast<int32_t>(s);
    }
    if (shape.first_child[0] >= 0) shape.spacing[0] = shape.spacing[shape.first_child[0]];
    return shape;
}

// The axis of a limb, smoothed, and how far around it points are still its own: what side chains are compared
// with.
struct LimbAxis {
    std::vector<DVec3> position;
    std::vector<double> surface;
};

LimbAxis smooth_axis(const Limb& limb, const Slices& slices, const SliceShape& shape) {
    const int count = static_cast<int>(limb.slices.size());
    LimbAxis axis;
    axis.position.resize(limb.slices.size());
    axis.surface.resize(limb.slices.size());
    for (int i = 0; i < count; i++) {
        DVec3 sum(0.0);
        double radius = 0.0;
        double weight = 0.0;
        const int reach = std::min({kSmoothWindow, i, count - 1 - i});
        for (int j = i - reach; j <= i + reach; j++) {
            sum += slices.centre[limb.slices[j]];
            weight += 1.0;
        }
        double members = 0.0;
        for (int j = std::max(0, i - kSmoothWindow); j <= std::min(count - 1, i + kSmoothWindow); j++) {
            const double n = static_cast<double>(slices.points_of(limb.slices[j]).size());
            radius += n * shape.radius[limb.slices[j]];
            members += n;
        }
        axis.position[i] = sum / weight;
        axis.surface[i] = kSurfaceFactor * (members > 0.0 ? radius / members : 0.0) +
                          kSurfaceMargin * shape.spacing[limb.slices[i]];
    }
    return axis;
}

// Follows the axis from `station` to the one nearest to p. The distance has one valley near the start.
int nearest_station(const LimbAxis& axis, int station, const DVec3& p) {
    const int last = static_cast<int>(axis.position.size()) - 1;
    auto distance = [&](int i) { return glm::distance(axis.position[i], p); };
    double best = distance(station);
    for (int direction : {1, -1}) {
        for (int i = station + direction, worse = 0; i >= 0 && i <= last && worse < 3; i += direction) {
            const double d = distance(i);
            worse = d < best ? 0 : worse + 1;
            if (d < best) {
                best = d;
                station = i;
            }
        }
    }
    return station;
}

// How long a limb along `chain` must be to count.
double required_length(const std::vector<int32_t>& chain, const Slices& slices, const LimbOptions& options) {
    if (options.linearity.empty() || options.leafy_branch <= options.minimum_branch)
        return options.minimum_branch;
    double sum = 0.0;
    double count = 0.0;
    for (const int32_t slice : chain)
        for (const uint32_t v : slices.points_of(static_cast<size_t>(slice))) {
            sum += options.linearity[v];
            count += 1.0;
        }
    const double mean = count > 0.0 ? sum / count : kWoodLinearity;
    const double leafy = std::clamp((kWoodLinearity - mean) / (kWoodLinearity - kLeafLinearity), 0.0, 1.0);
    return options.minimum_branch + leafy * (options.leafy_branch - options.minimum_branch);
}

struct Candidate {
    int32_t slice;
    int32_t limb;
    int32_t station;
};

}  // namespace

std::vector<Limb> find_limbs(const Slices& slices, const std::vector<Vec3>& points, const LocalScale& scale,
                             const LimbOptions& options) {
    const SliceShape shape = measure_slices(slices, points, scale);
    auto main_child = [&](int32_t slice) {
        int32_t best = -1;
        double best_length = -1.0;
        for (int32_t c = shape.first_child[slice]; c >= 0; c = shape.next_sibling[c]) {
            const double length = shape.longest[c] + glm::distance(slices.centre[c], slices.centre[slice]);
            if (length > best_length) {
                best_length = length;
                best = c;
            }
        }
        return best;
    };
    auto chain_from = [&](int32_t slice) {
        std::vector<int32_t> chain;
        for (; slice >= 0; slice = main_child(slice))
            chain.push_back(slice);
        return chain;
    };

    std::vector<Limb> limbs;
    std::deque<Candidate> waiting;
    // Puts the side chains of chain[begin..end) on the waiting list of `limb`.
    auto side_chains = [&](const std::vector<int32_t>& chain, size_t begin, size_t end, int32_t limb,
                           const std::vector<int32_t>& at) {
        for (size_t i = begin; i < end; i++) {
            const int32_t next = i + 1 < chain.size() ? chain[i + 1] : -1;
            for (int32_t c = shape.first_child[chain[i]]; c >= 0; c = shape.next_sibling[c])
                if (c != next) waiting.push_back({c, limb, at[i]});
        }
    };
    std::vector<LimbAxis> axes;
    std::vector<int32_t> stations;
    std::vector<double> escapes;
    auto add_limb = [&](Limb limb) {
        axes.push_back(smooth_axis(limb, slices, shape));
        stations.resize(limb.slices.size());
        std::iota(stations.begin(), stations.end(), 0);
        limbs.push_back(std::move(limb));
        side_chains(limbs.back().slices, 0, stations.size(), static_cast<int32_t>(limbs.size()) - 1,
                    stations);
    };
    Limb first;
    first.slices = chain_from(0);
    add_limb(std::move(first));

    while (!waiting.empty()) {
        const Candidate candidate = waiting.front();
        waiting.pop_front();
        const std::vector<int32_t> chain = chain_from(candidate.slice);
        const LimbAxis& axis = axes[candidate.limb];
        int station = candidate.station;
        double spacing = 0.0;
        double farthest = 0.0;
        stations.clear();
        escapes.clear();
        for (const int32_t slice : chain) {
            const DVec3& centre = slices.centre[slice];
            station = nearest_station(axis, station, centre);
            stations.push_back(station);
            escapes.push_back(glm::distance(centre, axis.position[station]) - axis.surface[station]);
            farthest = std::max(farthest, escapes.back());
            spacing += shape.spacing[slice];
        }
        spacing /= static_cast<double>(chain.size());
        const double least_escape = std::max(options.least_escape, kSparseBranch * spacing);
        const bool grows_out = farthest >= least_escape;
        // The part of the chain that still lies on the parent's surface belongs to the parent.
        size_t inside = chain.size();
        if (grows_out) {
            inside = 0;
            while (escapes[inside] < least_escape)
                inside++;
            while (inside > 0 && escapes[inside - 1] > 0.0)
                inside--;
        }
        double length = 0.0;
        if (grows_out) {
            station = inside > 0 ? stations[inside - 1] : candidate.station;
            length = glm::distance(slices.centre[chain[inside]], axis.position[station]) +
                     shape.longest[chain[inside]];
        }
        if (length < required_length(chain, slices, options)) inside = chain.size();

        Limb& parent = limbs[candidate.limb];
        const auto cut = static_cast<ptrdiff_t>(inside);
        parent.absorbed.insert(parent.absorbed.end(), chain.begin(), chain.begin() + cut);
        parent.absorbed_at.insert(parent.absorbed_at.end(), stations.begin(), stations.begin() + cut);
        side_chains(chain, 0, inside, candidate.limb, stations);
        if (inside == chain.size()) continue;
        Limb limb;
        limb.parent = candidate.limb;
        limb.attach = station;
        limb.slices.assign(chain.begin() + cut, chain.end());
        add_limb(std::move(limb));
    }
    return limbs;
}

}  // namespace treerec
