#include <algorithm>
#include <bit>
#include <cstring>

#include "error.h"
#include "exchange/skeleton_table.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"

namespace treerec {

namespace {

static_assert(std::endian::native == std::endian::little, "the writer copies little-endian memory");

template <typename T>
void append_bytes(std::string& out, T value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    out.append(bytes, sizeof value);
}

enum class Encoding { kAscii, kLittle, kBig };

struct ScalarType {
    size_t size = 0;
    bool is_float = false;
    bool is_signed = false;
};

std::optional<ScalarType> scalar_type(std::string_view name) {
    if (name == "char" || name == "int8") return ScalarType{1, false, true};
    if (name == "uchar" || name == "uint8") return ScalarType{1, false, false};
    if (name == "short" || name == "int16") return ScalarType{2, false, true};
    if (name == "ushort" || name == "uint16") return ScalarType{2, false, false};
    if (name == "int" || name == "int32") return ScalarType{4, false, true};
    if (name == "uint" || name == "uint32") return ScalarType{4, false, false};
    if (name == "float" || name == "float32") return ScalarType{4, true, true};
    if (name == "double" || name == "float64") return ScalarType{8, true, true};
    return std::nullopt;
}

struct Property {
    std::string name;
    ScalarType type;
    std::optional<ScalarType> list_count;  // set: a list, its length being of this type
};

struct Element {
    std::string name;
    size_t count = 0;
    std::vector<Property> properties;

    int find(std::string_view name_wanted) const {
        for (size_t i = 0; i < properties.size(); i++)
            if (properties[i].name == name_wanted && !properties[i].list_count) return static_cast<int>(i);
        return -1;
    }
};

struct Header {
    Encoding encoding = Encoding::kAscii;
    std::vector<Element> elements;
    FileStamp stamp;
};

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (size_t at = line.find_first_not_of(" \t"); at != std::string_view::npos;) {
        const size_t end = std::min(line.find_first_of(" \t", at), line.size());
        words.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(" \t", end);
    }
    return words;
}

// Reads the header and leaves `rest` at the first byte of the data.
Header read_header(std::string_view& rest, UpAxis up, const std::string& path) {
    const auto damaged = [&](const std::string& what) {
        return Error("'" + path + "' is no skeleton PLY: " + what);
    };
    Header header;
    header.stamp.up = up;
    if (!rest.starts_with("ply")) throw damaged("it does not start with 'ply'.");
    bool has_format = false;
    while (const std::optional<std::string_view> line = next_line(rest)) {
        const std::vector<std::string_view> words = words_of(*line);
        if (words.empty() || words[0] == "ply" || words[0] == "obj_info") continue;
        if (words[0] == "comment") {
            read_stamp(*line, header.stamp, path);
        } else if (words[0] == "format" && words.size() >= 2) {
            has_format = true;
            if (words[1] == "ascii")
                header.encoding = Encoding::kAscii;
            else if (words[1] == "binary_little_endian")
                header.encoding = Encoding::kLittle;
            else if (words[1] == "binary_big_endian")
                header.encoding = Encoding::kBig;
            else
                throw damaged("its format is unknown.");
        } else if (words[0] == "element" && words.size() >= 3) {
            const std::optional<double> count = parse_number(words[2]);
            if (!count || *count < 0.0 || *count > 16777216.0)
                throw damaged("an element's count is no number from 0 to 16 million.");
            header.elements.push_back({std::string(words[1]), static_cast<size_t>(*count), {}});
        } else if (words[0] == "property" && words.size() >= 3 && !header.elements.empty()) {
            const bool list = words[1] == "list" && words.size() >= 5;
            const std::optional<ScalarType> type = scalar_type(list ? words[3] : words[1]);
            const std::optional<ScalarType> count = list ? scalar_type(words[2]) : std::nullopt;
            if (!type || (list && !count)) throw damaged("a property's type is unknown.");
            header.elements.back().properties.push_back({std::string(words[list ? 4 : 2]), *type, count});
        } else if (words[0] == "end_header") {
            if (!has_format) throw damaged("its header names no format.");
            return header;
        } else {
            throw damaged("its header has a line that means nothing.");
        }
    }
    throw damaged("its header has no end.");
}

class ValueReader {
  public:
    ValueReader(std::string_view data, Encoding encoding, const std::string& path)
        : data_(data), encoding_(encoding), path_(path) {}

