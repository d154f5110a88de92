#include "scan/formats/text_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace treerec {

namespace {

constexpr size_t kSampleLines = 4096;
constexpr size_t kMostHeaderLines = 200;
constexpr size_t kMostColumns = 256;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '"';
}

}  // namespace

std::string_view trimmed_text(std::string_view line) {
    while (!line.empty() && (is_blank(line.front()) || line.front() == '\x1A'))
        line.remove_prefix(1);
    while (!line.empty() && (is_blank(line.back()) || line.back() == '\x1A'))
        line.remove_suffix(1);
    return line;
}

bool is_text_comment(std::string_view trimmed_line) {
    return trimmed_line.starts_with('#') || trimmed_line.starts_with("//") || trimmed_line.starts_with('%');
}

bool next_text_value(const char*& p, const char* end, char separator, double& value, bool& clean) {
    while (p != end && is_blank(*p))
        p++;
    if (p == end) return false;
    clean = true;
    value = kNaN;
    if (*p != separator) {
        clean = parse_number(p, end, value);
        if (p != end && !is_blank(*p) && *p != separator) {
            // Text, or "1.#QNAN" and its like.
            clean = clean && *p == '#';
            value = kNaN;
            while (p != end && *p != separator && (separator != ' ' || !is_blank(*p)))
                p++;
        }
        while (p != end && is_blank(*p))
            p++;
    }
    if (separator != ' ' && p != end && *p == separator) p++;
    return true;
}

namespace {

// Adds the values of a line; returns how many are numbers.
size_t append_values(std::string_view line, char separator, std::vector<double>& values) {
    const size_t most = values.size() + kMostColumns;
    size_t numeric = 0;
    const char* p = line.data();
    const char* end = p + line.size();
    double value = 0.0;
    bool clean = false;
    while (values.size() < most && next_text_value(p, end, separator, value, clean)) {
        values.push_back(value);
        numeric += clean ? 1 : 0;
    }
    return numeric;
}

}  // namespace

std::vector<double> text_values_of(std::string_view line, char separator, size_t& numeric) {
    std::vector<double> values;
    numeric = append_values(line, separator, values);
    return values;
}

namespace {

// Names in a header line, quoted or not.
std::vector<std::string> names_of(std::string_view line, char separator) {
    while (!line.empty() &&
           (line.front() == '#' || line.front() == '/' || line.front() == '%' || line.front() == ' '))
        line.remove_prefix(1);
    line = line.substr(0, line.find_last_not_of(" \t\r\x1A") + 1);
    if (line.find(',') != line.npos) separator = ',';
    if (line.find(';') != line.npos) separator = ';';
    if (separator == ' ' && line.find('\t') != line.npos) separator = '\t';
    std::vector<std::string> names;
    std::string name;
    bool quoted = false;
    bool started = false;
    auto flush = [&] {
        names.push_back(name);
        name.clear();
        started = false;
    };
    for (const char c : line) {
        if (c == '"') {
            quoted = !quoted;
            started = true;
        } else if (!quoted && (separator == ' ' ? c == ' ' : c == separator)) {
            if (separator != ' ' || started) flush();
        } else {
            name += c;
            started = true;
        }
    }
    if (started || separator != ' ') flush();
    if (names.size() > kMostColumns) names.resize(kMostColumns);
    return names;
}

// Lines spread evenly over the data.
std::vector<std::string_view> sample_lines(std::string_view bytes, size_t data) {
    std::vector<std::string_view> sample;
    const size_t length = bytes.size() - data;
    size_t at = data;
    for (size_t i = 0; i < kSampleLines; i++) {
        const size_t wanted = data + length / kSampleLines * i;
        if (wanted > at) {
            const size_t end = bytes.find('\n', wanted - 1);
            if (end == bytes.npos) break;
            at = end + 1;
        }
        TextLines lines(bytes, at);
        std::string_view line;
        if (!lines.next(line)) break;
        at = lines.at();
        const std::string_view text = trimmed_text(line);
        if (!text.empty() && !is_text_comment(text)) sample.push_back(text);
    }
    return sample;
}

// Which of ',' and ';' stands between values, and whether ',' is the decimal mark instead.
char find_separator(const std::vector<std::string_view>& sample, bool& decimal_comma) {
    const auto has = [&](char c) {
        return std::any_of(sample.begin(), sample.end(),
                           [&](std::string_view line) { return line.find(c) != line.npos; });
    };
    const bool semicolons = has(';');
    decimal_comma = false;
    if (!has(',')) return semicolons ? ';' : ' ';
    size_t commas = 0;
    size_t points = 0;
    size_t commas_in_numbers = 0;
    size_t gaps = 0;
    for (const std::string_view line : sample) {
        for (size_t i = 0; i < line.size(); i++) {
            const char c = line[i];
            points += c == '.';
            gaps += is_blank(c);
            if (c != ',') continue;
            commas++;
            const bool before = i > 0 && line[i - 1] >= '0' && line[i - 1] <= '9';
            const bool after = i + 1 < line.size() && line[i + 1] >= '0' && line[i + 1] <= '9';
            commas_in_numbers += before && after;
        }
    }
    decimal_comma = commas == commas_in_numbers && points == 0 && (semicolons || gaps > 0);
    if (semicolons) return ';';
    return decimal_comma ? ' ' : ',';
}

// Values of the sampled rows that have the usual number of columns, column by column.
struct Sample {
    std::vector<std::vector<double>> columns;

