// How each habit grows. Internal to synth/.
#pragma once

#include <array>

#include "synth/grow.h"

namespace treerec {

inline constexpr int kMaximumOrder = 3;  // of branches; the trunk is 0

// How the branches of one order grow. Lengths in metres, angles in degrees.
struct OrderHabit {
    double step;          // between nodes
    double sway;          // of the heading, per square root of a metre
    double lift;          // pull towards the sky (negative: towards the ground) per metre, at the base
    double tip_lift;      // the same at the tip
    double bare;          // share of its length without side branches
    double spacing;       // between side buds (or whorls)
    int whorl;            // buds per spacing
    double angle;         // of its side branches at its base
    double tip_angle;     // and at its tip
    double child_ratio;   // length of its longest side branch beside its own
    double least_length;  // shorter side branches do not grow
    double clearance;     // kept from other wood
};

struct HabitRules {
    const char* name;
    double least_height, most_height;
    double slenderness;             // height / diameter at the base above the flare
    double tip_radius;              // metres
    int stems;                      // from one root
    double spread;                  // degrees off the vertical, of several stems
    double least_lean, most_lean;   // degrees, of the trunk
    int leaders;                    // branches that the trunk splits into; 1: it goes through to the top
    double split;                   // at this share of the height
    double first_turn, other_turn;  // degrees by which the branches turn off, on average
    // Length of side branches along the trunk: share of the longest, from the first to the top.
    double profile_base, profile_middle, profile_top;
    std::array<OrderHabit, kMaximumOrder + 1> orders;
};

const HabitRules& habit_rules(Habit habit);

}  // namespace treerec
