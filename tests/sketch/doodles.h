// What people scribble in twenty seconds when they are asked for a tree: doodles.
//
// Crowns that are round, or clouds, hearts, triangles, zigzags, spirals or scribbles, firs of stacked
// triangles, bare trees and palms, with a trunk of one line, two, or a box, or all in one stroke; and beside
// them roots, ground, grass, apples, holes, a sun, letters. Strokes come in any order and direction, torn and
// unclosed, with a few points or thousands, on canvases of all sizes. And things that are no tree at all.
#pragma once

#include <cstdint>
#include <vector>

#include "sketch/strokes.h"

namespace treerec::test {

struct Doodle {
    Sketch sketch;
    const char* kind = "";
    bool tree_like = false;    // a person would call it a tree
    bool has_outline = false;  // of the crown, in one stroke or several
    // Where its crown is and where its trunk stands, pixels of the sketch's canvas, y down; of tree-like
    // ones.
    DVec2 crown_low{0.0}, crown_high{0.0};
    DVec2 stem_base{0.0};
};

// The same seed gives the same doodle. About one in seven is nothing like a tree.
Doodle scribbled_doodle(uint64_t seed);

}  // namespace treerec::test
