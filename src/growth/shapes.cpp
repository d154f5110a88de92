#include "growth/shapes.h"

#include <cmath>

#include "geometry/portable_math.h"

namespace treerec::growth {

namespace {

constexpr int kRingSides = 24, kTubeSides = 8;  // of a torus

void add_quad(Triangles& triangles, const DVec3& a, const DVec3& b, const DVec3& c, const DVec3& d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
}

}  // namespace

Triangles prism(const DVec3& a, const DVec3& b, const DVec3& x, const DVec3& y, int sides) {
    Triangles triangles;
    const bool turned = glm::dot(glm::cross(x, y), b - a) < 0.0;
    const auto side = [&](int i) {
        const SineCosine turn = portable_sine_cosine(2.0 * kPi * (turned ? sides - i : i) / sides);
        return x * turn.cosine + y * turn.sine;
    };
    for (int i = 0; i < sides; i++) {
        const DVec3 p = side(i), q = side((i + 1) % sides);
        add_quad(triangles, a + p, a + q, b + q, b + p);
        triangles.push_back({a, a + q, a + p});
        triangles.push_back({b, b + p, b + q});
    }
    return triangles;
}

Triangles box(const DVec3& middle, const DVec3& x, const DVec3& y, const DVec3& z) {
    Triangles triangles;
    const DVec3 axes[3] = {x, y, z};
    for (int i = 0; i < 3; i++)
        for (const double way : {1.0, -1.0}) {
            const DVec3 out = middle + way * axes[i], u = way * axes[(i + 1) % 3], v = axes[(i + 2) % 3];
            add_quad(triangles, out - u - v, out + u - v, out + u + v, out - u + v);
        }
    return triangles;
}

Triangles sheet(const DVec3& middle, const DVec3& x, const DVec3& y) {
    Triangles triangles;
    add_quad(triangles, middle - x - y, middle + x - y, middle + x + y, middle - x + y);
    return triangles;
}

Triangles torus(const DVec3& middle, const DVec3& axis, double radius, double thick) {
    const DVec3 x = any_perpendicular(axis), y = glm::cross(axis, x);
    const auto at = [&](int ring, int tube) {
        const SineCosine a = portable_sine_cosine(2.0 * kPi * (ring % kRingSides) / kRingSides),
                         b = portable_sine_cosine(2.0 * kPi * (tube % kTubeSides) / kTubeSides);
        return middle + (x * a.cosine + y * a.sine) * (radius + 0.5 * thick * b.cosine) +
               axis * (0.5 * thick * b.sine);
    };
    Triangles triangles;
    for (int ring = 0; ring < kRingSides; ring++)
        for (int tube = 0; tube < kTubeSides; tube++)
            add_quad(triangles, at(ring, tube), at(ring + 1, tube), at(ring + 1, tube + 1),
                     at(ring, tube + 1));
    return triangles;
}

}  // namespace treerec::growth
