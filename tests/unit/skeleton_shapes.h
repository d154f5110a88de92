// Random scans of wood whose axes and tips are known.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/random.h"
#include "scan/point_cloud.h"
#include "skeleton_test_clouds.h"

namespace treerec::test {

// A straight piece of wood; metres.
struct Wood {
    DVec3 a;
    DVec3 b;
    double radius_a = 0.0;
    double radius_b = 0.0;
    double from = 0.0;  // the part of the way round that is seen, as in add_cone()
    double to = 1.0;
    double gap_begin = 0.0;  // the part of the way along that is not seen, 0..1
    double gap_end = 0.0;

    DVec3 at(double t) const { return a + t * (b - a); }
    double radius(double t) const { return radius_a + t * (radius_b - radius_a); }
};

struct WoodScan {
    std::vector<Wood> wood;
    double spacing = 0.01;
    double noise = 0.0;
    size_t tips = 1;
    PointCloud cloud;
};

inline double share_along(const Wood& wood, const DVec3& p) {
    return glm::dot(p - wood.a, wood.b - wood.a) / glm::dot(wood.b - wood.a, wood.b - wood.a);
}

// Whether p lies well inside the wood, where no scanner sees it.
inline bool is_hidden(const Wood& wood, const DVec3& p, double noise) {
    const double t = share_along(wood, p);
    if (t < 0.0 || t > 1.0) return false;
    return glm::distance(p, wood.at(t)) < wood.radius(t) - 3.0 * noise - 1e-6;
}

inline void scan_wood(WoodScan& scan, Random& random) {
    for (size_t w = 0; w < scan.wood.size(); w++) {
        const Wood& wood = scan.wood[w];
        PointCloud seen;
        add_cone(seen, random, wood.a, wood.b, wood.radius_a, wood.radius_b, scan.spacing, scan.noise,
                 wood.from, wood.to);
        for (const Vec3& point : seen.positions) {
            const DVec3 p(point);
            const double t = share_along(wood, p);
            bool hidden = t > wood.gap_begin && t < wood.gap_end;
            for (size_t other = 0; other < scan.wood.size(); other++)
                hidden = hidden || (other != w && is_hidden(scan.wood[other], p, scan.noise));
            if (!hidden) scan.cloud.positions.push_back(point);
        }
    }
}

// A direction `angle` radians off `up`, turned by `turn` around it.
inline DVec3 tilted(const DVec3& up, double angle, double turn) {
    const DVec3 axis = glm::normalize(up);
    const DVec3 u = any_perpendicular(axis);
    const DVec3 v = glm::cross(axis, u);
    return std::cos(angle) * axis + std::sin(angle) * (std::cos(turn) * u + std::sin(turn) * v);
}

// A stem that ends in `arms` arms: the cross-sections of the arms add up to what the pipe model allows.
inline WoodScan fork_scan(uint64_t seed, int arms) {
    Random random(seed, 100 + static_cast<uint64_t>(arms));
    WoodScan scan;
    scan.tips = static_cast<size_t>(arms);
    const double radius = random.uniform(0.04, 0.2);
    scan.spacing = radius * random.uniform(0.1, 0.25);
    const DVec3 fork = random.uniform(1.2, 3.0) * tilted({0, 1, 0}, random.uniform(0.0, 0.3), 1.0);
    const double thick = random.uniform(0.85, 0.95) * radius;
    scan.wood.push_back({{0, 0, 0}, fork, radius, thick});
    const double turn = random.uniform(0.0, 6.28);
    for (int arm = 0; arm < arms; arm++) {
        const double angle = random.uniform(0.35, 0.8);
        const double share = random.uniform(0.55, arms == 2 ? 0.8 : 0.65);
        const DVec3 along = tilted(fork, angle, turn + 2.0 * kPi * (arm + random.uniform(-0.1, 0.1)) / arms);
        scan.wood.push_back({fork, fork + random.uniform(1.0, 2.0) * along, share * thick,
                             random.uniform(0.5, 1.2) * scan.spacing});
    }
    scan.noise = random.uniform(0.0, 0.003);
    scan_wood(scan, random);
    return scan;
}

// A fork whose stem is cut off above the arms.
inline WoodScan plain_fork_scan(uint64_t seed) {
    Random random(seed);
    WoodScan scan;
    scan.tips = 2;
    scan.spacing = 0.012;
    scan.noise = 0.002;
    const DVec3 base = {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
    const DVec3 fork = base + DVec3(0.1, 2.0, 0.05);
    scan.wood = {{base, fork, 0.10, 0.09},
                 {fork, fork + DVec3(0.7, 1.4, 0.0), 0.06, 0.02},
                 {fork, fork + DVec3(-0.6, 1.5, 0.2), 0.06, 0.02}};
    for (const Wood& wood : scan.wood)
        add_cone(scan.cloud, random, wood.a, wood.b, wood.radius_a, wood.radius_b, scan.spacing, scan.noise);
    return scan;
}

// Two stems that lean apart, or stand side by side.
inline WoodScan stems_scan(uint64_t seed) {
    Random random(seed, 200);
    WoodScan scan;
    scan.tips = 2;
    const double radius = random.uniform(0.04, 0.12);
    scan.spacing = radius * random.uniform(0.1, 0.25);
    const double half = radius * random.uniform(1.5, 3.0);
    for (const double side : {-1.0, 1.0}) {
        const double own = radius * random.uniform(0.7, 1.0);
        const DVec3 base(side * half, 0.0, 0.0);
        const DVec3 top = base + DVec3(side * random.uniform(0.15, 0.6), random.uniform(2.5, 3.5),
                                       random.uniform(-0.3, 0.3));
        scan.wood.push_back({base, top, own, random.uniform(0.5, 1.2) * scan.spacing});
    }
    scan.noise = random.uniform(0.0, 0.003);
    scan_wood(scan, random);
    return scan;
}

// A thick stem with `branches` thin side branches, of which a scanner sees the part `from`..`to` of the stem.
inline WoodScan sides_scan(uint64_t seed, int branches, double seen) {
    Random random(seed, 300 + static_cast<uint64_t>(branches) + (seen < 1.0 ? 50 : 0));
    WoodScan scan;
    scan.tips = static_cast<size_t>(branches) + 1;
    const double radius = random.uniform(0.08, 0.25);
    scan.spacing = radius * random.uniform(0.06, 0.12);
    const DVec3 top = random.uniform(4.0, 6.0) * tilted({0, 1, 0}, random.uniform(0.0, 0.15), 2.0);
    Wood stem{{0, 0, 0}, top, radius, 1.2 * scan.spacing};
    stem.to = seen;
    scan.wood.push_back(stem);
    const DVec3 u = any_perpendicular(glm::normalize(top));
    const DVec3 v = glm::cross(glm::normalize(top), u);
    for (int b = 0; b < branches; b++) {
        const double t = (b + random.uniform(0.7, 1.3)) / (branches + 1.0);
        // On the side that is seen.
        const double turn = 2.0 * kPi * random.uniform(0.15, 0.85) * seen;
        const double rise = random.uniform(0.3, 1.2);
        const DVec3 out = std::cos(turn) * u + std::sin(turn) * v;
        const DVec3 along = glm::normalize(out + rise * glm::normalize(top));
        const double own = stem.radius(t) * random.uniform(0.2, 0.5);
        scan.wood.push_back({stem.at(t),
                             stem.at(t) + random.uniform(0.8, 1.6) * along + stem.radius(t) * along, own,
                             random.uniform(0.5, 1.0) * scan.spacing});
    }
    scan.noise = random.uniform(0.0, 0.003);
    scan_wood(scan, random);
    return scan;
}

// A fork with a stretch missing in one arm, or in the stem.
inline WoodScan gap_scan(uint64_t seed) {
    WoodScan scan = fork_scan(seed, 2);
    Random random(seed, 400);
    Wood& gappy = scan.wood[random.below(3)];
    const double length = glm::distance(gappy.a, gappy.b);
    gappy.gap_begin = random.uniform(0.3, 0.5);
    gappy.gap_end = gappy.gap_begin + std::min(0.25, random.uniform(1.0, 3.0) * gappy.radius_b / length);
    scan.cloud.positions.clear();
    scan_wood(scan, random);
    return scan;
}

// A short, very thick stem under a low crown of a few boughs.
inline WoodScan thick_scan(uint64_t seed) {
    Random random(seed, 500);
    WoodScan scan;
    const double radius = random.uniform(0.3, 0.55);
    const DVec3 top = random.uniform(2.0, 3.0) * tilted({0, 1, 0}, random.uniform(0.0, 0.1), 1.0);
    scan.wood.push_back({{0, 0, 0}, top, radius, 0.8 * radius});
    const int boughs = 3 + static_cast<int>(random.below(3));
    for (int b = 0; b < boughs; b++) {
        const DVec3 along =
            tilted(top, random.uniform(0.4, 0.8), 2.0 * kPi * (b + random.uniform(-0.15, 0.15)) / boughs);
        const DVec3 stem_base = scan.wood[0].at(random.uniform(0.9, 0.97));
        const double own = radius * random.uniform(0.25, 0.4);
        scan.wood.push_back({stem_base, stem_base + random.uniform(3.0, 4.5) * along, own, 0.1 * own});
    }
    scan.tips = static_cast<size_t>(boughs);
    scan.spacing = radius / random.uniform(12.0, 40.0);
    scan.noise = random.uniform(0.0, 0.003);
    scan_wood(scan, random);
    return scan;
}

}  // namespace treerec::test
