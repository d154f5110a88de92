#include "exchange/lstring_file.h"

#include <cmath>

#include "error.h"
#include "exchange/text_scan.h"
#include "file_bytes.h"

namespace treerec {

namespace {

constexpr std::string_view kBegin = "# L-string;";
constexpr size_t kLineLength = 100;

// The words of the comment behind the stamp, one after the other.
class Header {
  public:
    Header(std::string_view line, const std::string& path) : rest_(line), path_(path) {}

    std::string_view word() {
        const size_t begin = std::min(rest_.find_first_not_of(" \t"), rest_.size());
        const size_t end = std::min(rest_.find_first_of(" \t", begin), rest_.size());
        const std::string_view found = rest_.substr(begin, end - begin);
        rest_.remove_prefix(end);
        return found;
    }

    double number() {
        const std::string_view text = word();
        const std::optional<double> value = parse_number(text);
        if (!value || !std::isfinite(*value))
            throw Error("'" + path_ + "', line 1: " + quote_word(text) + " is no number.");
        return *value;
    }

    DVec3 vector() {
        const double x = number();
        const double y = number();
        return {x, y, number()};
    }

  private:
    std::string_view rest_;
    const std::string& path_;
};

void read_header(std::string_view line, const std::string& path, ScanFrame& frame, LStringOptions& options) {
    FileStamp stamp{frame.up, frame.metres_per_unit, frame.tilt};
    if (!read_stamp(line, stamp, path)) throw Error("'" + path + "', line 1, is damaged.");
    frame.up = stamp.up;
    frame.metres_per_unit = stamp.metres_per_unit;
    frame.tilt = stamp.tilt;
    Header header(line, path);
    for (std::string_view word = header.word(); !word.empty(); word = header.word()) {
        if (word == "origin")
            frame.origin = header.vector();
        else if (word == "dialect")
            options.dialect = parse_lstring_dialect(header.word());
        else if (word == "angle")
            options.angle = header.number();
        else if (word == "step")
            options.step = header.number();
        else if (word == "radius")
            options.radius = header.number();
        else if (word == "thinning")
            options.thinning = header.number();
        else if (word == "leaf")
            options.leaf_symbols = header.word();
        else if (word == "tropism") {
            options.tropism = header.vector();
            options.elasticity = header.number();
        }
    }
}

void append_word(std::string& text, const char* name, double value, double usual) {
    if (value == usual) return;
    text += ' ';
    text += name;
    text += ' ';
    append_number(text, value);
}

}  // namespace

std::string lstring_file_text(std::string_view string, const ScanFrame& frame,
                              const LStringOptions& options) {
    const LStringOptions usual;
    std::string text(kBegin);
    text += ' ' + stamp_text(frame) + " origin";
    for (int axis = 0; axis < 3; axis++) {
        text += ' ';
        append_number(text, frame.origin[axis]);
    }
    text += options.dialect == LStringDialect::kPaper ? " dialect paper" : " dialect turtle";
    append_word(text, "angle", options.angle, usual.angle);
    append_word(text, "step", options.step, usual.step);
    append_word(text, "radius", options.radius, usual.radius);
    append_word(text, "thinning", options.thinning, usual.thinning);
    if (!options.leaf_symbols.empty()) text += " leaf " + options.leaf_symbols;
    if (options.elasticity != 0.0) {
        text += " tropism";
        for (const double value :
             {options.tropism.x, options.tropism.y, options.tropism.z, options.elasticity}) {
            text += ' ';
            append_number(text, value);
        }
    }
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
    LStringOptions told = options;
    ScanFrame frame;
    try {
        if (is_lstring_file(bytes)) {
            std::string_view rest = bytes;
            read_header(next_line(rest).value_or(""), path, frame, told);
        }
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
    return bytes.starts_with(kBegin);
}

}  // namespace treerec
