// How the grain winds about a trunk, by what of its unrolled bark runs aslant. Internal to growth/.
#pragma once

#include <optional>

#include "growth/bark_map.h"

namespace treerec::growth {

// theta_p (Mizoguchi and Miyata 2014, equation 7): radians a metre, positive where it winds in the sense in
// which `around` rises. Ridges, flutes and dents that lie one above the other tell it: rows of the map are
// compared with all others within a metre or two, turned against one another as each twist would have them
// (a Radon transform of their correlations). Nothing where they are not alike enough, where no twist is
// better than all others or than none, or where the trunk's two halves disagree.
std::optional<double> fit_twist(const BarkMap& map);

}  // namespace treerec::growth
