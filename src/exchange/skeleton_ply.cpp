#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "error.h"
#include "exchange/finite.h"
#include "exchange/skeleton_graph.h"
#include "exchange/skeleton_parsers.h"
#include "exchange/skeleton_table.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"
#include "ply_header.h"
#include "tree/trunk.h"

namespace treerec {

namespace {

static_assert(std::endian::native == std::endian::little, "the writer copies little-endian memory");

template <typename T>
void append_bytes(std::string& out, T value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    out.append(bytes, sizeof value);
}

class ValueReader {
  public:
    ValueReader(std::string_view data, const PlyHeader& header, const std::string& path)
        : data_(data), ascii_(header.encoding == PlyEncoding::kAscii), swap_(header.swaps()), path_(path) {}

    double next(PlyType type) {
        if (ascii_) return next_word();
        const size_t size = size_of(type);
        if (data_.size() - at_ < size) throw truncated();
        const double value = load_ply_value(data_.data() + at_, type, swap_);
        at_ += size;
        return value;
    }

  private:
    double next_word() {
        at_ = data_.find_first_not_of(" \t\r\n", at_);
        if (at_ == std::string_view::npos) {
            at_ = data_.size();
            throw truncated();
        }
        const size_t end = std::min(data_.find_first_of(" \t\r\n", at_), data_.size());
        const std::optional<double> value = parse_number(data_.substr(at_, end - at_));
        if (!value)
            throw Error("'" + path_ + "' is damaged: " + quote_word(data_.substr(at_, end - at_)) +
                        " is no number.");
        at_ = end;
        return *value;
    }
    Error truncated() const {
        return Error("'" + path_ + "' is cut off: it ends before its last node or edge.");
    }

