#include "mesh/sample_canvas.h"

#include <algorithm>
#include <utility>

namespace treerec {

namespace {

// The samples from `from` to `to` and `margin` around them.
std::pair<int, int> range(double from, double to, double margin, int side) {
    const double last = side - 1.0;
    return {static_cast<int>(std::clamp(std::min(from, to) - margin, 0.0, last)),
            static_cast<int>(std::clamp(std::max(from, to) + margin + 1.0, 0.0, last))};
}

}  // namespace

void SampleCanvas::draw_wood(const Ball& p, const Ball& q, const DVec3& color) {
    const DVec2 a(p.place);
    const DVec2 way = DVec2(q.place) - a;
    const double square = glm::dot(way, way);
    const double most = std::max(p.radius, q.radius);
    const auto [left, right] = range(p.place.x, q.place.x, most, side());
    const auto [top, bottom] = range(p.place.y, q.place.y, most, side());
    const double nearest = std::max(p.place.z, q.place.z) + most;
    for (int y = top; y <= bottom; y++) {
        for (int x = left; x <= right; x++) {
            if (nearest <= samples_[static_cast<size_t>(y) * side() + x].depth) continue;
            const DVec2 at(x, y);
            const double t = square > 0.0 ? std::clamp(glm::dot(at - a, way) / square, 0.0, 1.0) : 0.0;
            const double radius = p.radius + (q.radius - p.radius) * t;
            const DVec2 off = (at - a - way * t) / radius;
            const double out = glm::dot(off, off);
            if (out > 1.0) continue;
            const double towards = std::sqrt(1.0 - out);
            const double depth = p.place.z + (q.place.z - p.place.z) * t + radius * towards;
            Sample& sample = samples_[static_cast<size_t>(y) * side() + x];
            if (depth <= sample.depth) continue;
            const double light = std::max(0.0, -0.5 * off.x - 0.7 * off.y + 0.5 * towards);
            sample = {depth, color * (0.62 + 0.4 * light)};
        }
    }
}

Image SampleCanvas::finish() const {
    Image image(size_, size_, 4);
    for (int y = 0; y < size_; y++) {
        for (int x = 0; x < size_; x++) {
            DVec3 sum(0.0);
            int there = 0;
            for (int j = 0; j < kOver; j++) {
                for (int i = 0; i < kOver; i++) {
                    const Sample& one = samples_[static_cast<size_t>(y * kOver + j) * side() + x * kOver + i];
                    if (!std::isfinite(one.depth)) continue;
                    sum += one.color;
                    there++;
                }
            }
            if (there == 0) continue;
            uint8_t* pixel = image.at(x, y);
            for (int channel = 0; channel < 3; channel++)
                pixel[channel] = static_cast<uint8_t>(std::min(255.0, std::round(sum[channel] / there)));
            pixel[3] = static_cast<uint8_t>(std::lround(255.0 * there / (kOver * kOver)));
        }
    }
    return image;
}

}  // namespace treerec
