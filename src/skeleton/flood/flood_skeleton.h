// The whole voxel-flood skeletonizer, behind skeletonize().
#pragma once

#include "skeleton/stages.h"

namespace treerec {

// From work.points(), thinned to result.spacing metres, to all of work.result; radii that the cloud knows are
// taken from it (skeleton/cylinders/known_radii.h). Throws Error for a voxel that does not suit the tree,
// Cancelled on request.
void flood_skeleton(SkeletonWork& work);

}  // namespace treerec
