// The text form of a command: one line, a name and key=value words.
//
//     prune factor=1.5 spare_leader=no      # a comment
//     graft node=12 string="F(0.1)[+F(0.1)]F(0.2)"
//
// A value with blanks, quotes or # stands in double quotes, in which "" is a quote.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "error.h"
#include "geometry/vec.h"

namespace treerec {

// A command that cannot be understood. column: of the offending word, from 1; counts bytes.
class CommandError : public Error {
  public:
    CommandError(const std::string& sentence, size_t column) : Error(sentence), column_(column) {}
    size_t column() const { return column_; }

  private:
    size_t column_;
};

struct CommandWord {
    std::string key;
    std::string value;
    size_t column = 1;        // of the key
    size_t value_column = 1;  // of the value's first character
};

struct CommandLine {
    std::string name;
    size_t column = 1;
    std::vector<CommandWord> words;
};

// Nothing for a line that is blank or all comment. Throws CommandError.
std::optional<CommandLine> parse_command_line(std::string_view line);
// Appends " key=value", quoted where it must be.
void append_word(std::string& line, std::string_view key, std::string_view value);

// The shortest decimal that reads back as the same double.
std::string number_text(double value);
// "x,y,z".
std::string vector_text(const DVec3& v, char separator = ',');
// Nothing for what is no finite number, or has anything around it.
std::optional<double> read_number(std::string_view text);
// `count` numbers with `separator` between them, or nothing.
std::optional<std::vector<double>> read_numbers(std::string_view text, char separator, size_t count);
// The pieces between separators; at least one.
std::vector<std::string_view> split(std::string_view text, char separator);

}  // namespace treerec
