// The points of a cloud that fall on a tree in one photo. Internal to fidelity/.
#pragma once

#include <vector>

#include "fidelity/photo_fidelity.h"
#include "geometry/parallel.h"
#include "photos/sky_mask.h"

namespace treerec {

// shown: what the photo has where a place of the camera's coordinates falls, as a PhotoSky::Shown of which
// kSomething is the tree. Throws Cancelled.
template <typename Shown>
PhotoHits count_hits(const PointCloud& cloud, const Photo& photo, Shown shown, const Progress* progress) {
    constexpr size_t kChunk = 8192;
    struct Hits {
        size_t inside = 0, seen = 0;
    };
    std::vector<Hits> hits((cloud.size() + kChunk - 1) / kChunk);
    parallel_for(cloud.size(), kChunk, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        Hits here;
        for (size_t k = begin; k < end; k++) {
            const PhotoSky::Shown there =
                shown(photo.to_camera(cloud.frame.to_scan(DVec3(cloud.positions[k]))));
            here.seen += there != PhotoSky::Shown::kOutside;
            here.inside += there == PhotoSky::Shown::kSomething;
        }
        hits[begin / kChunk] = here;
    });
    PhotoHits found;
    found.name = photo.name;
    size_t seen = 0;
    for (const Hits& chunk : hits) {
        found.inside += chunk.inside;
        seen += chunk.seen;
    }
    found.outside = cloud.size() - found.inside;
    found.unseen = cloud.size() - seen;
    found.share = static_cast<double>(found.inside) / static_cast<double>(cloud.size());
    return found;
}

// The same with a mask of the camera's size, white on the tree.
inline PhotoHits count_hits(const PointCloud& cloud, const Photo& photo, const Camera& camera,
                            const Image& mask, const Progress* progress) {
    const auto shown = [&](const DVec3& in_camera) {
        const std::optional<DVec2> at = camera.project(in_camera);
        if (!at || !(at->x >= 0.0 && at->y >= 0.0 && at->x < camera.width && at->y < camera.height))
            return PhotoSky::Shown::kOutside;
        return *mask.at(static_cast<int>(at->x), static_cast<int>(at->y)) != 0 ? PhotoSky::Shown::kSomething
                                                                               : PhotoSky::Shown::kSky;
    };
    return count_hits(cloud, photo, shown, progress);
}

// The figures of all photos (definition 7.3). information: I.
PhotoFidelity sum_up_photos(std::vector<PhotoHits> photos, double information);

// The file of each photo's mask (read_masks()). Throws Error naming the photos that have none.
std::vector<std::string> mask_files(const std::string& folder, const PhotoModel& model);
// Throws Error for what is no picture.
Image read_mask(const std::string& path);
// Throws Error where the mask is not of its camera's size.
void check_mask(const Photo& photo, const Camera& camera, const Image& mask);

}  // namespace treerec
