// The base of a trunk, which widens into its roots. Internal to mesh/.
#pragma once

#include <vector>

#include "foliage/branch_axis.h"
#include "mesh/tube_rings.h"

namespace treerec {

// Nothing of the trunk above `reach` changes.
struct RootFlare {
    double amount = 0.0;  // how much wider it stands on the ground on average, over its radius; 0: no flare
    double reach = 0.0;   // metres along
    int lobes = 0;        // roots that it runs out into; 0: round
};

// What a standing trunk still lacks: scans often lose the base in grass, and a pipe in the ground is no tree.
// One that the scan itself widens keeps what was measured. Adds points to hang rings on. points: the trunk's
// axis, from the root; sides: of its tube.
RootFlare plan_flare(std::vector<AxisPoint>& points, uint32_t sides);

struct FlareAt {
    double radius;  // metres
    double slope;   // how it changes per metre along,
    double turn;    // and per metre around
};

// At an angle of a ring that lies below the flare's reach.
FlareAt flare_at(const RootFlare& flare, const Ring& ring, double angle);

// The picture of a base's bark: as wide as the wood is on average there, as far as limit_slant() lets it.
// rings: of the trunk, from the root.
void stretch_base(const RootFlare& flare, Ring* rings, size_t count);

}  // namespace treerec
