#include "photos/thin_points.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "geometry/parallel.h"
#include "geometry/point_tree.h"
#include "photos/cameras_tell.h"
#include "photos/photo_picture.h"

namespace treerec {

namespace {

constexpr double kNearest = 0.1;   // of a camera's distance from the upright line: no wood is nearer to it
constexpr double kLooking = 0.25;  // of the progress
constexpr double kMatched = 0.9;
constexpr double kAround = 3.0;       // cells, within which a surface has points
constexpr size_t kSurface = 12;       // of them: a flat one fills 28 cells, and a line 7
constexpr double kReplaced = 2.5;     // cells beside thin wood, whose points go
constexpr double kRoundPixels = 1.5;  // of radius: thinner wood gets fewer points

// What the photo shows there that a place was found from.
void colour(std::vector<ThinPlace>& places, const PhotoModel& model, const std::string& folder,
            Progress* progress) {
    std::vector<std::vector<size_t>> of_photo(model.photos.size());
    for (size_t k = 0; k < places.size(); k++)
        of_photo[places[k].photo].push_back(k);
    parallel_for(of_photo.size(), 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; i++) {
            if (progress) progress->check();
            if (of_photo[i].empty()) continue;
            const Photo& photo = model.photos[i];
            const Camera& camera = model.cameras[static_cast<size_t>(photo.camera)];
            const auto picture = picture_of(photo, camera, folder);
            if (!picture) continue;
            for (const size_t k : of_photo[i]) {
                const auto at = camera.project(photo.to_camera(places[k].position));
                if (!at || !(at->x >= 0 && at->y >= 0 && at->x < picture->width && at->y < picture->height))
                    continue;
                const uint8_t* pixel = picture->at(static_cast<int>(at->x), static_cast<int>(at->y));
                places[k].color = {pixel[0], pixel[1], pixel[2]};
            }
        }
    });
}

// Where a ray is nearer to the upright line through the subject than `reach`.
DepthRange range_in_cylinder(const DVec3& from, const DVec3& along, const DVec3& subject, const DVec3& sky,
                             double reach) {
    const auto flat = [&](const DVec3& v) { return v - glm::dot(v, sky) * sky; };
    const DVec3 way = flat(along), begin = flat(from - subject);
    const double a = glm::dot(way, way), b = glm::dot(way, begin), c = glm::dot(begin, begin) - reach * reach,
                 root = b * b - a * c;
    if (!(root > 0.0) || !(a > 1e-12)) return {};
    return {std::max((-b - std::sqrt(root)) / a, kNearest * glm::length(begin)), (-b + std::sqrt(root)) / a};
}

}  // namespace

std::vector<ThinPlace> find_thin_wood(const PhotoModel& model, std::span<const DVec3> sparse,
                                      const std::string& folder, const SkyCarver& carver,
                                      const ThinWoodOptions& options, Progress* progress) {
    const auto subject = subject_of(model);
    const auto sky = sky_of(model, sparse);
    if (!subject || !sky) return {};
    const double reach = subject_reach(model, *subject, *sky);
    const size_t count = model.photos.size();
    std::vector<std::vector<std::vector<Ridge>>> ridges(count);
    std::vector<double> scales(count, 1.0);
    std::atomic<size_t> done = 0;
    parallel_for(count, 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; i++) {
            if (progress) progress->check();
            const Photo& photo = model.photos[i];
            if (const auto picture =
                    picture_of(photo, model.cameras[static_cast<size_t>(photo.camera)], folder)) {
                const GreyPyramid pyramid = pyramid_of(*picture, options.most_pixels);
                scales[i] = 1.0 / pyramid.to_photo.x;
                ridges[i] = find_ridges(pyramid, options.ridges, progress);
            }
            if (progress)
                progress->update(kLooking * static_cast<double>(++done) / static_cast<double>(count),
                                 "Thin wood");
        }
    });
    SubProgress matching(progress, kLooking, kMatched);
    std::vector<ThinPlace> places =
        merged_places(match_lines(
                          model, ridges, scales, *subject,
                          [&](const DVec3& from, const DVec3& along) {
                              return range_in_cylinder(from, along, *subject, *sky, reach);
                          },
                          options, &matching),
                      progress);
    std::vector<uint8_t> is_sky(places.size(), 0);
    parallel_for(places.size(), 256, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; i++) {
            is_sky[i] = carver.is_sky(places[i].position);
            places[i].before_sky = carver.is_before_sky(places[i].position, places[i].way, places[i].radius);
        }
    });
    size_t kept = 0;
    for (size_t i = 0; i < places.size(); i++)
        if (!is_sky[i]) places[kept++] = places[i];
    places.resize(kept);
    colour(places, model, folder, progress);
    return places;
}

size_t add_thin_wood(PointCloud& cloud, double cell, std::vector<ThinPlace> places,
                     const Progress* progress) {
    const DVec3 origin = cloud.frame.origin;
    if (!cloud.empty() && !places.empty()) {
        const PointTree tree(cloud.positions, progress);
        const double reach = kAround * cell;
        std::erase_if(places, [&](const ThinPlace& place) {
            if (place.before_sky) return false;
            std::array<uint32_t, kSurface> near{};
            std::array<float, kSurface> squared{};
            const size_t count =
                tree.nearest(Vec3(place.position - origin), kSurface, near.data(), squared.data());
            return count == kSurface && squared[kSurface - 1] <= reach * reach;
        });
    }
    if (places.empty()) return 0;
    std::vector<Vec3> axes;
    for (const ThinPlace& place : places)
        axes.emplace_back(place.position - origin);
    const PointTree tree(axes, progress);
    std::vector<uint8_t> keep(cloud.size(), 1);
    parallel_for(cloud.size(), 1024, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; i++) {
            uint32_t near = 0;
            float squared = 0.0F;
            if (tree.nearest(cloud.positions[i], 1, &near, &squared) != 1) continue;
            const double reach = places[near].radius + kReplaced * cell;
            keep[i] = squared >= reach * reach;
        }
    });
    cloud.keep_only(keep);
    cloud.radii.resize(cloud.size(), 0.0F);
    for (size_t i = 0; i < places.size(); i++) {
        const ThinPlace& place = places[i];
        const DVec3 side = any_perpendicular(place.way), other = glm::cross(place.way, side);
        const int points = place.radius > kRoundPixels * place.pixel ? 6 : 3;
        for (int k = 0; k < points; k++) {
            // Each ring is turned against the last.
            const double angle = 2.0 * kPi * (k + 0.5 * static_cast<double>(i % 2)) / points;
            cloud.positions.emplace_back(place.position - origin +
                                         place.radius * (std::cos(angle) * side + std::sin(angle) * other));
            cloud.colors.push_back(place.color);
            cloud.radii.push_back(static_cast<float>(place.radius));
        }
    }
    return places.size();
}

}  // namespace treerec
