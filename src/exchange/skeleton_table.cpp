#include "exchange/skeleton_table.h"

#include <cmath>

#include "error.h"
#include "exchange/finite.h"

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
    if (count < 2)
        throw Error("'" + path + "' holds " + (count == 0 ? "no node" : "a single node") +
                    "; a tree has two or more.");
    bool has_length = false;
    for (size_t i = 0; i < count; i++) {
        const DVec3 &p = table.positions[i], offset = p - frame.origin;
        const auto within = [](const DVec3& v, double limit) {
            return std::abs(v.x) <= limit && std::abs(v.y) <= limit && std::abs(v.z) <= limit;
        };
        if (!within(p, kLargestCoordinate) || !within(offset, kLargestOffset) ||
            !(std::abs(table.radii[i]) <= kLargestOffset))
            throw Error("'" + path + "' holds no sound skeleton: the place or the radius of its node " +
                        std::to_string(i + 1) + " is no number that a tree can have.");
        has_length = has_length || offset != DVec3(0.0);
    }
    if (!has_length) throw Error("'" + path + "' holds no wood: all its nodes lie at one place.");
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
