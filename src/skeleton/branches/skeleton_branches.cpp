#include "skeleton/branches/skeleton_branches.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <span>
#include <utility>

#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "geometry/segment.h"

namespace treerec {

namespace {

constexpr double kSurfaceFactor = 1.3;  // times the radius: still the parent's own surface
constexpr double kSurfaceMargin = 1.0;  // and so many point spacings more: a strip's radius is too small
constexpr double kSparseBranch = 3.0;   // point spacings that a branch must at least reach out
constexpr double kStrip = 0.6;          // of the known radius: what spreads less is a strip of bark
constexpr double kStub = 0.6;           // surface radii that a branch must reach out, likewise
constexpr double kStrayWood = 0.2;      // of a gap: with less wood beyond it, that is stray points
constexpr double kLoopLength = 2.0;     // times its width that a loop of bark must at least be long
constexpr double kThinWood = 2.0;       // fine point spacings: thinner wood is all alike
constexpr int kSameFork = 5;            // stations
constexpr int kSmoothWindow = 2;        // stations to each side
constexpr size_t kSlicesPerTask = 512;

// First figures for each slice, before any fit.
struct SliceShape {
    std::vector<double> radius;   // mean distance of the points from their centre
    std::vector<double> spacing;  // mean local spacing of the points
    std::vector<double> known;    // mean known radius of the wood they lie on, 0 where unknown
    std::vector<double> longest;  // metres to the farthest tip above
    std::vector<double> bulk;     // square metres: the greatest way to a tip, each step times its thickness
    std::vector<int32_t> first_child;
    std::vector<int32_t> next_sibling;
    double thin = 0.0;  // metres: differences below this are none

