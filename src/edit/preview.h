// What an edit would do to the wood, as lines to be drawn over the tree before it is done.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec.h"
#include "tree/tree.h"

namespace treerec {

// Pairs of ends, tree space: wood that would be there, and wood that would be there no more. Wood that moves
// is in both. error: why the edit is refused; then there are no lines.
struct EditPreview {
    std::vector<DVec3> added, removed;
    std::vector<double> added_radii;  // of the upper ends, one for each pair
    std::string message, error;
};

// One line of text as perform() takes it (edit/commands/commands.h). Costs what that costs, and is linear
// besides.
EditPreview preview_edit(const Tree& tree, std::string_view line);

}  // namespace treerec
