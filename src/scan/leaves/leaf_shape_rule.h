// A plain rule for leaves by shape, against which colours are held. Internal to scan/.
#pragma once

#include "scan/leaves/leaf_cells.h"
#include "scan/leaves/leaf_paths.h"

namespace treerec {

// The logit of being leaf, at even odds, of a cell. Photos give bark as wavy as leaves, and of a crown its
// skin alone: this rule then contradicts the colours on half of the points or more, which tells such clouds
// from scanners'. (The networks of leaf_classifier.h agree with the colours on 75 % and more of both.)
// shapes: kShapeScales of them.
float logit_by_shape(const CellShape* shapes, const CellPath& path);

}  // namespace treerec
