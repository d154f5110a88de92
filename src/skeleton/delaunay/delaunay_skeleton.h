// AdTree's skeletonizer, behind skeletonize(): what readers of the papers expect, and ours is compared with.
#pragma once

#include <vector>

#include "skeleton/skeleton.h"

namespace treerec {

// Skeleton initialisation, simplification, branch fitting (Chen 2025, 2.2.2; Du et al. 2019, 3.1 to 3.3).
// points: the cloud's, thinned to result.spacing. cloud: metres, Y up; the tree gets its frame. Fills all of
// `result` but the spacing. Throws Error in a build without CGAL, Cancelled on request.
void delaunay_skeleton(const std::vector<Vec3>& points, const PointCloud& cloud,
                       const SkeletonOptions& options, SkeletonResult& result, StageClock& clock,
                       Progress* listener);

}  // namespace treerec
