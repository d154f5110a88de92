// Photos from around a place, masks of boxes in them, and such boxes.
#pragma once

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <string>
#include <vector>

#include "fidelity/photo_overlap.h"
#include "geometry/vec.h"
#include "photos/colmap_model.h"

namespace treerec::test {

// A photo from `centre` towards `aim`, held level, in a frame whose scan coordinates are the tree's.
inline Photo take_photo(const DVec3& centre, const DVec3& aim, const std::string& name) {
    const DVec3 forward = glm::normalize(aim - centre), sky(0.0, 1.0, 0.0);
    const DVec3 right = glm::normalize(glm::cross(forward, sky)), down = glm::cross(forward, right);
    const glm::dquat q = glm::quat_cast(glm::transpose(DMat3(right, down, forward)));
    Photo photo;
    photo.name = name;
    photo.rotation = {q.w, q.x, q.y, q.z};
    photo.translation = DVec3(0.0);
    photo.translation = -photo.to_camera(centre);
    return photo;
}

inline ScanFrame same_frame() {
    ScanFrame frame;
    frame.up = UpAxis::kY;
    return frame;
}

// Around the origin, with a lens that bends straight lines.
inline PhotoModel orbit(int photos, double away, double height) {
    PhotoModel model;
    model.cameras = parse_photo_model("1 SIMPLE_RADIAL 320 240 300 160 120 -0.05\n",
                                      "1 1 0 0 0 0 0 5 1 a.jpg\n\n", true, "")
                        .cameras;
    for (int i = 0; i < photos; i++) {
        const double angle = 2.0 * kPi * i / photos;
        model.photos.push_back(take_photo({away * std::cos(angle), height, away * std::sin(angle)},
                                          {0.0, height, 0.0}, std::string(1, static_cast<char>('a' + i))));
    }
    return model;
}

// What each photo's camera itself sees of a box's corners' span: masks made by projecting a cloud of its
// places through the lens.
inline std::vector<Image> masks_of(const PhotoModel& model, const Vec3& low, const Vec3& high) {
    std::vector<Image> masks;
    constexpr int kSteps = 160;
    for (const Photo& photo : model.photos) {
        const Camera& camera = model.cameras[0];
        Image mask(camera.width, camera.height, 1);
        const auto dot = [&](const DVec3& place) {
            const auto at = camera.project(photo.to_camera(place));
            if (at && at->x >= 0.0 && at->y >= 0.0 && at->x < camera.width && at->y < camera.height)
                *mask.at(static_cast<int>(at->x), static_cast<int>(at->y)) = 255;
        };
        for (int side = 0; side < 6; side++)
            for (int i = 0; i <= kSteps; i++)
                for (int j = 0; j <= kSteps; j++) {
                    DVec3 t(0.0);
                    t[side % 3] = side < 3 ? 0.0 : 1.0;
                    t[(side + 1) % 3] = static_cast<double>(i) / kSteps;
                    t[(side + 2) % 3] = static_cast<double>(j) / kSteps;
                    dot(DVec3(low) + t * DVec3(high - low));
                }
        masks.push_back(std::move(mask));
    }
    return masks;
}

inline OutlinePart box(const Vec3& low, const Vec3& high) {
    OutlinePart part;
    for (int i = 0; i < 8; i++)
        part.mesh.positions.push_back(
            {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    constexpr uint32_t kFaces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    for (const auto& face : kFaces)
        for (const uint32_t i : {face[0], face[1], face[2], face[0], face[2], face[3]})
            part.mesh.indices.push_back(i);
    return part;
}

}  // namespace treerec::test
