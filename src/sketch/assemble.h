// Branches and twigs into one tree.
#pragma once

#include <optional>
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

// Twigs lose what leaves the crown by `margin` (kept_places()), without one nothing; none is thicker than the
// wood that it stands on. Throws Cancelled.
AssembledTree assemble_tree(const Filling& filling, const SketchSpecies& species, const CrownSections& crown,
                            std::optional<double> margin, const Progress* progress = nullptr);

}  // namespace treerec
