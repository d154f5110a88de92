#include <array>

#include "error.h"
#include "exchange/skeleton_parsers.h"
#include "exchange/skeleton_table.h"
#include "exchange/text_scan.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"
#include "tree/branches.h"

namespace treerec {

void write_qsm_csv(const std::string& path, const Tree& tree) {
    std::string text =
        "radius,length,start_x,start_y,start_z,axis_x,axis_y,axis_z,parent_1based,branch,order,measured\n";
    text.reserve(text.size() + 160 * tree.size());
    const BranchList list = list_branches(tree);
    const ScanFrame& frame = tree.frame();
    std::vector<int32_t> cylinder(static_cast<size_t>(tree.id_end()), 0);
    int32_t count = 0;
    for (size_t b = 0; b < list.branches.size(); b++) {
        for (NodeId id : list.nodes_of(list.branches[b])) {
            const Node& node = tree.node(id);
            if (node.parent == kNoNode) continue;
            const DVec3 start = frame.to_scan(tree.node(node.parent).position);
            const DVec3 along = frame.to_scan(node.position) - start;
            const double length = glm::length(along);
            const DVec3 axis = normalized_or(along, frame.turn_to_scan(DVec3(0.0, 1.0, 0.0)));
            cylinder[id] = ++count;
            for (double value : {frame.length_to_scan(node.radius), length, start.x, start.y, start.z, axis.x,
                                 axis.y, axis.z}) {
                append_number(text, value);
                text += ',';
            }
            append_number(text, int64_t{cylinder[node.parent]});
            text += ',';
            append_number(text, static_cast<int64_t>(b + 1));
            text += ',';
            append_number(text, int64_t{list.branches[b].order});
            text += node.is_measured() ? ",1\n" : ",0\n";
        }
    }
    write_file(path, text);
}

Tree read_qsm_csv(const std::string& path, UpAxis up) {
    return parse_qsm_csv(read_file(path).view(), path, up);
}

Tree parse_qsm_csv(std::string_view bytes, const std::string& path, UpAxis up) {
    std::string_view rest = bytes;
    const std::optional<std::string_view> head = next_line(rest);
    const std::vector<std::string> fields = head ? split_fields(*head) : std::vector<std::string>();
    enum Column { kRadius, kLength, kStart, kAxis = kStart + 3, kParent = kAxis + 3, kColumns };
    const std::array<int, kColumns> columns = {find_field(fields, {"radius"}),
                                               find_field(fields, {"length"}),
                                               find_field(fields, {"start_x"}),
                                               find_field(fields, {"start_y"}),
                                               find_field(fields, {"start_z"}),
                                               find_field(fields, {"axis_x"}),
                                               find_field(fields, {"axis_y"}),
                                               find_field(fields, {"axis_z"}),
                                               find_field(fields, {"parent_1based", "parent"})};
    for (int column : columns)
        if (column < 0)
            throw Error("'" + path +
                        "' is no table of cylinders: its first line does not name radius, length, start_x.., "
                        "axis_x.. and parent_1based.");
    const int order = find_field(fields, {"order"}), measured = find_field(fields, {"measured"});
    SkeletonTable table;
    // Row 0 is the root, where the first cylinder without a parent starts; row i the end of cylinder i.
    table.positions.emplace_back(0.0);
    table.radii.push_back(0.0);
    table.parents.push_back(kNoNode);
    table.flags.push_back(kTrunkFlag);
    bool has_root = false;
    std::vector<double> values(fields.size());
    size_t line_number = 1;
    while (const std::optional<std::string_view> line = next_line(rest)) {
        line_number++;
        const std::string where = "'" + path + "', line " + std::to_string(line_number) + ": ";
        const std::vector<std::string> words = split_fields(*line);
        if (words.empty()) continue;
        if (words.size() != fields.size())
            throw Error(where + std::to_string(words.size()) + " values where the first line names " +
                        std::to_string(fields.size()) + ".");
        for (size_t i = 0; i < words.size(); i++) {
            const std::optional<double> value = parse_number(words[i]);
            if (!value) throw Error(where + quote_word(words[i]) + " is no number.");
            values[i] = *value;
        }
        const auto vector_at = [&](Column first) {
            return DVec3(values[columns[first]], values[columns[first + 1]], values[columns[first + 2]]);
        };
        const DVec3 start = vector_at(kStart);
        const double parent = values[columns[kParent]];
        if (!(parent >= 0.0 && parent < 16777216.0)) throw Error(where + "its parent is out of range.");
        if (parent == 0.0 && !has_root) {
            table.positions[0] = start;
            table.radii[0] = values[columns[kRadius]];
            has_root = true;
        }
        const bool trunk = order >= 0 && values[order] == 0.0;
        const bool fitted = measured >= 0 && values[measured] == 1.0;
        table.positions.push_back(start + values[columns[kLength]] * vector_at(kAxis));
        table.radii.push_back(values[columns[kRadius]]);
        table.parents.push_back(static_cast<NodeId>(parent));
        table.flags.push_back(
            static_cast<uint8_t>((trunk ? kTrunkFlag : 0) | (fitted ? kMeasuredRadiusFlag : 0)));
    }
    if (!has_root)
        throw Error("'" + path + "' holds no cylinder without a parent, where the tree would begin.");
    return tree_of(table, {up, 1.0}, path);
}

}  // namespace treerec
