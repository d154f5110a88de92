#include "skeleton/twigs/twigs.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "skeleton/cylinders/bark.h"
#include "skeleton/twigs/twig_growth.h"

namespace treerec {

namespace {

constexpr double kBarkRelief = 0.2;  // of the radius: so far off the bark, a point is still explained by it
constexpr int kStumpSteps = 12;      // stations back that the end of thick wood is looked for
constexpr double kStumpEnd = 1.5;    // radii: so long it is
constexpr double kFoot = 4.0;        // radii of the stem: up there roots and ground lie around it
constexpr double kMostBlur = 0.02;   // metres off the bark

class TwigFinder {
  public:
    TwigFinder(const std::vector<Vec3>& points, const PointGraph& graph, const LocalScale& scale,
               const PathTree& paths, const TwigOptions& options, std::vector<SkeletonBranch>& branches,
               std::vector<std::vector<Station>>& axes)
        : field_{points, graph, scale, paths, options, axes},
          branches_(branches),
          axes_(axes),
          bark_(branches, axes) {
        field_.branch.assign(points.size(), -1);
        field_.station.assign(points.size(), 0);
        field_.outside.assign(points.size(), 0.0f);
        field_.surface.assign(points.size(), 0.0f);
        field_.nearest.assign(points.size(), -1);
    }

    void take_slices(const Slices& slices, const Progress& progress) {
        auto take = [&](int32_t slice, int32_t branch, int32_t at) {
            for (const uint32_t v : slices.points_of(static_cast<size_t>(slice)))
                claim(v, bark_.on_branch(branch, at, DVec3(points_[v])));
        };
        parallel_for(branches_.size(), 16, [&](size_t begin, size_t end) {
            progress.check();
            for (size_t l = begin; l < end; l++) {
                const SkeletonBranch& branch = branches_[l];
                const int32_t index = static_cast<int32_t>(l);
                for (size_t i = 0; i < branch.slices.size(); i++)
                    take(branch.slices[i], index, static_cast<int32_t>(i));
                for (size_t m = 0; m < branch.merged.size(); m++)
                    take(branch.merged[m], index, branch.merged_at[m]);
                for (size_t a = 0; a < branch.absorbed.size(); a++)
                    take(branch.absorbed[a], index, branch.absorbed_at[a]);
            }
        });
        find_others(progress);
        while (field_.foot_end + 1 < static_cast<int32_t>(axes_[0].size()) &&
               glm::distance(axes_[0][field_.foot_end].position, axes_[0][0].position) <
                   kFoot * axes_[0][0].radius)
            field_.foot_end++;
        // A path starts on wood.
        for (const uint32_t v : paths_.order)
            if (paths_.parent[v] < 0 && field_.branch[v] < 0) {
                field_.branch[v] = 0;
                field_.station[v] = place_near(axes_[0], 0, DVec3(points_[v])).station;
            }
    }

    // Around a fork, a slice of one branch has points on the bark of another.
    void find_others(const Progress& progress) {
        // What is farther from all bark has escaped it, and lies neither on it nor on the end of a stump.
        const double thickest = bark_.thickest();
        const double stump = (portable::hypot(kStumpEnd, 1.0 + kBarkRelief) - 1.0) * thickest;
        const double far = std::max(required_escape(field_.options.least_escape, thickest),
                                    stump + TwigField::kMostTolerance);
        parallel_for(points_.size(), 1024, [&](size_t begin, size_t end) {
            progress.check();
            uint32_t hint = 0;
            for (size_t v = begin; v < end; v++) {
                if (field_.branch[v] >= 0) continue;
                const BarkPlace place = bark_.nearest(points_[v], far, hint);
                field_.outside[v] = std::numeric_limits<float>::infinity();
                if (place.branch < 0) continue;
                claim(static_cast<uint32_t>(v), place);
                if (field_.branch[v] < 0 && !field_.options.left_out.has(Pass::kStumpEnds))
                    claim_stump(static_cast<uint32_t>(v), place);
                field_.outside[v] = static_cast<float>(place.outside());
                field_.surface[v] = static_cast<float>(place.radius);
            }
        });
    }

