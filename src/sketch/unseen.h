// What a drawing does not show: the trunk's end inside the crown, and branches in front and behind.
#pragma once

#include <cstdint>

#include "sketch/crown_sections.h"
#include "sketch/sketch_axes.h"

namespace treerec {

// Where the drawn wood ends in the lower half of the crown, or the trunk ends thick, as one of two lines
// does, the trunk goes on through it, thinner and thinner; where it is at the top already its end tapers.
// Call it before add_unseen_branches().
void extend_trunk(SketchAxes& axes, const CrownSections& crown, uint64_t seed);

// Branches so that those of all sides are about as many, none of them drawn: each has the shape of the drawn
// branch nearest to it in height, somewhat varied, stands where there is most room around the trunk, and ends
// in the crown. Where no branch was drawn, they rise as a broadleaf's.
void add_unseen_branches(SketchAxes& axes, const CrownSections& crown, uint64_t seed);

}  // namespace treerec
