#include <algorithm>
#include <cmath>
#include <vector>

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
                                      double growth, bool fewer, uint64_t pick) {
    const auto suits = [&](size_t i) {  // equation 4
        const double off = 100.0 * (growth * species.twigs[i].length - length);
        const double thicker = 100.0 * (growth * species.twigs[i].radius - radius);
        return off < 0.0 && thicker < 0.0 && off * off < kLengthBound && thicker * thicker < kRadiusBound;
    };
    const auto one_of = [&](size_t like, auto&& fits) {
        std::vector<size_t> alike;
        for (size_t i = 0; i < species.twigs.size(); i++)
            if (i == like || (species.twigs[i].size == species.twigs[like].size && fits(i)))
                alike.push_back(i);
        return alike[pick % alike.size()];
    };
    // Of those that fit the longest.
    for (size_t i = species.twigs.size(); i-- > 0;)
        if (suits(i)) return ChosenTwig{one_of(i, suits), growth};
    std::optional<ChosenTwig> best;
    double nearest = 0.0;
    for (size_t i = 0; i < species.twigs.size(); i++) {
        const double fits = length / (growth * species.twigs[i].length);
        if (fits < kLeastScale * (fewer ? kCutShare : 1.0)) continue;
        const double off = std::abs(portable::log(fits));
        if (best && off >= nearest) continue;
        nearest = off;
        best = ChosenTwig{i, 0.0};
    }
    if (!best) return best;
    const auto fit = [&](size_t i) { return length / (growth * species.twigs[i].length); };
    best->twig = one_of(best->twig, [&](size_t i) { return fit(i) >= kLeastScale && fit(i) <= kMostScale; });
    best->scale = growth * std::clamp(fit(best->twig), kLeastScale, kMostScale);
    return best;
}

}  // namespace treerec
