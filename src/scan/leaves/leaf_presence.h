// Whether a cloud shows leaves at all, before one asks which of its points they are. Internal to scan/.
//
// The thresholds lie between the bare and the leafy scans of which each was thinned to as little as a
// fiftieth, evenly, from the top and from one side.
#pragma once

#include "scan/leaves/leaf_cells.h"
#include "scan/leaves/leaf_paths.h"

namespace treerec {

// Means over the points.
struct CrownLooks {
    double resolution = 0.0;  // cells along the cloud's extent
    double cell = 0.0;        // metres
    double filled = 0.0;      // share of the 26 cells around that are occupied, on the finest grid
    double scattered = 0.0;   // CellShape::scatter there
    double flat = 0.0;        // CellShape::planarity on the grid twice as coarse
};

// Above 0 for a tree in leaf: a logistic rule on the mean of all points' cells.
double mean_leafiness(const Cells& cells, const CellShapes& shapes, const CellPaths& paths);

// A first look by the coarser shapes alone (scales 1 and up): whether there is nothing to look for.
bool surely_bare(const Cells& cells, const CellShapes& shapes);

// shapes: of all scales.
CrownLooks look_at_crown(const Cells& cells, const CellShapes& shapes);

// Whether the cells are fine enough, or filled as no bare crown's are, for shape to tell leaves from twigs.
bool resolves_leaves(const CrownLooks& looks);
// Whether they may be, where mean_leafiness() says so: then is_lush() decides.
bool may_resolve_leaves(const CrownLooks& looks);
bool is_lush(double leafiness);

// What looks like blur may be leaves around the foot: where the crown is in leaf and most of it yet sharp
// wood.
bool may_be_leaves_not_blur(const CrownLooks& looks);
// share, leafiness: as for is_in_leaf().
bool are_leaves_not_blur(double share, double leafiness);

// Fronds are flat like no other leaves.
bool looks_like_fronds(const CrownLooks& looks);

// Where the means of a blurred scan's points lie on no surface either: whether they are sharp enough for the
// leafiness to tell leaves all the same. points: of the scan, to a mean.
bool may_outshine_blur(const CrownLooks& looks, double points);
bool outshines_blur(double leafiness);

struct LeafShare {
    double of_points = 0.0;
    bool closely = false;  // by the classifier, else by the shape rule, which is less sure
};

// Of a cloud that resolves leaves. leafiness: mean_leafiness().
bool is_in_leaf(const CrownLooks& looks, const LeafShare& share, double leafiness);
// Likewise beyond the doubts that remain where means of a blurred scan's points are looked at.
bool is_surely_in_leaf(const CrownLooks& looks, const LeafShare& share, double leafiness);

}  // namespace treerec