    double next(const ScalarType& type) {
        if (encoding_ == Encoding::kAscii) return next_word();
        if (data_.size() - at_ < type.size) throw truncated();
        uint64_t bits = 0;
        for (size_t i = 0; i < type.size; i++) {
            const size_t from = encoding_ == Encoding::kLittle ? type.size - 1 - i : i;
            bits = bits << 8 | static_cast<unsigned char>(data_[at_ + from]);
        }
        at_ += type.size;
        if (type.is_float)
            return type.size == 8 ? std::bit_cast<double>(bits)
                                  : static_cast<double>(std::bit_cast<float>(static_cast<uint32_t>(bits)));
        if (type.is_signed) {
            const int shift = 64 - 8 * static_cast<int>(type.size);
            return static_cast<double>(static_cast<int64_t>(bits << shift) >> shift);
        }
        return static_cast<double>(bits);
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
            throw Error("'" + path_ + "' is damaged: '" +
                        std::string(data_.substr(at_, std::min<size_t>(end - at_, 40))) + "' is no number.");
        at_ = end;
        return *value;
    }
    Error truncated() const {
        return Error("'" + path_ + "' is cut off: it ends before its last node or edge.");
    }

    std::string_view data_;
    Encoding encoding_;
    const std::string& path_;
    size_t at_ = 0;
};

// Calls row(values) for each item of the element; values: one per property, 0 for lists.
template <typename Row>
void read_element(ValueReader& reader, const Element& element, Row row) {
    if (element.properties.empty()) return;
    std::vector<double> values(element.properties.size());
    for (size_t i = 0; i < element.count; i++) {
        for (size_t p = 0; p < values.size(); p++) {
            const Property& property = element.properties[p];
            if (property.list_count) {
                const double length = reader.next(*property.list_count);
                for (double k = 0; k < length; k++)
                    reader.next(property.type);
            } else {
                values[p] = reader.next(property.type);
            }
        }
        row(values);
    }
}

}  // namespace

void write_skeleton_ply(const std::string& path, const Tree& tree) {
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

Tree read_skeleton_ply(const std::string& path, UpAxis up) {
    const FileBytes bytes = read_file(path);
    std::string_view rest = bytes.view();
    const Header header = read_header(rest, up, path);
    SkeletonTable table;
    bool has_vertices = false;
    bool has_edges = false;
    ValueReader reader(rest, header.encoding, path);
    for (const Element& element : header.elements) {
        if (element.name == "vertex") {
            const int x = element.find("x"), y = element.find("y"), z = element.find("z");
            const int radius = element.find("radius"), flags = element.find("flags");
            if (x < 0 || y < 0 || z < 0 || radius < 0)
                throw Error("'" + path + "' is no skeleton PLY: its vertices lack x, y, z or radius.");
            has_vertices = true;
            read_element(reader, element, [&](const std::vector<double>& values) {
                table.positions.emplace_back(values[x], values[y], values[z]);
                table.radii.push_back(values[radius]);
                const double bits = flags >= 0 ? values[flags] : 0.0;
                table.flags.push_back(bits >= 0.0 && bits <= 255.0 ? static_cast<uint8_t>(bits) : uint8_t{0});
            });
            table.parents.assign(table.positions.size(), kNoNode);
        } else if (element.name == "edge" && has_vertices) {
            const int from = element.find("vertex1"), to = element.find("vertex2");
            if (from < 0 || to < 0)
                throw Error("'" + path + "' is no skeleton PLY: its edges lack vertex1 or vertex2.");
            has_edges = true;
            const double limit = static_cast<double>(table.positions.size());
            read_element(reader, element, [&](const std::vector<double>& values) {
                if (!(values[from] >= 0.0 && values[from] < limit && values[to] >= 0.0 && values[to] < limit))
                    throw Error("'" + path + "' is damaged: an edge names a vertex that is not there.");
                NodeId& parent = table.parents[static_cast<size_t>(values[to])];
                if (parent != kNoNode) throw Error("'" + path + "' holds no tree: a vertex has two parents.");
                parent = static_cast<NodeId>(values[from]);
            });
        } else {
            read_element(reader, element, [](const std::vector<double>&) {});
        }
    }
    if (table.positions.empty()) throw Error("'" + path + "' holds no skeleton: it has no vertices.");
    if (!has_edges && table.positions.size() > 1)
        throw Error("'" + path + "' is a point cloud, not a skeleton: it has no edges.");
    return tree_of(table, header.stamp, path);
}

}  // namespace treerec
