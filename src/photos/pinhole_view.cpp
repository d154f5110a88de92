#include "photos/pinhole_view.h"

#include <algorithm>
#include <cmath>

#include "error.h"
#include "geometry/parallel.h"
#include "photos/photo_picture.h"

namespace treerec {

namespace {

constexpr size_t kRows = 16;  // that a thread takes at a time

}  // namespace

std::optional<DVec2> PinholeView::project(const DVec3& place) const {
    const DVec3 seen = glm::transpose(turn) * (place - centre);
    if (!(seen.z < 0.0)) return std::nullopt;
    return principal + focal * DVec2(seen.x, -seen.y) / -seen.z;
}

PinholeView pinhole_view(const Photo& photo, const Camera& camera, const ScanFrame& frame) {
    const auto middle = camera.project({0.0, 0.0, 1.0});
    const double focal = camera.focal_length();
    if (!middle || !(focal > 0.0))
        throw Error("The lens of the photo " + quote_word(photo.name) + " has no middle in COLMAP's model.");
    PinholeView view;
    const DMat3 axes = glm::transpose(photo.turn());  // COLMAP's: right, down, ahead
    view.turn =
        DMat3(frame.turn_to_tree(axes[0]), frame.turn_to_tree(-axes[1]), frame.turn_to_tree(-axes[2]));
    view.centre = frame.to_tree(photo.centre());
    view.focal = focal;
    view.principal = *middle;
    view.width = camera.width;
    view.height = camera.height;
    return view;
}

PinholeView fitted(PinholeView view, int longest) {
    const int longer = std::max(view.width, view.height);
    if (longer <= longest) return view;
    // Both sides are scaled by the same, and what is left of a pixel goes.
    const double scale = static_cast<double>(longest) / longer;
    view.width = std::max(1, static_cast<int>(view.width * scale));
    view.height = std::max(1, static_cast<int>(view.height * scale));
    view.focal *= scale;
    view.principal *= scale;
    return view;
}

Image undistorted(const Image& picture, const Camera& camera, const PinholeView& view) {
    // Pixels that are much smaller than the view's are averaged first, so that nothing glitters.
    const double finer = picture.width * camera.focal_length() / (camera.width * view.focal);
    const Image source = reduced(picture, std::max(1, static_cast<int>(finer)));
    const int times = std::max(1, static_cast<int>(finer));
    const DVec2 scale(static_cast<double>(picture.width) / camera.width / times,
                      static_cast<double>(picture.height) / camera.height / times);
    Image seen(view.width, view.height, picture.channels);
    parallel_for(static_cast<size_t>(view.height), kRows, [&](size_t begin, size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); y++)
            for (int x = 0; x < view.width; x++) {
                const DVec2 ray = (DVec2(x + 0.5, y + 0.5) - view.principal) / view.focal;
                const auto at = camera.project({ray.x, ray.y, 1.0});
                if (!at || !(at->x >= 0.0 && at->y >= 0.0 && at->x < camera.width && at->y < camera.height))
                    continue;
                const DVec2 place =
                    glm::clamp(*at * scale - 0.5, DVec2(0.0), DVec2(source.width - 1.0, source.height - 1.0));
                for (int k = 0; k < seen.channels; k++)
                    seen.at(x, y)[k] =
                        static_cast<uint8_t>(std::lround(level_between(source, place.x, place.y, k)));
            }
    });
    return seen;
}

}  // namespace treerec
