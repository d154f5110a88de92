// Photos as a camera without a lens would have taken them, beside the tree that was made of them: what a
// game engine's camera, which knows no lens, is compared with.
#pragma once

#include <optional>

#include "geometry/scan_frame.h"
#include "geometry/vec.h"
#include "mesh/image.h"
#include "photos/colmap_model.h"

namespace treerec {

// Where a photo was taken from, in a tree's space (metres, Y up), and how a pinhole sees from there.
struct PinholeView {
    DMat3 turn{1.0};       // its columns: what is to the right of the camera, above it, and behind it
    DVec3 centre{0.0};     // the camera's place
    double focal = 0.0;    // pixels, in both directions
    DVec2 principal{0.0};  // where the view's axis falls, in pixels from the upper left corner
    int width = 0;         // pixels
    int height = 0;

    // Where a place of the tree's space falls, in pixels; nothing for one that is not in front.
    std::optional<DVec2> project(const DVec3& place) const;
};

// The view of a photo, as large as its camera says, with the focal length of the picture's middle. frame:
// that of the tree, whose scan coordinates are the model's. Throws Error where the lens's formula gives no
// middle.
PinholeView pinhole_view(const Photo& photo, const Camera& camera, const ScanFrame& frame);

// The view with its picture's longer side this long at most, in pixels (1 or more).
PinholeView fitted(PinholeView view, int longest);

// What the view shows of a photo. picture: the photo's, of any size with the camera's proportions and any
// channels. Pixels that the photo doesn't show are 0.
Image undistorted(const Image& picture, const Camera& camera, const PinholeView& view);

}  // namespace treerec
