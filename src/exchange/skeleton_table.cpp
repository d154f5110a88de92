#include "exchange/skeleton_table.h"

#include <cmath>

#include "error.h"

namespace treerec {

namespace {

constexpr int kStampVersion = 1;
constexpr std::string_view kStampWord = "treerec ";
constexpr double kLeastRadius = 1e-4;  // metres

}  // namespace

std::string stamp_text(const ScanFrame& frame) {
    std::string text(kStampWord);
    append_number(text, int64_t{kStampVersion});
    text += " up ";
    text += up_axis_name(frame.up);
    text += " metres_per_unit ";
    append_number(text, frame.metres_per_unit);
    return text;
}

bool read_stamp(std::string_view comment, FileStamp& stamp, const std::string& path) {
    const size_t at = comment.find(kStampWord);
    if (at == std::string_view::npos) return false;
    std::vector<std::string_view> words;
    for (size_t i = at; i < comment.size();) {
        const size_t end = std::min(comment.find(' ', i), comment.size());
        if (end > i) words.push_back(comment.substr(i, end - i));
        i = end + 1;
    }
    if (words.size() < 6 || words[2] != "up" || words[4] != "metres_per_unit") return false;
    const std::optional<double> version = parse_number(words[1]);
    const std::optional<double> unit = parse_number(words[5]);
    if (!version || !unit) return false;
    if (*version > kStampVersion)
        throw Error("'" + path + "' was written by a newer version of this program; update to open it.");
    if (!(*unit > 1e-12) || !(*unit < 1e12)) return false;
    stamp.up = parse_up_axis(words[3]);
    stamp.metres_per_unit = *unit;
    return true;
}

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
