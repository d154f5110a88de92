// Benches, bushes, bicycles: what stands on the ground beside the tree that was photographed.
#include <algorithm>
#include <cmath>
#include <limits>

#include "scan/cleaning/clean_steps.h"
#include "scan/cleaning/samples.h"
#include "scan/robust.h"

namespace treerec {

namespace {

// Shares of the tree's height.
constexpr double kLow = 0.35;     // as high as it may be
constexpr double kBeside = 0.05;  // from the stem: nearer, and it may be a shoot of the tree's
constexpr double kCell = 0.01;    // points nearer than one to two of these are of one thing
// Of the ground's tolerance, up to which everything was taken: how high above it a thing may begin.
constexpr double kStands = 3.0;

struct Thing {
    double foot = std::numeric_limits<double>::max();
    double top = std::numeric_limits<double>::lowest();
    DVec2 centre{0.0};
    double points = 0.0;

    bool stands(const Ground& ground) const { return foot < kStands * ground.tolerance; }
};

}  // namespace

std::vector<uint8_t> find_beside(const std::vector<Vec3>& points, const Ground& ground, const DVec3& place,
                                 const Progress* progress) {
    std::vector<uint8_t> goes(points.size());
    if (!ground.found || points.empty()) return goes;
    const std::array<Range, 3> ranges = robust_ranges(points, progress);
    double height = 0.0;
    for (const Vec3& p : points)
        if (ranges[1].contains(p.y)) height = std::max(height, ground.above(p));
    if (!(height > 0.0)) return goes;
    const std::vector<uint32_t> label = connected_components(points, ranges, kCell * height);
    std::vector<Thing> things(*std::max_element(label.begin(), label.end()) + size_t{1});
    for (size_t i = 0; i < points.size(); i++) {
        Thing& thing = things[label[i]];
        const double above = ground.above(points[i]);
        thing.foot = std::min(thing.foot, above);
        thing.top = std::max(thing.top, above);
        thing.centre += DVec2(points[i].x, points[i].z);
        thing.points += 1.0;
    }
    if (progress) progress->check();
    const DVec2 wanted(place.x, place.z);
    const auto away = [&](const Thing& thing) { return glm::length(thing.centre / thing.points - wanted); };
    // The stem is what is tall, or else, where it has a gap above, what is nearest.
    const bool tall = std::any_of(things.begin(), things.end(), [&](const Thing& thing) {
        return thing.stands(ground) && thing.top >= kLow * height;
    });
    double nearest = tall ? 0.0 : std::numeric_limits<double>::max();
    for (const Thing& thing : things)
        if (thing.stands(ground)) nearest = std::min(nearest, away(thing));
    std::vector<uint8_t> leaves(things.size());
    for (size_t t = 0; t < things.size(); t++)
        leaves[t] = things[t].stands(ground) && things[t].top < kLow * height &&
                    away(things[t]) > std::max(kBeside * height, nearest);
    for (size_t i = 0; i < points.size(); i++)
        goes[i] = leaves[label[i]];
    return goes;
}

}  // namespace treerec
