#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "scan/stems/lone_trunk.h"
#include "skeleton/cylinders/sections.h"
#include "skeleton/simplify/assemble.h"
#include "skeleton/stages.h"
#include "tree/trunk.h"

namespace treerec {

namespace {

constexpr double kLeastGap = 0.3;   // metres: a gap that the user is told of,
constexpr double kGapShare = 0.04;  // and of the tree's extent

// A sentence about the widest gap that was bridged, if it is a remarkable one.
// factor: by how much the cloud was enlarged.
std::vector<std::string> gap_warnings(const std::vector<std::vector<Station>>& axes,
                                      const std::vector<SkeletonBranch>& branches, double extent,
                                      double factor) {
    double widest = 0.0;
    int gaps = 0;
    const double least = std::max(kLeastGap, kGapShare * extent);
    for (size_t l = 0; l < axes.size(); l++)
        for (size_t i = branches[l].parent < 0 ? 1 : 0; i < axes[l].size(); i++) {
            if (!axes[l][i].bridged) continue;
            const Station& before = i > 0 ? axes[l][i - 1] : axes[branches[l].parent][branches[l].attach];
            const double width = glm::distance(axes[l][i].position, before.position);
            if (width < least) continue;
            gaps++;
            widest = std::max(widest, width);
        }
    if (gaps == 0) return {};
    std::array<char, 200> text;
    std::snprintf(text.data(), text.size(),
                  "The scan has %s of up to %.1f m in the wood; what lies between is a guess.",
                  gaps == 1 ? "a gap" : (std::to_string(gaps) + " gaps").c_str(), widest / factor);
    return {text.data()};
}

// A stump is one piece of wood: its sections, one after another.
Tree stump_tree(const std::vector<TrunkRing>& rings, const SkeletonOptions& options) {
    std::vector<Station> axis;
    for (const TrunkRing& ring : rings)
        axis.push_back({ring.centre, ring.radius, ring.scatter, options.fit_radii});
    SkeletonBranch branch;
    branch.slices.resize(axis.size());
    return assemble_tree({axis}, {branch}, options.simplify_distance);
}

}  // namespace

bool take_stump(SkeletonWork& work) {
    const std::vector<Vec3>& all = work.cloud.positions;
    const std::vector<TrunkRing> rings =
        work.options.trunk_alone ? trunk_rings(all, &work.progress) : stump_rings(all, &work.progress);
    if (rings.empty()) return false;
    work.result.tree = stump_tree(rings, work.options);
    finish(work);
    if (work.options.keep_raw) work.result.raw = work.result.tree;
    return true;
}

void simplify(SkeletonWork& work) {
    work.result.warnings = gap_warnings(work.axes, work.branches, work.extent, work.factor);
    work.progress.update(0.95, "Simplification");
    work.result.tree =
        assemble_tree(work.axes, work.branches, work.options.simplify_distance, work.options.left_out);
    finish(work);
}

DVec3 finish(SkeletonWork& work) {
    SkeletonResult& result = work.result;
    mark_trunk(result.tree);
    measure_sections(result.tree, work.thinned.measured(), work.progress);
    const DVec3 base = result.tree.node(result.tree.root()).position;
    for (Tree* tree : {&result.tree, &result.raw}) {
        if (tree->size() == 0) continue;
        tree->set_frame(work.cloud.frame);
        tree->rebase(base);
    }
    work.clock.stop("Simplification", result.tree.size());
    work.progress.update(1.0, "Skeleton");
    return base;
}

}  // namespace treerec
