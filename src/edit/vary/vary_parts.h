// What src/edit/vary/vary.cpp and vary_foliage.cpp share.
#pragma once

#include <cstdint>
#include <vector>

#include "edit/vary/vary.h"

namespace treerec {

// A branch that is to grow.
struct VariantMaker::Slot {
    int32_t branch = 0;  // whose shape it takes
    int32_t parent = 0;
    DVec3 base{0.0};
    DMat3 turn{1.0};     // of that shape's ways; may mirror
    double scale = 1.0;  // of its lengths,
    double gauge = 1.0;  // and of its radii
    double drift = 1.0;  // what its own growth and that of the branches below it multiply to
    double parent_length = 0.0;
    uint64_t key = 0;
};

// One variant in the making.
struct VariantMaker::Work {
    double amount = 0.0;
    double size = 1.0;   // what its age makes of lengths,
    double gauge = 1.0;  // and of radii
    std::vector<Slot> slots;
    std::vector<DVec3> positions;
    std::vector<double> radii;
    std::vector<NodeId> parents;
    std::vector<uint8_t> flags, leaf_rules;
    std::vector<uint16_t> sections;
    // How many nodes, and how much wood, more than the tree itself has.
    double more_nodes = 0.0, more_wood = 0.0;
    // The way along the trunk, 0..1, turns what it bears: a start, an even twist, and a swing.
    double twist_start = 0.0, twist_even = 0.0, twist_swing = 0.0;
    std::vector<uint32_t> cells;  // of the foliage, and where they went
    std::vector<DVec3> places;
    std::vector<DVec3> tilts;  // by node of the branch at work
};

}  // namespace treerec
