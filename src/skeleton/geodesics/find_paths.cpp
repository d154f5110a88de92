#include <algorithm>

#include "skeleton/sampling/wide_gaps.h"
#include "skeleton/stages.h"

namespace treerec {

namespace {

constexpr int kGapRounds = 4;  // wide gaps that are looked at, one behind the other

}  // namespace

void find_paths(SkeletonWork& work) {
    const std::vector<Vec3>& points = work.points();
    work.progress.update(0.55, "Shortest paths");
    work.progress.check();
    work.root = find_root(points, work.graph, work.first_scale, work.options.stem_base, work.progress,
                          work.options.left_out);
    work.progress.check();
    work.extent = extent_from(points, work.root.position);
    work.paths = shortest_paths(work.graph, work.first_scale, work.root.seeds, work.progress);
    WideGaps gaps;
    for (int round = 0; work.does(Pass::kWideGaps) && round < kGapRounds; round++) {
        const size_t known = gaps.links.size();
        if (!link_over_wide_gap(points, work.paths, work.extent, work.graph, gaps, work.progress)) break;
        if (gaps.links.size() > known)
            work.paths =
                shortest_paths(work.graph, work.first_scale, work.root.seeds, work.progress, gaps.links);
    }
    if (work.options.keep_raw) work.result.raw = path_tree_as_tree(points, work.paths, work.root.position);
    work.clock.stop("Shortest paths", points.size());
}

}  // namespace treerec