    std::string_view data_;
    bool ascii_;
    bool swap_;
    const std::string& path_;
    size_t at_ = 0;
};

// Calls row(values, pair) for each item of the element; values: one per property, of lists the length; pair:
// the two values of the last list that has two.
template <typename Row>
void read_element(ValueReader& reader, const PlyElement& element, Row row) {
    if (element.properties.empty()) return;
    std::vector<double> values(element.properties.size());
    std::pair<double, double> pair{-1.0, -1.0};
    for (size_t i = 0; i < element.count; i++) {
        for (size_t p = 0; p < values.size(); p++) {
            const PlyProperty& property = element.properties[p];
            if (property.is_list) {
                const double length = reader.next(property.length_type);
                values[p] = length;
                for (double k = 0; k < length; k++) {
                    const double value = reader.next(property.type);
                    if (length == 2.0) (k == 0.0 ? pair.first : pair.second) = value;
                }
            } else {
                values[p] = reader.next(property.type);
            }
        }
        row(values, pair);
    }
}

}  // namespace

void write_skeleton_ply(const std::string& path, const Tree& tree) {
    require_readable(tree, path);
    const SkeletonTable table = table_of(tree);
    const size_t count = table.positions.size();
    const size_t edges = count > 0 ? count - 1 : 0;
    std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment skeleton; " +
                        stamp_text(tree.frame()) + "\nelement vertex " + std::to_string(count) +
                        "\nproperty double x\nproperty double y\nproperty double z\nproperty double radius\n"
                        "property uchar flags\nelement edge " +
                        std::to_string(edges) + "\nproperty int vertex1\nproperty int vertex2\nend_header\n";
    bytes.reserve(bytes.size() + 41 * count);
    for (size_t i = 0; i < count; i++) {
        for (int axis = 0; axis < 3; axis++)
            append_bytes(bytes, table.positions[i][axis]);
        append_bytes(bytes, table.radii[i]);
        append_bytes(bytes, table.flags[i]);
    }
    for (size_t i = 0; i < count; i++) {
        if (table.parents[i] == kNoNode) continue;
        append_bytes(bytes, static_cast<int32_t>(table.parents[i]));
        append_bytes(bytes, static_cast<int32_t>(i));
    }
    write_file(path, bytes);
}

Tree read_skeleton_ply(const std::string& path, const SkeletonChoice& choice, SkeletonReport* report) {
    return parse_skeleton_ply(read_file(path).view(), path, choice, report);
}

Tree parse_skeleton_ply(std::string_view bytes, const std::string& path, const SkeletonChoice& choice,
                        SkeletonReport* report) {
    if (!is_ply(bytes)) throw Error("'" + path + "' is no skeleton PLY: it does not start with 'ply'.");
    const PlyHeader header = read_ply_header(bytes, path);
    FileStamp stamp{choice.up, 1.0};
    bool is_ours = false;
    for (const std::string& comment : header.comments)
        is_ours = read_stamp(comment, stamp, path) || is_ours;
    SkeletonTable table;
    std::vector<std::pair<NodeId, NodeId>> edges;
    bool has_vertices = false, has_edges = false, has_flags = false;
    bool is_directed = true;
    ValueReader reader(bytes.substr(header.end), header, path);
    for (const PlyElement& element : header.elements) {
        if (element.name == "vertex") {
            const int x = element.find("x"), y = element.find("y"), z = element.find("z");
            const int radius = element.find("radius"), flags = element.find("flags");
            if (x < 0 || y < 0 || z < 0 || radius < 0)
                throw Error("'" + path + "' is no skeleton PLY: its vertices lack x, y, z or radius.");
            has_vertices = true;
            has_flags = flags >= 0;
            read_element(reader, element, [&](const std::vector<double>& values, const auto&) {
                table.positions.emplace_back(values[x], values[y], values[z]);
                table.radii.push_back(values[radius]);
                const double bits = flags >= 0 ? values[flags] : 0.0;
                table.flags.push_back(bits >= 0.0 && bits <= 255.0 ? static_cast<uint8_t>(bits) : uint8_t{0});
            });
            table.parents.assign(table.positions.size(), kNoNode);
        } else if (element.name == "edge" && has_vertices) {
            const int from = element.find("vertex1"), to = element.find("vertex2");
            int list = -1;
            for (size_t p = 0; p < element.properties.size(); p++)
                if (element.properties[p].is_list) list = static_cast<int>(p);
            if ((from < 0 || to < 0) && list < 0)
                throw Error(
                    "'" + path +
                    "' is no skeleton PLY: its edges lack vertex1 and vertex2, or a list of the two.");
            const bool named = from >= 0 && to >= 0;
            has_edges = true;
            is_directed = named;
            const double limit = static_cast<double>(table.positions.size());
            read_element(reader, element, [&](const std::vector<double>& values, const auto& pair) {
                if (!named && values[list] != 2.0)
                    throw Error("'" + path + "' is damaged: an edge does not join two vertices.");
                const double a = named ? values[from] : pair.first, b = named ? values[to] : pair.second;
                if (!(a >= 0.0 && a < limit && b >= 0.0 && b < limit))
                    throw Error("'" + path + "' is damaged: an edge names a vertex that is not there.");
                edges.emplace_back(static_cast<NodeId>(a), static_cast<NodeId>(b));
            });
        } else {
            read_element(reader, element, [](const std::vector<double>&, const auto&) {});
        }
    }
    if (table.positions.empty()) throw Error("'" + path + "' holds no skeleton: it has no vertices.");
    if (!has_edges && table.positions.size() > 1)
        throw Error("'" + path + "' is a point cloud, not a skeleton: it has no edges.");
    // Each vertex below one other and one below none: the edges lead from parents to children. Those of other
    // programs need not.
    std::vector<uint8_t> parents(table.positions.size(), 0);
    for (const auto& [from, to] : edges) {
        if (parents[to] && is_ours) throw Error("'" + path + "' holds no tree: a vertex has two parents.");
        is_directed = is_directed && !parents[to];
        parents[to] = 1;
        table.parents[to] = from;
    }
    is_directed = is_directed && edges.size() + 1 == table.positions.size();
    if (is_ours || is_directed) {
        choose_tree({1}, choice, path, report);
        Tree tree = tree_of(table, stamp, path);
        if (!has_flags) mark_trunk(tree);
        return tree;
    }
    Tree tree = tree_of(tree_of_graph(table, edges, {stamp.up, choice.tree}, path, report), stamp, path);
    if (!has_flags) mark_trunk(tree);
    return tree;
}

}  // namespace treerec
