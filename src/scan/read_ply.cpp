// PLY: G. Turk, "The PLY Polygon File Format", 1994, as it is written in the wild.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "scan/readers.h"

namespace treerec {

namespace {

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat, kDouble };
enum class Encoding { kAscii, kLittle, kBig };

constexpr size_t kTypeSize[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
constexpr size_t kBlock =
    16384;  // points decoded at a time, so that the columns of a block stay in the cache
constexpr size_t kLongestHeader = 1 << 20;

struct Property {
    std::string name;
    Type type = Type::kFloat;
    bool is_list = false;
    Type length_type = Type::kUint8;  // of a list
};

struct Element {
    std::string name;
    uint64_t count = 0;
    std::vector<Property> properties;

    bool has_list() const {
        return std::any_of(properties.begin(), properties.end(), [](const Property& p) { return p.is_list; });
    }
    // Of the properties that are not lists.
    size_t packed_size() const {
        size_t size = 0;
        for (const Property& p : properties)
            if (!p.is_list) size += kTypeSize[static_cast<int>(p.type)];
        return size;
    }
};

struct Header {
    Encoding encoding = Encoding::kAscii;
    std::vector<Element> elements;
    size_t end = 0;  // where the data begin
};

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (size_t p = 0;;) {
        const size_t begin = line.find_first_not_of(" \t\r\f\v", p);
        if (begin == line.npos) return words;
        p = std::min(line.find_first_of(" \t\r\f\v", begin), line.size());
        words.push_back(line.substr(begin, p - begin));
    }
}

Type parse_type(const ReadJob& job, std::string_view word) {
    struct Name {
        std::string_view text;
        Type type;
    };
    static constexpr Name kNames[] = {
        {"char", Type::kInt8},     {"int8", Type::kInt8},     {"uchar", Type::kUint8},
        {"uint8", Type::kUint8},   {"short", Type::kInt16},   {"int16", Type::kInt16},
        {"ushort", Type::kUint16}, {"uint16", Type::kUint16}, {"int", Type::kInt32},
        {"int32", Type::kInt32},   {"uint", Type::kUint32},   {"uint32", Type::kUint32},
        {"int64", Type::kInt64},   {"uint64", Type::kUint64}, {"float", Type::kFloat},
        {"float32", Type::kFloat}, {"double", Type::kDouble}, {"float64", Type::kDouble},
    };
    for (const Name& name : kNames)
        if (name.text == word) return name.type;
    job.fail("has a property of the unknown type '" + std::string(word.substr(0, 40)) +
             "' in its PLY header.");
}

uint64_t parse_count(const ReadJob& job, std::string_view word) {
    uint64_t count = 0;
    for (const char c : word) {
        if (c < '0' || c > '9' || count > (uint64_t{1} << 50))
            job.fail("has an element with the impossible count '" + std::string(word.substr(0, 40)) +
                     "' in its PLY header.");
        count = count * 10 + static_cast<uint64_t>(c - '0');
    }
    return count;
}

Header read_header(const ReadJob& job) {
    const std::string_view bytes = job.bytes.view();
    // Old Macintosh files end their lines by a carriage return alone.
    const size_t first_end = bytes.find_first_of("\n\r");
    const bool mac = first_end != bytes.npos && bytes[first_end] == '\r' &&
                     !(first_end + 1 < bytes.size() && bytes[first_end + 1] == '\n');
    Header header;
    bool format_seen = false;
    size_t p = 0;
    for (size_t line = 1;; line++) {
        const size_t end = bytes.substr(0, kLongestHeader).find(mac ? '\r' : '\n', p);
        if (end == bytes.npos) job.fail("is cut off or damaged: its PLY header has no line 'end_header'.");
        const std::vector<std::string_view> words = words_of(bytes.substr(p, end - p));
        p = end + 1;
        if (words.empty() || words[0] == "ply" || words[0] == "comment" || words[0] == "obj_info") continue;
        if (words[0] == "end_header") break;
        if (words[0] == "format" && words.size() >= 2) {
            format_seen = true;
            if (words[1] == "ascii") {
                header.encoding = Encoding::kAscii;
            } else if (words[1] == "binary_little_endian") {
                header.encoding = Encoding::kLittle;
            } else if (words[1] == "binary_big_endian") {
                header.encoding = Encoding::kBig;
            } else {
                job.fail("has the unknown PLY format '" + std::string(words[1].substr(0, 40)) + "'.");
            }
        } else if (words[0] == "element" && words.size() >= 3) {
            header.elements.push_back({std::string(words[1]), parse_count(job, words[2]), {}});
        } else if (words[0] == "property" && words.size() >= 3 && !header.elements.empty()) {
            Property property;
            property.is_list = words[1] == "list";
            if (property.is_list && words.size() < 5)
                job.fail("has an incomplete list property in its PLY header.");
            if (property.is_list) property.length_type = parse_type(job, words[2]);
            property.type = parse_type(job, words[property.is_list ? 3 : 1]);
            property.name = words[property.is_list ? 4 : 2];
            header.elements.back().properties.push_back(property);
        } else {
            job.fail("is damaged: line " + std::to_string(line) + " of its PLY header makes no sense.");
        }
    }
    if (!format_seen) job.fail("has no 'format' line in its PLY header.");
    header.end = p;
    return header;
}

template <typename T>
T load(const char* p, bool swap) {
    T value;
    if (swap) {
        char turned[sizeof(T)];
        for (size_t i = 0; i < sizeof(T); i++)
            turned[i] = p[sizeof(T) - 1 - i];
        std::memcpy(&value, turned, sizeof(T));
    } else {
        std::memcpy(&value, p, sizeof(T));
    }
    return value;
}

// Calls body(T{}) with the C++ type of `type`.
template <typename Body>
auto with_type(Type type, const Body& body) {
    switch (type) {
        case Type::kInt8:
            return body(int8_t{});
        case Type::kUint8:
            return body(uint8_t{});
        case Type::kInt16:
            return body(int16_t{});
        case Type::kUint16:
            return body(uint16_t{});
        case Type::kInt32:
            return body(int32_t{});
        case Type::kUint32:
            return body(uint32_t{});
        case Type::kInt64:
            return body(int64_t{});
        case Type::kUint64:
            return body(uint64_t{});
        case Type::kFloat:
            return body(float{});
        case Type::kDouble:
            break;
    }
    return body(double{});
}

double load_as_double(const char* p, Type type, bool swap) {
    return with_type(type, [&](auto t) { return static_cast<double>(load<decltype(t)>(p, swap)); });
}

// One column of a block of rows into every third value of `target`.
template <typename Target>
void decode_column(const char* rows, size_t stride, size_t count, Type type, bool swap, Target* target) {
    with_type(type, [&](auto t) {
        using T = decltype(t);
        if (swap) {
            for (size_t i = 0; i < count; i++)
                target[3 * i] = static_cast<Target>(load<T>(rows + i * stride, true));
        } else {
            for (size_t i = 0; i < count; i++)
                target[3 * i] = static_cast<Target>(load<T>(rows + i * stride, false));
        }
    });
}

[[noreturn]] void fail_cut_off(const ReadJob& job, const Element& element, uint64_t found) {
    job.fail("is cut off: its header promises " + std::to_string(element.count) + " of '" + element.name +
             "', but it holds " + std::to_string(found) + "; copy it again.");
}

// What the vertex element offers.
struct Vertices {
    std::vector<int8_t> roles;  // by property
    bool colors = false;
    bool normals = false;
    float white = 0.0F;
};

Vertices understand(const ReadJob& job, const Element& element) {
    Vertices result;
    std::vector<std::string> names;
    for (const Property& p : element.properties)
        names.push_back(p.is_list ? "" : p.name);
    result.roles = roles_from_names(names);
    for (const Role role : {kRoleX, kRoleY, kRoleZ})
        if (!has_role(result.roles, role)) job.fail("is a PLY file whose vertices lack x, y or z.");
    result.colors = has_role(result.roles, kRoleR);
    result.normals = has_role(result.roles, kRoleNx);
    for (size_t i = 0; i < names.size(); i++) {
        if (result.roles[i] != kRoleR) continue;
        if (element.properties[i].type == Type::kUint8) result.white = 255.0F;
        if (element.properties[i].type == Type::kUint16) result.white = 65535.0F;
    }
    return result;
}

class BinaryReader {
  public:
    BinaryReader(const ReadJob& job, const Header& header)
        : job_(job),
          p_(job.bytes.view().data() + header.end),
          end_(job.bytes.view().data() + job.bytes.size),
          swap_((header.encoding == Encoding::kBig) == (std::endian::native == std::endian::little)) {}

