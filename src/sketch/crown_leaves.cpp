#include "sketch/crown_leaves.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "foliage/leaf_rule_text.h"
#include "tree/branches.h"

namespace treerec {

namespace {

// Twigs are to have room for leaves that cover the outline so many times, with the holes that their pictures
// have; but for no more than so many times as many as a large crown has.
constexpr double kCovers = 34.0, kOfMostLeaves = 2.0, kLargeCrown = 24000.0;
// The share of a twig's wood that is near enough to a tip to bear leaves, of our species and at least.
constexpr double kBearing = 0.6, kLeastBearing = 0.25;
// Of a leaf's length: how far beyond its wood it covers most of what is there, since it leans.
constexpr double kStandsOut = 0.46;
// Of half a crown's width: in a slender one leaves would find no wood to stand on.
constexpr double kMostMargin = 0.25;
// So many times as close as on grown trees leaves stand, and are the more.
constexpr double kCrowding = 1.5;
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
    const double larger = std::sqrt(covering_leaves(crown, rules, height) / kLargeCrown);
    const double margin =
        kStandsOut * leaf_length(rules, height) * std::clamp(larger, 1.0, std::sqrt(kOfMostLeaves)) +
        rules.petiole;
    return std::min(margin, kMostMargin * crown.reach());
}

double bearing_share(const SketchSpecies& species, double height) {
    if (!species.own) return kBearing;
    const double reach = species.leaves.twig_length * shrunk(height) / twig_growth(species, height);
    double all = 0.0, bearing = 0.0;
    for (const SpeciesTwig& twig : species.twigs) {
        const std::vector<double> to_tip = longest_paths(twig.scion);
        for (const NodeId id : twig.scion.depth_first()) {
            const Node& node = twig.scion.node(id);
            if (node.parent == kNoNode) continue;
            const double length = glm::distance(node.position, twig.scion.node(node.parent).position);
            all += length;
            bearing += std::clamp(reach - to_tip[static_cast<size_t>(id)], 0.0, length);
        }
    }
    return all > 0.0 ? std::max(bearing / all, kLeastBearing) : kBearing;
}

double wanted_wood(const CrownSections& crown, const SketchSpecies& species, double height) {
    const LeafRules& rules = species.leaves;
    const double count = std::min(covering_leaves(crown, rules, height), kOfMostLeaves * kLargeCrown);
    return count * rules.internode * shrunk(height) / bearing_share(species, height);
}

void fill_with_leaves(Tree& tree) {
    std::ostringstream rule;
    rule << "leaf_area_index=0 crowding=" << kCrowding
         << " maximum_leaves=" << std::lround(kLargeCrown * kCrowding);
    const uint8_t number = tree.name_leaf_rule(plain_leaf_rule(rule.str()));
    for (const NodeId id : tree.depth_first())
        tree.set_leaf_rule(id, number);
}

}  // namespace treerec
