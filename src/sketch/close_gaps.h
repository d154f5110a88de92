// A crown that one can't see the sky through where the outline is drawn.
#pragma once

#include <cstdint>

#include "progress.h"
#include "sketch/crown_sections.h"
#include "sketch/fill.h"

namespace treerec {

// Where a twig's nodes come to lie: the scion's (p) at joint + axes * (scale * p).
DMat3 twig_axes(const Tree& scion, const TwigPlace& place);

// Metres of a twig's wood that the crown leaves of it (assemble.h). joint: where it stands.
double kept_wood(const Tree& scion, const TwigPlace& place, const DVec3& joint, const CrownSections& crown,
                 double margin);

// Adds twigs, from the limb nearest to each, to the parts of the crown's front view, and then of its side
// view, that no leafy twig is seen in. growth: twig_growth(). height: the tree's, metres. most_wood: metres
// of all twigs, beyond which none is added.
void close_gaps(Filling& filling, const CrownSections& crown, const SketchSpecies& species, double growth,
                double height, double most_wood, uint64_t seed, const Progress* progress);

}  // namespace treerec
