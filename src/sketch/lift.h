// Flat strokes into space (Ma and Liu 2020, 3.1).
#pragma once

#include <string>
#include <vector>

#include "sketch/crown_sections.h"
#include "sketch/sketch.h"
#include "sketch/sketch_axes.h"

namespace treerec {

// How a canvas lies in space: (x, y) of DrawnTree to metres, the base at the origin.
struct CanvasPlace {
    DVec2 stem_base{0.0};  // pixels
    double scale = 0.01;   // metres a pixel

    DVec2 metres(const DVec2& pixel) const { return (pixel - stem_base) * scale; }
};

// The trunk in the plane z = 0, and the drawn branches.
// kTrue: x and y stay; each branch goes evenly, before or behind, to where it has most of the crown's depth,
//     but neither out of the crown nor farther than it is long.
// kPaper: each is turned about the upright axis through its base by an angle of its own within 60 degrees to
//     either side, 10 apart; where that is too much for so many, they are evenly closer, which is remarked.
// Radii by equation 2, of the trunk from its base's (SketchOptions, as drawn, or height / 40) to a tenth of
// it; a branch starts thinner than the trunk is there, as its length is to the trunk's. With a taper, which
// is of a tree as high as this one, they are as it has them. remarks: what there is to say is added.
SketchAxes lift(const DrawnTree& drawn, const Sketch& sketch, const CanvasPlace& place,
                const CrownSections& crown, const SketchOptions& options,
                const std::optional<WoodTaper>& taper, std::vector<std::string>& remarks);

// Of a branch, at its points: as much thinner than its parent as it is shorter than the trunk, within bounds;
// or as the branches' taper has it.
std::vector<double> radii_of(const SketchAxis& branch, const SketchAxes& axes);

}  // namespace treerec
