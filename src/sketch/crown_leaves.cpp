#include "sketch/crown_leaves.h"

#include <algorithm>
#include <cmath>

namespace treerec {

namespace {

// Leaves are to cover the outline so many times, with the holes that their pictures have; but no more than so
// many times what the rules allow, since beyond that fewer and larger ones stand.
constexpr double kCovers = 34.0, kOfMostLeaves = 2.0;
// The share of a twig's wood that is near enough to a tip to bear leaves.
constexpr double kBearing = 0.6;
// Of a leaf's length: how far beyond its wood it covers most of what is there, since it leans.
constexpr double kStandsOut = 0.46;
// Of half a crown's width: in a slender one leaves would find no wood to stand on.
constexpr double kMostMargin = 0.25;
constexpr double kLeastGrowth = 0.3, kMostGrowth = 1.5;

// Leaves that would cover the crown's outline often enough.
double covering_leaves(const CrownSections& crown, const LeafRules& rules, double height) {
    const double length = leaf_length(rules, height);
    return kCovers * crown.area() / (length * length * std::min(rules.blade_width, 1.0));
}

}  // namespace

double twig_growth(const SketchSpecies& species, double height) {
    return std::clamp(std::sqrt(height / species.height), kLeastGrowth, kMostGrowth);
}

double shrunk(double height) {
    return std::sqrt(std::min(height / 12.0, 1.0));
}

double leaf_length(const LeafRules& rules, double height) {
    return rules.leaf_size * (rules.form == LeafForm::kSpray ? shrunk(height) : 1.0);
}

double leaf_margin(const CrownSections& crown, const LeafRules& rules, double height) {
    // Where they would be more than the rules allow, fewer and larger ones stand.
    const double larger = std::sqrt(covering_leaves(crown, rules, height) / rules.maximum_leaves);
    const double margin =
        kStandsOut * leaf_length(rules, height) * std::clamp(larger, 1.0, std::sqrt(kOfMostLeaves)) +
        rules.petiole;
    return std::min(margin, kMostMargin * crown.reach());
}

double wanted_wood(const CrownSections& crown, const LeafRules& rules, double height) {
    const double count =
        std::min(covering_leaves(crown, rules, height), kOfMostLeaves * rules.maximum_leaves);
    return count * rules.internode * shrunk(height) / kBearing;
}

}  // namespace treerec