    void skip(const Element& element) {
        if (element.properties.empty()) return;
        if (!element.has_list()) {
            take_fixed(element);
            return;
        }
        for (uint64_t i = 0; i < element.count; i++)
            walk_row(element, i, nullptr);
    }

    RawCloud read(const Element& element) {
        const Vertices vertices = understand(job_, element);
        RawCloud raw;
        raw.color_white = vertices.white;
        const size_t stride = element.packed_size();
        const bool lists = element.has_list();
        const char* rows = lists ? p_ : take_fixed(element);
        if (lists && element.count > static_cast<uint64_t>(end_ - p_) / stride)
            fail_cut_off(job_, element, static_cast<uint64_t>(end_ - p_) / stride);
        const size_t count = static_cast<size_t>(element.count);
        raw.positions.resize(count);
        if (vertices.colors) raw.colors.resize(count);
        if (vertices.normals) raw.normals.resize(count);
        std::vector<char> packed(lists ? kBlock * stride : 0);
        for (size_t begin = 0; begin < count; begin += kBlock) {
            const size_t length = std::min(kBlock, count - begin);
            const char* block = rows + begin * stride;
            if (lists) {
                for (size_t i = 0; i < length; i++)
                    walk_row(element, begin + i, packed.data() + i * stride);
                block = packed.data();
            }
            decode(element, vertices, block, stride, begin, length, raw);
            job_.step(0.1 + 0.7 * static_cast<double>(begin) / static_cast<double>(count));
        }
        return raw;
    }

