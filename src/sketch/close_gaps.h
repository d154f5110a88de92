// A crown that one can't see the sky through where the outline is drawn.
#pragma once

#include <cstdint>

#include "progress.h"
#include "sketch/crown_sections.h"
#include "sketch/fill.h"

namespace treerec {

// Where a twig's nodes come to lie: the scion's (p) at joint + axes * (scale * p).
DMat3 twig_axes(const Tree& scion, const TwigPlace& place);

// Adds twigs, from the limb nearest to each, to the parts of the crown's front view, and then of its side
// view, that no leafy twig is seen in. growth: twig_growth(). height: the tree's, metres.
void close_gaps(Filling& filling, const CrownSections& crown, const SketchSpecies& species, double growth,
                double height, uint64_t seed, const Progress* progress);

}  // namespace treerec
