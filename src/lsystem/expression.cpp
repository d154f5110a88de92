#include "lsystem/expression.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "error.h"
#include "geometry/portable_math.h"
#include "lsystem/lstring.h"
#include "lsystem/turtle.h"

namespace treerec {

namespace {

enum Operation : uint8_t {
    kNumber,
    kVariable,
    kNegate,
    kNot,
    kAdd,
    kSubtract,
    kMultiply,
    kDivide,
    kModulo,
    kPower,
    kLess,
    kLessOrEqual,
    kGreater,
    kGreaterOrEqual,
    kEqual,
    kUnequal,
    kAnd,
    kOr,
    kFirstFunction
};

struct Function {
    const char* name;
    int arguments;
    double (*call)(const double* arguments, Random& random);
};

double to_degrees(double radians) {
    return radians / kRadiansPerDegree;
}

const Function kFunctions[] = {
    {"sin", 1, [](const double* x, Random&) { return portable::sin(x[0] * kRadiansPerDegree); }},
    {"cos", 1, [](const double* x, Random&) { return portable::cos(x[0] * kRadiansPerDegree); }},
    {"tan", 1, [](const double* x, Random&) { return portable::tan(x[0] * kRadiansPerDegree); }},
    {"asin", 1, [](const double* x, Random&) { return to_degrees(portable::asin(x[0])); }},
    {"acos", 1, [](const double* x, Random&) { return to_degrees(portable::acos(x[0])); }},
    {"atan", 1, [](const double* x, Random&) { return to_degrees(portable::atan(x[0])); }},
    {"atan2", 2, [](const double* x, Random&) { return to_degrees(portable::atan2(x[0], x[1])); }},
    {"sqrt", 1, [](const double* x, Random&) { return std::sqrt(x[0]); }},
    {"exp", 1, [](const double* x, Random&) { return portable::exp(x[0]); }},
    {"log", 1, [](const double* x, Random&) { return portable::log(x[0]); }},
    {"abs", 1, [](const double* x, Random&) { return std::abs(x[0]); }},
    {"floor", 1, [](const double* x, Random&) { return std::floor(x[0]); }},
    {"ceil", 1, [](const double* x, Random&) { return std::ceil(x[0]); }},
    {"round", 1, [](const double* x, Random&) { return std::round(x[0]); }},
    {"sign", 1, [](const double* x, Random&) { return double((x[0] > 0.0) - (x[0] < 0.0)); }},
    {"min", 2, [](const double* x, Random&) { return std::min(x[0], x[1]); }},
    {"max", 2, [](const double* x, Random&) { return std::max(x[0], x[1]); }},
    {"pow", 2, [](const double* x, Random&) { return portable::pow(x[0], x[1]); }},
    {"uniform", 2, [](const double* x, Random& random) { return random.uniform(x[0], x[1]); }},
    {"normal", 2, [](const double* x, Random& random) { return x[0] + x[1] * random.normal(); }},
};

constexpr int kDeepest = 100;  // brackets in brackets
constexpr int kMostValues = 64;

bool is_name_start(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

}  // namespace

void GrammarText::fail(size_t offset, const std::string& what) const {
    throw Error("The grammar, " + place_in_text(text_, offset) + ": " + what);
}

void GrammarText::skip(bool lines) {
    while (at < text_.size()) {
        const char c = text_[at];
        if (c == '#')
            at = std::min(text_.find('\n', at), text_.size());
        else if (c == ' ' || c == '\t' || c == '\r' || (lines && c == '\n'))
            at++;
        else
            return;
    }
}

std::string_view GrammarText::name() {
    if (!is_name_start(next())) return {};
    const size_t begin = at;
    while (is_name_start(next()) || is_digit(next()))
        at++;
    return text_.substr(begin, at - begin);
}

class ExpressionParser {
  public:
    ExpressionParser(GrammarText& text, const std::map<std::string, int, std::less<>>& variables,
                     const std::map<std::string, double, std::less<>>& constants, bool in_brackets)
        : text_(text), variables_(variables), constants_(constants), brackets_(in_brackets ? 1 : 0) {}

    Expression parse() {
        skip();
        result_.offset_ = text_.at;
        any_of(0);
        return std::move(result_);
    }

  private:
    struct Binary {
        std::string_view word;
        Operation operation;
        int level;  // what binds more tightly stands higher
    };
    // Longer words before those that they begin with.
    static constexpr Binary kBinaries[] = {
        {"||", kOr, 0},      {"|", kOr, 0},           {"&&", kAnd, 1},
        {"&", kAnd, 1},      {"<=", kLessOrEqual, 2}, {">=", kGreaterOrEqual, 2},
        {"==", kEqual, 2},   {"!=", kUnequal, 2},     {"<", kLess, 2},
        {">", kGreater, 2},  {"=", kEqual, 2},        {"+", kAdd, 3},
        {"-", kSubtract, 3}, {"*", kMultiply, 4},     {"/", kDivide, 4},
        {"%", kModulo, 4}};
    static constexpr int kTightest = 5;

    // Inside brackets an expression may run over the ends of lines.
    void skip() { text_.skip(brackets_ > 0); }

    void emit(uint8_t operation, int taken, double number = 0.0, int32_t variable = 0) {
        result_.code_.push_back({operation, variable, number});
        values_ += 1 - taken;
        if (values_ > kMostValues) text_.fail("this expression is too long.");
    }

