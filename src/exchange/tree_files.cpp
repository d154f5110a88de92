#include "exchange/tree_files.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <unordered_map>

#include "error.h"
#include "exchange/finite.h"
#include "exchange/foliage_lines.h"
#include "exchange/lstring_file.h"
#include "exchange/qsm_columns.h"
#include "exchange/section_lines.h"
#include "exchange/skeleton_graph.h"
#include "exchange/skeleton_parsers.h"
#include "exchange/skeleton_table.h"
#include "file_bytes.h"
#include "lsystem/grammar.h"
#include "tree/trunk.h"

namespace treerec {

namespace {

// Where the values of one node lie in its tuple; -1 where they are missing.
struct Columns {
    int x = -1, y = -1, z = -1, radius = -1, parent = -1, flags = -1, id = -1, count = 0;

    explicit Columns(const std::vector<std::string>& fields)
        : x(find_field(fields, {"x"})),
          y(find_field(fields, {"y"})),
          z(find_field(fields, {"z"})),
          radius(find_field(fields, {"radius"})),
          parent(find_field(fields, {"parent_id", "parent"})),
          flags(find_field(fields, {"flags"})),
          id(find_field(fields, {"id", "node", "node_id", "index"})),
          count(static_cast<int>(fields.size())) {}
    bool has_node() const { return x >= 0 && y >= 0 && z >= 0 && radius >= 0; }
};

struct TreefileHeader {
    size_t tree_fields = 0;  // values before the root's
    Columns root;
    Columns branch;
};

// The line of field names, or nothing if it is none.
std::optional<TreefileHeader> parse_treefile_header(std::string_view line) {
    const std::vector<std::string> fields = split_fields(line);
    const auto first = std::find(fields.begin(), fields.end(), "x");
    if (first == fields.end()) return std::nullopt;
    const auto second = std::find(first + 1, fields.end(), "x");
    TreefileHeader header{
        static_cast<size_t>(first - fields.begin()), Columns(std::vector<std::string>(first, second)),
        Columns(std::vector<std::string>(second == fields.end() ? first : second, fields.end()))};
    if (!header.root.has_node() || !header.branch.has_node()) return std::nullopt;
    return header;
}

uint8_t flags_from(double value) {
    return value >= 0.0 && value <= 255.0 ? static_cast<uint8_t>(value) : uint8_t{0};
}

NodeId parent_from(double value) {
    return value >= -1.0 && value < 16777216.0 ? static_cast<NodeId>(value) : NodeId{-2};
}

void append_node(const double* values, const Columns& columns, bool is_root, SkeletonTable& table) {
    table.positions.emplace_back(values[columns.x], values[columns.y], values[columns.z]);
    table.radii.push_back(values[columns.radius]);
    table.parents.push_back(columns.parent >= 0 ? parent_from(values[columns.parent])
                            : is_root           ? kNoNode
                                                : NodeId{-2});
    table.flags.push_back(columns.flags >= 0 ? flags_from(values[columns.flags]) : uint8_t{0});
}

SkeletonTable parse_treefile_line(std::string_view line, size_t line_number, const TreefileHeader& header,
                                  const std::string& path) {
    const std::string where = "'" + path + "', line " + std::to_string(line_number) + ": ";
    std::vector<double> values;
    values.reserve(static_cast<size_t>(std::count(line.begin(), line.end(), ',')) + 1);
    for (size_t at = 0; at < line.size();) {
        const size_t end = std::min(line.find(',', at), line.size());
        const std::string_view word = line.substr(at, end - at);
        at = end + 1;
        if (word.find_first_not_of(" \t") == std::string_view::npos) continue;
        const std::optional<double> value = parse_number(word);
        if (!value) throw Error(where + quote_word(word) + " is no number.");
        values.push_back(*value);
    }
    const size_t root_end = header.tree_fields + static_cast<size_t>(header.root.count);
    if (values.size() < root_end || (values.size() - root_end) % static_cast<size_t>(header.branch.count))
        throw Error(where + "its " + std::to_string(values.size()) +
                    " values do not fill whole nodes; is the file cut off?");
    SkeletonTable table;
    append_node(values.data() + header.tree_fields, header.root, true, table);
    for (size_t at = root_end; at < values.size(); at += static_cast<size_t>(header.branch.count))
        append_node(values.data() + at, header.branch, false, table);
    return table;
}

}  // namespace

void write_treefile(const std::string& path, const Tree& tree, const Foliage& foliage) {
    require_readable(tree, path);
    const SkeletonTable table = table_of(tree);
    std::string text =
        "# Tree file, one line per tree, one tuple per node; " + stamp_text(tree.frame()) + "\n";
    append_section_lines(text, tree);
    append_foliage_lines(text, foliage, tree.node(tree.root()).position);
    text += "x,y,z,radius,parent_id,flags\n";
    text.reserve(text.size() + 90 * table.positions.size());
    for (size_t i = 0; i < table.positions.size(); i++) {
        if (i > 0) text += ", ";
        for (int axis = 0; axis < 3; axis++) {
            append_number(text, table.positions[i][axis]);
            text += ',';
        }
        append_number(text, table.radii[i]);
        text += ',';
        append_number(text, int64_t{table.parents[i]});
        text += ',';
        append_number(text, int64_t{table.flags[i]});
    }
    text += '\n';
    write_file(path, text);
}

Tree read_treefile(const std::string& path, const SkeletonChoice& choice, SkeletonReport* report) {
    return parse_treefile(read_file(path).view(), path, choice, report);
}

Tree parse_treefile(std::string_view bytes, const std::string& path, const SkeletonChoice& choice,
                    SkeletonReport* report) {
    std::string_view rest = bytes;
    FileStamp stamp{choice.up, 1.0};
    std::optional<TreefileHeader> header;
    SkeletonTable wanted;
    std::vector<FileSection> sections;
    FoliageLines foliage;
    std::vector<size_t> sizes;  // of the trees, in nodes
    size_t line_number = 0;
    while (const std::optional<std::string_view> line = next_line(rest)) {
        line_number++;
        if (line->find_first_not_of(" \t") == std::string_view::npos) continue;
        if (line->front() == '#') {
            if (!read_section_line(*line, sections, path) && !foliage.read(*line, path))
                read_stamp(*line, stamp, path);
            continue;
        }
        if (!header) {
            header = parse_treefile_header(*line);
            if (!header)
                throw Error("'" + path + "' is no tree file: line " + std::to_string(line_number) +
                            " does not name the fields x,y,z,radius,parent_id.");
            continue;
        }
        SkeletonTable table = parse_treefile_line(*line, line_number, *header, path);
        sizes.push_back(table.positions.size());
        if (choice.tree == 0 ? sizes.back() > wanted.positions.size() : sizes.size() == choice.tree)
            wanted = std::move(table);
    }
    if (!header) throw Error("'" + path + "' is no tree file: it names no fields x,y,z,radius,parent_id.");
    if (sizes.empty()) throw Error("'" + path + "' holds no tree.");
    choose_tree(sizes, choice, path, report);
    Tree tree = tree_of(wanted, stamp, path);
    if (header->branch.flags < 0) mark_trunk(tree);
    if (sizes.size() == 1) {
        put_sections(sections, tree, path);
        Foliage seen = foliage.take(path);
        if (report) report->foliage = std::move(seen);
    }
    return tree;
}

Tree read_node_csv(const std::string& path, const SkeletonChoice& choice, SkeletonReport* report) {
    return parse_node_csv(read_file(path).view(), path, choice, report);
}

Tree parse_node_csv(std::string_view bytes, const std::string& path, const SkeletonChoice& choice,
                    SkeletonReport* report) {
    std::string_view rest = bytes;
    const std::optional<std::string_view> head = next_line(rest);
    const Columns columns(head ? split_fields(*head) : std::vector<std::string>());
    if (!columns.has_node() || columns.parent < 0)
        throw Error("'" + path +
                    "' is no table of nodes: its first line does not name x, y, z, radius and parent.");
    SkeletonTable table;
    std::vector<double> parent_ids;
    std::unordered_map<double, NodeId> row_of;  // looked up only, never walked
    std::vector<double> values;
    size_t line_number = 1;
    while (const std::optional<std::string_view> line = next_line(rest)) {
        line_number++;
        if (line->find_first_not_of(" \t") == std::string_view::npos) continue;
        values.clear();
        for (const std::string& field : split_fields(*line)) {
            const std::optional<double> value = parse_number(field);
            if (!value)
                throw Error("'" + path + "', line " + std::to_string(line_number) + ": " + quote_word(field) +
                            " is no number.");
            values.push_back(*value);
        }
        if (values.size() != static_cast<size_t>(columns.count))
            throw Error("'" + path + "', line " + std::to_string(line_number) + ": " +
                        std::to_string(values.size()) + " values where the first line names " +
                        std::to_string(columns.count) + ".");
        const NodeId row = static_cast<NodeId>(table.positions.size());
        const double id = columns.id >= 0 ? values[columns.id] : row;
        if (!std::isfinite(id))
            throw Error("'" + path + "', line " + std::to_string(line_number) + ": its id is no number.");
        append_node(values.data(), columns, false, table);
        parent_ids.push_back(values[columns.parent]);
        if (!row_of.emplace(id, row).second)
            throw Error("'" + path + "', line " + std::to_string(line_number) +
                        ": this id was there before.");
    }
    if (table.positions.empty()) throw Error("'" + path + "' holds no nodes.");
    for (size_t i = 0; i < parent_ids.size(); i++) {
        const auto parent = row_of.find(parent_ids[i]);
        table.parents[i] = parent == row_of.end() ? kNoNode : parent->second;
    }
    Tree tree = tree_of(chosen_tree(table, choice, path, report), {choice.up, 1.0}, path);
    if (columns.flags < 0) mark_trunk(tree);
    return tree;
}

namespace {

constexpr size_t kSniffed = 4096;

enum class SkeletonFormat { kNone, kTreefile, kPly, kNodeCsv, kQsmCsv, kSwc, kMtg, kLString };

std::string next_bytes(std::istream& in) {
    std::string bytes(kSniffed, '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<size_t>(in.gcount()));
    return bytes;
}

std::ifstream open_to_sniff(const std::string& path) {
    std::error_code failure;
    if (!std::filesystem::exists(path_of(path), failure)) throw Error("There is no file '" + path + "'.");
    return std::ifstream(path_of(path), std::ios::binary);
}

// The file's first 4 kB.
std::string first_bytes(const std::string& path) {
    std::ifstream in = open_to_sniff(path);
    return next_bytes(in);
}

// 4 kB from the first line on that is no comment: a tree file has its wood's outlines before its nodes.
std::string bytes_after_comments(const std::string& path) {
    std::ifstream in = open_to_sniff(path);
    while (in.peek() == '#')
        in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    return next_bytes(in);
}

SkeletonFormat sniff(const std::string& path) {
    const std::string bytes = first_bytes(path);
    if (is_lstring_file(bytes) || extension_of(path) == "lstring") return SkeletonFormat::kLString;
    if (looks_like_mtg(bytes)) return SkeletonFormat::kMtg;
    if (looks_like_qsm_sections(bytes)) return SkeletonFormat::kQsmCsv;
    std::string_view rest = bytes;
    if (rest.starts_with("ply")) {
        bool edges = false;
        bool radius = false;
        while (const std::optional<std::string_view> line = next_line(rest)) {
            edges = edges || line->starts_with("element edge");
            radius =
                radius || (line->starts_with("property") && line->find(" radius") != std::string_view::npos);
        }
        return edges && radius ? SkeletonFormat::kPly : SkeletonFormat::kNone;
    }
    const std::string table = bytes_after_comments(path);
    rest = table;
    while (const std::optional<std::string_view> line = next_line(rest)) {
        if (line->empty() || line->front() == '#') continue;
        if (find_qsm_columns(*line)) return SkeletonFormat::kQsmCsv;
        const std::vector<std::string> fields = split_fields(*line);
        const Columns columns(fields);
        if (!columns.has_node() || columns.parent < 0) break;
        // A node table names its parent column plainly or has ids; a tree file has neither.
        return columns.id >= 0 || find_field(fields, {"parent"}) >= 0 ? SkeletonFormat::kNodeCsv
                                                                      : SkeletonFormat::kTreefile;
    }
    return looks_like_swc(bytes, bytes.size() < kSniffed) ? SkeletonFormat::kSwc : SkeletonFormat::kNone;
}

// What it is that is no skeleton, where that can be told; else what would be one.
std::string other_kind(const std::string& path) {
    const std::string bytes = first_bytes(path);
    std::string_view rest = bytes;
    const std::string_view first = next_line(rest).value_or("");
    if (first.starts_with("MATLAB"))
        return "is a MATLAB file; have TreeQSM write its cylinders as text (save_model_text).";
    if (first.find("parent\tdiameter") != std::string_view::npos)
        return "is TreeQSM's table of branches; the skeleton is in the one of cylinders (cylinder_...txt).";
    if (first.starts_with("ply"))
        return bytes.find("element edge") != std::string::npos
                   ? "has edges but no radii, so that it is no skeleton that can be read."
                   : "is a PLY file without edges: a point cloud or a mesh, but no skeleton.";
    return "is no skeleton that can be read: a tree file (.txt), a skeleton PLY, a table of nodes or of "
           "cylinders (.csv), SWC, MTG, an L-string.";
}

Tree read_string_of(const std::string& path, std::optional<LStringDialect> dialect) {
    const FileBytes file = read_file(path);
    if (!has_heading(file.view()) && is_grammar(file.view()))
        throw Error("'" + path + "' is a grammar; 'treerec grow' makes a tree of it.");
    LStringOptions options;
    options.dialect_is_told = dialect.has_value();
    options.dialect = dialect.value_or(options.dialect);
    Tree tree = parse_lstring_file(file.view(), path, options).tree;
    require_wood(tree, "The L-string '" + path + "'");
    return tree;
}

}  // namespace

bool is_skeleton_file(const std::string& path) {
    return sniff(path) != SkeletonFormat::kNone;
}

Tree read_skeleton(const std::string& path, const SkeletonChoice& choice, SkeletonReport* report) {
    switch (sniff(path)) {
        case SkeletonFormat::kTreefile:
            return read_treefile(path, choice, report);
        case SkeletonFormat::kPly:
            return read_skeleton_ply(path, choice, report);
        case SkeletonFormat::kNodeCsv:
            return read_node_csv(path, choice, report);
        case SkeletonFormat::kQsmCsv:
            return read_qsm_csv(path, choice, report);
        case SkeletonFormat::kLString:
            choose_tree({1}, choice, path, report);
            return read_string_of(path, choice.dialect);
        case SkeletonFormat::kSwc:
            return read_swc(path, choice, report);
        case SkeletonFormat::kMtg:
            return read_mtg(path, choice, report);
        case SkeletonFormat::kNone:
            break;
    }
    throw Error("'" + path + "' " + other_kind(path));
}

}  // namespace treerec
