// Multiscale tree graphs: C. Godin, Y. Caraglio, "A multiscale model of plant topological structures",
// Journal of Theoretical Biology 191, 1998; the text form is that of AMAPmod's manual, section "coding".
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "error.h"
#include "exchange/finite.h"
#include "exchange/skeleton_graph.h"
#include "exchange/skeleton_parsers.h"
#include "exchange/text_scan.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"
#include "tree/branches.h"
#include "tree/trunk.h"

namespace treerec {

namespace {

// Words between tabs, none of them dropped.
std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    for (size_t at = 0; at <= line.size();) {
        const size_t end = std::min(line.find('\t', at), line.size());
        std::string_view cell = line.substr(at, end - at);
        const size_t first = cell.find_first_not_of(" \r");
        cell = first == std::string_view::npos ? std::string_view()
                                               : cell.substr(first, cell.find_last_not_of(" \r") - first + 1);
        cells.push_back(cell);
        at = end + 1;
    }
    return cells;
}

// Where a line has its code and its features; -1 for those that are not there.
struct MtgColumns {
    size_t codes = 0;  // cells that may hold the code
    int x = -1, y = -1, z = -1, radius = -1;
    double radius_factor = 1.0;
};

MtgColumns columns_of(const std::vector<std::string_view>& head, const std::string& path) {
    MtgColumns columns;
    std::vector<std::string> names;
    for (const std::string_view cell : head) {
        const std::vector<std::string> fields = split_fields(cell);
        names.push_back(fields.empty() ? std::string() : fields[0]);
    }
    // The code may take as many cells as stand before the first feature.
    for (size_t i = 1; i < names.size() && columns.codes == 0; i++)
        if (!names[i].empty()) columns.codes = i;
    if (columns.codes == 0) columns.codes = names.size();
    columns.x = find_field(names, {"xx", "x"});
    columns.y = find_field(names, {"yy", "y"});
    columns.z = find_field(names, {"zz", "z"});
    columns.radius = find_field(names, {"radius", "rayon"});
    if (columns.radius < 0) {
        columns.radius = find_field(names, {"diameter", "topdia", "topdiameter", "diam"});
        columns.radius_factor = 0.5;
    }
    if (columns.x < 0 || columns.y < 0 || columns.z < 0 || columns.radius < 0)
        throw Error(
            "'" + path +
            "' is an MTG without the features that say where its nodes are and how thick: XX, YY, ZZ and "
            "radius (or diameter). Save it with these, as plantscan3d does.");
    return columns;
}

}  // namespace

void write_mtg(const std::string& path, const Tree& tree) {
    require_readable(tree, path);
    const BranchList list = list_branches(tree);
    size_t columns = 1;
    for (const Branch& branch : list.branches)
        columns = std::max(columns, static_cast<size_t>(branch.order) + 1);
    std::string text =
        "CODE:\tFORM-A\n\n"
        "CLASSES:\nSYMBOL\tSCALE\tDECOMPOSITION\tINDEXATION\tDEFINITION\n"
        "$\t0\tFREE\tFREE\tIMPLICIT\nP\t1\tFREE\tFREE\tEXPLICIT\nN\t2\tFREE\tFREE\tEXPLICIT\n\n"
        "DESCRIPTION:\nLEFT\tRIGHT\tRELTYPE\tMAX\nN\tN\t+\t?\nN\tN\t<\t?\n\n"
        "FEATURES:\nNAME\tTYPE\nXX\tREAL\nYY\tREAL\nZZ\tREAL\nradius\tREAL\n\n"
        "MTG:\nENTITY-CODE" +
        std::string(columns, '\t') + "XX\tYY\tZZ\tradius\n/P1\n";
    text.reserve(text.size() + 100 * tree.size());
    const ScanFrame& frame = tree.frame();
    int64_t count = 0;
    // What grows aside is told before its branch goes on.
    std::vector<NodeId> left{tree.root()};
    while (!left.empty()) {
        const NodeId id = left.back();
        left.pop_back();
        const Node& node = tree.node(id);
        const int32_t branch = list.branch_of[id];
        const auto column = static_cast<size_t>(list.branches[branch].order);
        text.append(column, '\t');
        const bool goes_on = node.parent != kNoNode && list.branch_of[node.parent] == branch;
        text += node.parent == kNoNode ? "^/N" : goes_on ? "^<N" : "+N";
        append_number(text, ++count);
        text.append(columns - column, '\t');
        const DVec3 place = frame.to_scan(node.position);
        for (const double value : {place.x, place.y, place.z, frame.length_to_scan(node.radius)}) {
            append_number(text, value);
            text += '\t';
        }
        text.back() = '\n';
        for (const NodeId child : tree.children(id))
            if (list.branch_of[child] == branch) left.push_back(child);
        const size_t first = left.size();
        for (const NodeId child : tree.children(id))
            if (list.branch_of[child] != branch) left.push_back(child);
        std::reverse(left.begin() + static_cast<std::ptrdiff_t>(first), left.end());
    }
    write_file(path, text);
}

