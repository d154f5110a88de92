// A small picture of a whole tree, drawn without an engine: for lists of files and of variants.
#pragma once

#include <string>
#include <vector>

#include "foliage/leaves.h"
#include "geometry/vec.h"
#include "mesh/image.h"
#include "tree/tree.h"

namespace treerec {

// 0..255 each, as a screen shows them.
struct TreeColors {
    DVec3 stout{112.0, 92.0, 74.0};   // of the stem,
    DVec3 thin{140.0, 112.0, 84.0};   // and of twigs
    DVec3 leaf{92.0, 134.0, 56.0};    // in the light
    DVec3 other{148.0, 160.0, 66.0};  // what leaves of the highest hue have of another colour
};

// Of a leaf preset (foliage/leaf_rules.h); those of "generic" for any other name.
TreeColors tree_colors(const std::string& preset);

// Seen level from the front (along -z, x to the right), filling a square of `size` pixels, 16..1024; four
// channels, transparent around the tree. Leaves are soft dots. An empty tree leaves it empty. Throws Error
// for another size. Linear in nodes, leaves and pixels; the same arguments give the same bytes.
Image draw_tree(const Tree& tree, const std::vector<LeafPlacement>& leaves, const TreeColors& colors,
                int size);

// The same with leaves of several kinds; of `colors` only those of the wood are looked at.
struct PicturedLeaves {
    std::vector<LeafPlacement> leaves;
    DVec3 leaf{0.0}, other{0.0};  // as in TreeColors
};
Image draw_leafy_tree(const Tree& tree, const std::vector<PicturedLeaves>& kinds, const TreeColors& colors,
                      int size);

}  // namespace treerec
