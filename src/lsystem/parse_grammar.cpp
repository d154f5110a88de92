#include <algorithm>
#include <cmath>
#include <map>

#include "error.h"
#include "lsystem/grammar.h"

namespace treerec {

namespace {

constexpr std::string_view kMarks = "+-&^\\/|$!~%{}.'@;";
constexpr size_t kLongestContext = 32;
constexpr int kMostParameters = 16;
constexpr int kMostIterations = 10000;

bool is_symbol(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           (c != '\0' && kMarks.find(c) != std::string_view::npos);
}

class GrammarParser {
  public:
    explicit GrammarParser(std::string_view text) : text_(text), whole_(text) {
        // Its digits are symbols, also behind a turn, and what it writes has no heading.
        grammar_.turtle.dialect_is_told = true;
        grammar_.turtle.heeds_heading = false;
    }

    Grammar parse() {
        while (next_statement())
            statement();
        if (!has_axiom_) text_.fail("there is no axiom; write 'axiom: ' and the string to begin with.");
        // Rules with a context are tried first (ABOP 1.8).
        std::stable_partition(grammar_.rules.begin(), grammar_.rules.end(), [](const GrammarRule& rule) {
            return !rule.left.empty() || !rule.right.empty();
        });
        return std::move(grammar_);
    }

  private:
    using Variables = std::map<std::string, int, std::less<>>;

    // False at the end. A #define or #ignore is a statement, any other # a comment.
    bool next_statement() {
        while (true) {
            while (text_.next() == ' ' || text_.next() == '\t' || text_.next() == '\r' ||
                   text_.next() == '\n')
                text_.at++;
            if (text_.ended()) return false;
            if (text_.next() != '#' || text_.starts_with("#define") || text_.starts_with("#ignore"))
                return true;
            text_.skip();
        }
    }

    void statement() {
        const size_t begin = text_.at;
        indent_ = indent_at(begin);
        const bool directive = text_.next() == '#';
        if (directive) text_.at++;
        const std::string_view word = text_.name();
        text_.skip();
        if (directive && word == "define") {
            define();
        } else if (directive) {
            if (text_.next() == ':') text_.at++;
            setting("ignore", begin);
        } else if (text_.next() == '=' && !word.empty()) {
            text_.at++;
            if (is_setting(word))
                setting(word, begin);
            else
                constants_.insert_or_assign(std::string(word), number());
        } else if (text_.next() == ':' && is_setting(word)) {
            text_.at++;
            setting(word, begin);
        } else if (text_.next() == ':' && is_label(word)) {
            text_.at++;
            rule();
        } else if (text_.next() == ':' && word.size() > 1) {
            text_.fail(begin, "there is no setting " + quote_word(word) + "; there are " + kSettingList);
        } else {
            text_.at = begin;
            rule();
        }
        end_statement();
    }

    void end_statement() {
        text_.skip();
        if (!text_.ended() && text_.next() != '\n')
            text_.fail("here the line should end; what is " + quote_word({&text_.rest().front(), 1}) + "?");
    }

    static constexpr const char* kSettingList =
        "axiom, angle, step, radius, thinning, iterations, seed, leaf, leaf_preset, ignore and "
        "tropism.";

    static bool is_setting(std::string_view word) {
        static constexpr std::string_view kNames[] = {"axiom",       "angle",      "step",   "radius",
                                                      "thinning",    "iterations", "seed",   "leaf",
                                                      "leaf_preset", "ignore",     "tropism"};
        return std::find(std::begin(kNames), std::end(kNames), word) != std::end(kNames);
    }

    // p1: as ABOP numbers its productions.
    static bool is_label(std::string_view word) {
        return word.size() > 1 && word[0] == 'p' &&
               word.find_first_not_of("0123456789", 1) == std::string_view::npos;
    }

    void define() {
        text_.skip();
        const std::string name(text_.name());
        if (name.empty()) text_.fail("here the name of a constant should stand.");
        constants_.insert_or_assign(name, number());
    }

    // A constant expression.
    double number() {
        const Expression expression = Expression::parse(text_, {}, constants_);
        Random random(1);
        const double value = expression.evaluate(nullptr, random);
        if (!std::isfinite(value)) text_.fail(expression.offset(), "this is no finite number.");
        return value;
    }

    double number_within(double least, double most, const char* what) {
        text_.skip();
        const size_t begin = text_.at;
        const double value = number();
        if (!(value >= least && value <= most)) text_.fail(begin, what);
        return value;
    }

