// Two photos as if one camera, moved sideways, had taken both: what stands in a row of one stands in the same
// row of the other (Fusiello, Trucco and Verri, "A compact algorithm for rectification of stereo pairs",
// 2000).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/vec.h"
#include "mesh/image.h"
#include "photos/colmap_model.h"

namespace treerec {

// One side of a pair. Pixels that the photo doesn't show are 0, and `inside` says so.
struct RectifiedView {
    std::vector<uint8_t> grey;
    std::vector<uint8_t> inside;
    std::vector<std::array<uint8_t, 3>> colours;
};

struct RectifiedPair {
    int width = 0;  // of both, pixels
    int height = 0;
    double focal = 0.0;     // pixels
    DVec2 centre{0.0};      // the principal point
    double baseline = 0.0;  // in the model's unit
    DMat3 to_world{1.0};    // from the common camera's axes (x right, y down, z ahead)
    DVec3 origin{0.0};      // of the left one, in the model
    RectifiedView left;
    RectifiedView right;

    // The point that the left one sees in the middle of pixel (x, y), in front of the camera by the depth
    // that the disparity (pixels, more than 0) gives: depth = focal * baseline / disparity.
    DVec3 point_at(double x, double y, double disparity) const;
};

// A photo with its picture, which may be smaller than the camera says.
struct LoadedPhoto {
    const Photo* photo = nullptr;
    const Camera* camera = nullptr;
    Image picture;       // 3 channels
    double scale = 1.0;  // the picture's pixels in one of the camera's
};

// Pictures without the lens's distortion, with about as many pixels as the photos have. Nothing for two that
// see nothing in common, stand in one place, or one before the other.
std::optional<RectifiedPair> rectify(const LoadedPhoto& one, const LoadedPhoto& other);

}  // namespace treerec