    void run(Progress& progress) {
        std::vector<float> length(points_.size(), 0.0f);
        std::vector<uint8_t> may(points_.size(), 0);  // something on the way from the wood may escape it
        std::vector<uint64_t> tips;
        for (const uint32_t v : paths_.order)
            if (field_.branch[v] < 0) {
                const uint32_t before = static_cast<uint32_t>(paths_.parent[v]);
                length[v] = length[before] + paths_.step[v];
                // Paths only grow shorter, so what cannot escape now never will.
                may[v] = may[before] != 0 || field_.may_escape(v) ? 1 : 0;
                if (may[v] != 0) tips.push_back(farthest_first(length[v], v));
            }
        GrownTwigs twigs = grow_twigs(field_, std::move(tips), progress);
        branches_.insert(branches_.end(), std::make_move_iterator(twigs.branches.begin()),
                         std::make_move_iterator(twigs.branches.end()));
        axes_.insert(axes_.end(), std::make_move_iterator(twigs.axes.begin()),
                     std::make_move_iterator(twigs.axes.end()));
    }

    // The scan blurs bark: what is still free, no further out of the bark than the wood is thick, belongs to
    // the wood that its path comes from. Else thin wood would lie where most of its points are, and be too
    // thin.
    void take_blur(Progress& progress) {
        std::vector<int32_t>& wood = field_.nearest;  // by free point: the first on its path that is not free
        size_t looked = 0;
        for (const uint32_t v : paths_.order) {
            if (++looked % 1024 == 0) progress.check();
            if (field_.branch[v] >= 0) continue;
            const int32_t before = paths_.parent[v];
            wood[v] = field_.branch[before] >= 0 ? before : wood[before];
            const int32_t branch = field_.branch[wood[v]];
            const BarkPlace place = place_near(axes_[branch], field_.station[wood[v]], DVec3(points_[v]));
            if (place.outside() >= std::min(kMostBlur, place.radius)) continue;
            field_.branch[v] = branch;
            field_.station[v] = place.station;
        }
    }

    PointPlaces places() && { return {std::move(field_.branch), std::move(field_.station)}; }

  private:
    // Notes that the point lies on the bark of the branch, if it does.
    void claim(uint32_t v, const BarkPlace& place) {
        if (place.distance > (1.0 + kBarkRelief) * place.radius + field_.tolerance(v)) return;
        field_.branch[v] = place.branch;
        field_.station[v] = place.station;
    }

    // Where thick wood ends in thinner branches, or is cut off, its end stands around them: a point straight
    // ahead of the thicker stations behind its place lies on that.
    void claim_stump(uint32_t v, const BarkPlace& place) {
        const DVec3 p(points_[v]);
        int32_t branch = place.branch;
        int32_t at = place.station;
        for (int step = 0; step < kStumpSteps; step++) {
            const std::vector<Station>& line = axes_[branch];
            const double radius = line[at].radius;
            if (at > 0) {
                int32_t behind = at - 1;
                while (behind > 0 && glm::distance(line[at].position, line[behind].position) < radius)
                    behind--;
                const DVec3 along = normalized_or(line[at].position - line[behind].position, DVec3(0, 1, 0));
                const DVec3 offset = p - line[at].position;
                const double ahead = glm::dot(offset, along);
                if (std::abs(ahead) <= kStumpEnd * radius &&
                    glm::length(offset - ahead * along) <=
                        (1.0 + kBarkRelief) * radius + field_.tolerance(v)) {
                    field_.branch[v] = branch;
                    field_.station[v] = at;
                    return;
                }
            }
            if (at == 0 && branches_[branch].parent < 0) return;
            const int32_t next = at > 0 ? at - 1 : branches_[branch].attach;
            if (at == 0) branch = branches_[branch].parent;
            at = next;
        }
    }

    TwigField field_;
    const std::vector<Vec3>& points_ = field_.points;
    const PathTree& paths_ = field_.paths;
    std::vector<SkeletonBranch>& branches_;
    std::vector<std::vector<Station>>& axes_;
    const Bark bark_;  // of the branches that are given
};

}  // namespace

PointPlaces add_twigs(const std::vector<Vec3>& points, const PointGraph& graph, const LocalScale& scale,
                      const PathTree& paths, const Slices& slices, const TwigOptions& options,
                      std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes,
                      Progress& progress) {
    TwigFinder finder(points, graph, scale, paths, options, branches, axes);
    finder.take_slices(slices, progress);
    finder.run(progress);
    if (!options.left_out.has(Pass::kBlur)) finder.take_blur(progress);
    return std::move(finder).places();
}

}  // namespace treerec