    void setting(std::string_view word, size_t begin) {
        LStringOptions& turtle = grammar_.turtle;
        if (word == "axiom") {
            if (has_axiom_) text_.fail(begin, "there is an axiom already.");
            grammar_.axiom = successor({});
            has_axiom_ = true;
        } else if (word == "angle") {
            turtle.angle = number();
        } else if (word == "step") {
            turtle.step = number();
        } else if (word == "radius") {
            turtle.radius = number_within(1e-9, 1e3, "the radius must be positive, in metres.");
        } else if (word == "thinning") {
            turtle.thinning = number_within(1e-9, 1.0, "thinning is a ratio above 0 and up to 1.");
        } else if (word == "iterations") {
            const double value =
                number_within(0.0, kMostIterations, "iterations are a number from 0 to 10000.");
            grammar_.iterations = static_cast<int>(value);
        } else if (word == "seed") {
            grammar_.seed = static_cast<uint64_t>(
                number_within(0.0, 9e15, "the seed is a whole number that is not negative."));
        } else if (word == "leaf") {
            for (const char symbol : symbols())
                turtle.leaf_symbols += symbol;
        } else if (word == "leaf_preset") {
            text_.skip();
            grammar_.leaf_preset = text_.name();
            if (grammar_.leaf_preset.empty()) text_.fail("here the name of a leaf preset should stand.");
        } else if (word == "ignore") {
            for (const char symbol : symbols())
                grammar_.ignored[static_cast<unsigned char>(symbol)] = true;
        } else {
            tropism();
        }
    }

    void tropism() {
        double values[4] = {};
        for (int i = 0; i < 4; i++) {
            text_.skip();
            if (i > 0) {
                if (text_.next() != ',')
                    text_.fail("tropism takes four numbers: x, y, z of where to and the elasticity.");
                text_.at++;
            }
            values[i] = number();
        }
        grammar_.turtle.tropism = {values[0], values[1], values[2]};
        grammar_.turtle.elasticity = values[3];
    }

    std::string symbols() {
        std::string found;
        for (text_.skip(); !text_.ended() && text_.next() != '\n'; text_.skip()) {
            const char c = text_.next();
            if (!is_symbol(c)) text_.fail(quote_word({&c, 1}) + " is no symbol.");
            found += c;
            text_.at++;
        }
        return found;
    }

    // Whether a list of symbols goes on with c. open: where its brackets stand that are not closed yet.
    bool goes_on(char c, std::vector<size_t>& open) {
        if (c == '[') {
            open.push_back(text_.at);
        } else if (c == ']') {
            if (open.empty()) text_.fail("this ] closes no [.");
            open.pop_back();
        } else {
            return is_symbol(c);
        }
        return true;
    }

    // Symbols with formal parameters, up to what is none; a lone * is an empty list.
    std::vector<GrammarPattern> patterns(Variables& variables) {
        std::vector<GrammarPattern> found;
        std::vector<size_t> open;
        text_.skip();
        if (text_.next() == '*') {
            text_.at++;
            return found;
        }
        for (text_.skip(); !text_.at_arrow(); text_.skip()) {
            const char c = text_.next();
            if (!goes_on(c, open)) break;
            if (found.size() >= kLongestContext) text_.fail("a context has at most 32 symbols.");
            text_.at++;
            found.push_back({c, static_cast<int>(variables.size()), 0});
            if (c != '[' && c != ']') formals(found.back(), variables);
        }
        if (!open.empty()) text_.fail(open.back(), "this [ is never closed.");
        return found;
    }

    void formals(GrammarPattern& pattern, Variables& variables) {
        text_.skip();
        if (text_.next() != '(') return;
        do {
            text_.at++;
            text_.skip();
            const size_t begin = text_.at;
            const std::string name(text_.name());
            if (name.empty()) text_.fail("here the name of a parameter should stand.");
            if (!variables.emplace(name, static_cast<int>(variables.size())).second)
                text_.fail(begin, quote_word(name) + " is named twice in this rule.");
            if (++pattern.count > kMostParameters) text_.fail(begin, "a symbol has at most 16 parameters.");
            text_.skip();
        } while (text_.next() == ',');
        if (text_.next() != ')') text_.fail("here a ) or a comma should stand.");
        text_.at++;
    }

