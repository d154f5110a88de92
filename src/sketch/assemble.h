// Limbs and twigs into one tree.
#pragma once

#include <vector>

#include "progress.h"
#include "sketch/crown_sections.h"
#include "sketch/fill.h"
#include "sketch/species.h"
#include "tree/tree.h"

namespace treerec {

struct AssembledTree {
    Tree tree;
    std::vector<int32_t> stroke_of_node;  // by node id; -1: of no stroke
};

// Twigs lose what leaves the crown (by `margin`, CrownSections::contains()), where `cut`; none is thicker
// than the wood that it stands on. Throws Cancelled.
AssembledTree assemble_tree(const Filling& filling, const SketchSpecies& species, const CrownSections& crown,
                            bool cut, double margin, const Progress* progress = nullptr);

}  // namespace treerec
