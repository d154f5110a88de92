// Grows a plausible tree from a seed: ground truth for tests and the bundled sample.
//
// Order by order, each branch walks from its parent and bends by its habit: a slow random sway, gravity
// (up or down), the light above and the wood already there. Side buds sit around it by phyllotaxis. Radii
// follow the pipe model (Shinozaki et al. 1964) with the exponent that meets the trunk's base.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tree/tree.h"

namespace treerec {

enum class Habit { kBroadleaf, kConifer, kBirch, kForked, kLeaning, kShrub, kButtressed, kPalm };

struct GrowOptions {
    Habit habit = Habit::kBroadleaf;
    double height = 0.0;  // metres; 0: the habit's own, by the seed
    uint64_t seed = 1;
};

std::vector<Habit> all_habits();
// "broadleaf", "conifer", "birch", "forked", "leaning", "shrub" (several stems), "buttressed", "palm".
std::string habit_name(Habit habit);
std::vector<std::string> habit_names();
// Throws Error for another name, listing these.
Habit parse_habit(const std::string& name);

// Metres, Y up, root at (0,0,0), trunk marked, frame with Z up. All radii count as measured. The same options
// give the same tree on every machine. Throws Error for a height outside 1..60 m.
Tree grow_tree(const GrowOptions& options);

}  // namespace treerec
