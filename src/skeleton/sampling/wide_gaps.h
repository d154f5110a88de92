// Gaps so wide that several stems cross them.
#pragma once

#include "skeleton/geodesics/paths.h"

namespace treerec {

struct WideGaps {
    std::vector<SureLink> links;   // over them
    std::vector<PointEdge> known;  // those links, and every edge that a gap was found at
};

// Where a good part of the tree hangs on one link over a wide gap, as where a slab of the scan is missing,
// the other stems that the slab cut hang on their own tops, by whatever they touch there. Looks at the gap
// that most hangs on and was not looked at yet, and adds, for every piece of wood that ends there and runs
// straight on to wood on the other side, the link between them. points: metres. extent: of the tree, metres.
// Returns whether there was such a gap and any wood runs on over it: where none does, no other gap is looked
// at.
bool link_over_wide_gap(const std::vector<Vec3>& points, const PathTree& paths, double extent,
                        PointGraph& graph, WideGaps& gaps, Progress& progress);

}  // namespace treerec
