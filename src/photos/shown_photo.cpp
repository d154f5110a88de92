#include "photos/shown_photo.h"

#include <algorithm>
#include <cmath>

#include "error.h"
#include "photos/photo_picture.h"

namespace treerec {

namespace {

// Pixels of the longer side by which a smaller copy of a photo may miss its camera's proportions.
constexpr double kRounding = 2.0;

Image opaque(const Image& picture) {
    Image with(picture.width, picture.height, 4);
    const size_t count = static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height);
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < 3; k++)
            with.pixels[4 * i + k] = picture.pixels[3 * i + k];
        with.pixels[4 * i + 3] = 255;
    }
    return with;
}

}  // namespace

Image shown_photo(const std::string& path, const Camera& camera, const PinholeView& view,
                  const Progress* progress) {
    const Image picture = read_photo(path);
    if (progress) progress->check();
    const double across = static_cast<double>(picture.width) * camera.height;
    const double down = static_cast<double>(picture.height) * camera.width;
    if (std::abs(across - down) > kRounding * std::max(camera.width, camera.height))
        throw Error("'" + path + "' has " + std::to_string(picture.width) + " x " +
                    std::to_string(picture.height) + " pixels, and its camera in the COLMAP model has " +
                    std::to_string(camera.width) + " x " + std::to_string(camera.height) +
                    ": it is another photo, or was turned or cropped since.");
    Image seen = undistorted(opaque(picture), camera, view);
    if (progress) progress->check();
    return seen;
}

}  // namespace treerec
