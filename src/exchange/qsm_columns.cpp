#include "exchange/qsm_columns.h"

#include <string>

#include "exchange/text_scan.h"

namespace treerec {

namespace {

std::string_view trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t\r\"");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1);
}

// "Start.X" and "radius (m)" as "start_x" and "radius".
std::string plain_name(std::string_view name) {
    std::string plain;
    for (const char c : trimmed(name.substr(0, name.find('('))))
        plain += c == '.' || c == ' ' ? '_' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return plain;
}

std::array<int, 3> find_vector(const std::vector<std::string>& names,
                               std::initializer_list<const char*> stems) {
    for (const char* stem : stems)
        for (const auto& ends :
             {std::array{"_x", "_y", "_z"}, std::array{"x", "y", "z"}, std::array{"_1", "_2", "_3"}}) {
            std::array<int, 3> found{};
            for (size_t axis = 0; axis < 3; axis++)
                found[axis] = find_field(names, {(std::string(stem) + ends[axis]).c_str()});
            if (found[0] >= 0 && found[1] >= 0 && found[2] >= 0) return found;
        }
    return {-1, -1, -1};
}

}  // namespace

void split_row(std::string_view line, char delimiter, std::vector<std::string_view>& words) {
    words.clear();
    if (delimiter == ' ') {
        for (size_t at = line.find_first_not_of(" \t\r"); at != std::string_view::npos;) {
            const size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
            words.push_back(trimmed(line.substr(at, end - at)));
            at = line.find_first_not_of(" \t\r", end);
        }
        return;
    }
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) return;
    for (size_t at = 0; at <= line.size();) {
        const size_t end = std::min(line.find(delimiter, at), line.size());
        words.push_back(trimmed(line.substr(at, end - at)));
        at = end + 1;
    }
    if (words.back().empty()) words.pop_back();
}

std::optional<QsmColumns> find_qsm_columns(std::string_view line) {
    QsmColumns columns;
    // TreeQSM's names hold blanks between tabs.
    for (const char delimiter : {',', ';', '\t', ' '})
        if (delimiter == ' ' || line.find(delimiter) != std::string_view::npos) {
            columns.delimiter = delimiter;
            break;
        }
    std::vector<std::string_view> words;
    split_row(line, columns.delimiter, words);
    std::vector<std::string> names;
    for (const std::string_view word : words) {
        const std::string name = plain_name(word);
        // One name for three values, as TreeQSM writes them.
        const bool vector = name == "start_point" || name == "axis_direction";
        for (const char* end : {"_x", "_y", "_z"})
            if (vector) names.push_back((name == "start_point" ? "start" : "axis") + std::string(end));
        if (!vector) names.push_back(name);
    }
    columns.count = names.size();
    columns.radius = find_field(names, {"radius", "radius_cyl"});
    columns.length = find_field(names, {"length"});
    columns.start = find_vector(names, {"start", "s"});
    columns.axis = find_vector(names, {"axis", "a"});
    columns.end = find_vector(names, {"end", "e"});
    columns.parent = find_field(names, {"parent_1based", "parentid", "parent_id", "p2", "parent"});
    // Our own rows are numbered, whatever else a column may say.
    columns.id = find_field(names, {"parent_1based"}) >= 0 ? -1 : find_field(names, {"id", "cyl_id", "p1"});
    columns.order = find_field(names, {"order", "branch_order", "branchorder", "branching_order"});
    columns.measured = find_field(names, {"measured"});
    columns.added = find_field(names, {"added"});
    const bool has_end = columns.end[0] >= 0 || (columns.axis[0] >= 0 && columns.length >= 0);
    if (columns.radius < 0 || columns.parent < 0 || columns.start[0] < 0 || !has_end) return std::nullopt;
    return columns;
}

}  // namespace treerec
