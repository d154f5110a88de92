// How a text cloud is laid out: its separator, its columns, where its rows begin. Internal to scan/.
#pragma once

#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

#include "scan/formats/readers.h"

namespace treerec {

struct TextLayout {
    char separator = ' ';       // ' ' for blanks alone; ',' or ';' beside blanks
    std::vector<int8_t> roles;  // by column
    size_t last_column = 0;     // the last with a role
    std::string label_column;   // the name of the one with labels
    size_t data = 0;            // where the first row begins
    std::optional<uint64_t> promised_points;
};

// Finds the first row and the header above it, and settles the separator and the columns. Decimal commas
// become points in job.bytes.
TextLayout find_text_layout(const ReadJob& job);

class TextLines {
  public:
    TextLines(std::string_view bytes, size_t at) : bytes_(bytes), at_(at) {}

    bool next(std::string_view& line) {
        if (at_ >= bytes_.size()) return false;
        const void* found = std::memchr(bytes_.data() + at_, '\n', bytes_.size() - at_);
        const size_t end =
            found ? static_cast<size_t>(static_cast<const char*>(found) - bytes_.data()) : bytes_.size();
        line = bytes_.substr(at_, end - at_);
        begin_ = at_;
        at_ = end + 1;
        ended_ = found != nullptr;
        return true;
    }
    size_t begin() const { return begin_; }  // of the line given last
    size_t at() const { return at_; }
    bool ended() const { return ended_; }  // whether the line given last had a line end

  private:
    std::string_view bytes_;
    size_t at_;
    size_t begin_ = 0;
    bool ended_ = true;
};

std::string_view trimmed_text(std::string_view line);
bool is_text_comment(std::string_view trimmed_line);

// The next value of a row: moves p behind it and its separator. False at the end of the line. value: NaN for
// a field that is no number; clean: whether it was a number or empty.
bool next_text_value(const char*& p, const char* end, char separator, double& value, bool& clean);

// The numbers of a line, NaN for text; numeric: how many are numbers.
std::vector<double> text_values_of(std::string_view line, char separator, size_t& numeric);

}  // namespace treerec
