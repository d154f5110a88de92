// The whole voxel-flood skeletonizer, behind skeletonize().
#pragma once

#include <algorithm>
#include <vector>

#include "skeleton/skeleton.h"

namespace treerec {

// The shortest branch where the user states none, metres. extent: of the tree, from its root.
inline double automatic_branch(double extent) {
    constexpr double kLeast = 0.05;
    constexpr double kShare = 0.003;
    return std::max(kLeast, kShare * extent);
}

// points: the cloud's, thinned to result.spacing. cloud: metres, Y up; the tree gets its frame, and the radii
// that it knows (skeleton/cylinders/known_radii.h). factor: by how much the cloud was enlarged
// (scan/usual_size.h), which the lengths in sentences leave out. Fills all of `result` but the spacing.
// Throws Error for a voxel that does not suit the tree, Cancelled on request.
void flood_skeleton(const std::vector<Vec3>& points, const PointCloud& cloud, const SkeletonOptions& options,
                    double factor, SkeletonResult& result, StageClock& clock, Progress* listener);

}  // namespace treerec
