#include "error.h"
#include "foliage/leaves.h"

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

}  // namespace

std::vector<std::string> leaf_preset_names() {
    return {"generic", "maple", "cherry", "oak", "birch", "pine", "none"};
}

LeafRules leaf_preset(const std::string& name) {
    if (name == "generic") return {};
    if (name == "maple") return rules(LeafArrangement::kOpposite, 0.075, 0.32, 52.0, 18.0);
    if (name == "cherry") return rules(LeafArrangement::kAlternate, 0.050, 0.27, 50.0, 28.0);
    if (name == "oak") return rules(LeafArrangement::kAlternate, 0.060, 0.29, 55.0, 10.0);
    if (name == "birch") return rules(LeafArrangement::kAlternate, 0.045, 0.23, 42.0, 45.0);
    if (name == "pine") return rules(LeafArrangement::kAlternate, 0.050, 0.26, 45.0, 0.0);
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

}  // namespace treerec
