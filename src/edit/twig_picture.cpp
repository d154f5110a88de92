#include "edit/twig_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "edit/scion.h"
#include "error.h"

namespace treerec {

namespace {

constexpr int kOver = 3;           // samples per pixel and axis
constexpr double kFilled = 0.92;   // of the picture's side
constexpr double kStout = 0.0075;  // metres of radius from which wood has its stout colour,
constexpr double kThin = 0.0025;   // and up to which its thin one
const DVec3 kStoutColor(152.0, 126.0, 100.0);
const DVec3 kThinColor(168.0, 136.0, 104.0);

// From the scion's axes into the picture's: right, up, towards the eye. It goes right and 30 degrees up, away
// from the eye a little, its up side up; the eye looks down a little.
DMat3 picture_axes() {
    const double rise = 30.0 * kPi / 180.0;
    const DMat3 standing =
        turn_about({0, 0, 1}, rise) * DMat3(DVec3(0, 0, 1), DVec3(1, 0, 0), DVec3(0, 1, 0));
    return turn_about({1, 0, 0}, 22.0 * kPi / 180.0) * turn_about({0, 1, 0}, rise) * standing;
}

struct Sample {
    double depth = -std::numeric_limits<double>::infinity();
    DVec3 color{0.0};
};

struct Dot {
    DVec3 place;  // samples, y downwards; z towards the eye
    double radius;
};

void draw_segment(std::vector<Sample>& samples, int side, const Dot& p, const Dot& q, const DVec3& color) {
    const DVec2 a(p.place);
    const DVec2 way = DVec2(q.place) - a;
    const double square = glm::dot(way, way);
    const auto range = [&](double from, double to, double margin) {
        return std::pair<int, int>(std::max(0, static_cast<int>(std::min(from, to) - margin)),
                                   std::min(side - 1, static_cast<int>(std::max(from, to) + margin) + 1));
    };
    const double most = std::max(p.radius, q.radius);
    const auto [left, right] = range(p.place.x, q.place.x, most);
    const auto [top, bottom] = range(p.place.y, q.place.y, most);
    for (int y = top; y <= bottom; y++) {
        for (int x = left; x <= right; x++) {
            const DVec2 at(x, y);
            const double t = square > 0.0 ? std::clamp(glm::dot(at - a, way) / square, 0.0, 1.0) : 0.0;
            const double radius = p.radius + (q.radius - p.radius) * t;
            const DVec2 off = (at - a - way * t) / radius;
            const double out = glm::dot(off, off);
            if (out > 1.0) continue;
            const double towards = std::sqrt(1.0 - out);
            const double depth = p.place.z + (q.place.z - p.place.z) * t + radius * towards;
            Sample& sample = samples[static_cast<size_t>(y) * side + x];
            if (depth <= sample.depth) continue;
            // Lit from above, the left and the eye.
            const double light = std::max(0.0, -0.5 * off.x - 0.7 * off.y + 0.5 * towards);
            sample = {depth, color * (0.62 + 0.4 * light)};
        }
    }
}

}  // namespace

Image draw_twig(const Tree& scion, int size) {
    require_scion(scion);
    if (size < 16 || size > 512) throw Error("A twig's picture must be 16 to 512 pixels wide.");
    const DMat3 axes = picture_axes();
    const std::vector<NodeId> order = scion.depth_first();
    Bounds seen;
    for (NodeId id : order)
        seen.add(axes * scion.node(id).position);
    const DVec3 extent = seen.size();
    const double widest = std::max({extent.x, extent.y, 1e-9});
    const int side = size * kOver;
    const double scale = kFilled * side / widest;
    const auto dot_at = [&](NodeId id, double radius) {
        const DVec3 place = (axes * scion.node(id).position - seen.centre()) * scale;
        // No wood is thinner than a pixel.
        return Dot{{0.5 * side + place.x, 0.5 * side - place.y, place.z},
                   std::clamp(radius * scale, 0.5 * kOver, 0.25 * side)};
    };
    std::vector<Sample> samples(static_cast<size_t>(side) * side);
    for (NodeId id : order) {
        const Node& node = scion.node(id);
        if (node.parent == kNoNode) continue;
        const double first = std::min(scion.node(node.parent).radius, 1.3 * node.radius);
        const double share = std::clamp((node.radius - kThin) / (kStout - kThin), 0.0, 1.0);
        draw_segment(samples, side, dot_at(node.parent, first), dot_at(id, node.radius),
                     glm::mix(kThinColor, kStoutColor, share));
    }
    Image image(size, size, 4);
    for (int y = 0; y < size; y++) {
        for (int x = 0; x < size; x++) {
            DVec3 sum(0.0);
            int there = 0;
            for (int j = 0; j < kOver; j++) {
                for (int i = 0; i < kOver; i++) {
                    const Sample& one = samples[static_cast<size_t>(y * kOver + j) * side + x * kOver + i];
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
