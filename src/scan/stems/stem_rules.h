// When two stems are one tree's. Internal to stems/.
#pragma once

#include "scan/stems/separate_trees.h"

namespace treerec {

// As shares of the height.
inline constexpr double kClosest = 0.05;  // between the feet of two trees
inline constexpr double kSeed = 0.08;     // of a stem, from its lowest slice up: further up it meets branches
// Others.
inline constexpr double kClosestMetres = 0.6;
inline constexpr double kMostLean = 0.9;   // run over rise of a whole stem
inline constexpr double kThinnest = 0.25;  // of a thick stem's radius

// Whether the feet stand too near to each other for two trees. closest: as a share of the height.
bool stand_together(const Stem& a, const Stem& b, double closest, double height);
// Whether the axes come together further up: a branch that leans on the ground.
bool lean_together(const Stem& a, const Stem& b, double height);

// other's seed and feet are stem's, too.
void take_in(Stem& stem, const Stem& other);

}  // namespace treerec
