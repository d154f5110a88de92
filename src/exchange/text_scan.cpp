#include "exchange/text_scan.h"

#include <algorithm>

#include "error.h"
#include "exchange/finite.h"

namespace treerec {

namespace {

constexpr int kStampVersion = 1;
constexpr std::string_view kStampWord = "treerec ";

}  // namespace

std::vector<std::string> split_fields(std::string_view line) {
    std::vector<std::string> fields;
    std::string field;
    for (char c : line) {
        if (c == ',' || c == ' ' || c == '\t' || c == ';') {
            if (!field.empty()) fields.push_back(field);
            field.clear();
        } else if (c != '"' && c != '\r') {
            field += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        }
    }
    if (!field.empty()) fields.push_back(field);
    return fields;
}

int find_field(const std::vector<std::string>& fields, std::initializer_list<const char*> names) {
    for (const char* name : names) {
        const auto at = std::find(fields.begin(), fields.end(), name);
        if (at != fields.end()) return static_cast<int>(at - fields.begin());
    }
    return -1;
}

std::string stamp_text(const ScanFrame& frame) {
    std::string text(kStampWord);
    append_number(text, int64_t{kStampVersion});
    text += " up ";
    text += up_axis_name(frame.up);
    text += " metres_per_unit ";
    append_number(text, frame.metres_per_unit);
    if (frame.tilt == DVec3(0.0)) return text;
    text += " tilt";
    for (int axis = 0; axis < 3; axis++) {
        text += ' ';
        append_number(text, frame.tilt[axis]);
    }
    return text;
}

bool read_stamp(std::string_view comment, FileStamp& stamp, const std::string& path) {
    const size_t at = comment.find(kStampWord);
    if (at == std::string_view::npos) return false;
    std::vector<std::string_view> words;
    for (size_t i = at; i < comment.size();) {
        const size_t end = std::min(comment.find(' ', i), comment.size());
        if (end > i) words.push_back(comment.substr(i, end - i));
        i = end + 1;
    }
    if (words.size() < 6 || words[2] != "up" || words[4] != "metres_per_unit") return false;
    const std::optional<double> version = parse_number(words[1]);
    const std::optional<double> unit = parse_number(words[5]);
    if (!version || !unit) return false;
    if (*version > kStampVersion)
        throw Error("'" + path + "' was written by a newer version of this program; update to open it.");
    if (!(*unit > kSmallestUnit) || !(*unit < kLargestUnit)) return false;
    try {
        stamp.up = parse_up_axis(words[3]);
    } catch (const Error& error) {
        throw Error("'" + path + "' is damaged: " + error.what());
    }
    stamp.metres_per_unit = *unit;
    stamp.tilt = DVec3(0.0);
    if (words.size() < 7 || words[6] != "tilt") return true;
    for (size_t axis = 0; axis < 3; axis++) {
        const std::optional<double> value =
            7 + axis < words.size() ? parse_number(words[7 + axis]) : std::nullopt;
        stamp.tilt[static_cast<int>(axis)] = value.value_or(2.0);
    }
    if (!is_tilt(stamp.tilt)) throw Error("'" + path + "' is damaged: its tilt is none.");
    return true;
}

}  // namespace treerec
