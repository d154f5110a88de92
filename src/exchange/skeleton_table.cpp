#include "exchange/skeleton_table.h"

#include <cmath>

#include "error.h"

namespace treerec {

namespace {

constexpr double kLeastRadius = 1e-4;  // metres

}  // namespace

SkeletonTable table_of(const Tree& tree) {
    SkeletonTable table;
    table.positions.reserve(tree.size());
    table.radii.reserve(tree.size());
    table.parents.reserve(tree.size());
    table.flags.reserve(tree.size());
    std::vector<NodeId> row(static_cast<size_t>(tree.id_end()), kNoNode);
    for (NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        row[id] = static_cast<NodeId>(table.positions.size());
        table.positions.push_back(tree.frame().to_scan(node.position));
        table.radii.push_back(tree.frame().length_to_scan(node.radius));
        table.parents.push_back(node.parent == kNoNode ? kNoNode : row[node.parent]);
        table.flags.push_back(node.flags);
    }
    return table;
}

Tree tree_of(const SkeletonTable& table, const FileStamp& stamp, const std::string& path) {
    const size_t count = table.positions.size();
    ScanFrame frame;
    frame.up = stamp.up;
    frame.metres_per_unit = stamp.metres_per_unit;
    frame.tilt = stamp.tilt;
    std::vector<DVec3> positions(count);
    std::vector<double> radii(count);
    for (size_t i = 0; i < count; i++)
        if (table.parents[i] == kNoNode) {
            frame.origin = table.positions[i];
            break;
        }
    for (size_t i = 0; i < count; i++) {
        positions[i] = frame.to_tree(table.positions[i]);
        radii[i] = table.radii[i] * frame.metres_per_unit;
        if (radii[i] >= 0.0) radii[i] = std::max(radii[i], kLeastRadius);
    }
    try {
        Tree tree = Tree::from_arrays(table.parents, positions, radii, table.flags);
        tree.set_frame(frame);
        return tree;
    } catch (const Error& error) {
        throw Error("'" + path + "' holds no sound skeleton: " + error.what());
    }
}

}  // namespace treerec
