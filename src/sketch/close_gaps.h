// A crown that one can't see the sky through where the outline is drawn.
#pragma once

#include <cstdint>

#include "foliage/leaf_rules.h"
#include "progress.h"
#include "sketch/crown_sections.h"
#include "sketch/fill.h"

namespace treerec {

// Adds twigs, from the branch nearest to each, to the parts of the crown's front view, and then of its side
// view, that no leafy twig is seen in. rules: of the species' leaves. height: the tree's, metres. most_wood:
// metres of all twigs, beyond which none is added.
void close_gaps(Filling& filling, const CrownSections& crown, const SketchSpecies& species,
                const LeafRules& rules, double height, double most_wood, uint64_t seed,
                const Progress* progress);

}  // namespace treerec