    void rule() {
        GrammarRule rule;
        const std::string_view before = whole_.substr(0, text_.at);
        rule.line = static_cast<int>(1 + std::count(before.begin(), before.end(), '\n'));
        Variables variables;
        size_t begin = text_.at;
        std::vector<GrammarPattern> strict = patterns(variables);
        text_.skip();
        if (text_.next() == '<') {
            rule.left = std::move(strict);
            for (const GrammarPattern& pattern : rule.left)
                if (pattern.symbol == '[' || pattern.symbol == ']')
                    text_.fail(begin, "a context to the left has no brackets.");
            text_.at++;
            begin = text_.at;
            strict = patterns(variables);
            text_.skip();
        }
        if (text_.next() == '>') {
            text_.at++;
            rule.right = patterns(variables);
            text_.skip();
        }
        if (strict.size() != 1 || strict[0].symbol == '[')
            text_.fail(begin, "a rule begins with one symbol, and maybe its context: A < B > C -> D.");
        rule.strict = strict[0];
        rule.variables = static_cast<int>(variables.size());
        if (text_.next() == ':') {
            text_.at++;
            text_.skip();
            if (text_.next() == '*')
                text_.at++;
            else
                rule.condition = Expression::parse(text_, variables, constants_);
            text_.skip();
        }
        if (!text_.at_arrow()) text_.fail("here the arrow -> of a rule should stand.");
        text_.at += text_.starts_with("-->") ? 3 : 2;
        rule.successor = successor(variables);
        text_.skip();
        if (text_.next() == ':') {
            text_.at++;
            rule.weight = Expression::parse(text_, variables, constants_);
        }
        grammar_.rules.push_back(std::move(rule));
    }

    // What stands behind an arrow or the axiom: * for nothing.
    std::vector<GrammarModule> successor(const Variables& variables) {
        std::vector<GrammarModule> modules;
        std::vector<size_t> open;
        text_.skip(true);
        if (text_.next() == '*') {
            text_.at++;
            return modules;
        }
        for (;; skip_within(!open.empty())) {
            const char c = text_.next();
            if (!goes_on(c, open)) break;
            text_.at++;
            modules.push_back({c, {}});
            if (c != '[' && c != ']') actuals(modules.back(), variables);
        }
        if (!open.empty()) text_.fail(open.back(), "this [ is never closed.");
        if (modules.empty()) text_.fail("here symbols should stand, or * for none.");
        return modules;
    }

    // Blanks, and the ends of lines where brackets are open or the next line is indented more deeply than the
    // statement.
    void skip_within(bool in_brackets) {
        text_.skip(in_brackets);
        while (text_.next() == '\n') {
            GrammarText ahead = text_;
            ahead.skip(true);
            if (ahead.ended() || indent_at(ahead.at) <= indent_) return;
            text_ = ahead;
        }
    }

    size_t indent_at(size_t offset) const {
        const size_t end = whole_.substr(0, offset).rfind('\n');
        return end == std::string_view::npos ? offset : offset - end - 1;
    }

    void actuals(GrammarModule& module, const Variables& variables) {
        text_.skip();
        if (text_.next() != '(') return;
        const size_t bracket = text_.at;
        do {
            text_.at++;
            text_.skip(true);
            module.parameters.push_back(Expression::parse(text_, variables, constants_, true));
            if (module.parameters.size() > kMostParameters)
                text_.fail(bracket, "a symbol has at most 16 parameters.");
            text_.skip(true);
        } while (text_.next() == ',');
        if (text_.ended()) text_.fail(bracket, "this ( is never closed.");
        if (text_.next() != ')') text_.fail("here a ) or a comma should stand.");
        text_.at++;
    }

    GrammarText text_;
    std::string_view whole_;
    Grammar grammar_;
    bool has_axiom_ = false;
    size_t indent_ = 0;  // of the statement being read
    std::map<std::string, double, std::less<>> constants_;
};

}  // namespace

Grammar Grammar::parse(std::string_view text) {
    return GrammarParser(text).parse();
}

bool is_grammar(std::string_view text) {
    GrammarText at(text);
    while (!at.ended()) {
        at.skip(true);
        const bool named = at.name() == "axiom";
        at.skip();
        if (named && (at.next() == ':' || at.next() == '=')) return true;
        at.at = std::min(text.find('\n', at.at), text.size());
    }
    return false;
}

}  // namespace treerec