  private:
    // The rows of an element without lists, all of them.
    const char* take_fixed(const Element& element) {
        const size_t stride = element.packed_size();
        const uint64_t found = static_cast<uint64_t>(end_ - p_) / stride;
        if (found < element.count) fail_cut_off(job_, element, found);
        const char* rows = p_;
        p_ += stride * static_cast<size_t>(element.count);
        return rows;
    }

    // Moves past row `index`; copies its values that are not lists to `packed` unless that is null.
    void walk_row(const Element& element, uint64_t index, char* packed) {
        if (index % kBlock == 0) job_.step(0.1);
        for (const Property& property : element.properties) {
            const size_t size = kTypeSize[static_cast<int>(property.type)];
            size_t length = size;
            if (property.is_list) {
                const size_t length_size = kTypeSize[static_cast<int>(property.length_type)];
                if (static_cast<size_t>(end_ - p_) < length_size) fail_cut_off(job_, element, index);
                const double items = load_as_double(p_, property.length_type, swap_);
                p_ += length_size;
                if (!(items >= 0.0)) job_.fail("is damaged: a list in it has a negative length.");
                if (items > static_cast<double>(end_ - p_)) fail_cut_off(job_, element, index);
                length = static_cast<size_t>(items) * size;
            }
            if (static_cast<size_t>(end_ - p_) < length) fail_cut_off(job_, element, index);
            if (packed && !property.is_list) {
                std::memcpy(packed, p_, length);
                packed += length;
            }
            p_ += length;
        }
    }

    void decode(const Element& element, const Vertices& vertices, const char* block, size_t stride,
                size_t begin, size_t length, RawCloud& raw) const {
        size_t offset = 0;
        for (size_t i = 0; i < element.properties.size(); i++) {
            const Property& property = element.properties[i];
            if (property.is_list) continue;
            const int role = vertices.roles[i];
            const char* column = block + offset;
            if (role >= kRoleNx) {
                decode_column(column, stride, length, property.type, swap_,
                              &raw.normals[begin][role - kRoleNx]);
            } else if (role >= kRoleR) {
                decode_column(column, stride, length, property.type, swap_,
                              &raw.colors[begin][role - kRoleR]);
            } else if (role >= kRoleX) {
                decode_column(column, stride, length, property.type, swap_, &raw.positions[begin][role]);
            }
            offset += kTypeSize[static_cast<int>(property.type)];
        }
    }

