#include "edit/graft/twig_picture.h"

#include <algorithm>

#include "edit/graft/scion.h"
#include "error.h"
#include "mesh/sample_canvas.h"

namespace treerec {

namespace {

constexpr double kFilled = 0.92;   // of the picture's side
constexpr double kStout = 0.0075;  // metres of radius from which wood has its stout colour,
constexpr double kThin = 0.0025;   // and up to which its thin one
const DVec3 kStoutColor(152.0, 126.0, 100.0);
const DVec3 kThinColor(168.0, 136.0, 104.0);

// From the scion's axes into the picture's: right, up, towards the eye. It goes right and 30 degrees up, away
// from the eye a little, its up side up; the eye looks down a little.
DMat3 picture_axes() {
    const double rise = 30.0 * kPi / 180.0;
    const DMat3 standing =
        turn_about({0, 0, 1}, rise) * DMat3(DVec3(0, 0, 1), DVec3(1, 0, 0), DVec3(0, 1, 0));
    return turn_about({1, 0, 0}, 22.0 * kPi / 180.0) * turn_about({0, 1, 0}, rise) * standing;
}

}  // namespace

Image draw_twig(const Tree& scion, int size) {
    require_scion(scion);
    if (size < 16 || size > 512) throw Error("A twig's picture must be 16 to 512 pixels wide.");
    const DMat3 axes = picture_axes();
    const std::vector<NodeId> order = scion.depth_first();
    Bounds seen;
    for (NodeId id : order)
        seen.add(axes * scion.node(id).position);
    const DVec3 extent = seen.size();
    const double widest = std::max({extent.x, extent.y, 1e-9});
    SampleCanvas canvas(size);
    const int side = canvas.side();
    const double scale = kFilled * side / widest;
    const auto ball_at = [&](NodeId id, double radius) {
        const DVec3 place = (axes * scion.node(id).position - seen.centre()) * scale;
        // No wood is thinner than a pixel.
        return SampleCanvas::Ball{{0.5 * side + place.x, 0.5 * side - place.y, place.z},
                                  std::clamp(radius * scale, 0.5 * SampleCanvas::kOver, 0.25 * side)};
    };
    for (NodeId id : order) {
        const Node& node = scion.node(id);
        if (node.parent == kNoNode) continue;
        const double first = std::min(scion.node(node.parent).radius, 1.3 * node.radius);
        const double share = std::clamp((node.radius - kThin) / (kStout - kThin), 0.0, 1.0);
        canvas.draw_wood(ball_at(node.parent, first), ball_at(id, node.radius),
                         glm::mix(kThinColor, kStoutColor, share));
    }
    return canvas.finish();
}

}  // namespace treerec
