#include "ply_header.h"

#include <algorithm>

#include "error.h"

namespace treerec {

namespace {

constexpr size_t kLongestHeader = 1 << 20;

[[noreturn]] void fail(const std::string& path, const std::string& rest) {
    throw Error("'" + path + "' " + rest);
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (size_t p = 0;;) {
        const size_t begin = line.find_first_not_of(" \t\r\f\v", p);
        if (begin == line.npos) return words;
        p = std::min(line.find_first_of(" \t\r\f\v", begin), line.size());
        words.push_back(line.substr(begin, p - begin));
    }
}

PlyType parse_type(const std::string& path, std::string_view word) {
    struct Name {
        std::string_view text;
        PlyType type;
    };
    static constexpr Name kNames[] = {
        {"char", PlyType::kInt8},     {"int8", PlyType::kInt8},     {"uchar", PlyType::kUint8},
        {"uint8", PlyType::kUint8},   {"short", PlyType::kInt16},   {"int16", PlyType::kInt16},
        {"ushort", PlyType::kUint16}, {"uint16", PlyType::kUint16}, {"int", PlyType::kInt32},
        {"int32", PlyType::kInt32},   {"uint", PlyType::kUint32},   {"uint32", PlyType::kUint32},
        {"int64", PlyType::kInt64},   {"uint64", PlyType::kUint64}, {"float", PlyType::kFloat},
        {"float32", PlyType::kFloat}, {"double", PlyType::kDouble}, {"float64", PlyType::kDouble},
    };
    for (const Name& name : kNames)
        if (name.text == word) return name.type;
    fail(path, "has a property of the unknown type " + quote_word(word) + " in its PLY header.");
}

uint64_t parse_count(const std::string& path, std::string_view word) {
    uint64_t count = 0;
    for (const char c : word) {
        if (c < '0' || c > '9' || count > (uint64_t{1} << 50))
            fail(path,
                 "has an element with the impossible count " + quote_word(word) + " in its PLY header.");
        count = count * 10 + static_cast<uint64_t>(c - '0');
    }
    return count;
}

}  // namespace

bool PlyElement::has_list() const {
    return std::any_of(properties.begin(), properties.end(), [](const PlyProperty& p) { return p.is_list; });
}

size_t PlyElement::packed_size() const {
    size_t size = 0;
    for (const PlyProperty& p : properties)
        if (!p.is_list) size += size_of(p.type);
    return size;
}

int PlyElement::find(std::string_view wanted) const {
    for (size_t i = 0; i < properties.size(); i++)
        if (properties[i].name == wanted && !properties[i].is_list) return static_cast<int>(i);
    return -1;
}

bool is_ply(std::string_view bytes) {
    return bytes.starts_with("ply") && bytes.size() > 3 &&
           std::string_view("\n\r \t").find(bytes[3]) != std::string_view::npos;
}

PlyHeader read_ply_header(std::string_view bytes, const std::string& path) {
    // Old Macintosh files end their lines by a carriage return alone.
    const size_t first_end = bytes.find_first_of("\n\r");
    const bool mac = first_end != bytes.npos && bytes[first_end] == '\r' &&
                     !(first_end + 1 < bytes.size() && bytes[first_end + 1] == '\n');
    PlyHeader header;
    bool format_seen = false;
    size_t p = 0;
    for (size_t line = 1;; line++) {
        const size_t end = bytes.substr(0, kLongestHeader).find(mac ? '\r' : '\n', p);
        if (end == bytes.npos) fail(path, "is cut off or damaged: its PLY header has no line 'end_header'.");
        const std::string_view text = bytes.substr(p, end - p);
        const std::vector<std::string_view> words = words_of(text);
        p = end + 1;
        if (words.empty() || words[0] == "ply" || words[0] == "obj_info") continue;
        if (words[0] == "end_header") break;
        if (words[0] == "comment") {
            header.comments.emplace_back(text.substr(0, text.find_last_not_of('\r') + 1));
        } else if (words[0] == "format" && words.size() >= 2) {
            format_seen = true;
            if (words[1] == "ascii") {
                header.encoding = PlyEncoding::kAscii;
            } else if (words[1] == "binary_little_endian") {
                header.encoding = PlyEncoding::kLittle;
            } else if (words[1] == "binary_big_endian") {
                header.encoding = PlyEncoding::kBig;
            } else {
                fail(path, "has the unknown PLY format " + quote_word(words[1]) + ".");
            }
        } else if (words[0] == "element" && words.size() >= 3) {
            header.elements.push_back({std::string(words[1]), parse_count(path, words[2]), {}});
        } else if (words[0] == "property" && words.size() >= 3 && !header.elements.empty()) {
            PlyProperty property;
            property.is_list = words[1] == "list";
            if (property.is_list && words.size() < 5)
                fail(path, "has an incomplete list property in its PLY header.");
            if (property.is_list) property.length_type = parse_type(path, words[2]);
            property.type = parse_type(path, words[property.is_list ? 3 : 1]);
            property.name = words[property.is_list ? 4 : 2];
            header.elements.back().properties.push_back(property);
        } else {
            fail(path, "is damaged: line " + std::to_string(line) + " of its PLY header makes no sense.");
        }
    }
    if (!format_seen) fail(path, "has no 'format' line in its PLY header.");
    header.end = p;
    return header;
}

}  // namespace treerec
