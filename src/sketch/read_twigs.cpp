#include "sketch/read_twigs.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "error.h"
#include "file_bytes.h"

namespace treerec {

namespace {

constexpr size_t kLargest = size_t{64} << 20U;  // bytes: pictures of twigs are in it, too

// The text in quotes that begins at `at`, which moves behind it; nothing where it does not end.
std::optional<std::string> quoted(std::string_view text, size_t& at) {
    std::string value;
    for (at++; at < text.size(); at++) {
        if (text[at] == '"') {
            at++;
            return value;
        }
        if (text[at] != '\\' || at + 1 >= text.size()) {
            value += text[at];
            continue;
        }
        at++;
        value += text[at] == 'n' ? '\n' : text[at] == 't' ? '\t' : text[at];
    }
    return {};
}

}  // namespace

std::vector<std::string> read_twig_strings(const std::string& path) {
    const FileBytes file = read_file(path);
    const std::string_view text = file.view();
    if (text.size() > kLargest)
        throw Error("'" + path + "' is larger than 64 MiB, which no library of twigs is.");
    if (text.starts_with("RSRC") || text.starts_with("RSCC"))
        throw Error("'" + path + "' is a binary resource; save the library as text, with the ending .tres.");
    if (!text.starts_with("[gd_resource")) return {std::string(text)};
    std::vector<std::string> strings;
    std::optional<std::string> own;
    int dialect = -1;
    const auto end_section = [&] {
        if (own && !own->empty()) strings.push_back(with_dialect(std::move(*own), dialect));
        own.reset();
        dialect = -1;
    };
    constexpr std::string_view kString = "lstring = \"", kDialect = "dialect = ";
    bool line_begins = true;
    for (size_t at = 0; at < text.size();) {
        if (line_begins && text[at] == '[') end_section();
        if (line_begins && text.substr(at).starts_with(kString)) {
            at += kString.size() - 1;
            own = quoted(text, at);
            line_begins = false;
            continue;
        }
        if (line_begins && text.substr(at).starts_with(kDialect) && at + kDialect.size() < text.size())
            dialect = text[at + kDialect.size()] - '0';
        if (text[at] == '"') {
            // A text may have lines that look like properties.
            if (!quoted(text, at)) break;
            line_begins = false;
            continue;
        }
        line_begins = text[at] == '\n';
        at++;
    }
    end_section();
    if (strings.empty()) throw Error("'" + path + "' is a resource, but has no twigs in it.");
    return strings;
}

// As Twig.get_string() has it: of two words in a line the later one is heard.
std::string with_dialect(std::string string, int dialect) {
    if (dialect != 0 && dialect != 1) return string;
    const std::string word = dialect == 1 ? " dialect paper" : " dialect turtle";
    constexpr std::string_view kHeading = "# L-string;";
    if (!string.starts_with(kHeading)) return std::string(kHeading) + word + "\n" + string;
    string.insert(std::min(string.find('\n'), string.size()), word);
    return string;
}

}  // namespace treerec
