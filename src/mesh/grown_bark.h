// Bark that was grown as one surface (growth/), as plain data: what shows it needs nothing of how it came to
// be.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "tree/tree.h"

namespace treerec {

// A closed surface about some of a tree's branches; their tubes are not drawn as far as it covers them.
// Metres, tree space; counter-clockwise from outside.
struct GrownBark {
    struct Branch {
        NodeId first = kNoNode;  // the branch's first own node (tree/branches.h): the root, of the trunk
        double until = 0.0;      // metres along the branch's axis that are covered; infinite: all
    };
    struct Vertex {
        Vec3 position{0.0f};
        Vec3 normal{0.0f};   // unit
        float along = 0.0f;  // metres of its branch's axis,
        float around =
            0.0f;  // and 0..1 of a round about it, where the bark's picture has it (grain turns it)
        float radius = 0.0f;   // metres: of the axis there
        int32_t branch = 0;    // in `branches`
        bool decayed = false;  // wood without bark
    };
    std::vector<Branch> branches;
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;

    bool empty() const { return indices.empty(); }
};

}  // namespace treerec