    const ReadJob& job_;
    const char* p_;
    const char* end_;
    bool swap_;
};

class AsciiReader {
  public:
    AsciiReader(const ReadJob& job, const Header& header)
        : job_(job),
          p_(job.bytes.view().data() + header.end),
          end_(job.bytes.view().data() + job.bytes.size) {}

    void skip(const Element& element) {
        if (element.properties.empty()) return;
        for (uint64_t i = 0; i < element.count; i++) {
            next_line(element, i);
            to_line_end();
        }
    }

    RawCloud read(const Element& element) {
        const Vertices vertices = understand(job_, element);
        RawCloud raw;
        raw.color_white = vertices.white;
        // A row takes two bytes per value or more, whatever the header promises.
        const size_t most = static_cast<size_t>(end_ - p_) / (2 * element.properties.size()) + 1;
        const size_t count = static_cast<size_t>(std::min<uint64_t>(element.count, most));
        raw.positions.reserve(count);
        if (vertices.colors) raw.colors.reserve(count);
        if (vertices.normals) raw.normals.reserve(count);
        std::array<double, kRoleCount> row{};
        for (uint64_t i = 0; i < element.count; i++) {
            if (i % kBlock == 0)
                job_.step(0.1 + 0.7 * static_cast<double>(i) / static_cast<double>(element.count));
            next_line(element, i);
            for (size_t k = 0; k < element.properties.size(); k++) {
                double items = 1.0;
                if (element.properties[k].is_list) items = value(element, i);
                if (!(items >= 0.0)) job_.fail("is damaged: a list in it has a negative length.");
                for (double item = 0.0; item < items; item += 1.0) {
                    const double number = value(element, i);
                    if (vertices.roles[k] != kNoRole) row[static_cast<size_t>(vertices.roles[k])] = number;
                }
            }
            to_line_end();
            raw.add(row, vertices.colors, vertices.normals);
        }
        return raw;
    }

  private:
    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

    // To the first value of the next line that has one.
    void next_line(const Element& element, uint64_t index) {
        while (p_ != end_ && (is_blank(*p_) || *p_ == '\n'))
            p_++;
        if (p_ == end_) fail_cut_off(job_, element, index);
    }

    void to_line_end() {
        const void* end = std::memchr(p_, '\n', static_cast<size_t>(end_ - p_));
        p_ = end ? static_cast<const char*>(end) : end_;
    }

    double value(const Element& element, uint64_t index) {
        while (p_ != end_ && is_blank(*p_))
            p_++;
        if (p_ == end_) fail_cut_off(job_, element, index);
        double number = 0.0;
        if (*p_ == '\n' || !parse_number(p_, end_, number))
            job_.fail("is damaged: row " + std::to_string(index + 1) + " of '" + element.name +
                      "' does not hold the numbers that its header promises.");
        // "1.#QNAN" and its like.
        if (p_ != end_ && !is_blank(*p_) && *p_ != '\n') {
            while (p_ != end_ && !is_blank(*p_) && *p_ != '\n')
                p_++;
            number = std::numeric_limits<double>::quiet_NaN();
        }
        return number;
    }

    const ReadJob& job_;
    const char* p_;
    const char* end_;
};

template <typename Reader>
RawCloud read_vertices(const ReadJob& job, const Header& header) {
    Reader reader(job, header);
    for (const Element& element : header.elements) {
        if (element.name == "vertex" || element.name == "vertices" || element.name == "point") {
            if (element.count == 0) job.fail("holds no points.");
            return reader.read(element);
        }
        reader.skip(element);
    }
    job.fail("is a PLY file without vertices.");
}

}  // namespace

RawCloud read_ply(const ReadJob& job) {
    const Header header = read_header(job);
    if (header.encoding == Encoding::kAscii) {
        job.report.format = "PLY ascii";
        char* bytes = job.bytes.data.get();
        if (bytes[header.end - 1] == '\r')
            std::replace(bytes + header.end, bytes + job.bytes.size, '\r', '\n');
        return read_vertices<AsciiReader>(job, header);
    }
    job.report.format =
        header.encoding == Encoding::kLittle ? "PLY binary little endian" : "PLY binary big endian";
    return read_vertices<BinaryReader>(job, header);
}

}  // namespace treerec
