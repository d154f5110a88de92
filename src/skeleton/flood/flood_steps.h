// How a flood went, step by step, to be drawn (Zhang 2013, 8.1.7).
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

// What the points are: of the wood's surface, as scanners and photos see it, or of all its inside.
enum class CloudKind : uint8_t { kSurface, kSolid };

// One of the directions that a neighbourhood splits into (Zhang 2013, 5.3 and 5.4). Lengths in metres.
struct FloodDirection {
    DVec3 direction{0.0, 1.0, 0.0};  // of unit length, from the node
    double length = 0.0;
    double radius = 0.0;
    double share = 0.0;  // of the neighbourhood's points
    int32_t child = -1;  // the node that was grown there; -1 where the direction was dropped
};

// What happened at one node. Nodes are numbered as they were grown, the root is 0; tree space, metres.
struct FloodStep {
    int32_t node = 0;
    int32_t parent = -1;
    int32_t generation = 0;
    DVec3 position{0.0};
    std::vector<Vec3> voxels;  // the middles of the neighbourhood's voxels, in the order of the flood
    std::vector<FloodDirection> directions;
};

}  // namespace treerec
