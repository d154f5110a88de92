#include "exchange/lstring_file.h"

#include <cmath>

#include "error.h"
#include "exchange/finite.h"
#include "exchange/text_scan.h"
#include "file_bytes.h"

namespace treerec {

namespace {

constexpr size_t kLineLength = 100;

// What the heading says of the place in the scan. A heading without a stamp says nothing of it.
void read_place(std::string_view line, const std::string& path, ScanFrame& frame) {
    const bool stamped = line.find(" treerec ") != std::string_view::npos;
    FileStamp stamp{frame.up, frame.metres_per_unit, frame.tilt};
    if (!stamped) return;
    if (!read_stamp(line, stamp, path)) throw Error("'" + path + "', line 1, is damaged.");
    frame.up = stamp.up;
    frame.metres_per_unit = stamp.metres_per_unit;
    frame.tilt = stamp.tilt;
    constexpr std::string_view kOrigin = " origin";
    const size_t at = line.find(" origin ");
    if (at == std::string_view::npos) return;
    std::string_view rest = line.substr(at + kOrigin.size());
    for (int axis = 0; axis < 3; axis++) {
        rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
        const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r"));
        const std::optional<double> value = parse_number(word);
        if (!value || !std::isfinite(*value))
            throw Error("'" + path + "', line 1: " + quote_word(word) + " is no number.");
        frame.origin[axis] = *value;
        rest.remove_prefix(word.size());
    }
}

}  // namespace

std::string lstring_file_text(std::string_view string, const ScanFrame& frame,
                              const LStringOptions& options) {
    std::string text = "# L-string; " + stamp_text(frame) + " origin";
    for (int axis = 0; axis < 3; axis++) {
        text += ' ';
        append_number(text, frame.origin[axis]);
    }
    if (options.dialect == LStringDialect::kTurtle) text += " dialect turtle";
    text += heading_words(options);
    text += '\n';
    text.reserve(text.size() + string.size() + string.size() / kLineLength + 2);
    bool inside = false;
    char before = 0;
    size_t length = 0;
    for (const char c : string) {
        // ~ and the name of its leaf stay together.
        if (length >= kLineLength && !inside && c != '(' && before != '~') {
            text += '\n';
            length = 0;
        }
        inside = (inside || c == '(') && c != ')';
        text += c;
        length = c == '\n' ? 0 : length + 1;
        before = c;
    }
    if (text.back() != '\n') text += '\n';
    return text;
}

void write_lstring_file(const std::string& path, const Tree& tree, const LStringOptions& options,
                        const Progress* progress) {
    if (tree.empty()) throw Error("The tree is empty; there is nothing to write to '" + path + "'.");
    require_readable(tree, path, false);
    const std::string string = write_lstring(tree, tree.root(), options, progress);
    ScanFrame frame = tree.frame();
    frame.origin = frame.to_scan(tree.node(tree.root()).position);
    // Which other settings it would be read by is no matter: every number is written.
    LStringOptions plain;
    plain.dialect = options.dialect;
    write_file(path, lstring_file_text(string, frame, plain), progress);
}

LStringTree read_lstring_file(const std::string& path, const LStringOptions& options,
                              const Progress* progress) {
    return parse_lstring_file(read_file(path).view(), path, options, progress);
}

LStringTree parse_lstring_file(std::string_view bytes, const std::string& path, const LStringOptions& options,
                               const Progress* progress) {
    ScanFrame frame;
    try {
        LStringOptions told = options;
        if (has_heading(bytes)) {
            read_place(bytes.substr(0, bytes.find('\n')), path, frame);
            if (options.heeds_heading) told = with_heading(bytes, options, "'" + path + "'");
        }
        told.heeds_heading = false;
        LStringTree read = read_lstring_with_leaves(bytes, told, progress);
        read.tree.set_frame(frame);
        return read;
    } catch (const Cancelled&) {
        throw;
    } catch (const Error& error) {
        const std::string sentence = error.what();
        if (sentence.starts_with("'" + path + "'")) throw;
        throw Error("'" + path + "' holds no L-string that can be read: " + sentence);
    }
}

bool is_lstring_file(std::string_view bytes) {
    if (has_heading(bytes)) return true;
    // Its first line that says something draws wood and has nothing but a turtle's symbols and numbers; a
    // table has names or no F.
    while (const std::optional<std::string_view> line = next_line(bytes)) {
        const size_t begin = line->find_first_not_of(" \t");
        if (begin == std::string_view::npos || (*line)[begin] == '#') continue;
        return line->find('F') != std::string_view::npos &&
               line->find_first_not_of(" \tFf[]()!+-&^\\/|$~{}%@.,0123456789eE") == std::string_view::npos;
    }
    return false;
}

}  // namespace treerec
