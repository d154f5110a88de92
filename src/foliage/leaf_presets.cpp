#include <cmath>

#include "error.h"
#include "foliage/leaf_rules.h"

namespace treerec {

namespace {

LeafRules rules(LeafArrangement arrangement, double internode, double leaf_size, double angle, double droop) {
    LeafRules made;
    made.arrangement = arrangement;
    made.internode = internode;
    made.leaf_size = leaf_size;
    made.angle = angle;
    made.droop = droop;
    return made;
}

LeafRules willow() {
    // Long whips that hang, with narrow leaves.
    LeafRules made = rules(LeafArrangement::kSpiral, 0.062, 0.36, 28.0, 62.0);
    made.twig_length = 0.9;
    made.angle_variation = 14.0;
    made.blade_width = 0.17;
    made.curl = 26.0;
    return made;
}

LeafRules apple() {
    // Leaves stand in rosettes on spurs.
    LeafRules made = rules(LeafArrangement::kSpiral, 0.070, 0.26, 58.0, 14.0);
    made.clustering = 0.25;
    made.closing = 0.2;
    made.blade_width = 0.62;
    return made;
}

LeafRules pine() {
    // Tufts at the ends of bare twigs.
    LeafRules made = rules(LeafArrangement::kSpiral, 0.045, 0.26, 52.0, -6.0);
    made.clustering = 0.35;
    made.closing = 0.5;
    made.leaflets = 2;
    made.blade_width = 0.02;
    made.curl = 8.0;
    return made;
}

LeafRules spruce() {
    // Flat sprays to both sides of the twigs, which hang a little.
    LeafRules made = rules(LeafArrangement::kAlternate, 0.054, 0.28, 50.0, 24.0);
    made.twig_length = 0.9;
    made.angle_variation = 12.0;
    made.leaflets = 1;
    made.blade_width = 0.06;
    made.phototropism = 0.6;
    made.curl = 12.0;
    return made;
}

LeafRules palm() {
    // Fronds at the end of the stem alone: young ones upright, old ones hanging.
    LeafRules made = rules(LeafArrangement::kSpiral, 0.020, 2.8, 118.0, 12.0);
    made.twig_length = 0.84;
    made.maximum_radius = 0.5;
    made.by_order = {1.0f, 0.0f};
    made.closing = 0.85;
    made.size_variation = 0.12;
    made.angle_variation = 10.0;
    made.phototropism = 0.0;  // they arch away from the stem on all sides, not to the light
    made.curl = 75.0;
    made.fold = 30.0;  // leaflets stand at an angle to one another, so that no frond is a line from the side
    made.leaflets = 41;
    made.blade_width = 0.06;
    made.follow_density = 0.0;
    return made;
}

LeafRules ginkgo() {
    // Bunches from short shoots, which stand all along shoots of several years.
    LeafRules made = rules(LeafArrangement::kFascicled, 0.043, 0.274, 60.0, 16.0);
    made.twig_length = 1.1;
    made.blade_width = 1.45;
    made.curl = 12.0;
    return made;
}

LeafRules poplar() {
    // Long flat petioles: blades hang, and the least wind turns them.
    LeafRules made = rules(LeafArrangement::kSpiral, 0.050, 0.27, 48.0, 36.0);
    made.divergence = 144.0;  // every sixth leaf above the first
    made.blade_width = 0.95;
    made.curl = 12.0;
    return made;
}

LeafRules magnolia() {
    // Stiff leaves crowded at the ends of the shoots.
    LeafRules made = rules(LeafArrangement::kSpiral, 0.050, 0.34, 56.0, 4.0);
    made.clustering = 0.4;
    made.closing = 0.45;
    made.blade_width = 0.42;
    made.curl = 8.0;
    return made;
}

// Leaf area over ground: means of stands in Asner, Scurlock and Hicke 2003 (Global Ecology and Biogeography
// 12, 191-205: temperate broad-leaved woods 5.1, needle-leaved ones 5.5, orchards and plantings 3 to 4) and
// the ranges of species in Breuer, Eckhardt and Frede 2003 (Ecological Modelling 169, 237-293); a conifer's
// is of half its needles' surface. What blades cover of a spray's picture is measured; a test holds it to
// that.
struct Foliar {
    const char* preset;
    double leaf_area_index;
    double spray_cover;
};
constexpr Foliar kFoliar[] = {
    {"generic", 4.5, 0.34}, {"maple", 5.0, 0.29},  {"cherry", 4.0, 0.30},   {"oak", 4.5, 0.32},
    {"birch", 3.5, 0.28},   {"willow", 4.0, 0.22}, {"apple", 3.5, 0.32},    {"pine", 3.0, 0.22},
    {"spruce", 6.5, 0.23},  {"palm", 0.0, 0.35},  // a palm has as many fronds as stand
    {"ginkgo", 4.0, 0.41},  {"poplar", 3.5, 0.38}, {"magnolia", 4.5, 0.47},
};

LeafRules by_name(const std::string& name) {
    if (name == "generic") return {};
    if (name == "maple") {
        LeafRules maple = rules(LeafArrangement::kDecussate, 0.075, 0.32, 52.0, 18.0);
        maple.blade_width = 1.0;
        return maple;
    }
    if (name == "cherry") return rules(LeafArrangement::kSpiral, 0.058, 0.29, 50.0, 28.0);
    if (name == "oak") {
        LeafRules oak = rules(LeafArrangement::kSpiral, 0.073, 0.32, 55.0, 10.0);
        oak.blade_width = 0.6;
        return oak;
    }
    if (name == "birch") {
        LeafRules birch = rules(LeafArrangement::kSpiral, 0.062, 0.27, 42.0, 45.0);
        birch.blade_width = 0.74;
        return birch;
    }
    if (name == "willow") return willow();
    if (name == "apple") return apple();
    if (name == "pine") return pine();
    if (name == "spruce") return spruce();
    if (name == "palm") return palm();
    if (name == "ginkgo") return ginkgo();
    if (name == "poplar") return poplar();
    if (name == "magnolia") return magnolia();
    if (name == "none") {
        LeafRules none;
        none.enabled = false;
        return none;
    }
    std::string known;
    for (const std::string& other : leaf_preset_names())
        known += (known.empty() ? "" : ", ") + other;
    throw Error("'" + name + "' is no leaf preset; use one of: " + known + ".");
}

constexpr double kLongest = 1e4;  // metres

void require(double value, double low, double high, const char* what) {
    if (!(value >= low && value <= high))
        throw Error(std::string("The leaf rule's ") + what + " is out of its range.");
}

}  // namespace

std::vector<std::string> leaf_preset_names() {
    return {"generic", "maple",  "cherry", "oak",    "birch",  "willow",   "apple",
            "pine",    "spruce", "palm",   "ginkgo", "poplar", "magnolia", "none"};
}

LeafRules leaf_preset(const std::string& name) {
    LeafRules made = by_name(name);
    for (const Foliar& kind : kFoliar)
        if (name == kind.preset) {
            made.leaf_area_index = kind.leaf_area_index;
            made.spray_cover = kind.spray_cover;
        }
    return made;
}

void check_leaf_rules(const LeafRules& rules) {
    require(rules.whorl, 1, 64, "number of leaves in a whorl");
    require(rules.divergence, -360.0, 360.0, "divergence");
    require(rules.internode, 1e-4, kLongest, "internode");
    require(rules.twig_length, 0.0, kLongest, "twig length");
    require(rules.clustering, 0.0, 1.0, "clustering");
    require(rules.maximum_radius, 0.0, kLongest, "maximum radius");
    require(rules.leaf_area_index, 0.0, 100.0, "leaf area index");
    require(rules.spray_cover, 0.01, 1.0, "cover of a spray");
    require(rules.leaflets, 1, 128, "number of leaflets");
    require(rules.blade_width, 1e-3, 10.0, "blade width");
    require(rules.petiole, 0.0, kLongest, "petiole");
    require(rules.leaf_size, 1e-4, kLongest, "leaf size");
    require(rules.size_variation, 0.0, 1.0, "size variation");
    require(rules.angle, 0.0, 180.0, "angle");
    require(rules.closing, 0.0, 1.0, "closing");
    require(rules.droop, -180.0, 180.0, "droop");
    require(rules.angle_variation, 0.0, 180.0, "angle variation");
    require(rules.phototropism, 0.0, 1.0, "phototropism");
    require(rules.curl, -180.0, 180.0, "curl");
    require(rules.fold, -80.0, 80.0, "fold");
    require(rules.crowding, 0.01, 100.0, "crowding");
    require(rules.standing, 0.0, 1.0, "share of standing leaves");
    require(rules.unfolded, 0.01, 1.0, "share of leaves' size");
    require(rules.follow_density, 0.0, 1.0, "share of the scan's density");
    require(rules.follow_color, 0.0, 1.0, "share of the scan's colour");
    for (const std::vector<float>* table : {&rules.by_height, &rules.by_radius, &rules.by_order})
        for (const float value : *table)
            require(value, 0.0, 1.0, "density");
    if (rules.sprig && rules.sprig->wood.size() < 2) throw Error("The leaf rule's sprig has no wood.");
}

int leaves_per_node(const LeafRules& rules) {
    switch (rules.arrangement) {
        case LeafArrangement::kOpposite:
        case LeafArrangement::kDecussate:
            return 2;
        case LeafArrangement::kWhorled:
        case LeafArrangement::kFascicled:
            return rules.whorl;
        case LeafArrangement::kAlternate:
        case LeafArrangement::kSpiral:
            break;
    }
    return 1;
}

}  // namespace treerec
