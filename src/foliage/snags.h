// Finds the twigs that bear no leaves. Internal to foliage/.
#pragma once

#include <cstdint>
#include <vector>

#include "tree/branches.h"
#include "tree/tree.h"

namespace treerec {

// By branch: 1 for a snag, and for all that grows on one. A scan of an old stem is full of them - dead twigs,
// bark strips, water shoots, noise - and leaves on them make ivy of its stem and a bush of its base. A snag
// springs from wood thicker than `stout_radius` (metres) and
//   - is shorter than six radii of that wood, or
//   - is itself thinner than `stout_radius` and half that wood, and hugs it: nowhere further from its axis
//     than three radii, or
//   - is as thin, reaches no further than twelve radii, and lies below the crown: below all but a tenth of
//     the thin wood.
std::vector<uint8_t> find_snags(const Tree& tree, const BranchList& list, double stout_radius);

}  // namespace treerec
