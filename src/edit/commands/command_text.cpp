#include "edit/commands/command_text.h"

#include <charconv>
#include <cmath>

namespace treerec {

namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

bool is_name(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

// The value that begins at `at`, which is moved behind it.
std::string take_value(std::string_view line, size_t& at) {
    std::string value;
    if (at < line.size() && line[at] == '"') {
        const size_t begin = at++;
        while (true) {
            if (at >= line.size()) throw CommandError("The quote that begins here does not end.", begin + 1);
            if (line[at] == '"') {
                at++;
                if (at >= line.size() || line[at] != '"') break;
            }
            value += line[at++];
        }
        if (at < line.size() && !is_blank(line[at]))
            throw CommandError("A blank must follow the closing quote.", at + 1);
        return value;
    }
    while (at < line.size() && !is_blank(line[at])) {
        if (line[at] == '"') throw CommandError("A quote can only begin right after the '='.", at + 1);
        value += line[at++];
    }
    return value;
}

}  // namespace

std::optional<CommandLine> parse_command_line(std::string_view line) {
    CommandLine command;
    size_t at = 0;
    const auto skip_blanks = [&] {
        while (at < line.size() && is_blank(line[at]))
            at++;
        return at < line.size() && line[at] != '#';
    };
    const auto take_name = [&] {
        const size_t begin = at;
        while (at < line.size() && is_name(line[at]))
            at++;
        return std::string(line.substr(begin, at - begin));
    };
    const auto rest_of_word = [&](size_t begin) {
        size_t end = begin;
        while (end < line.size() && !is_blank(line[end]))
            end++;
        return quote_word(line.substr(begin, end - begin));
    };
    if (!skip_blanks()) return std::nullopt;
    command.column = at + 1;
    const size_t begin = at;
    command.name = take_name();
    if (command.name.empty() || (at < line.size() && !is_blank(line[at])))
        throw CommandError(
            "A line must begin with a command's name, but " + rest_of_word(begin) + " is none.", begin + 1);
    while (skip_blanks()) {
        CommandWord word;
        const size_t start = at;
        word.column = at + 1;
        word.key = take_name();
        if (word.key.empty() || at >= line.size() || line[at] != '=')
            throw CommandError(rest_of_word(start) + " is not of the form name=value.", start + 1);
        at++;
        word.value_column = at + 1;
        word.value = take_value(line, at);
        for (const CommandWord& other : command.words)
            if (other.key == word.key) throw CommandError("'" + word.key + "' is given twice.", start + 1);
        command.words.push_back(std::move(word));
    }
    return command;
}

void append_word(std::string& line, std::string_view key, std::string_view value) {
    line += ' ';
    line += key;
    line += '=';
    if (!value.empty() && value.find_first_of(" \t\r\n\"#") == std::string_view::npos) {
        line += value;
        return;
    }
    line += '"';
    for (const char c : value) {
        if (c == '"') line += '"';
        line += c;
    }
    line += '"';
}

std::string number_text(double value) {
    char buffer[32];
    const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
    return {buffer, result.ptr};
}

std::string vector_text(const DVec3& v, char separator) {
    return number_text(v.x) + separator + number_text(v.y) + separator + number_text(v.z);
}

std::optional<double> read_number(std::string_view text) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double value = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

std::optional<std::vector<double>> read_numbers(std::string_view text, char separator, size_t count) {
    std::vector<double> numbers;
    for (const std::string_view piece : split(text, separator)) {
        const std::optional<double> number = read_number(piece);
        if (!number || numbers.size() == count) return std::nullopt;
        numbers.push_back(*number);
    }
    return numbers.size() == count ? std::optional(numbers) : std::nullopt;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> pieces;
    while (true) {
        const size_t end = text.find(separator);
        pieces.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return pieces;
        text.remove_prefix(end + 1);
    }
}

}  // namespace treerec
