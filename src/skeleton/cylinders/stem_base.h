// Where a stem stands on the ground.
#pragma once

#include <vector>

#include "skeleton/branches/skeleton_branches.h"
#include "skeleton/cylinders/axis.h"

namespace treerec {

// The lowest points of a stem are those of one root spur, or what is left of the ground beside it, and its
// axis runs along them before it goes up. Puts the lowest stations of an upright stem, the root too, on the
// straight line of the stem above, each at its own height. A base that is swept but goes up all the way
// stays, and so does all of a stem that is not straight above, or too short to tell. stem: metres, Y up, from
// the root.
void plant_stem_base(std::vector<Station>& stem);

// The sections of a base are those of spurs, buttresses and litter as much as of the stem. Radii there that
// are well below the stem's above count as unknown, and none is more than twice that. stem: as above, fitted.
void limit_stem_base(std::vector<Station>& stem);

// The root has half a ring of points at most, on a spur as often as not: puts it where the stem above comes
// from, at its own height, or as far along a stem that lies. Where several stems meet it is none of theirs,
// and stays. branches, axes: metres, Y up; the first is the stem. Twigs on the root do not count as stems.
void seat_root(const std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes);

}  // namespace treerec
