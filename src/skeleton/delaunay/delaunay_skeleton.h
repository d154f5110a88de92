// AdTree's skeletonizer, behind skeletonize(): what readers of the papers expect, and ours is compared with.
#pragma once

#include "skeleton/stages.h"

namespace treerec {

// Skeleton initialisation, simplification, branch fitting (Chen 2025, 2.2.2; Du et al. 2019, 3.1 to 3.3).
// From work.points(), thinned to result.spacing metres, to all of work.result. Throws Error in a build
// without CGAL, Cancelled on request.
void delaunay_skeleton(SkeletonWork& work);

}  // namespace treerec
