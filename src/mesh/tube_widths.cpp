// How wide the tubes of coarser levels are. Few sides, few rings and a point at the tip all make a tube cover
// less of the picture than its wood would, up to a half of a twig: that is given back here.
#include <algorithm>

#include "geometry/portable_math.h"
#include "mesh/parallel_transport.h"
#include "mesh/tube_builder.h"

namespace treerec::tubes {

namespace {

constexpr double kFreeBase = 1.5;    // twigs that stand for more than this may be wider than what bears them
constexpr double kNarrowest = 1.0;   // of a ring's own radius: no tube is thinner than its wood,
constexpr double kWidest = 1.5;      // and none wider, where the few rings left cover too little,
constexpr double kWidestFree = 2.5;  // unless it stands for many: then over how many times its area

// How wide a prism about a circle of radius 1 looks from aside, on average: its circumference over pi.
double mean_width(uint32_t sides) {
    return 2.0 * sides * portable::sin(kPi / sides) / kPi;
}

// What a ring's radius adds to what a run of rings covers.
double share_of(const Ring* rings, size_t count, size_t i) {
    double length = 0.0;
    if (i > 0) length += glm::distance(rings[i - 1].centre, rings[i].centre);
    if (i + 1 < count) length += glm::distance(rings[i].centre, rings[i + 1].centre);
    return 0.5 * length * rings[i].radius;
}

}  // namespace

void Builder::widen(size_t index) {
    Tube& tube = tubes[index];
    if (tube.rings < 2) return;
    Ring* run = rings[index / kBranchesPerChunk].data() + tube.first_ring;
    const bool goes_on = covered[index] > 0.0;  // from grown bark: only what is left of it is drawn here
    double whole = 0.0;
    for (size_t i = 0; goes_on && i < tube.rings; i++)
        whole += 2.0 * share_of(run, tube.rings, i);
    const double area = widened[index] * (goes_on ? whole : drawn_area(tree, list, list.branches[index]));
    // A twig that stands for many may start wider than what bears it: from so far nobody sees it.
    const bool free = widened[index] > kFreeBase && list.branches[index].attach != kNoNode;
    if (free) run[0].radius = std::max(run[0].radius, tube.base_radius);
    // Else its start stays hidden; and a flare has its own width.
    size_t first = free || (tube.parent_radius <= 0.0 && !goes_on) ? 0 : 1;
    while (first < tube.foot_rows)
        first++;
    double kept = 0.0, open = 0.0;
    size_t ground = 0;  // what lies below it covers nothing
    while (ground < tube.foot_rows && run[ground].along < 0.0)
        ground++;
    for (size_t i = ground; i < tube.rings; i++)
        (i < first ? kept : open) +=
            mean_width(tube.sides) * share_of(run + ground, tube.rings - ground, i - ground);
    if (!(open > 0.0)) return;
    const double wider =
        std::clamp((area - kept) / open, kNarrowest, free ? kWidestFree * widened[index] : kWidest);
    for (size_t i = first; i < tube.rings; i++)
        run[i].radius = std::max(run[i].radius * wider, least);
    if (tube.point) run[tube.rings - 1].radius = least;
    if (!free) return;
    tube.plug = true;
    // The wood itself is no thicker for that.
    widened[index] = static_cast<float>(std::max(wider, 1.0));
    limit_tilt(run, tube.rings);
    parallel_transport(run, tube.rings);
}

}  // namespace treerec::tubes
