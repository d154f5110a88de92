// What a virtual scanner can hit: a tree's wood, and what hangs on it. Internal to synth/.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "tree/tree.h"

namespace treerec {

enum class Shape : uint8_t { kCone, kDisc };

// A tapered cylinder from `from` to `to`, or a disc around `from` with its unit normal in `to`. Metres.
struct Surface {
    DVec3 from;
    DVec3 to;
    double from_radius;
    double to_radius;
    NodeId node;  // the tree's node whose wood it is or hangs on
    Shape shape = Shape::kCone;
    bool leaf = false;
};

// One tapered cylinder per segment.
std::vector<Surface> wood_surfaces(const Tree& tree);

// Discs along the thin wood. share: of full foliage, where a disc stands every 1.5 cm.
void add_leaves(const Tree& tree, double share, uint64_t seed, std::vector<Surface>& surfaces);

// A palm's crown: `count` arching fronds around the highest node, a rachis with strips on both sides each.
void add_fronds(const Tree& tree, int count, uint64_t seed, std::vector<Surface>& surfaces);

// `count` planks of wood around the base of the trunk, about as high as a person. They belong to the root.
void add_buttresses(const Tree& tree, int count, uint64_t seed, std::vector<Surface>& surfaces);

}  // namespace treerec
