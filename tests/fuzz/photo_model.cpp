#include <algorithm>

#include "fuzz.h"
#include "photos/colmap_model.h"

// The first byte says whether it is text (odd), the second how many of the rest are the cameras.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace treerec;
    if (size < 2) return 0;
    const std::string_view rest(reinterpret_cast<const char*>(data + 2), size - 2);
    const size_t cameras = std::min<size_t>(data[1], rest.size());
    try {
        const PhotoModel model =
            parse_photo_model(rest.substr(0, cameras), rest.substr(cameras), data[0] % 2 == 1, "folder");
        fuzz::require(!model.photos.empty(), "a model that was read has photos");
        for (const Photo& photo : model.photos) {
            fuzz::require(photo.camera >= 0 && static_cast<size_t>(photo.camera) < model.cameras.size(),
                          "every photo has a camera");
            const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
            fuzz::require(camera.width > 0 && camera.height > 0, "every camera has a size");
            for (const DVec3& p : {DVec3(0.0, 0.0, 1.0), DVec3(1.0, -2.0, 0.5), DVec3(1e9, 1e9, 1e-9)}) {
                const auto at = camera.project(photo.to_camera(p));
                if (at) fuzz::require(!(at->x < 0.0 && at->x >= 0.0), "a projection can be compared");
            }
        }
    } catch (const Error& error) {
        fuzz::require_sentence(error);
    }
    return 0;
}
