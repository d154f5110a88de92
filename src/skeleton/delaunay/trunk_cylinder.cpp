#include "skeleton/delaunay/trunk_cylinder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/circle_fit.h"
#include "geometry/linear_system.h"
#include "geometry/portable_math.h"
#include "geometry/quantile.h"
#include "geometry/symmetric_eigen.h"

namespace treerec {

namespace {

constexpr double kBreastHeight = 1.3;   // metres
constexpr double kShare = 0.1;          // of the tree's longest way, in smaller trees
constexpr double kHalfWindow = 0.25;    // of the height of the window's middle
constexpr size_t kFewest = 6;           // points
constexpr double kWidest = 0.25;        // radius, of the tree's longest way
constexpr double kLeastCoverage = 0.3;  // of the circle
constexpr double kRoughest = 0.25;      // median distance from the surface, of the radius
constexpr int kSlabs = 3;               // looked at, each square to the axis that the one before told
constexpr int kSteps = 30;
constexpr double kTukey = 4.685;
constexpr double kToDeviation = 1.4826;
constexpr double kThinnest = 0.001;  // metres
constexpr double kExponent = 1.1;    // Du et al. 2019, 3.3

constexpr size_t kUnknowns = 5;
using Row = std::array<double, kUnknowns>;

struct Cylinder {
    DVec3 middle;
    DVec3 axis;
    double radius;
};

double off_surface(const Cylinder& c, const DVec3& p) {
    return glm::length(glm::cross(p - c.middle, c.axis)) - c.radius;
}

double median_off(const Cylinder& c, const std::vector<DVec3>& points) {
    std::vector<double> off;
    for (const DVec3& p : points)
        off.push_back(std::abs(off_surface(c, p)));
    std::nth_element(off.begin(), off.begin() + static_cast<ptrdiff_t>(off.size() / 2), off.end());
    return off[off.size() / 2];
}

// The unknowns: the axis's place and slope in the plane across it (u, v), and the radius.
Cylinder moved(const Cylinder& c, const DVec3& u, const DVec3& v, const Row& step) {
    return {c.middle + step[0] * u + step[1] * v, glm::normalize(c.axis + step[2] * u + step[3] * v),
            c.radius + step[4]};
}

// One step of Levenberg and Marquardt with the weights of the current distances.
Row marquardt_step(const Cylinder& c, const std::vector<DVec3>& points, const std::vector<double>& weights,
                   const DVec3& u, const DVec3& v, double damping) {
    std::array<Row, kUnknowns> normal{};
    Row right{};
    for (size_t i = 0; i < points.size(); i++) {
        const DVec3 d = points[i] - c.middle;
        const double along = glm::dot(d, c.axis);
        const DVec3 out = normalized_or(d - along * c.axis, u);
        const double a = glm::dot(out, u), b = glm::dot(out, v);
        const Row gradient = {-a, -b, -along * a, -along * b, -1.0};
        const double off = off_surface(c, points[i]);
        for (size_t k = 0; k < kUnknowns; k++) {
            for (size_t j = 0; j < kUnknowns; j++)
                normal[k][j] += weights[i] * gradient[k] * gradient[j];
            right[k] -= weights[i] * gradient[k] * off;
        }
    }
    for (size_t k = 0; k < kUnknowns; k++)
        normal[k][k] += damping * normal[k][k] + 1e-12;
    Row step{};
    if (!solve_linear(normal, right, step)) step = {};
    return step;
}

std::vector<double> biweights(const Cylinder& c, const std::vector<DVec3>& points) {
    const double scale = std::max(kTukey * kToDeviation * median_off(c, points), 1e-6);
    std::vector<double> weights;
    for (const DVec3& p : points) {
        const double t = off_surface(c, p) / scale;
        weights.push_back(std::abs(t) < 1.0 ? (1.0 - t * t) * (1.0 - t * t) : 0.0);
    }
    return weights;
}

double cost_of(const Cylinder& c, const std::vector<DVec3>& points, const std::vector<double>& weights) {
    double sum = 0.0;
    for (size_t i = 0; i < points.size(); i++)
        sum += weights[i] * off_surface(c, points[i]) * off_surface(c, points[i]);
    return sum;
}

Cylinder refined(Cylinder c, const std::vector<DVec3>& points) {
    double damping = 1e-3;
    for (int i = 0; i < kSteps; i++) {
        const DVec3 u = any_perpendicular(c.axis), v = glm::cross(c.axis, u);
        const std::vector<double> weights = biweights(c, points);
        const Cylinder next = moved(c, u, v, marquardt_step(c, points, weights, u, v, damping));
        if (next.radius > 0.0 && cost_of(next, points, weights) < cost_of(c, points, weights)) {
            c = next;
            damping *= 0.1;
        } else {
            damping *= 10.0;
        }
    }
    return c;
}

// Points of the tree's stem that are between so many metres from the root: the ring across it.
std::vector<uint32_t> ring_of(const InitialSkeleton& skeleton, double from, double to) {
    std::vector<uint32_t> ring;
    for (const uint32_t v : skeleton.tree.order) {
        const double along = skeleton.tree.along[v];
        if (along >= from && along <= to) ring.push_back(v);
    }
    return ring;
}

}  // namespace

std::optional<TrunkCylinder> fit_trunk_cylinder(const std::vector<Vec3>& points,
                                                const InitialSkeleton& skeleton, bool measure,
                                                uint64_t seed) {
    const double longest = skeleton.reach[skeleton.tree.order.front()];
    const double at = std::min(kBreastHeight, kShare * longest);
    std::vector<uint32_t> ring;
    double half = kHalfWindow * at;
    for (; ring.size() < kFewest && half < at; half *= 1.5)
        ring = ring_of(skeleton, at - half, at + half);
    if (ring.size() < kFewest) return std::nullopt;
    TrunkCylinder trunk;
    std::vector<DVec3> own, low, high;
    for (const uint32_t v : ring) {
        own.emplace_back(points[v]);
        trunk.reach = std::max(trunk.reach, skeleton.reach[v]);
        (skeleton.tree.along[v] < at ? low : high).emplace_back(points[v]);
    }
    const auto mean = [](const std::vector<DVec3>& of) {
        DVec3 sum(0.0);
        for (const DVec3& p : of)
            sum += p;
        return sum / static_cast<double>(std::max<size_t>(1, of.size()));
    };
    Cylinder c{mean(own), DVec3(0, 1, 0), 0.0};
    if (!low.empty() && !high.empty()) c.axis = normalized_or(mean(high) - mean(low), c.axis);
    // The paths lead up one side of stout bark and around it, and rings of them are aslant. Of a slab across,
    // the halves' middles lie on the axis however slanting its faces are.
    const std::vector<uint32_t> near_base = ring_of(skeleton, 0.0, 2.0 * at);  // no boughs that hang down
    for (int i = 0; i < kSlabs; i++) {
        low.clear();
        high.clear();
        std::vector<DVec3> slab;
        for (const uint32_t v : near_base) {
            const DVec3 off = DVec3(points[v]) - c.middle;
            const double up = glm::dot(off, c.axis);
            if (std::abs(up) > half || glm::length(off - up * c.axis) > kWidest * longest) continue;
            slab.emplace_back(points[v]);
            (up < 0.0 ? low : high).emplace_back(points[v]);
        }
        if (low.empty() || high.empty() || slab.size() < kFewest) break;
        own = std::move(slab);
        c.axis = normalized_or(mean(high) - mean(low), c.axis);
        c.middle = mean(own);
    }
    // A first circle tells where in the slab the axis is.
    const DVec3 u = any_perpendicular(c.axis), v = glm::cross(c.axis, u);
    std::vector<DVec2> flat;
    for (const DVec3& p : own)
        flat.emplace_back(glm::dot(p - c.middle, u), glm::dot(p - c.middle, v));
    const std::optional<CircleFit> circle = fit_circle(flat, kWidest * longest, Random(seed));
    if (measure && circle && circle->coverage >= kLeastCoverage) {
        c.middle += circle->centre.x * u + circle->centre.y * v;
        c.radius = circle->radius;
        const Cylinder fitted = refined(c, own);
        if (fitted.radius > 0.0 && fitted.radius < kWidest * longest && is_finite(fitted.middle) &&
            median_off(fitted, own) <= kRoughest * fitted.radius) {
            c = fitted;
            trunk.measured = true;
        }
    }
    if (!trunk.measured) {
        c.radius = 0.0;
        c.radius = std::max(kThinnest, median_off(c, own));
    }
    trunk.middle = c.middle;
    trunk.axis = c.axis;
    trunk.radius = c.radius;
    trunk.scatter = median_off(c, own);
    return trunk;
}

double allometric_radius(const TrunkCylinder& trunk, double reach) {
    const double share = trunk.reach > 0.0 ? std::max(0.0, reach / trunk.reach) : 1.0;
    return std::max(kThinnest, trunk.radius * portable::pow(std::max(share, 1e-9), kExponent));
}

}  // namespace treerec
