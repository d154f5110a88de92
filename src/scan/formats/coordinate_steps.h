// Coordinates that were rounded until no tree was left in them. Internal to scan/.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

struct CoordinateSteps {
    int axis = 0;
    double step = 0.0;       // units of the file
    bool as_floats = false;  // the coordinates are 32-bit numbers, whose steps grow with their size
};

// The coarsest step in which the coordinates of an axis come, where rounding far from zero has left too
// little of a tree: to 32-bit numbers or to a few digits. Nothing where they are fine enough, or stand near
// zero, as voxels do. `keep`: by position, whether it counts.
std::optional<CoordinateSteps> find_coarse_steps(const std::vector<DVec3>& positions,
                                                 const std::vector<uint8_t>& keep);

}  // namespace treerec
