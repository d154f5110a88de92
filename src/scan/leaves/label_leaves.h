// Leaves as the scan's file labels them. Internal to scan/.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scan/point_cloud.h"

namespace treerec {

struct LabelledLeaves {
    std::optional<uint8_t> leaf;  // the label of leaves; none where the labels tell nothing of them
    std::optional<uint8_t> wood;  // of wood
    std::string sentence;         // what is said of it; empty where nothing is
};

// cloud: metres, Y up, clean. Of two labels, the wood's is that of the foot: it has nearly all points there,
// and reaches up into the other's. (The classes of LAS may have two values as well, such as ground and
// trees.)
LabelledLeaves find_labelled_leaves(const PointCloud& cloud);

}  // namespace treerec
