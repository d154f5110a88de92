// Small pieces that the readers and writers of text skeletons share.
#pragma once

#include <charconv>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/scan_frame.h"

namespace treerec {

// The number that the whole of `text` (blanks around it aside) spells, or nothing.
inline std::optional<double> parse_number(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t\r\"");
    if (first == std::string_view::npos) return std::nullopt;
    text = text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
    if (text.front() == '+') text.remove_prefix(1);
    double value = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

// Appends the shortest decimal that reads back as the same double.
inline void append_number(std::string& out, double value) {
    char buffer[32];
    const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
    out.append(buffer, result.ptr);
}

inline void append_number(std::string& out, int64_t value) {
    char buffer[24];
    const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
    out.append(buffer, result.ptr);
}

// Splits off and returns the next line of `text` (without its end), or nothing at the end.
inline std::optional<std::string_view> next_line(std::string_view& text) {
    if (text.empty()) return std::nullopt;
    const size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
}

// The fields of a line, split at commas, semicolons and blanks, in lower case and without quotes.
std::vector<std::string> split_fields(std::string_view line);
// The place in `fields` of the first of `names` that is there, or -1.
int find_field(const std::vector<std::string>& fields, std::initializer_list<const char*> names);

// What our own files say in a comment about how they lie in space: "treerec 1 up z metres_per_unit 1", and
// " tilt x y z" after it where ScanFrame::tilt is not zero.
struct FileStamp {
    UpAxis up = UpAxis::kZ;
    double metres_per_unit = 1.0;
    DVec3 tilt{0.0};
};
std::string stamp_text(const ScanFrame& frame);
// Reads a comment's text into `stamp`; false if it is some other comment. Throws Error for a newer version.
bool read_stamp(std::string_view comment, FileStamp& stamp, const std::string& path);

}  // namespace treerec
