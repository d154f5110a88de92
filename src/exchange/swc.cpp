// SWC: R. C. Cannon et al., "An on-line archive of reconstructed hippocampal neurons", 1998, the form in
// which skeletons of neurons are exchanged, and since then of plants.
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "error.h"
#include "exchange/skeleton_graph.h"
#include "exchange/skeleton_parsers.h"
#include "exchange/skeleton_table.h"
#include "exchange/text_scan.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"
#include "tree/trunk.h"

namespace treerec {

namespace {

constexpr size_t kValues = 7;  // id, type, x, y, z, radius, parent

// False if the line does not hold seven numbers.
bool read_row(std::string_view line, std::array<double, kValues>& row) {
    size_t count = 0;
    for (size_t at = line.find_first_not_of(" \t,"); at != std::string_view::npos; count++) {
        const size_t end = std::min(line.find_first_of(" \t,", at), line.size());
        const std::optional<double> value = parse_number(line.substr(at, end - at));
        if (!value || count == kValues) return false;
        row[count] = *value;
        at = line.find_first_not_of(" \t,", end);
    }
    return count == kValues;
}

bool is_blank_or_comment(std::string_view line) {
    const size_t first = line.find_first_not_of(" \t");
    return first == std::string_view::npos || line[first] == '#';
}

bool is_whole(double value, double least) {
    return value >= least && value < 1e9 && value == std::floor(value);
}

}  // namespace

bool looks_like_swc(std::string_view bytes, bool whole_file) {
    std::array<double, kValues> row{};
    bool root = false;
    size_t rows = 0;
    while (const std::optional<std::string_view> line = next_line(bytes)) {
        // The last one may be cut off.
        if (bytes.empty() && !whole_file && rows > 0) break;
        if (is_blank_or_comment(*line)) continue;
        if (!read_row(*line, row)) return false;
        if (!is_whole(row[0], 0.0) || !is_whole(row[1], 0.0) || !is_whole(row[6], -1.0)) return false;
        root = root || row[6] == -1.0;
        rows++;
    }
    return root;
}

Tree read_swc(const std::string& path, const SkeletonChoice& choice, SkeletonReport* report) {
    return parse_swc(read_file(path).view(), path, choice, report);
}

Tree parse_swc(std::string_view bytes, const std::string& path, const SkeletonChoice& choice,
               SkeletonReport* report) {
    FileStamp stamp{choice.up, 1.0};
    SkeletonTable table;
    std::vector<double> parents;
    std::unordered_map<double, NodeId> row_of;  // looked up only, never walked
    size_t line_number = 0;
    std::array<double, kValues> row{};
    while (const std::optional<std::string_view> line = next_line(bytes)) {
        line_number++;
        const auto where = [&] { return "'" + path + "', line " + std::to_string(line_number) + ": "; };
        if (is_blank_or_comment(*line)) {
            read_stamp(*line, stamp, path);
            continue;
        }
        if (!read_row(*line, row))
            throw Error(where() +
                        "these are not the seven numbers of SWC: id, type, x, y, z, radius, parent.");
        if (!is_whole(row[0], 0.0)) throw Error(where() + "its id is no whole number.");
        if (!row_of.emplace(row[0], static_cast<NodeId>(table.positions.size())).second)
            throw Error(where() + "this id was there before.");
        table.positions.emplace_back(row[2], row[3], row[4]);
        table.radii.push_back(row[5]);
        table.flags.push_back(0);
        parents.push_back(row[6]);
    }
    if (table.positions.empty()) throw Error("'" + path + "' holds no nodes.");
    table.parents.resize(parents.size(), kNoNode);
    for (size_t i = 0; i < parents.size(); i++) {
        if (parents[i] == -1.0) continue;
        const auto parent = row_of.find(parents[i]);
        if (parent == row_of.end())
            throw Error("'" + path + "' is damaged: a node hangs on one that is not there.");
        table.parents[i] = parent->second;
    }
    Tree tree = tree_of(chosen_tree(table, choice, path, report), stamp, path);
    mark_trunk(tree);
    return tree;
}

}  // namespace treerec
