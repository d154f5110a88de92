// Gaps so wide that several stems cross them.
#pragma once

#include "skeleton/paths.h"

namespace treerec {

// Where a good part of the tree hangs on one link over a wide gap, as where a slab of the scan is missing,
// the other stems that the slab cut hang on their own tops, by whatever they touch there. Adds to the graph,
// for every piece of wood beyond that ends at the gap and runs straight on to wood on this side, the link
// between them. points: metres. extent: of the tree, metres. links: those that were found before; the new
// ones are appended. Returns whether there are any.
bool link_over_wide_gaps(const std::vector<Vec3>& points, const PathTree& paths, double extent,
                         PointGraph& graph, std::vector<SureLink>& links, Progress& progress);

}  // namespace treerec
