// One tree out of a scan of several.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

// Which tree to take where a cloud holds several.
struct PickOptions {
    bool enabled = true;                           // false: whatever is in the cloud is one tree
    size_t number = 1;                             // 1 is the largest, 2 the next, …
    std::optional<DVec3> position = std::nullopt;  // scan coordinates: the tree that stands nearest

    bool operator==(const PickOptions&) const = default;
};

struct StandingTree {
    DVec3 foot{0.0};      // scan coordinates
    double height = 0.0;  // metres
    size_t points = 0;    // of the cloud
};

struct PickReport {
    std::vector<StandingTree> trees;  // largest first; empty where the cloud was taken for one tree
    size_t taken = 0;                 // index into trees
};

}  // namespace treerec
