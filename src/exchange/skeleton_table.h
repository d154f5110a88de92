// The table of nodes that every skeleton file comes down to, in scan coordinates.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exchange/text_scan.h"
#include "tree/tree.h"

namespace treerec {

struct SkeletonTable {
    std::vector<DVec3> positions;  // scan coordinates and units
    std::vector<double> radii;     // scan units
    std::vector<NodeId> parents;   // index into the table, -1 for the root
    std::vector<uint8_t> flags;
};

// In depth-first order, so that parents come first and children keep their order.
SkeletonTable table_of(const Tree& tree);
// The tree, its origin at its root, the stamp's axis up. A radius of zero, as some programs write for tips,
// becomes a tenth of a millimetre. Throws Error where the table is no tree, or one of a single node, without
// length or of impossible measures; `path` is for the sentence.
Tree tree_of(const SkeletonTable& table, const FileStamp& stamp, const std::string& path);

}  // namespace treerec
