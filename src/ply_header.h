// The header of PLY files and their values, for clouds and skeletons alike: G. Turk, "The PLY Polygon File
// Format", 1994, as it is written in the wild.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace treerec {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat, kDouble };
// The line of a cloud's header that has PointCloud::spacing after it.
inline constexpr std::string_view kSpacingComment = "comment spacing ";

enum class PlyEncoding { kAscii, kLittle, kBig };

// In bytes, in the binary encodings.
inline size_t size_of(PlyType type) {
    static constexpr size_t kSizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return kSizes[static_cast<size_t>(type)];
}

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::kFloat;
    bool is_list = false;
    PlyType length_type = PlyType::kUint8;  // of a list
};

struct PlyElement {
    std::string name;
    uint64_t count = 0;  // as the header promises; below 2^54
    std::vector<PlyProperty> properties;

    bool has_list() const;
    // Bytes of the properties that are no lists.
    size_t packed_size() const;
    // The index of the property of this name that is no list, or -1.
    int find(std::string_view wanted) const;
};

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::kAscii;
    std::vector<PlyElement> elements;
    std::vector<std::string> comments;  // whole lines
    size_t end = 0;                     // where the data begin

    // Whether binary values must be turned round on this machine.
    bool swaps() const {
        return (encoding == PlyEncoding::kBig) == (std::endian::native == std::endian::little);
    }
};

// Whether the bytes begin as a PLY file does.
bool is_ply(std::string_view bytes);

// Reads the header of a file whose bytes begin with "ply". Throws Error; `path` is for the sentence.
PlyHeader read_ply_header(std::string_view bytes, const std::string& path);

template <typename T>
T load_value(const char* p, bool swap) {
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
auto with_ply_type(PlyType type, const Body& body) {
    switch (type) {
        case PlyType::kInt8:
            return body(int8_t{});
        case PlyType::kUint8:
            return body(uint8_t{});
        case PlyType::kInt16:
            return body(int16_t{});
        case PlyType::kUint16:
            return body(uint16_t{});
        case PlyType::kInt32:
            return body(int32_t{});
        case PlyType::kUint32:
            return body(uint32_t{});
        case PlyType::kInt64:
            return body(int64_t{});
        case PlyType::kUint64:
            return body(uint64_t{});
        case PlyType::kFloat:
            return body(float{});
        case PlyType::kDouble:
            break;
    }
    return body(double{});
}

inline double load_ply_value(const char* p, PlyType type, bool swap) {
    return with_ply_type(type, [&](auto t) { return static_cast<double>(load_value<decltype(t)>(p, swap)); });
}

}  // namespace treerec
