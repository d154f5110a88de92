// The first line of an L-string that says how it is to be read.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "error.h"
#include "lsystem/lstring.h"
#include "lsystem/short_number.h"

namespace treerec {

namespace {

constexpr std::string_view kBegin = "# L-string;";

// The words of the line, one after the other.
class Words {
  public:
    Words(std::string_view line, const std::string& who) : rest_(line), who_(who) {}

    std::string_view word() {
        const size_t begin = std::min(rest_.find_first_not_of(" \t\r"), rest_.size());
        const size_t end = std::min(rest_.find_first_of(" \t\r", begin), rest_.size());
        const std::string_view found = rest_.substr(begin, end - begin);
        rest_.remove_prefix(end);
        return found;
    }

    double number() {
        const std::string_view text = word();
        double value = 0.0;
        const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (failure != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
            throw Error(who_ + ", line 1: " + quote_word(text) + " is no number.");
        return value;
    }

  private:
    std::string_view rest_;
    const std::string& who_;
};

void append_word(std::string& text, const char* name, double value, double usual) {
    if (value == usual) return;
    text += ' ';
    text += name;
    text += ' ';
    append_exact(text, value);
}

}  // namespace

bool has_heading(std::string_view text) {
    return text.starts_with(kBegin);
}

LStringOptions with_heading(std::string_view text, const LStringOptions& options, const std::string& who) {
    LStringOptions told = options;
    if (!has_heading(text)) return told;
    const std::string_view line = text.substr(0, text.find('\n'));
    Words words(line.substr(kBegin.size()), who);
    for (std::string_view word = words.word(); !word.empty(); word = words.word()) {
        if (word == "dialect") {
            const LStringDialect dialect = parse_lstring_dialect(words.word());
            if (!options.dialect_is_told) told.dialect = dialect;
            told.dialect_is_told = true;
        } else if (word == "angle") {
            told.angle = words.number();
        } else if (word == "step") {
            told.step = words.number();
        } else if (word == "radius") {
            told.radius = words.number();
        } else if (word == "thinning") {
            told.thinning = words.number();
        } else if (word == "leaf") {
            told.leaf_symbols = words.word();
        } else if (word == "tropism") {
            for (int axis = 0; axis < 3; axis++)
                told.tropism[axis] = words.number();
            told.elasticity = words.number();
        }
    }
    return told;
}

std::string heading_words(const LStringOptions& options) {
    const LStringOptions usual;
    std::string text;
    if (options.dialect == LStringDialect::kPaper) text += " dialect paper";
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
            append_exact(text, value);
        }
    }
    return text;
}

std::string heading(const LStringOptions& options) {
    const std::string words = heading_words(options);
    return words.empty() ? words : std::string(kBegin) + words + "\n";
}

}  // namespace treerec
