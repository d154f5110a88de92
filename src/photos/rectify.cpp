#include "photos/rectify.h"

#include <algorithm>
#include <cmath>

#include "photos/photo_picture.h"

namespace treerec {

namespace {

constexpr double kSideways =
    0.5;  // sine of 30 degrees: how far the way from one to the other is from the view
constexpr double kLargest = 2.0;    // of a photo's pixels: as many has a rectified one at most
constexpr int kLeastSide = 32;      // pixels
constexpr int kBorderSteps = 16;    // on each side of a photo, whose places tell what it sees
constexpr double kForwards = 0.2;   // cosine: a ray farther to the side has no place in the common picture
constexpr int kUndistortions = 20;  // steps that find the ray of a pixel

// The direction in the camera's axes that falls on a pixel (z is 1), by turning the projection around.
std::optional<DVec3> ray_of(const Camera& camera, const DVec2& pixel) {
    const auto at = [&](const DVec2& p) { return camera.project(DVec3(p.x, p.y, 1.0)); };
    const auto here = at({0.0, 0.0});
    const double focal = camera.focal_length();
    if (!here || !(focal > 0.0)) return {};
    DVec2 p = (pixel - *here) / focal;
    for (int i = 0; i < kUndistortions; i++) {
        const auto falls = at(p);
        if (!falls) return {};
        const DVec2 miss = pixel - *falls;
        p += miss / focal;
        if (std::abs(miss.x) + std::abs(miss.y) < 1e-6) break;
    }
    return DVec3(p.x, p.y, 1.0);
}

struct Range {
    DVec2 low{INFINITY, INFINITY};
    DVec2 high{-INFINITY, -INFINITY};
    bool any() const { return low.x < high.x && low.y < high.y; }
};

// Where the border of a photo falls at the distance 1 of the common camera.
Range seen_by(const LoadedPhoto& photo, const DMat3& common) {
    Range range;
    const DMat3 turn = common * glm::transpose(photo.photo->turn());
    const double width = photo.camera->width, height = photo.camera->height;
    for (int side = 0; side < 4; side++)
        for (int i = 0; i <= kBorderSteps; i++) {
            const double t = static_cast<double>(i) / kBorderSteps;
            const DVec2 pixel = side == 0   ? DVec2(t * width, 0.0)
                                : side == 1 ? DVec2(t * width, height)
                                : side == 2 ? DVec2(0.0, t * height)
                                            : DVec2(width, t * height);
            const auto ray = ray_of(*photo.camera, pixel);
            if (!ray) continue;
            const DVec3 turned = turn * *ray;
            if (turned.z < kForwards * glm::length(turned)) continue;
            const DVec2 place(turned.x / turned.z, turned.y / turned.z);
            range.low = glm::min(range.low, place);
            range.high = glm::max(range.high, place);
        }
    return range;
}

RectifiedView view_of(const LoadedPhoto& photo, const RectifiedPair& pair) {
    RectifiedView view;
    const size_t count = static_cast<size_t>(pair.width) * static_cast<size_t>(pair.height);
    view.grey.assign(count, 0);
    view.inside.assign(count, 0);
    view.colours.assign(count, {});
    const Image& picture = photo.picture;
    const DMat3 turn = photo.photo->turn() * pair.to_world;
    for (int y = 0; y < pair.height; y++)
        for (int x = 0; x < pair.width; x++) {
            const DVec3 ray((x + 0.5 - pair.centre.x) / pair.focal, (y + 0.5 - pair.centre.y) / pair.focal,
                            1.0);
            const auto falls = photo.camera->project(turn * ray);
            if (!falls) continue;
            const double u = falls->x * photo.scale - 0.5, v = falls->y * photo.scale - 0.5;
            if (!(u >= 0.0 && v >= 0.0 && u < picture.width - 1 && v < picture.height - 1)) continue;
            const size_t i =
                static_cast<size_t>(y) * static_cast<size_t>(pair.width) + static_cast<size_t>(x);
            std::array<double, 3> sum{};
            for (size_t k = 0; k < 3; k++)
                sum[k] = level_between(picture, u, v, static_cast<int>(k));
            for (size_t k = 0; k < 3; k++)
                view.colours[i][k] = static_cast<uint8_t>(std::lround(sum[k]));
            // Rec. 601's luma.
            view.grey[i] =
                static_cast<uint8_t>(std::lround(0.299 * sum[0] + 0.587 * sum[1] + 0.114 * sum[2]));
            view.inside[i] = 1;
        }
    return view;
}

}  // namespace

DVec3 RectifiedPair::point_at(double x, double y, double disparity) const {
    const double depth = focal * baseline / disparity;
    const DVec3 ray((x + 0.5 - centre.x) / focal, (y + 0.5 - centre.y) / focal, 1.0);
    return origin + to_world * (depth * ray);
}

std::optional<RectifiedPair> rectify(const LoadedPhoto& one, const LoadedPhoto& other) {
    DVec3 way = other.photo->centre() - one.photo->centre();
    const double baseline = glm::length(way);
    const DVec3 ahead = one.photo->ahead() + other.photo->ahead();
    if (!(baseline > 0.0) || !(glm::length(ahead) > kSideways)) return {};
    way /= baseline;
    DVec3 z = ahead - glm::dot(ahead, way) * way;
    if (glm::length(z) < kSideways * glm::length(ahead)) return {};
    z = glm::normalize(z);
    RectifiedPair pair;
    pair.baseline = baseline;
    pair.origin = one.photo->centre();
    // The way from left to right is x.
    pair.to_world = DMat3(way, glm::cross(z, way), z);
    const DMat3 common = glm::transpose(pair.to_world);
    const Range first = seen_by(one, common), second = seen_by(other, common);
    if (!first.any() || !second.any()) return {};
    Range both;
    both.low = {std::min(first.low.x, second.low.x), std::max(first.low.y, second.low.y)};
    both.high = {std::max(first.high.x, second.high.x), std::min(first.high.y, second.high.y)};
    if (!both.any()) return {};
    pair.focal = 0.5 * (one.camera->focal_length() * one.scale + other.camera->focal_length() * other.scale);
    const double most = kLargest * static_cast<double>(one.picture.width) * one.picture.height;
    const double area = (both.high.x - both.low.x) * (both.high.y - both.low.y) * pair.focal * pair.focal;
    if (!(area > 0.0)) return {};
    if (area > most) pair.focal *= std::sqrt(most / area);
    pair.width = static_cast<int>((both.high.x - both.low.x) * pair.focal);
    pair.height = static_cast<int>((both.high.y - both.low.y) * pair.focal);
    if (pair.width < kLeastSide || pair.height < kLeastSide) return {};
    pair.centre = -both.low * pair.focal;
    pair.left = view_of(one, pair);
    pair.right = view_of(other, pair);
    return pair;
}

}  // namespace treerec