bool looks_like_mtg(std::string_view bytes) {
    while (const std::optional<std::string_view> line = next_line(bytes)) {
        const size_t first = line->find_first_not_of(" \t");
        if (first == std::string_view::npos || (*line)[first] == '#') continue;
        std::string_view word = line->substr(first);
        if (!word.starts_with("CODE")) return false;
        word = word.substr(4);
        word = word.substr(std::min(word.find_first_not_of(" \t"), word.size()));
        return word.starts_with(':') && word.find("FORM-") != std::string_view::npos;
    }
    return false;
}

Tree read_mtg(const std::string& path, const SkeletonChoice& choice, SkeletonReport* report) {
    return parse_mtg(read_file(path).view(), path, choice, report);
}

Tree parse_mtg(std::string_view bytes, const std::string& path, const SkeletonChoice& choice,
               SkeletonReport* report) {
    MtgColumns columns;
    bool begun = false;  // behind the line of ENTITY-CODE
    SkeletonTable table;
    // By column of codes: the node of the last line there, or what that line grows on where it is no node
    // itself.
    std::vector<NodeId> last;
    size_t line_number = 0;
    while (const std::optional<std::string_view> line = next_line(bytes)) {
        line_number++;
        const auto where = [&] { return "'" + path + "', line " + std::to_string(line_number) + ": "; };
        const std::vector<std::string_view> cells = cells_of(*line);
        if (!begun) {
            begun = cells[0].starts_with("ENTITY-CODE");
            if (begun) columns = columns_of(cells, path);
            continue;
        }
        size_t column = 0;
        while (column < cells.size() && cells[column].empty())
            column++;
        if (column == cells.size() || cells[column].starts_with('#')) continue;
        if (column >= columns.codes) throw Error(where() + "there is no code before its features.");
        const std::string_view code = cells[column];
        // ^: on from the last line of this column; else on from the column before.
        const bool onward = code.starts_with('^');
        if (onward ? column >= last.size() : column > last.size())
            throw Error(where() + quote_word(code) + " has nothing to grow on.");
        const NodeId parent = onward ? last[column] : column == 0 ? kNoNode : last[column - 1];
        last.resize(column);
        const auto cell = [&](int at) {
            return static_cast<size_t>(at) < cells.size() ? cells[static_cast<size_t>(at)]
                                                          : std::string_view();
        };
        if (cell(columns.x).empty() && cell(columns.y).empty() && cell(columns.z).empty()) {
            last.push_back(parent);
            continue;
        }
        const auto number_at = [&](int at) {
            const std::optional<double> value = parse_number(cell(at));
            if (!value) throw Error(where() + quote_word(cell(at)) + " is no number.");
            return *value;
        };
        last.push_back(static_cast<NodeId>(table.positions.size()));
        table.positions.emplace_back(number_at(columns.x), number_at(columns.y), number_at(columns.z));
        table.radii.push_back(
            cell(columns.radius).empty() ? 0.0 : columns.radius_factor * number_at(columns.radius));
        table.parents.push_back(parent);
        table.flags.push_back(0);
    }
    if (!begun) throw Error("'" + path + "' is an MTG that is cut off: it has no line ENTITY-CODE.");
    if (table.positions.empty()) throw Error("'" + path + "' is an MTG without a node that has a place.");
    Tree tree = tree_of(chosen_tree(table, choice, path, report), {choice.up, 1.0}, path);
    mark_trunk(tree);
    return tree;
}

}  // namespace treerec
