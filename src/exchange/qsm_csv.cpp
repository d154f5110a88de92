#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "error.h"
#include "exchange/finite.h"
#include "exchange/qsm_columns.h"
#include "exchange/skeleton_graph.h"
#include "exchange/skeleton_parsers.h"
#include "exchange/skeleton_table.h"
#include "exchange/text_scan.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"
#include "tree/branches.h"
#include "tree/trunk.h"

namespace treerec {

void write_qsm_csv(const std::string& path, const Tree& tree) {
    require_readable(tree, path);
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

Tree read_qsm_csv(const std::string& path, const SkeletonChoice& choice, SkeletonReport* report) {
    return parse_qsm_csv(read_file(path).view(), path, choice, report);
}

Tree parse_qsm_csv(std::string_view bytes, const std::string& path, const SkeletonChoice& choice,
                   SkeletonReport* report) {
    if (looks_like_qsm_sections(bytes)) return parse_qsm_sections(bytes, path, choice, report);
    choose_tree({1}, choice, path, report);
    std::string_view rest = bytes;
    const std::optional<std::string_view> head = next_line(rest);
    const std::optional<QsmColumns> columns = head ? find_qsm_columns(*head) : std::nullopt;
    if (!columns)
        throw Error("'" + path +
                    "' is no table of cylinders: its first line does not name radius, parent, start_x.. and "
                    "end_x.. (or axis_x.. and length).");
    const QsmColumns& at = *columns;
    // Row 0 is the root, where the first cylinder without a parent starts; row i the end of cylinder i.
    SkeletonTable table;
    table.positions.emplace_back(0.0);
    table.radii.push_back(0.0);
    table.parents.push_back(kNoNode);
    table.flags.push_back(kTrunkFlag);
    std::vector<double> parents{0.0}, orders{INFINITY};
    std::vector<DVec3> starts{DVec3(0.0)};
    std::unordered_map<double, NodeId> row_of;  // looked up only, never walked
    std::vector<std::string_view> words;
    size_t line_number = 1;
    while (const std::optional<std::string_view> line = next_line(rest)) {
        line_number++;
        const auto where = [&] { return "'" + path + "', line " + std::to_string(line_number) + ": "; };
        split_row(*line, at.delimiter, words);
        if (words.empty()) continue;
        // A program that numbers its rows may leave that column without a name.
        const size_t shift = words.size() == at.count + 1 ? 1 : 0;
        if (words.size() != at.count + shift)
            throw Error(where() + std::to_string(words.size()) + " values where the first line names " +
                        std::to_string(at.count) + ".");
        const auto number_at = [&](int column) {
            const std::string_view word = words[static_cast<size_t>(column) + shift];
            const std::optional<double> value = parse_number(word);
            if (!value) throw Error(where() + quote_word(word) + " is no number.");
            return *value;
        };
        const auto vector_at = [&](int column_x, int column_y, int column_z) {
            return DVec3(number_at(column_x), number_at(column_y), number_at(column_z));
        };
        const NodeId row = static_cast<NodeId>(table.positions.size());
        const DVec3 start = vector_at(at.start[0], at.start[1], at.start[2]);
        starts.push_back(start);
        table.positions.push_back(at.end[0] >= 0 ? vector_at(at.end[0], at.end[1], at.end[2])
                                                 : start + number_at(at.length) *
                                                               vector_at(at.axis[0], at.axis[1], at.axis[2]));
        const double radius = number_at(at.radius);
        table.radii.push_back(radius);
        const bool fitted = (at.measured >= 0 && number_at(at.measured) == 1.0) ||
                            (at.added >= 0 && number_at(at.added) == 0.0);
        table.flags.push_back(fitted ? kMeasuredRadiusFlag : 0);
        orders.push_back(at.order >= 0 ? number_at(at.order) : INFINITY);
        const double id = at.id >= 0 ? number_at(at.id) : row;
        if (!std::isfinite(id)) throw Error(where() + "its id is no number.");
        if (!row_of.emplace(id, row).second) throw Error(where() + "this id was there before.");
        // R writes NA where there is none.
        const std::string_view word = words[static_cast<size_t>(at.parent) + shift];
        const double parent = word == "NA" || word == "NaN" ? -1.0 : number_at(at.parent);
        if (!(std::abs(parent) < 16777216.0)) throw Error(where() + "its parent is out of range.");
        parents.push_back(parent);
        table.parents.push_back(0);
    }
    bool has_root = false;
    const double trunk_order = *std::min_element(orders.begin(), orders.end());
    for (size_t row = 1; row < parents.size(); row++) {
        const auto parent = row_of.find(parents[row]);
        if (parent != row_of.end()) {
            table.parents[row] = parent->second;
        } else if (parents[row] > 0.0) {
            throw Error("'" + path + "' is damaged: its cylinder " + std::to_string(row) +
                        " hangs on one that is not there.");
        } else if (!has_root) {
            has_root = true;
            table.positions[0] = starts[row];
            table.radii[0] = table.radii[row];
        }
        if (at.order >= 0 && orders[row] == trunk_order) table.flags[row] |= kTrunkFlag;
    }
    if (!has_root)
        throw Error("'" + path + "' holds no cylinder without a parent, where the tree would begin.");
    Tree tree = tree_of(table, {choice.up, 1.0}, path);
    if (at.order < 0) mark_trunk(tree);
    return tree;
}

}  // namespace treerec
