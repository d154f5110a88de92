// The text that TreeQSM exports for modelling programs: sections below lines such as "# Cylinder data", their
// columns without names, in the order of its cylinder tables (P. Raumonen et al., TreeQSM 2.x manual).
#include <algorithm>
#include <string>
#include <vector>

#include "error.h"
#include "exchange/qsm_columns.h"
#include "exchange/skeleton_parsers.h"
#include "exchange/text_scan.h"

namespace treerec {

namespace {

constexpr size_t kNamed = 9;  // radius, length, start, axis and parent: what every version has first
constexpr const char* kNames = "radius,length,start_x,start_y,start_z,axis_x,axis_y,axis_z,parent_1based";
constexpr size_t kAll = 14;
constexpr const char* kOtherNames = ",extension,branch,order,position,added";

bool is_blank(std::string_view line) {
    return line.find_first_not_of(" \t\r") == std::string_view::npos;
}

// Of a line that begins a section: what follows its #, in lower case.
std::string title_of(std::string_view line) {
    std::string title;
    for (const char c : line.substr(std::min(line.find_first_not_of("# \t"), line.size())))
        title += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return title;
}

bool begins_cylinders(std::string_view line) {
    return line.starts_with('#') && title_of(line).starts_with("cylinder");
}

// Blanks, tabs or commas between them.
std::vector<std::string_view> values_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (size_t at = line.find_first_not_of(" \t\r,"); at != std::string_view::npos;) {
        const size_t end = std::min(line.find_first_of(" \t\r,", at), line.size());
        words.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(" \t\r,", end);
    }
    return words;
}

}  // namespace

bool looks_like_qsm_sections(std::string_view bytes) {
    bool begun = false;
    while (const std::optional<std::string_view> line = next_line(bytes)) {
        if (is_blank(*line)) continue;
        if (!begun && !line->starts_with('#')) return false;
        if (line->starts_with('#')) {
            begun = begun || begins_cylinders(*line);
            continue;
        }
        const std::vector<std::string_view> words = values_of(*line);
        return words.size() >= kNamed &&
               std::all_of(words.begin(), words.begin() + kNamed,
                           [](std::string_view word) { return parse_number(word).has_value(); });
    }
    return false;
}

Tree parse_qsm_sections(std::string_view bytes, const std::string& path, const SkeletonChoice& choice,
                        SkeletonReport* report) {
    // As the table with names that it is.
    std::string table(kNames);
    size_t columns = 0, line_number = 0;
    bool inside = false;
    while (const std::optional<std::string_view> line = next_line(bytes)) {
        line_number++;
        if (is_blank(*line)) continue;
        if (line->starts_with('#')) {
            if (inside && columns > 0 && begins_cylinders(*line))
                throw Error("'" + path + "', line " + std::to_string(line_number) +
                            ": a second section of cylinders begins; give each tree a file of its own.");
            if (inside && columns > 0) break;
            inside = begins_cylinders(*line);
            continue;
        }
        if (!inside) continue;
        const std::vector<std::string_view> words = values_of(*line);
        if (columns == 0) {
            columns = words.size() == kAll ? kAll : kNamed;
            if (columns == kAll) table += kOtherNames;
            table += '\n';
        }
        if (words.size() < columns)
            throw Error("'" + path + "', line " + std::to_string(line_number) + ": " +
                        std::to_string(words.size()) + " values are too few for a cylinder.");
        for (size_t i = 0; i < columns; i++) {
            if (!parse_number(words[i]))
                throw Error("'" + path + "', line " + std::to_string(line_number) + ": " +
                            quote_word(words[i]) + " is no number.");
            table += words[i];
            table += i + 1 < columns ? ',' : '\n';
        }
    }
    if (columns == 0) throw Error("'" + path + "' holds no cylinders.");
    return parse_qsm_csv(table, path, choice, report);
}

}  // namespace treerec
