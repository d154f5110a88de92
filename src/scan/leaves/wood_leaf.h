// Tells a scan's leaves from its wood, so that the skeleton follows wood and the crown keeps its foliage.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

struct WoodLeaf {
    bool foliage = false;     // whether there are leaves at all; without them the rest but the noise is empty
    double leaf_share = 0.0;  // of the points
    bool by_colour = false;   // green told more than shape
    bool by_labels = false;   // the scan's file told it
    std::vector<uint8_t> leaf;  // by point of the cloud: 1 for a leaf
    // By point: 1 for what the skeleton should follow: all wood, and among the leaves what is hardly leafier,
    // and the points along the paths of branches that the leaves hide. What is neither leaf nor this is none
    // of the tree: it grows around the foot.
    std::vector<uint8_t> wood_path;
    // By point: the logit of being leaf at even odds (NaN: not looked at). Only where shape shows leaves and
    // what the skeleton follows may hold many of them, so that its branches want a second look
    // (skeleton/twigs/leaf_twigs.h): even where `foliage` is false.
    std::vector<float> leafiness;
    double hidden_share = 0.0;  // of the branches' length in the crown: followed through leaves, not seen
    bool fronds = false;        // a palm: the skeleton should be one stem
    double reach = 0.0;         // metres: how far fronds reach from it
    double noise = 0.0;         // metres, at least, where there is too much of it for shape to tell; else 0
    std::vector<std::string> warnings;
};

// cloud: metres, Y up, clean. Where its labels tell leaves from wood, they do (label_leaves.h). Else the
// shape of all of it tells whether it is in leaf (leaf_presence.h), and two small networks look at each point
// and its surroundings (leaf_classifier.h), which tests/bench/fit_leaves.py fits to virtual scans, sharp and
// blurred, and to real ones whose leaves are known; the tree's own share of leaves is then found by
// expectation maximisation (Saerens, Latinne and Decaestecker 2002). Where the leaves are fronds, the tree is
// a palm. Colour counts where it falls into a green and another group (leaf_colour.h); where the light has
// bleached it and shape contradicts it, as in photos, colour alone tells, and all points are followed. A scan
// without leaves, or too sparse or noisy to show them, is left whole. Round bark that shows between the
// leaves is a stem (round_stems.h), and what grows around its foot is not followed. The order of the points
// and the number of threads change nothing.
WoodLeaf tell_wood_from_leaves(const PointCloud& cloud, Progress* progress = nullptr);

}  // namespace treerec
