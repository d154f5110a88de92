#include "photos/free_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr double kSquare = 2.0;  // pixels of the picture
constexpr size_t kNowhere = std::numeric_limits<size_t>::max();

}  // namespace

FreeSpace::FreeSpace(const LoadedPhoto& photo)
    : photo_(photo.photo), camera_(photo.camera), squares_(photo.scale / kSquare) {
    width_ = static_cast<int>(std::ceil(camera_->width * squares_));
    height_ = static_cast<int>(std::ceil(camera_->height * squares_));
    depths_.assign(static_cast<size_t>(width_) * static_cast<size_t>(height_), 0.0F);
}

size_t FreeSpace::square_of(const DVec3& seen) const {
    const auto pixel = seen.z > 0.0 ? camera_->project(seen) : std::nullopt;
    if (!pixel) return kNowhere;
    const DVec2 square = glm::floor(*pixel * squares_);
    if (!(square.x >= 0.0 && square.y >= 0.0 && square.x < width_ && square.y < height_)) return kNowhere;
    return static_cast<size_t>(square.y) * static_cast<size_t>(width_) + static_cast<size_t>(square.x);
}

void FreeSpace::add(const DVec3& place, double unsure) {
    const DVec3 seen = photo_->to_camera(place);
    const size_t square = square_of(seen);
    const auto depth = static_cast<float>(seen.z - unsure);
    if (square == kNowhere || !(depth > 0.0F)) return;
    float& nearest = depths_[square];
    if (nearest == 0.0F || depth < nearest) nearest = depth;
}

bool FreeSpace::sees_through(const DVec3& place, double slack) const {
    const DVec3 seen = photo_ ? photo_->to_camera(place) : DVec3(0.0);
    const size_t square = photo_ ? square_of(seen) : kNowhere;
    return square != kNowhere && static_cast<double>(depths_[square]) > seen.z + slack;
}

std::vector<uint32_t> count_seen_through(std::span<const DVec3> places, std::span<const FreeSpace> photos,
                                         double slack, const Progress* progress) {
    std::vector<uint32_t> counts(places.size(), 0);
    parallel_for(places.size(), 256, [&](size_t first, size_t last) {
        if (progress) progress->check();
        for (size_t i = first; i < last; i++)
            for (const FreeSpace& photo : photos)
                counts[i] += photo.sees_through(places[i], slack);
    });
    return counts;
}

}  // namespace treerec
