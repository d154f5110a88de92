// Where and when branches grow: what the surface follows.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "growth/section.h"

namespace treerec::growth {

// Of a branch's axis; metres, tree space.
struct AxisPlace {
    DVec3 position{0.0};
    DVec3 pith{0.0};                 // where the tip comes by: the axis, evened out where it is thick
    DVec3 direction{0.0, 1.0, 0.0};  // unit, towards the tip
    double along = 0.0;              // from where the axis begins
    double radius = 0.0;             // that it has in the end; where `follow` is off, of no matter
    double step = 0.0;               // when the tip is here; never falling
    double speed = 0.0;              // S_c of the cambium that is born here, metres a step
};

struct GrowthBranch {
    int32_t parent = -1;
    double parent_along = 0.0;    // metres of the parent's axis, where it leaves it
    std::vector<AxisPlace> axis;  // two places or more
    bool ends_open = false;       // a thinner tube goes on from the tip
    BranchSections sections;      // none: it is round

    double first_step() const { return axis.front().step; }
    double last_step() const { return axis.back().step; }
};

struct GrowthPlan {
    std::vector<GrowthBranch> branches;  // parents before children, the trunk first
    int steps = 0;
    // Cambium keeps to the axis's radii, by age, instead of to S_c alone: what it grows more than plain
    // cambium, as burls, comes on top.
    bool follow = false;
    double twist = 0.0;  // theta_p of equation 7, radians a metre: how the grain winds about its branch
    // A closed mesh that it starts from, metres, tree space; none: figure 4's prism.
    std::vector<std::array<DVec3, 3>> seed;
    bool fuse = false;   // surfaces that meet become one
    double young = 0.0;  // metres: of the axes' radii, what their tips have at once where `follow` is on
};

// By linear interpolation, held at the ends.
AxisPlace place_at(const GrowthBranch& branch, double along);
// Where the tip stands at a step.
AxisPlace tip_at(const GrowthBranch& branch, double step);
// Where a tip goes in a step that has come `along` metres: where it should be by then. One that was held up
// comes after at twice its pace.
AxisPlace next_place(const GrowthBranch& branch, double along, int step);
// 0 where the tip is, 1 at the end.
double age_of(const GrowthPlan& plan, const AxisPlace& place, double step);
// Where the middle of plain wood at `place` of a branch is at a step: at first the pith, in the end the axis.
DVec3 wood_centre(const GrowthPlan& plan, const AxisPlace& place, double step);
// Metres: how thick plain round wood at `place` of a branch is at a step.
double bark_radius(const GrowthPlan& plan, const AxisPlace& place, double step);

}  // namespace treerec::growth
