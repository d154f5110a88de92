// Radii by a rule instead of by the points (Zhang 2013, 5.4, figure 5.4).
#pragma once

#include <cstdint>
#include <string>

#include "tree/tree.h"

namespace treerec {

// As the points tell them; a child's radius a fixed part of its parent's (r = c R); or Leonardo da Vinci's
// rule, that the squares of the children's diameters are together that of the parent's.
enum class RadiusRule : uint8_t { kMeasured, kLinear, kDaVinci };

// "measured", "linear", "davinci". Throws Error for any other word, naming all.
RadiusRule parse_radius_rule(const std::string& word);
const char* radius_rule_name(RadiusRule rule);

// Replaces all radii but those of kMeasured. The stem is as thick at its base as it was where it stands clear
// of its flare (at breast height, or a tenth of a small tree). Between two forks the radius stays: each is
// one branch. At a fork the linear rule takes for c what is usual between a fork and its branches in the
// radii that are there (their mean in logarithms); da Vinci's leaves open how the children share, and gives
// each as much as it bears tips, so that all tips are alike. None is thinner than a tenth of a millimetre.
// Radii count as measured no more.
void apply_radius_rule(Tree& tree, RadiusRule rule);

}  // namespace treerec