    // Left-associative operators of this level and above.
    void any_of(int level) {
        if (level == kTightest) return unary();
        any_of(level + 1);
        while (true) {
            skip();
            const Binary* found = nullptr;
            for (const Binary& binary : kBinaries)
                if (!found && text_.starts_with(binary.word)) found = &binary;
            if (!found || found->level != level || text_.at_arrow()) return;
            text_.at += found->word.size();
            any_of(level + 1);
            emit(found->operation, 2);
        }
    }

    // -x^2 is -(x^2), as in ABOP's language and in mathematics.
    void unary() {
        skip();
        if (++depth_ > kDeepest) text_.fail("this expression is too deep.");
        const char sign = text_.next();
        if ((sign == '-' && !text_.at_arrow()) || sign == '+' || sign == '!') {
            text_.at++;
            unary();
            if (sign != '+') emit(sign == '-' ? kNegate : kNot, 1);
        } else {
            primary();
            skip();
            if (text_.next() == '^') {
                text_.at++;
                unary();  // to the right first: 2^3^2 is 2^9
                emit(kPower, 2);
            }
        }
        depth_--;
    }

    void primary() {
        const size_t begin = text_.at;
        if (text_.next() == '(') {
            text_.at++;
            brackets_++;
            any_of(0);
            close(begin);
        } else if (is_digit(text_.next()) || text_.next() == '.') {
            number();
        } else if (const std::string_view name = text_.name(); name.empty()) {
            text_.fail("here a number, a name or a ( should stand.");
        } else {
            skip();
            if (text_.next() == '(')
                call(name, begin);
            else
                value(name, begin);
        }
    }

    void close(size_t opened) {
        skip();
        if (text_.next() != ')') text_.fail(text_.ended() ? opened : text_.at, "here a ) is missing.");
        text_.at++;
        brackets_--;
    }

    void number() {
        const std::string_view rest = text_.rest();
        double value = 0.0;
        const auto [end, failure] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
        if (failure != std::errc()) text_.fail("here a number should stand.");
        text_.at += static_cast<size_t>(end - rest.data());
        emit(kNumber, 0, value);
    }

    void value(std::string_view name, size_t begin) {
        if (const auto variable = variables_.find(name); variable != variables_.end())
            return emit(kVariable, 0, 0.0, variable->second);
        if (const auto constant = constants_.find(name); constant != constants_.end())
            return emit(kNumber, 0, constant->second);
        text_.fail(begin, "nothing is called " + quote_word(name) + " here.");
    }

    void call(std::string_view name, size_t begin) {
        const auto* function = std::find_if(std::begin(kFunctions), std::end(kFunctions),
                                            [&](const Function& f) { return name == f.name; });
        if (function == std::end(kFunctions))
            text_.fail(begin, "there is no function " + quote_word(name) + ".");
        text_.at++;
        brackets_++;
        for (int i = 0; i < function->arguments; i++) {
            if (i > 0) {
                skip();
                if (text_.next() != ',')
                    text_.fail(std::string(name) + "() takes " + std::to_string(function->arguments) +
                               " numbers with a comma between them.");
                text_.at++;
            }
            any_of(0);
        }
        close(begin);
        emit(static_cast<uint8_t>(kFirstFunction + (function - kFunctions)), function->arguments);
    }

    GrammarText& text_;
    const std::map<std::string, int, std::less<>>& variables_;
    const std::map<std::string, double, std::less<>>& constants_;
    int brackets_;
    Expression result_;
    int depth_ = 0;
    int values_ = 0;
};

Expression Expression::parse(GrammarText& text, const std::map<std::string, int, std::less<>>& variables,
                             const std::map<std::string, double, std::less<>>& constants, bool in_brackets) {
    return ExpressionParser(text, variables, constants, in_brackets).parse();
}

double Expression::evaluate(const double* variables, Random& random) const {
    double stack[kMostValues + 1];
    double* top = stack;  // one past the last value
    for (const Step& step : code_) {
        switch (step.operation) {
            case kNumber:
                *top++ = step.number;
                continue;
            case kVariable:
                *top++ = variables[step.variable];
                continue;
            case kNegate:
                top[-1] = -top[-1];
                continue;
            case kNot:
                top[-1] = top[-1] == 0.0;
                continue;
            default:
                break;
        }
        if (step.operation >= kFirstFunction) {
            const Function& function = kFunctions[step.operation - kFirstFunction];
            top -= function.arguments;
            *top = function.call(top, random);
            top++;
            continue;
        }
        const double b = *--top;
        double& a = top[-1];
        switch (step.operation) {
            case kAdd:
                a += b;
                break;
            case kSubtract:
                a -= b;
                break;
            case kMultiply:
                a *= b;
                break;
            case kDivide:
                a /= b;
                break;
            case kModulo:
                a = std::fmod(a, b);
                break;
            case kPower:
                a = portable::pow(a, b);
                break;
            case kLess:
                a = a < b;
                break;
            case kLessOrEqual:
                a = a <= b;
                break;
            case kGreater:
                a = a > b;
                break;
            case kGreaterOrEqual:
                a = a >= b;
                break;
            case kEqual:
                a = a == b;
                break;
            case kUnequal:
                a = a != b;
                break;
            case kAnd:
                a = a != 0.0 && b != 0.0;
                break;
            default:
                a = a != 0.0 || b != 0.0;
        }
    }
    return stack[0];
}

}  // namespace treerec
