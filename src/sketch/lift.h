// Flat strokes into space (Ma and Liu 2020, 3.1).
#pragma once

#include <string>
#include <vector>

#include "sketch/crown_sections.h"
#include "sketch/limbs.h"
#include "sketch/sketch.h"

namespace treerec {

// How a canvas lies in space: (x, y) of DrawnTree to metres, the foot at the origin.
struct CanvasPlace {
    DVec2 foot{0.0};      // pixels
    double scale = 0.01;  // metres a pixel

    DVec2 metres(const DVec2& pixel) const { return (pixel - foot) * scale; }
};

// The trunk in the plane z = 0, and the drawn branches.
// kTrue: x and y stay; each branch goes evenly, before or behind, to where it has most of the crown's depth,
//     but neither out of the crown nor farther than it is long.
// kPaper: each is turned about the upright axis through its base by an angle of its own within 60 degrees to
//     either side, 10 apart; where that is too much for so many, they are evenly closer, which is remarked.
// Radii by equation 2, of the trunk from its foot's (SketchOptions, as drawn, or height / 40) to a tenth of
// it; a branch starts thinner than the trunk is there, as its length is to the trunk's. With a taper, which
// is of a tree as high as this one, they are as it has them. remarks: what there is to say is added.
Limbs lift(const DrawnTree& drawn, const Sketch& sketch, const CanvasPlace& place, const CrownSections& crown,
           const SketchOptions& options, const std::optional<WoodTaper>& taper,
           std::vector<std::string>& remarks);

// Of a branch, at its points: as much thinner than its parent as it is shorter than the trunk, within bounds;
// or as the limbs' taper has it.
std::vector<double> radii_of(const Limb& branch, const Limbs& limbs);

}  // namespace treerec