    double thickness(size_t slice) const { return std::max(known[slice], thin); }
};

SliceShape measure_slices(const Slices& slices, const std::vector<Vec3>& points, const LocalScale& scale,
                          const Progress& progress) {
    const size_t count = slices.size();
    SliceShape shape;
    shape.radius.assign(count, 0.0);
    shape.spacing.assign(count, 0.0);
    shape.known.assign(count, 0.0);
    shape.longest.assign(count, 0.0);
    shape.bulk.assign(count, 0.0);
    shape.first_child.assign(count, -1);
    shape.next_sibling.assign(count, -1);
    std::vector<double> wood(count, 0.0);  // metres of all chains above
    // The spacing is raised on thick wood; what is finest is near the true one.
    std::vector<float> spacings = scale.spacing;
    const auto fine = spacings.begin() + static_cast<ptrdiff_t>(spacings.size() / 10);
    std::nth_element(spacings.begin(), fine, spacings.end());
    shape.thin = kThinWood * *fine;
    std::vector<double> steps(count, 0.0);  // metres to the parent
    parallel_for(count, kSlicesPerTask, [&](size_t first, size_t last) {
        progress.check();
        for (size_t s = std::max<size_t>(first, 1); s < last; s++) {
            for (const uint32_t v : slices.points_of(s)) {
                shape.radius[s] += glm::distance(DVec3(points[v]), slices.centre[s]);
                shape.spacing[s] += scale.spacing[v];
                if (!scale.radius.empty()) shape.known[s] += scale.radius[v];
            }
            const double members = static_cast<double>(slices.points_of(s).size());
            shape.radius[s] /= members;
            shape.spacing[s] /= members;
            shape.known[s] /= members;
            steps[s] = glm::distance(slices.centre[s], slices.centre[slices.parent[s]]);
        }
    });
    for (size_t s = count; s-- > 1;) {
        const size_t p = static_cast<size_t>(slices.parent[s]);
        const double step = steps[s];
        if (slices.bridged[s] && wood[s] < kStrayWood * step) continue;  // stray points
        wood[p] += wood[s] + step;
        shape.longest[p] = std::max(shape.longest[p], shape.longest[s] + step);
        shape.bulk[p] = std::max(shape.bulk[p], shape.bulk[s] + step * shape.thickness(s));
        shape.next_sibling[s] = shape.first_child[p];
        shape.first_child[p] = static_cast<int32_t>(s);
    }
    if (shape.first_child[0] >= 0) shape.spacing[0] = shape.spacing[shape.first_child[0]];
    return shape;
}

// The centre of each station's points, merged slices included.
std::vector<DVec3> station_centres(const SkeletonBranch& branch, const Slices& slices) {
    std::vector<DVec3> centre(branch.slices.size());
    std::vector<double> weight(branch.slices.size());
    for (size_t i = 0; i < centre.size(); i++) {
        centre[i] = slices.centre[branch.slices[i]];
        weight[i] = static_cast<double>(slices.points_of(branch.slices[i]).size());
    }
    for (size_t m = 0; m < branch.merged.size(); m++) {
        const int32_t at = branch.merged_at[m];
        const double more = static_cast<double>(slices.points_of(branch.merged[m]).size());
        weight[at] += more;
        centre[at] += more / weight[at] * (slices.centre[branch.merged[m]] - centre[at]);
    }
    return centre;
}

// The axis of a branch, smoothed, and how far around it points are still its own: what side chains are
// compared with.
struct SmoothAxis {
    std::vector<DVec3> position;
    std::vector<double> surface;
};

SmoothAxis smooth_axis(const SkeletonBranch& branch, const Slices& slices, const SliceShape& shape) {
    const int count = static_cast<int>(branch.slices.size());
    const std::vector<DVec3> centre = station_centres(branch, slices);
    std::vector<double> spread(
        branch.slices.size());  // sum of the points' distances from the station's centre
    std::vector<double> members(branch.slices.size());
    auto add = [&](int32_t slice, int32_t at) {
        const double n = static_cast<double>(slices.points_of(slice).size());
        spread[at] +=
            n * portable::hypot(shape.radius[slice], glm::distance(slices.centre[slice], centre[at]));
        members[at] += n;
    };
    for (int i = 0; i < count; i++)
        add(branch.slices[i], i);
    for (size_t m = 0; m < branch.merged.size(); m++)
        add(branch.merged[m], branch.merged_at[m]);

    SmoothAxis axis;
    axis.position.resize(branch.slices.size());
    axis.surface.resize(branch.slices.size());
    for (int i = 0; i < count; i++) {
        DVec3 sum(0.0);
        double radius = 0.0;
        double weight = 0.0;
        // The root's own slice has no points and may stand between several stems.
        const int own = i > 0 && branch.slices[0] == 0 ? i - 1 : i;
        const int reach = std::min({kSmoothWindow, own, count - 1 - i});
        for (int j = i - reach; j <= i + reach; j++) {
            sum += centre[j];
            weight += 1.0;
        }
        axis.position[i] = sum / weight;
        double near = 0.0;
        for (int j = std::max(0, i - kSmoothWindow); j <= std::min(count - 1, i + kSmoothWindow); j++) {
            radius += spread[j];
            near += members[j];
        }
        const double seen = near > 0.0 ? radius / near : 0.0;
        const double known = shape.known[branch.slices[i]];
        // A strip of thick wood runs on its bark, and other strips of it may lie right across.
        const double around = seen < kStrip * known ? 2.0 * known : std::max(seen, known);
        axis.surface[i] = kSurfaceFactor * around + kSurfaceMargin * shape.spacing[branch.slices[i]];
    }
    return axis;
}

// Follows the axis from `station` to the one nearest to p. The distance has one valley near the start.
int nearest_station(const SmoothAxis& axis, int station, const DVec3& p) {
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

// A chain that may become a branch.
struct Candidate {
    double length;  // metres from its first slice to its tip
    int32_t slice;
    int32_t branch;
    int32_t station;

    // The longest comes first, so that a strip of bark meets the branch it belongs to.
    bool operator<(const Candidate& other) const {
        return length != other.length ? length < other.length : slice > other.slice;
    }
};

// A chain laid along a branch's axis, to where it is clearly off the branch's surface.
struct Fit {
    std::vector<int32_t> stations;  // of the branch, nearest to each slice of the chain
    size_t inside = 0;              // so many slices from the chain's base lie on the branch's own surface
    int32_t attach = 0;
};

class BranchFinder {
  public:
    BranchFinder(const Slices& slices, const std::vector<Vec3>& points, const LocalScale& scale,
                 const BranchOptions& options, const Progress& progress)
        : slices_(slices),
          options_(options),
          progress_(progress),
          shape_(measure_slices(slices, points, scale, progress)),
          owner_(slices.size(), -1),
          owner_station_(slices.size(), 0) {}

    std::vector<SkeletonBranch> run() {
        SkeletonBranch first;
        first.slices = chain_from(0);
        add_branch(std::move(first));
        while (!waiting_.empty()) {
            const Candidate candidate = waiting_.top();
            waiting_.pop();
            progress_.check();
            place(candidate);
        }
        return std::move(branches_);
    }

  private:
    // The child that continues the branch: the one with the most wood on its way to a tip, so that a stem
    // does not end where a longer but thinner branch leaves it.
    int32_t main_child(int32_t slice) const {
        int32_t best = -1;
        double most = -1.0;
        for (int32_t c = shape_.first_child[slice]; c >= 0; c = shape_.next_sibling[c]) {
            const double bulk = shape_.bulk[c] + glm::distance(slices_.centre[c], slices_.centre[slice]) *
                                                     shape_.thickness(static_cast<size_t>(c));
            if (bulk > most) {
                most = bulk;
                best = c;
            }
        }
        return best;
    }

    std::vector<int32_t> chain_from(int32_t slice) const {
        std::vector<int32_t> chain;
        for (; slice >= 0; slice = main_child(slice))
            chain.push_back(slice);
        return chain;
    }

    // Puts the side chains of the chain's first `end` slices on the waiting list of `branch`.
    void await_sides(std::span<const int32_t> chain, size_t end, int32_t branch,
                     const std::vector<int32_t>& stations) {
        for (size_t i = 0; i < end; i++) {
            const int32_t next = i + 1 < chain.size() ? chain[i + 1] : -1;
            for (int32_t c = shape_.first_child[chain[i]]; c >= 0; c = shape_.next_sibling[c])
                if (c != next) waiting_.push({shape_.longest[c], c, branch, stations[i]});
        }
    }

    // Makes the chain's first `end` slices part of the branch.
    void absorb(std::span<const int32_t> chain, size_t end, int32_t branch,
                const std::vector<int32_t>& stations) {
        SkeletonBranch& into = branches_[branch];
        const auto cut = static_cast<ptrdiff_t>(end);
        into.absorbed.insert(into.absorbed.end(), chain.begin(), chain.begin() + cut);
        into.absorbed_at.insert(into.absorbed_at.end(), stations.begin(), stations.begin() + cut);
        for (size_t i = 0; i < end; i++)
            own(chain[i], branch, stations[i]);
        await_sides(chain, end, branch, stations);
    }

    void own(int32_t slice, int32_t branch, int32_t station) {
        owner_[slice] = branch;
        owner_station_[slice] = station;
    }

    // Merges the part of the chain, from its base on, that forms a loop with the branch: the branch's slices
    // beside its end lie further along. Says how many slices that were.
    size_t merge_loop(std::span<const int32_t> chain, int32_t branch, Fit& fit) {
        if (options_.left_out.has(Pass::kLoops)) return 0;
        const SmoothAxis& axis = axes_[branch];
        std::vector<int32_t> stations;
        int32_t station = fit.attach;
        double aside = 0.0;
        double length = glm::distance(slices_.centre[chain[0]], axis.position[fit.attach]);
        size_t end = 0;
        int32_t end_station = fit.attach;
        for (size_t i = 0; i < chain.size(); i++) {
            const DVec3& centre = slices_.centre[chain[i]];
            station = nearest_station(axis, station, centre);
            stations.push_back(station);
            aside = std::max(aside, glm::distance(centre, axis.position[station]));
            if (i > 0) length += glm::distance(centre, slices_.centre[chain[i - 1]]);
            if (aside > options_.widest_loop) break;
            if (length < kLoopLength * aside) continue;
            for (const uint32_t beside : slices_.slices_beside(chain[i]))
                if (owner_[beside] == branch && owner_station_[beside] > fit.attach) {
                    end = i + 1;
                    end_station = std::max(fit.attach, owner_station_[beside]);
                }
        }
        if (end == 0) return 0;
        SkeletonBranch& into = branches_[branch];
        for (size_t i = 0; i < end; i++) {
            into.merged.push_back(chain[i]);
            into.merged_at.push_back(stations[i]);
            own(chain[i], branch, stations[i]);
        }
        await_sides(chain, end, branch, stations);
        axes_[branch] = smooth_axis(into, slices_, shape_);
        fit.attach = std::max(stations[end - 1], std::min(end_station, stations[end - 1]));
        return end;
    }

    void add_branch(SkeletonBranch branch) {
        const int32_t index = static_cast<int32_t>(branches_.size());
        axes_.push_back(smooth_axis(branch, slices_, shape_));
        sides_.emplace_back();
        if (branch.parent >= 0) sides_[static_cast<size_t>(branch.parent)].push_back(index);
        std::vector<int32_t> stations(branch.slices.size());
        std::iota(stations.begin(), stations.end(), 0);
        for (const int32_t i : stations)
            own(branch.slices[i], index, i);
        await_sides(branch.slices, stations.size(), index, stations);
        branches_.push_back(std::move(branch));
    }

    // From the way between the parent's axis and the branch's first station.
    double distance_from_base(int32_t branch, const DVec3& p) const {
        const DVec3& first = axes_[branch].position[0];
        if (branches_[branch].parent < 0) return glm::distance(first, p);
        const DVec3& fork = axes_[branches_[branch].parent].position[branches_[branch].attach];
        return distance_to_segment(p, fork, first);
    }

    // How far a slice's centre lies above the branch's surface at the station.
    double escape(int32_t slice, int32_t branch, int32_t station) const {
        const SmoothAxis& axis = axes_[branch];
        const DVec3& centre = slices_.centre[slice];
        const double aside =
            station == 0 ? distance_from_base(branch, centre) : glm::distance(centre, axis.position[station]);
        return aside - axis.surface[station];
    }

    Fit lay_along(std::span<const int32_t> chain, int32_t branch, int32_t station) const {
        const SmoothAxis& axis = axes_[branch];
        double spacing = 0.0;
        for (const int32_t slice : chain)
            spacing += shape_.spacing[slice];
        const double least_escape =
            std::max(options_.least_escape, kSparseBranch * spacing / static_cast<double>(chain.size()));
        Fit fit;
        fit.attach = station;
        std::vector<double> escapes;
        for (const int32_t slice : chain) {
            station = nearest_station(axis, station, slices_.centre[slice]);
            fit.stations.push_back(station);
            escapes.push_back(escape(slice, branch, station));
            if (escapes.back() >= std::max(least_escape, kStub * axis.surface[station])) break;
            fit.inside++;
        }
        if (fit.inside == chain.size()) return fit;
        while (fit.inside > 0 && escapes[fit.inside - 1] > 0.0)
            fit.inside--;
        if (fit.inside > 0) fit.attach = fit.stations[fit.inside - 1];
        return fit;
    }

    void place(const Candidate& candidate) {
        const std::vector<int32_t> whole = chain_from(candidate.slice);
        std::span<const int32_t> chain = whole;
        int32_t branch = candidate.branch;
        int32_t station = candidate.station;
        Fit fit;
        for (;;) {
            fit = lay_along(chain, branch, station);
            absorb(chain, fit.inside, branch, fit.stations);
            chain = chain.subspan(fit.inside);
            if (chain.empty()) return;
            // What leaves the branch may be a strip of another branch that leaves it at the same place.
            const int32_t side = side_under(chain, branch, fit.attach);
            if (side >= 0) {
                branch = side;
                station = 0;
                continue;
            }
            const size_t merged = merge_loop(chain, branch, fit);
            if (merged == 0) break;
            chain = chain.subspan(merged);
            if (chain.empty()) return;
            station = fit.attach;
        }
        const double length = glm::distance(slices_.centre[chain[0]], axes_[branch].position[fit.attach]) +
                              shape_.longest[chain[0]];
        if (length < options_.minimum_branch) {
            // Also where it is off the surface.
            std::vector<int32_t> stations(fit.stations.begin() + static_cast<ptrdiff_t>(fit.inside),
                                          fit.stations.end());
            while (stations.size() < chain.size())
                stations.push_back(
                    nearest_station(axes_[branch], stations.back(), slices_.centre[chain[stations.size()]]));
            absorb(chain, chain.size(), branch, stations);
            return;
        }
        SkeletonBranch next;
        next.parent = branch;
        next.attach = fit.attach;
        next.slices.assign(chain.begin(), chain.end());
        add_branch(std::move(next));
    }

    // The side branch of `branch`, near station `attach`, on whose surface the chain starts; -1 for none.
    int32_t side_under(std::span<const int32_t> chain, int32_t branch, int32_t attach) const {
        if (options_.left_out.has(Pass::kSameFork)) return -1;
        for (const int32_t side : sides_[branch]) {
            if (std::abs(branches_[side].attach - attach) > kSameFork) continue;
            const int32_t station = nearest_station(axes_[side], 0, slices_.centre[chain.front()]);
            if (escape(chain.front(), side, station) <= 0.0) return side;
        }
        return -1;
    }

    const Slices& slices_;
    const BranchOptions& options_;
    const Progress& progress_;
    SliceShape shape_;
    std::vector<SkeletonBranch> branches_;
    std::vector<SmoothAxis> axes_;
    std::vector<int32_t> owner_;  // by slice: the branch that it is part of, -1 while that is open
    std::vector<int32_t> owner_station_;
    std::vector<std::vector<int32_t>> sides_;  // the branches on each branch
    std::priority_queue<Candidate> waiting_;
};

}  // namespace

std::vector<SkeletonBranch> branches_of_slices(const Slices& slices, const std::vector<Vec3>& points,
                                               const LocalScale& scale, const BranchOptions& options,
                                               const Progress& progress) {
    return BranchFinder(slices, points, scale, options, progress).run();
}

}  // namespace treerec
