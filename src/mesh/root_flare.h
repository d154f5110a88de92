// The foot of a standing trunk: it widens, runs out into surface roots and goes on below the ground. Internal
// to mesh/.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "foliage/branch_axis.h"
#include "mesh/tube_rings.h"
#include "mesh/uneven_section.h"

namespace treerec {

inline constexpr uint32_t kMostRoots = 7;

struct SurfaceRoot {
    double angle;  // where it leaves the trunk
    double bend;   // radians, how far it has turned aside where it goes under
    double out;    // how far its back stands out of the trunk on the ground, over the trunk's radius
    double width;  // radians: the standard deviation of its section
    double reach;  // metres up the trunk, where it begins,
    double end;    // and metres below the ground, where it is cut off
};

// Nothing of the trunk above `reach` changes.
struct RootFlare {
    double amount = 0.0;  // how much wider the trunk stands on the ground between its roots, over its radius
    double reach = 0.0;   // metres along; 0: no flare
    double depth = 0.0;   // metres below the root, where it is cut
    double radius = 0.0;  // metres, of the trunk at its root
    uint32_t count = 0;   // of surface roots; 0: round
    std::array<SurfaceRoot, kMostRoots> roots;  // by angle, the first one at 0
    double turn = 0.0;                          // radians that the rings' corners are turned by
};

// Metres that a trunk goes on below the ground, so that slopes hide its cut. height: of the tree, metres.
double foot_depth(double height);

// The foot of a standing trunk, as far as it lacks one: scans lose its roots in grass and litter, and a pipe
// in the ground is no tree. A base that the scan itself widens keeps what was measured, and its roots only
// stand out of that. points: the trunk's axis, from the root; seed: tells trees apart; roots: it may have
// any.
RootFlare plan_flare(const std::vector<AxisPoint>& points, double depth, uint64_t seed, bool roots);

// Lobes that the scan saw are the trunk's own roots and buttresses: others stand back from them. relief: of
// the outline there, from its narrowest to its widest over the radius.
void hold_back_roots(RootFlare& flare, double relief);

// As wide on average, and round: for where single roots are not seen.
RootFlare without_roots(RootFlare flare);

// Puts rings that show the flare in place of those below its reach: level on the ground, and on down to the
// cut. The first one is the cut, and all of 0 .. the returned number (not included) are the foot's.
// points: see plan_flare(); level: of detail; rings: the trunk's own, from the root, from `first` on to the
// end.
size_t lay_foot_rings(const RootFlare& flare, const std::vector<AxisPoint>& points, int level,
                      std::vector<Ring>& rings, size_t first);

struct FootVertex {
    DVec3 position;
    DVec3 normal;
    DVec3 tangent;  // unit, along +u
    double v;       // metres along the bark, over roots too
    double light;   // 0 .. 1: what reaches the hollows between roots
};

// Vertices of the foot's rows, of sides + 1 columns each, which gather where roots stand out. rings: of the
// trunk, from the cut; rows: the foot's, at least one ring follows them.
// section: what was measured shows there too.
std::vector<FootVertex> shape_foot(const RootFlare& flare, const Ring* rings, size_t rows, uint32_t sides,
                                   const UnevenSection& section);

// The picture of a base's bark: as wide as its outline there, as far as limit_slant() lets it. rings: of the
// trunk, from the cut.
void stretch_base(const RootFlare& flare, Ring* rings, size_t count);

}  // namespace treerec
