#include "cli/arguments.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace treerec {

namespace {

const Option* find_option(const Command& command, const std::string& name) {
    for (const Option& option : command.options)
        if (option.name == name) return &option;
    return nullptr;
}

// Levenshtein's distance.
size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<size_t> row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); j++)
        row[j] = j;
    for (size_t i = 1; i <= a.size(); i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= b.size(); j++) {
            const size_t above = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
            diagonal = above;
        }
    }
    return row[b.size()];
}

std::string unknown_option(const Command& command, const std::string& word) {
    std::vector<std::string> names{"--help"};
    for (const Option& option : command.options)
        names.push_back(option.name);
    const std::optional<std::string> nearest = nearest_word(word, names);
    return "There is no option " + word + (nearest ? "; did you mean " + *nearest + "?" : ".");
}

template <typename T>
bool parse_whole(const std::string& text, T& value) {
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    return failure == std::errc() && end == text.data() + text.size();
}

std::string plain(double value) {
    char buffer[32];
    const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
    return {buffer, result.ptr};
}

}  // namespace

std::optional<std::string> nearest_word(const std::string& word, const std::vector<std::string>& known) {
    std::optional<std::string> best;
    size_t least = std::max<size_t>(2, word.size() / 3) + 1;
    for (const std::string& candidate : known) {
        const size_t distance = word.size() > 200 ? least : edit_distance(word, candidate);
        if (distance < least) {
            least = distance;
            best = candidate;
        }
    }
    return best;
}

Arguments::Arguments(const Command& command, const std::vector<std::string>& words) {
    bool options_end = false;
    for (size_t i = 0; i < words.size(); i++) {
        const std::string& word = words[i];
        if (options_end || word.size() < 2 || word[0] != '-') {
            positional_.push_back(word);
            continue;
        }
        if (word == "--") {
            options_end = true;
            continue;
        }
        const size_t equals = word.starts_with("--") ? word.find('=') : std::string::npos;
        const std::string name = word.substr(0, equals);
        const Option* option = find_option(command, name);
        if (!option) throw UsageError(unknown_option(command, name));
        std::string value;
        if (option->value.empty()) {
            if (equals != std::string::npos) throw UsageError(name + " takes no value.");
        } else if (equals != std::string::npos) {
            value = word.substr(equals + 1);
        } else if (i + 1 < words.size()) {
            value = words[++i];
        } else {
            throw UsageError(name + " needs a value: " + name + " " + option->value + ".");
        }
        std::vector<std::string>& values = values_[name];
        if (!values.empty() && !option->repeated) throw UsageError(name + " is given twice.");
        values.push_back(value);
    }
}

std::string Arguments::text(const std::string& option, const std::string& otherwise) const {
    const auto found = values_.find(option);
    return found == values_.end() ? otherwise : found->second.back();
}

const std::vector<std::string>& Arguments::all(const std::string& option) const {
    static const std::vector<std::string> kNone;
    const auto found = values_.find(option);
    return found == values_.end() ? kNone : found->second;
}

double Arguments::number(const std::string& option, double otherwise, double least, double most) const {
    if (!has(option)) return otherwise;
    const std::string word = text(option, "");
    double value = 0.0;
    if (!parse_whole(word, value) || !(value >= least && value <= most))
        throw UsageError(option + " needs a number from " + plain(least) + " to " + plain(most) + ", not '" +
                         word + "'.");
    return value;
}

uint64_t Arguments::whole(const std::string& option, uint64_t otherwise, uint64_t least,
                          uint64_t most) const {
    if (!has(option)) return otherwise;
    const std::string word = text(option, "");
    uint64_t value = 0;
    if (!parse_whole(word, value) || value < least || value > most)
        throw UsageError(option + " needs a whole number from " + std::to_string(least) + " to " +
                         std::to_string(most) + ", not '" + word + "'.");
    return value;
}

std::string help_text(const Command& command) {
    std::string text = command.summary + "\n\nusage: treerec " + command.usage + "\n";
    if (!command.options.empty()) text += "\n";
    constexpr size_t kColumn = 25;
    for (const Option& option : command.options) {
        std::string left = "  " + option.name + (option.value.empty() ? "" : " " + option.value);
        left.resize(std::max(left.size() + 2, kColumn), ' ');
        // The help's own line breaks are indented to the column.
        std::string help;
        for (char c : option.help) {
            help += c;
            if (c == '\n') help.append(kColumn, ' ');
        }
        text += left + help + "\n";
    }
    if (!command.notes.empty()) text += "\n" + command.notes + "\n";
    return text;
}

}  // namespace treerec
