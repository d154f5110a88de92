#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"
#include "sketch/fill.h"

namespace treerec {

namespace {

// Equation 4's bounds, of squared centimetres.
constexpr double kLengthBound = 5.0, kRadiusBound = 1.0;
constexpr double kLeastScale = 0.7, kMostScale = 1.3;
constexpr double kCutShare = 0.5;  // of a twig that may be cut away

}  // namespace

std::optional<ChosenTwig> choose_twig(const SketchSpecies& species, double length, double radius,
                                      double growth, bool fewer) {
    // Equation 4, of those that fit the longest.
    for (size_t i = species.twigs.size(); i-- > 0;) {
        const double off = 100.0 * (growth * species.twigs[i].length - length);
        const double thicker = 100.0 * (growth * species.twigs[i].radius - radius);
        if (off < 0.0 && thicker < 0.0 && off * off < kLengthBound && thicker * thicker < kRadiusBound)
            return ChosenTwig{i, growth};
    }
    std::optional<ChosenTwig> best;
    double nearest = 0.0;
    for (size_t i = 0; i < species.twigs.size(); i++) {
        const double fits = length / (growth * species.twigs[i].length);
        if (fits < kLeastScale * (fewer ? kCutShare : 1.0)) continue;
        const double off = std::abs(portable::log(fits));
        if (best && off >= nearest) continue;
        nearest = off;
        best = ChosenTwig{i, growth * std::clamp(fits, kLeastScale, kMostScale)};
    }
    return best;
}

}  // namespace treerec