    template <typename Predicate>
    double share(size_t column, size_t width, const Predicate& holds) const {
        const size_t rows = columns[column].size();
        size_t good = 0;
        double row[3] = {};
        for (size_t i = 0; i < rows; i++) {
            for (size_t k = 0; k < width; k++)
                row[k] = columns[column + k][i];
            good += holds(row);
        }
        return rows ? static_cast<double>(good) / static_cast<double>(rows) : 0.0;
    }

    // How far the three columns from `column` differ within a row, summed over the rows.
    double spread_of(size_t column) const {
        double sum = 0.0;
        for (size_t i = 0; i < columns[column].size(); i++) {
            const auto [low, high] =
                std::minmax({columns[column][i], columns[column + 1][i], columns[column + 2][i]});
            if (high > low) sum += high - low;
        }
        return sum;
    }
};

Sample take_sample(const std::vector<std::string_view>& lines, char separator) {
    std::vector<double> values;       // of all lines, one after another,
    std::vector<size_t> row_ends{0};  // and where each line's end
    std::vector<size_t> widths(kMostColumns + 1);
    for (const std::string_view line : lines) {
        append_values(line, separator, values);
        widths[values.size() - row_ends.back()]++;
        row_ends.push_back(values.size());
    }
    const size_t width = static_cast<size_t>(std::max_element(widths.begin(), widths.end()) - widths.begin());
    Sample sample;
    sample.columns.resize(width);
    for (std::vector<double>& column : sample.columns)
        column.reserve(widths[width]);
    for (size_t row = 0; row < lines.size(); row++) {
        if (row_ends[row + 1] - row_ends[row] != width) continue;
        for (size_t c = 0; c < width; c++)
            sample.columns[c].push_back(values[row_ends[row] + c]);
    }
    return sample;
}

bool is_unit(const double* v) {
    const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    return square == 0.0 || std::abs(square - 1.0) < 0.02;
}

bool is_whole_color(const double* v) {
    for (int k = 0; k < 3; k++)
        if (!(v[k] >= 0.0 && v[k] <= 255.0 && v[k] == std::floor(v[k]))) return false;
    return true;
}

bool is_fraction_color(const double* v) {
    for (int k = 0; k < 3; k++)
        if (!(v[k] >= 0.0 && v[k] <= 1.0)) return false;
    return true;
}

// Guesses the columns' roles from what is in them.
std::vector<int8_t> roles_from_values(const Sample& sample) {
    const size_t width = sample.columns.size();
    std::vector<int8_t> roles(width, kNoRole);
    size_t first = 0;
    // A running number before x y z.
    const std::vector<double>& numbers = sample.columns[0];
    bool running = width >= 4 && numbers.size() >= 3;
    for (size_t i = 1; running && i < numbers.size(); i++)
        running = numbers[i] > numbers[i - 1] && numbers[i] == std::floor(numbers[i]);
    if (running && numbers[0] >= 0.0 && numbers[1] - numbers[0] == 1.0) first = 1;
    auto give = [&](size_t column, Role role) {
        for (size_t k = 0; k < 3; k++)
            roles[column + k] = static_cast<int8_t>(role + static_cast<int>(k));
    };
    give(first, kRoleX);
    auto free_triple = [&](size_t column) {
        return roles[column] == kNoRole && roles[column + 1] == kNoRole && roles[column + 2] == kNoRole;
    };
    for (size_t c = first + 3; c + 3 <= width; c++) {
        const double zero =
            sample.share(c, 3, [](const double* v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; });
        if (zero > 0.5 || sample.share(c, 3, is_unit) < 0.95) continue;
        give(c, kRoleNx);
        break;
    }
    // Where an intensity or an opacity stands beside the colours, the three that differ least are the
    // colours.
    for (const auto& fits : {is_whole_color, is_fraction_color}) {
        size_t best = width;
        double best_spread = std::numeric_limits<double>::max();
        for (size_t c = first + 3; c + 3 <= width; c++) {
            if (has_role(roles, kRoleR) || !free_triple(c) || sample.share(c, 3, fits) < 0.99) continue;
            const double flat =
                sample.share(c, 3, [](const double* v) { return v[0] <= 1 && v[1] <= 1 && v[2] <= 1; });
            const double spread = sample.spread_of(c);
            if ((fits == is_whole_color && flat > 0.9) || !(spread < best_spread)) continue;
            best = c;
            best_spread = spread;
        }
        if (best < width) give(best, kRoleR);
    }
    return roles;
}

}  // namespace

