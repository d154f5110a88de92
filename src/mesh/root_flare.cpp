#include "mesh/root_flare.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr double kWider = 1.32;        // the base's radius over that of the trunk above it, as trunks stand
constexpr double kReach = 1.6;         // radii up the trunk, but
constexpr double kMostReach = 0.45;    // metres at most
constexpr double kLookUp = 3.0;        // radii: where the trunk above is measured
constexpr double kLobe = 0.45;         // of the flare: how much further out it is at a root than between two
constexpr double kRoughly = 0.05;      // less than that is left out
constexpr uint32_t kSidesPerLobe = 4;  // fewer show no root
constexpr double kBaseHeight = 3.0;    // radii: how far up a trunk widens into its roots

}  // namespace

RootFlare plan_flare(std::vector<AxisPoint>& points, uint32_t sides) {
    RootFlare flare;
    if (points.size() < 2) return flare;
    const double length = points.back().along;
    size_t hint = 0;
    const double base = points.front().radius;
    const double up = kLookUp * base;
    if (up > 0.5 * length) return flare;
    const double above = axis_at(points, up, hint).radius;
    // What it is at the base already, and must stay.
    const double lacks = kWider * above / base - 1.0;
    if (lacks < kRoughly) return flare;
    flare.amount = std::min(lacks, kWider - 1.0);
    flare.reach = std::min(kReach * base, kMostReach);
    flare.lobes = static_cast<int>(std::min(sides / kSidesPerLobe, 6u));
    if (flare.lobes < 3) flare.lobes = 0;
    for (double share : {0.25, 0.55, 1.0}) {
        const double along = share * flare.reach;
        const AxisPoint point = axis_at(points, along, hint);
        const double gap = 0.1 * flare.reach;
        if (along - points[hint].along < gap || points[hint + 1].along - along < gap) continue;
        points.insert(points.begin() + static_cast<std::ptrdiff_t>(hint) + 1, point);
    }
    return flare;
}

FlareAt flare_at(const RootFlare& flare, const Ring& ring, double angle) {
    const double left = std::clamp(1.0 - ring.along / flare.reach, 0.0, 1.0);
    const double lobe = 1.0 + kLobe * portable::cos(flare.lobes * angle);
    const double wide = flare.amount * left * left * (flare.lobes > 0 ? lobe : 1.0);
    FlareAt at;
    at.radius = ring.radius * (1.0 + wide);
    at.slope = -2.0 * ring.radius * flare.amount * left / flare.reach * (flare.lobes > 0 ? lobe : 1.0);
    at.turn = flare.lobes > 0 ? -flare.amount * left * left * kLobe * flare.lobes *
                                    portable::sin(flare.lobes * angle) / (1.0 + wide)
                              : 0.0;
    return at;
}

void stretch_base(const RootFlare& flare, Ring* rings, size_t count) {
    for (size_t i = 0; i < count && rings[i].along < flare.reach; i++) {
        const double left = 1.0 - rings[i].along / flare.reach;
        rings[i].stretch = 1.0 + flare.amount * left * left;
    }
    limit_slant(rings, count, std::max(kBaseHeight * rings[0].radius, flare.reach));
}

}  // namespace treerec
