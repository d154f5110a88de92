#include "photos/thin_points.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>

#include "error.h"
#include "file_bytes.h"
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

void ThinPoints::remove_if(const std::function<bool(const ThinPlace&)>& wrong) {
    std::vector<uint8_t> drop(places.size(), 0);
    parallel_for(places.size(), 256, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; i++)
            drop[i] = wrong(places[i]);
    });
    size_t kept = 0;
    for (size_t i = 0; i < places.size(); i++) {
        if (drop[i]) continue;
        places[kept] = places[i];
        colors[kept++] = colors[i];
    }
    places.resize(kept);
    colors.resize(kept);
}

ThinPoints find_thin_points(const PhotoModel& model, std::span<const DVec3> sparse, const std::string& folder,
                            const ThinWoodOptions& options, Progress* progress) {
    ThinPoints thin;
    const auto subject = subject_of(model);
    const auto sky = sky_of(model, sparse);
    if (!subject || !sky) return thin;
    const double reach = subject_reach(model, *subject, *sky);
    const size_t count = model.photos.size();
    std::vector<std::vector<std::vector<Ridge>>> ridges(count);
    std::vector<double> scales(count, 1.0);
    std::vector<std::string> failures(count);
    std::atomic<size_t> done = 0;
    const auto path_to = [&](size_t i) { return utf8_of(path_of(folder) / path_of(model.photos[i].name)); };
    parallel_for(count, 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; i++) {
            if (progress) progress->check();
            try {
                const Image picture = read_photo(path_to(i));
                const Camera& camera = model.cameras[static_cast<size_t>(model.photos[i].camera)];
                if (picture.width != camera.width || picture.height != camera.height)
                    throw Error("'" + path_to(i) + "' is not as large as the model says; it was left out.");
                const GreyPyramid pyramid = pyramid_of(picture, options.most_pixels);
                scales[i] = 1.0 / pyramid.to_photo.x;
                ridges[i] = find_ridges(pyramid, options.ridges, progress);
            } catch (const Cancelled&) {
                throw;
            } catch (const Error& error) {
                failures[i] = error.what();
            }
            if (progress)
                progress->update(kLooking * static_cast<double>(++done) / static_cast<double>(count),
                                 "Thin wood");
        }
    });
    for (const std::string& failure : failures)
        if (!failure.empty()) thin.warnings.push_back(failure);
    SubProgress matching(progress, kLooking, kMatched);
    const std::vector<ThinPlace> places = match_lines(
        model, ridges, scales, *subject,
        [&](const DVec3& from, const DVec3& along) {
            return range_in_cylinder(from, along, *subject, *sky, reach);
        },
        options, &matching);
    thin.places = merged_places(places, progress);
    thin.colors.resize(thin.places.size(), {128, 128, 128});
    std::vector<std::vector<size_t>> of_photo(count);
    for (size_t k = 0; k < thin.places.size(); k++)
        of_photo[thin.places[k].photo].push_back(k);
    parallel_for(count, 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; i++) {
            if (progress) progress->check();
            if (of_photo[i].empty()) continue;
            const Image picture = read_photo(path_to(i));
            const Camera& camera = model.cameras[static_cast<size_t>(model.photos[i].camera)];
            for (const size_t k : of_photo[i]) {
                const auto at = camera.project(model.photos[i].to_camera(thin.places[k].position));
                if (!at || !(at->x >= 0 && at->y >= 0 && at->x < picture.width && at->y < picture.height))
                    continue;
                const uint8_t* pixel = picture.at(static_cast<int>(at->x), static_cast<int>(at->y));
                thin.colors[k] = {pixel[0], pixel[1], pixel[2]};
            }
        }
    });
    return thin;
}

size_t add_thin_points(PointCloud& cloud, double cell, const ThinPoints& thin, const Progress* progress) {
    if (thin.places.empty() || !(cell > 0.0)) return 0;
    const DVec3 origin = cloud.frame.origin;
    std::vector<uint8_t> drop(cloud.size(), 0), stays(thin.places.size(), 1);
    if (!cloud.empty()) {
        const PointTree tree(cloud.positions, progress);
        parallel_for(thin.places.size(), 256, [&](size_t first, size_t last) {
            std::array<uint32_t, kSurface> near{};
            std::array<float, kSurface> squared{};
            for (size_t i = first; i < last; i++) {
                const Vec3 at(thin.places[i].position - origin);
                const size_t count = tree.nearest(at, kSurface, near.data(), squared.data());
                const auto reach = static_cast<float>(kAround * cell);
                stays[i] = (!thin.before_sky.empty() && thin.before_sky[i]) || count < kSurface ||
                           squared[kSurface - 1] > reach * reach;
            }
        });
    }
    std::vector<Vec3> axes;
    std::vector<float> reaches;
    for (size_t i = 0; i < thin.places.size(); i++) {
        if (!stays[i]) continue;
        axes.emplace_back(thin.places[i].position - origin);
        reaches.push_back(static_cast<float>(thin.places[i].radius + kReplaced * cell));
    }
    if (axes.empty()) return 0;
    const PointTree tree(axes, progress);
    parallel_for(cloud.size(), 1024, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; i++) {
            uint32_t near = 0;
            float squared = 0.0F;
            if (tree.nearest(cloud.positions[i], 1, &near, &squared) == 1)
                drop[i] = squared < reaches[near] * reaches[near];
        }
    });
    size_t kept = 0;
    for (size_t i = 0; i < cloud.size(); i++) {
        if (drop[i]) continue;
        cloud.positions[kept] = cloud.positions[i];
        cloud.colors[kept++] = cloud.colors[i];
    }
    cloud.positions.resize(kept);
    cloud.colors.resize(kept);
    size_t added = 0;
    for (size_t i = 0; i < thin.places.size(); i++) {
        if (!stays[i]) continue;
        const ThinPlace& place = thin.places[i];
        const DVec3 side = any_perpendicular(place.way), other = glm::cross(place.way, side);
        const int points = place.radius > kRoundPixels * place.pixel ? 6 : 3;
        for (int k = 0; k < points; k++) {
            const double angle = 2.0 * kPi * (k + 0.5 * static_cast<double>(added % 2)) / points;
            cloud.positions.emplace_back(place.position - origin +
                                         place.radius * (std::cos(angle) * side + std::sin(angle) * other));
            cloud.colors.push_back(thin.colors[i]);
        }
        added++;
    }
    return added;
}

}  // namespace treerec
