#include "mesh/tube_rings.h"

#include <algorithm>
#include <cmath>

namespace treerec {

namespace {

constexpr double kUpright = 0.5;    // the least y of a standing trunk's direction
constexpr double kMostSlant = 0.3;  // of the bark's picture at its seam: metres around per metre along

}  // namespace

void limit_tilt(Ring* rings, size_t count) {
    for (int pass = 0; pass < 3; pass++) {
        for (size_t i = 0; i + 1 < count; i++) {
            Ring &a = rings[i], &b = rings[i + 1];
            const double distance = glm::distance(a.centre, b.centre);
            const double sine_half = std::min(1.0, 0.4 * distance / std::max(a.radius, b.radius));
            const double least_cosine = 1.0 - 2.0 * sine_half * sine_half;
            const double cosine = glm::dot(a.normal, b.normal);
            if (cosine >= least_cosine) continue;
            const DVec3 mean =
                normalized_or(a.normal + b.normal, normalized_or(b.centre - a.centre, a.normal));
            const DVec3 side = normalized_or(b.normal - mean * glm::dot(b.normal, mean), DVec3(0.0));
            const double cosine_half = std::sqrt(1.0 - sine_half * sine_half);
            a.normal = normalized_or(mean * cosine_half - side * sine_half, mean);
            b.normal = normalized_or(mean * cosine_half + side * sine_half, mean);
        }
    }
}

bool stands(const Ring* rings, size_t count) {
    if (count < 2) return false;
    // Which way it stands shows a radius above the ground; right there, scans have spurs and leftovers.
    const Ring* above = rings + 1;
    while (above + 1 < rings + count && above->along < rings[0].radius)
        above++;
    return above->normal.y >= kUpright && rings[1].centre.y > rings[0].centre.y;
}

void limit_slant(Ring* rings, size_t count, double height) {
    size_t above = 0;
    while (above + 1 < count && rings[above].along < height)
        above++;
    if (above == 0) return;
    double shown = rings[above].radius * rings[above].stretch;
    for (size_t i = above; i-- > 0;) {
        Ring& ring = rings[i];
        const double change = kMostSlant / (2.0 * kPi) * (rings[i + 1].along - ring.along);
        shown = std::clamp(ring.radius * ring.stretch, shown - change, shown + change);
        ring.stretch = shown / ring.radius;
    }
}

double ring_slope(const Ring* rings, size_t count, size_t i) {
    const Ring& before = rings[i > 0 ? i - 1 : 0];
    const Ring& after = rings[std::min(i + 1, count - 1)];
    return std::clamp((after.radius - before.radius) / std::max(after.along - before.along, 1e-30), -1.0,
                      1.0);
}

}  // namespace treerec
