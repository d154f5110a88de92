// What the scan tells of the outlines of stout wood.
#pragma once

#include <vector>

#include "geometry/vec.h"
#include "progress.h"
#include "tree/tree.h"

namespace treerec {

// Gives the nodes of stout wood the section that the points about them show (outline_of()), over a length of
// about a diameter; nodes nearer to each other than a quarter of one share theirs. A point speaks for the
// wood whose bark is nearest. Radii and places stay. Same sections whatever the order of the points and the
// number of threads. points: metres, in the tree's space. Throws Cancelled on request.
void measure_sections(Tree& tree, const std::vector<Vec3>& points, const Progress& progress);

}  // namespace treerec
