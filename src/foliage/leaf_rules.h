// What leaves a kind of tree bears and how they stand (Chen 2025, 3.2.5).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/vec.h"
#include "tree/tree.h"

namespace treerec {

// How leaves follow one another along a twig (phyllotaxis; ABOP, chapter 4).
enum class LeafArrangement {
    kAlternate,  // one at a node, to the left and the right in turn
    kOpposite,   // two at a node, all in one plane
    kDecussate,  // two at a node, each pair across the one before
    kWhorled,    // `whorl` at a node, each whorl turned by half a step
    kSpiral,     // one at a node, turned by `divergence`
    kFascicled,  // a bunch of `whorl` from one short shoot; the shoots stand in a spiral
};

// What one card shows.
enum class LeafForm {
    kSpray,    // a picture of a twig's end with several leaves: a full crown from few triangles
    kSimple,   // one leaf
    kPinnate,  // a leaf of `leaflets` along a stalk, as the ash's
    kPalmate,  // a leaf of `leaflets` from one point, as the horse chestnut's
    kNeedles,  // a bundle of `leaflets` needles
    kSprig,    // the wood and the leaves of `sprig`
};

// A twig that is drawn at every place where a leaf would stand; what a string of turtle commands means
// (lsystem/lstring.h), or any scion. Its root stands at the origin, it grows along +Y, +Z is up. Its own
// length is no matter: leaf_size decides.
struct LeafSprig {
    struct Leaf {
        DVec3 position{0.0};
        DVec3 heading{0.0, 1.0, 0.0};
        DVec3 up{0.0, 0.0, 1.0};
        double size = 0.0;  // as the wood is measured; 0: a third of the sprig's length
    };
    Tree wood;
    std::vector<Leaf> leaves;  // none: one at every tip
};

inline constexpr double kUsualFold = 8.0;
inline constexpr double kMostCrowding = 3.0;

// Lengths in metres. On a smaller tree they shrink with the square root of its height: leaf_size (of sprays
// alone: a single leaf has its own size) and internode below 12 m, twig_length and maximum_radius below 6 m.
// Angles in degrees.
struct LeafRules {
    bool enabled = true;

    // Where leaves stand. One stands at every twig's tip besides.
    LeafArrangement arrangement = LeafArrangement::kSpiral;
    int whorl = 3;                // leaves in a whorl or a bunch
    double divergence = 137.508;  // the golden angle: leaves above one another shade least
    // Metres of twig for each card; nodes that bear several stand so many times as far apart.
    double internode = 0.063;
    double crowding = 1.0;     // how many times as close as that they stand
    double twig_length = 0.6;  // how far from its tip a branch bears leaves
    double clustering = 0.0;   // 0: evenly along it .. 1: nearly all just below the tip
    double maximum_radius =
        0.02;  // thicker wood bears none, but for the tips; nor do snags (snags.h) on wood twice as thick
    // The share of leaves that stand, 0..1, even steps with straight lines between them; empty: all.
    std::vector<float> by_height;  // from the root to the top
    std::vector<float> by_radius;  // from no thickness to maximum_radius
    std::vector<float>
        by_order;  // one value for each order of branches, from the trunk's; the last for all further

    // Square metres of blades, one side of them, for each of the ground that the crown covers (LAI). What is
    // more, the inner leaves are short of; where twigs are too few they bear leaves more closely, up to
    // kMostCrowding times. The shares above are of it. 0: as many as the internodes make.
    double leaf_area_index = 4.5;

    // What they are like.
    LeafForm form = LeafForm::kSpray;
    int leaflets = 7;
    double spray_cover = 0.3;     // of a spray's card: what blades cover of it
    double blade_width = 0.5;     // of a single leaf or leaflet, over its length
    double petiole = 0.0;         // metres of stalk below the card's own
    double leaf_size = 0.28;      // length of the card without the petiole
    double size_variation = 0.3;  // share
    double angle = 55.0;          // between the twig and the leaf
    double closing = 0.0;         // share of the angle by which the uppermost leaves close in on the tip
    double droop = 20.0;          // towards the ground
    double angle_variation = 20.0;
    double phototropism = 0.5;  // 0: faces as the twig turns them, 0.5: to the light, 1: leaves bend up to it
    double curl = 18.0;         // how far a card bends down along its length
    // By how much each half is turned out of the blade's plane about the midrib: down, as a roof, for sprays
    // and the leaflets of a compound leaf; up, as a channel, for a single blade. Needles have none.
    double fold = kUsualFold;
    std::shared_ptr<const LeafSprig> sprig;  // of kSprig; without one, kSimple

    // How many of them stand now: 1 in summer, 0 in winter. The same ones fall first for every value.
    double standing = 1.0;
    // How large they are now, over full-grown ones: as many stand, at the same places, while they unfold.
    double unfolded = 1.0;

    // How far the scan's own leaves (Foliage) decide: where leaves stand, and how they are coloured; 0..1.
    double follow_density = 1.0;
    double follow_color = 1.0;

    int maximum_leaves = 10000;  // beyond it fewer, larger leaves cover the same area
};

// "generic", "maple", "cherry", "oak", "birch", "willow", "apple", "pine", "spruce", "palm", "ginkgo",
// "poplar", "magnolia", "none". Throws Error for another name, listing these.
LeafRules leaf_preset(const std::string& name);
std::vector<std::string> leaf_preset_names();

// Throws Error where a number is not finite or not in its range, or the sprig is none; says which.
void check_leaf_rules(const LeafRules& rules);

// Leaves at one node: 1, 2 or `whorl`.
int leaves_per_node(const LeafRules& rules);

}  // namespace treerec