TextLayout find_text_layout(const ReadJob& job) {
    TextLayout layout;
    const std::string_view bytes = job.bytes.view();
    std::vector<std::string_view> header;
    TextLines lines(bytes, bytes.starts_with("\xEF\xBB\xBF") ? 3 : 0);
    std::string_view line;
    bool found = false;
    while (!found && lines.next(line)) {
        const std::string_view text = trimmed_text(line);
        if (text.empty()) continue;
        size_t numeric = 0;
        std::string split(text);  // by every separator there is
        std::replace_if(
            split.begin(), split.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
        const std::vector<double> values = text_values_of(split, ' ', numeric);
        if (!is_text_comment(text) && numeric >= 3) {
            layout.data = lines.begin();
            found = true;
        } else if (values.size() == 1 && numeric == 1 && values[0] >= 0.0 &&
                   values[0] == std::floor(values[0]) && values[0] < 1e15) {
            layout.promised_points = static_cast<uint64_t>(values[0]);
        } else {
            header.push_back(line);
            if (header.size() > kMostHeaderLines) break;
        }
    }
    if (!found)
        job.fail("is not a point cloud that can be read: no line in it begins with three numbers (x y z).");

    const std::vector<std::string_view> sample_text = sample_lines(bytes, layout.data);
    bool decimal_comma = false;
    layout.separator = find_separator(sample_text, decimal_comma);
    if (decimal_comma)
        std::replace(job.bytes.data.get() + layout.data, job.bytes.data.get() + job.bytes.size, ',', '.');
    const Sample sample = take_sample(sample_text, layout.separator);
    const size_t width = sample.columns.size();
    if (width < 3) job.fail("has " + std::to_string(width) + " columns; a point cloud needs x, y and z.");

    if (!job.options.columns.empty()) {
        layout.roles = roles_from_names(job.options.columns);
        for (const Role role : {kRoleX, kRoleY, kRoleZ})
            if (!has_role(layout.roles, role))
                throw Error(
                    "The columns were named without x, y and z; name all three, and '-' for one to skip.");
        if (layout.roles.size() > width)
            job.fail("has " + std::to_string(width) + " columns, but " + std::to_string(layout.roles.size()) +
                     " were named.");
        for (size_t c = 0; c < layout.roles.size(); c++)
            if (layout.roles[c] == kRoleLabel) layout.label_column = job.options.columns[c];
        layout.roles.resize(width, kNoRole);
    } else {
        for (const std::string_view header_line : header) {
            std::vector<std::string> names = names_of(header_line, layout.separator);
            // R names the columns but not the column of row names before them.
            if (names.size() + 1 == width && header_line.find('"') != header_line.npos)
                names.insert(names.begin(), "");
            std::vector<int8_t> roles = roles_from_names(names);
            roles.resize(width, kNoRole);
            if (has_role(roles, kRoleX) && has_role(roles, kRoleY) && has_role(roles, kRoleZ)) {
                layout.roles = roles;
                for (size_t c = 0; c < width && c < names.size(); c++)
                    if (roles[c] == kRoleLabel) layout.label_column = names[c];
            }
        }
        if (layout.roles.empty()) {
            layout.roles = roles_from_values(sample);
            if (!header.empty() && !is_text_comment(trimmed_text(header.back())))
                job.report.warnings.emplace_back(
                    "The header names no x, y and z; the columns were told apart by their values.");
        }
    }
    for (size_t c = 0; c < width; c++)
        if (layout.roles[c] != kNoRole) layout.last_column = c;
    job.report.format = "text, " + std::to_string(width) + " columns: " + describe_roles(layout.roles);
    return layout;
}

}  // namespace treerec
