// A whole tree from a few strokes (Ma and Liu 2020).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "foliage/leaf_rules.h"
#include "progress.h"
#include "sketch/strokes.h"
#include "tree/tree.h"

namespace treerec {

// How strokes get their third dimension (Ma and Liu 2020, 3.1).
enum class SketchDepth : uint8_t {
    // x and y stay exactly as drawn; depth is added, and branches that the drawing does not show, in front
    // and behind, so that the crown is as deep as it is wide.
    kTrue,
    // As printed: branches are turned about their bases by up to 60 degrees, at least 10 apart.
    kPaper,
};

// How the crown bounds the twigs (Ma and Liu 2020, 3.2).
enum class SketchCrown : uint8_t {
    kSections,  // round sections of the outline, a ray marched through those nearest to its own branch
    kAlpha,     // as printed: square sections filled with random points, alpha shapes of each branch's share
};

struct SketchOptions {
    SketchDepth depth = SketchDepth::kTrue;
    SketchCrown crown = SketchCrown::kSections;
    // Metres at the base; 0: as drawn with two lines, else height / 40, less in a slender crown.
    double trunk_radius = 0.0;
    double density = 1.0;  // of twigs, 0..4
    // Of the leaves that are to fill the crown; nothing: those of the preset of the sketch's species.
    std::optional<LeafRules> leaves;
};

struct SketchedTree {
    Tree tree;  // metres, the trunk's base at the origin, Y up, the canvas faces +Z
    UnderstoodSketch understood;
    std::vector<std::string> remarks;  // about the whole, understood.remarks first
    // By node id: the stroke (place in Sketch::strokes) that the node was drawn by, or -1 (twigs, and what
    // the drawing does not show).
    std::vector<int32_t> stroke_of_node;
    // A point of the sketch's canvas (x, y) lies at ((x - base.x) * scale, (base.y - y) * scale) in x and y.
    DVec2 stem_base{0.0};
    double scale = 0.01;      // metres a pixel of the sketch's canvas
    std::string species;      // the preset of its leaves and bark; unless the twigs are own ones, theirs, too
    double crown_base = 0.0;  // metres above the base: below there is only the trunk
};

// The same sketch and options give the same tree on every machine. Throws Error where understand_sketch()
// does, for an unknown species (with twigs of one's own: leaf preset) or options out of range, and Cancelled.
SketchedTree sketch_tree(const Sketch& sketch, const SketchOptions& options,
                         const Progress* progress = nullptr);

}  // namespace treerec
