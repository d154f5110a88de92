// Twigs on the branches, as long as the crown has room (Ma and Liu 2020, 4.2).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "progress.h"
#include "sketch/crown_sections.h"
#include "sketch/sketch.h"
#include "sketch/sketch_axes.h"
#include "sketch/species.h"
#include "sketch/twig_place.h"

namespace treerec {

// An axis that is ready to become wood: the trunk first, then those that grow from it or from another.
struct FilledAxis {
    SketchAxis axis;
    int32_t parent = -1;  // place in the list; -1: the trunk
};

struct Filling {
    std::vector<FilledAxis> axes;
    std::vector<TwigPlace> twigs;
    size_t bare = 0;  // places in the crown that no twig is short enough for
};

// kSections (default): twigs stand evenly around each branch, by the species' arrangement and angles off
//     its direction; a place whose room is longer than any twig gets a branch with twigs of its own. Then
//     what the front view would still see through gets a twig from the branch nearest to it.
// As printed (options.depth is kPaper): one twig at a random node of each group of nodes, in a random
//     direction of that range, by equation 4; where none fits the nearest is scaled by .7 to 1.3, else none.
Filling fill_crown(const SketchAxes& axes, const CrownSections& crown, const SketchSpecies& species,
                   double height, double metres_per_pixel, uint64_t seed, const SketchOptions& options,
                   const Progress* progress);

// The twig for a place with so much room, in metres: its place in the species' twigs and its scale; nothing
// where none fits. growth: of all twigs (twig_growth()). fewer: whether one that is too long even at .7 may
// be taken if it is no more than twice too long, since what leaves the crown is cut. pick: of those of one
// size that fit alike (SpeciesTwig::size), one is taken by this number, any.
struct ChosenTwig {
    size_t twig;
    double scale;
};
std::optional<ChosenTwig> choose_twig(const SketchSpecies& species, double length, double radius,
                                      double growth, bool fewer, uint64_t pick = 0);

}  // namespace treerec
