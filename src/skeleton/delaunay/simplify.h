// AdTree's simplification: what is noise goes, and what lies side by side becomes one.
#pragma once

#include <cstdint>
#include <vector>

#include "skeleton/cylinders/axis.h"
#include "skeleton/delaunay/initial_skeleton.h"
#include "skeleton/delaunay/trunk_cylinder.h"

namespace treerec {

struct DelaunayVertex {
    DVec3 position{0.0};
    int32_t parent = -1;  // before its children
    double weight = 0.0;  // metres of all edges above
    double reach = 0.0;   // metres to the farthest tip above
};

// The skeleton without its noise (Chen 2025, 2.2.2, step 2; Du et al. 2019, 3.2). A side branch that carries
// no more than its wood is wide there, or less than `shortest` metres, is noise. Children of a vertex whose
// edges run side by side within the wood's width, or as far as the points are apart, are merged, each as
// heavy as what it carries. spacing: metres between the points. root: the first vertex, metres. Throws
// Cancelled.
std::vector<DelaunayVertex> simplify_skeleton(const std::vector<Vec3>& points,
                                              const InitialSkeleton& skeleton, const DVec3& root,
                                              const TrunkCylinder& trunk, double spacing, double shortest,
                                              const Progress& progress);

// The branches of a skeleton, for assemble_tree(): at a fork what carries most goes on. Radii are those of
// the trunk's cylinder and, from there on, allometric (Du et al. 2019, 3.3). longest_edge: metres; a longer
// one crosses a gap.
void branches_of(const std::vector<DelaunayVertex>& vertices, const TrunkCylinder& trunk, double longest_edge,
                 std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes);

}  // namespace treerec
