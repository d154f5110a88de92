// Arithmetic in grammars: parsed once, evaluated often.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/random.h"

namespace treerec {

// Where a parser stands in a grammar's text. Comments (# to the end of the line) are blanks.
class GrammarText {
  public:
    explicit GrammarText(std::string_view text) : text_(text) {}

    // Throws Error: "The grammar, line 3, column 7: " + what.
    [[noreturn]] void fail(size_t offset, const std::string& what) const;
    [[noreturn]] void fail(const std::string& what) const { fail(at, what); }

    // Skips blanks, and the ends of lines too where `lines`.
    void skip(bool lines = false);
    bool ended() const { return at >= text_.size(); }
    // The next byte, or 0 at the end.
    char next(size_t ahead = 0) const { return at + ahead < text_.size() ? text_[at + ahead] : '\0'; }
    bool starts_with(std::string_view word) const { return text_.substr(at).starts_with(word); }
    std::string_view rest() const { return text_.substr(at); }
    // A name of letters, digits and _, or nothing.
    std::string_view name();
    // "->" or "-->".
    bool at_arrow() const { return starts_with("->") || starts_with("-->"); }

    size_t at = 0;

  private:
    std::string_view text_;
};

// Numbers, names, + - * / % ^ (a power), comparisons (= and == are the same), & | ! (also && ||) and
// functions: sin cos tan asin acos atan atan2 (degrees), sqrt exp log abs floor ceil round sign min max pow,
// uniform(low, high) and normal(mean, deviation). What is true is 1, what is not 0.
class Expression {
  public:
    // variables: names and where evaluate() finds them. in_brackets: it may run over the ends of lines.
    // Throws Error with line and column.
    static Expression parse(GrammarText& text, const std::map<std::string, int, std::less<>>& variables,
                            const std::map<std::string, double, std::less<>>& constants,
                            bool in_brackets = false);

    bool empty() const { return code_.empty(); }
    // May return what is not finite.
    double evaluate(const double* variables, Random& random) const;
    // Of its first byte in the grammar, for errors.
    size_t offset() const { return offset_; }

  private:
    friend class ExpressionParser;
    struct Step {
        uint8_t operation = 0;
        int32_t variable = 0;
        double number = 0.0;
    };

    std::vector<Step> code_;
    size_t offset_ = 0;
};

}  // namespace treerec
