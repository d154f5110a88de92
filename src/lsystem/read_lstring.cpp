#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "error.h"
#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "lsystem/lstring.h"
#include "lsystem/turtle.h"

namespace treerec {

namespace {

constexpr size_t kDeepest = size_t{1} << 21;  // brackets in brackets; no tree of kLargestId nodes needs more
constexpr double kFarthest = 1e12;            // metres
constexpr double kThinnest = 1e-5;            // metres; what thinning ends at

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool is_letter_or_digit(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c);
}

class Reader {
  public:
    Reader(std::string_view text, const LStringOptions& options, const Progress* progress)
        : text_(text),
          options_(options.heeds_heading ? with_heading(text, options) : options),
          progress_(progress),
          random_(options.seed) {
        require_usable(options_);
        parents_.reserve(text.size() / 24 + 1);
        positions_.reserve(text.size() / 24 + 1);
        radii_.reserve(text.size() / 24 + 1);
        flags_.reserve(text.size() / 24 + 1);
        state_.radius = options_.radius;
        add_node(kNoNode, false);
    }

    LStringTree read() {
        const bool paper = options_.dialect == LStringDialect::kPaper;
        varied_ = options_.angle_spread > 0.0 || options_.length_spread > 0.0;
        size_t steps = 0;
        while (skip_blanks()) {
            if ((++steps & 0xfff) == 0 && progress_) progress_->check();
            begin_ = at_++;
            const char symbol = text_[begin_];
            if (paper)
                obey_paper(symbol);
            else
                obey_turtle(symbol);
        }
        if (!stack_.empty()) fail(stack_.back().begin, "this [ is never closed.");
        if (outlines_ > 0) fail(outline_.begin, "this { is never closed.");
        return finish();
    }

  private:
    struct State {
        Turtle turtle;
        double radius = 0.0;
        double yaw = 0.0;  // the paper's dialect
        double pitch = 0.0;
        size_t begin = 0;  // of its bracket
        NodeId node = 0;
        int32_t level = 0;  // of the brackets in which its node was made
        int32_t depth = 0;  // of its node
        uint8_t flags = 0;
    };
    struct Outline {
        size_t begin = 0;
        DVec3 position{0.0};
        DVec3 heading{0.0};
        DVec3 up{0.0};
        double reach = 0.0;
    };

    static void require_usable(const LStringOptions& o) {
        const double numbers[] = {o.angle,     o.step,         o.tropism.x,     o.tropism.y,
                                  o.tropism.z, o.angle_spread, o.length_spread, o.elasticity};
        for (const double number : numbers)
            if (!std::isfinite(number)) throw Error("The L-string's options must be finite numbers.");
        if (!(o.radius > 0.0 && o.radius < 1e6)) throw Error("An L-string's radius must be positive.");
        if (!(o.thinning > 0.0 && o.thinning <= 1.0 && o.taper > 0.0 && o.taper <= 1.0))
            throw Error("An L-string's radii must thin by a ratio above 0 and up to 1.");
        if (!(std::abs(glm::length(o.skyward) - 1.0) < 1e-6))
            throw Error("The direction to the sky must be a unit vector.");
    }

    [[noreturn]] void fail(size_t offset, const std::string& what) const {
        throw Error("The L-string, " + place_in_text(text_, offset) + ": " + what);
    }

    // False at the end.
    bool skip_blanks() {
        while (at_ < text_.size()) {
            if (text_[at_] == '#')
                at_ = std::min(text_.find('\n', at_), text_.size());
            else if (!is_blank(text_[at_]))
                return true;
            else
                at_++;
        }
        return false;
    }

    double number() {
        skip_blanks();
        const char* first = text_.data() + at_;
        const char* last = text_.data() + text_.size();
        if (first < last && *first == '+') first++;
        double value = 0.0;
        const auto [end, failure] = std::from_chars(first, last, value);
        if (failure != std::errc() || !std::isfinite(value)) fail(at_, "here a number should stand.");
        at_ = static_cast<size_t>(end - text_.data());
        return value;
    }

    // Of a turn, which takes its number in brackets. A string of the paper's that nothing says so of would be
    // another branch.
    double turn() {
        const double angle = parameter(options_.angle);
        if (!has_parameter_ && !options_.dialect_is_told && skip_blanks() &&
            (is_digit(text_[at_]) || text_[at_] == '.'))
            fail(begin_,
                 std::string("a number without brackets, as the paper's dialect writes it. Read the ") +
                     "string as dialect paper, or write " + text_[begin_] + "(45).");
        return angle;
    }

    // The first of the parameters behind a symbol, or `otherwise`.
    double parameter(double otherwise) {
        has_parameter_ = skip_blanks() && text_[at_] == '(';
        if (!has_parameter_) return otherwise;
        const size_t bracket = at_++;
        const double first = number();
        while (skip_blanks() && text_[at_] == ',') {
            at_++;
            number();
        }
        if (at_ >= text_.size()) fail(bracket, "this ( is never closed.");
        if (text_[at_] != ')') fail(at_, "here a ) or a comma should stand.");
        at_++;
        return first;
    }

    // The paper writes both +(45) and +45.
    double paper_parameter(double otherwise) {
        if (skip_blanks() && (is_digit(text_[at_]) || text_[at_] == '.')) {
            has_parameter_ = true;
            return number();
        }
        return parameter(otherwise);
    }

    void add_node(NodeId parent, bool guess) {
        if (parents_.size() >= options_.most_nodes)
            fail(begin_, "the tree gets more than " + std::to_string(options_.most_nodes) + " nodes.");
        const DVec3& at = state_.turtle.position;
        if (!(std::abs(at.x) + std::abs(at.y) + std::abs(at.z) < kFarthest))
            fail(begin_, "the turtle leaves all bounds here.");
        const NodeId id = static_cast<NodeId>(parents_.size());
        const int32_t level = static_cast<int32_t>(stack_.size());
        if (parent != kNoNode && state_.level == level) continuations_.push_back(id);
        parents_.push_back(parent);
        positions_.push_back(state_.turtle.position);
        radii_.push_back(state_.radius);
        flags_.push_back(static_cast<uint8_t>(state_.flags | (guess ? kGuessFlag : 0)));
        state_.node = id;
        state_.level = level;
    }

    bool at_root() const { return parents_.size() == 1; }

    void push() {
        if (stack_.size() >= kDeepest) fail(begin_, "too many brackets lie in brackets.");
        stack_.push_back(state_);
        stack_.back().begin = begin_;
    }

    void pop() {
        if (stack_.empty()) fail(begin_, "this ] closes no [.");
        state_ = stack_.back();
        stack_.pop_back();
    }

    void draw(double length, bool guess) {
        if (varied_) {
            const double spread = options_.angle_spread;
            state_.turtle.turn_left(random_.uniform(-spread, spread));
            state_.turtle.pitch_up(random_.uniform(-spread, spread));
            length *= 1.0 + random_.uniform(-options_.length_spread, options_.length_spread);
        }
        state_.turtle.move(length);
        if (outlines_ > 0) {
            outline_.reach =
                std::max(outline_.reach, glm::distance(outline_.position, state_.turtle.position));
            return;
        }
        add_node(state_.node, guess);
        if (options_.elasticity != 0.0) state_.turtle.bend(options_.tropism, options_.elasticity);
    }

    void set_radius(double radius) {
        if (!(radius > 0.0) || radius > 1e6) fail(begin_, "a radius must be positive.");
        state_.radius = radius;
        if (!at_root() || has_root_radius_) return;
        radii_[0] = radius;
        has_root_radius_ = true;
    }

    void set_flags(double value) {
        if (!(value >= 0.0 && value < 8.0)) fail(begin_, "flags are a number from 0 to 7.");
        const uint8_t flags = static_cast<uint8_t>(value);
        state_.flags = flags & (kTrunkFlag | kMeasuredRadiusFlag);
        if (!at_root() || has_root_flags_) return;
        flags_[0] = flags;
        has_root_flags_ = true;
    }

    void add_leaf(char kind, double size) {
        if (outlines_ > 0) return;
        const Turtle& turtle = state_.turtle;
        leaves_.push_back({state_.node, turtle.position, turtle.heading, turtle.up, size, kind});
    }

    void leaf(char kind) {
        // ~l(0.1): the name of a leaf; a move or a turn is none.
        if (kind == 0 && at_ < text_.size() && is_letter_or_digit(text_[at_]) && text_[at_] != 'F' &&
            text_[at_] != 'f' && text_[at_] != 'G')
            kind = text_[at_++];
        add_leaf(kind, parameter(0.0));
    }

    void open_outline() {
        if (outlines_++ > 0) return;
        outline_ = {begin_, state_.turtle.position, state_.turtle.heading, state_.turtle.up, 0.0};
    }

    void close_outline() {
        if (outlines_ == 0) fail(begin_, "this } closes no {.");
        if (--outlines_ > 0) return;
        leaves_.push_back(
            {state_.node, outline_.position, outline_.heading, outline_.up, outline_.reach, '{'});
    }

    // To the end of the branch.
    void cut() {
        size_t open = 0;
        while (skip_blanks()) {
            if (text_[at_] == ']' && open-- == 0) return;
            if (text_[at_] == '[') open++;
            at_++;
        }
    }

    void obey_turtle(char symbol) {
        Turtle& turtle = state_.turtle;
        switch (symbol) {
            case 'F':
                return draw(parameter(options_.step), false);
            case 'f':
                return draw(parameter(options_.step), true);
            case '+':
                return turtle.turn_left(turn());
            case '-':
                return turtle.turn_left(-turn());
            case '&':
                return turtle.pitch_up(-turn());
            case '^':
                return turtle.pitch_up(turn());
            case '\\':
                return turtle.roll_left(parameter(options_.angle));
            case '/':
                return turtle.roll_left(-parameter(options_.angle));
            case '|':
                parameter(0.0);
                return turtle.turn_around();
            case '$':
                parameter(0.0);
                return turtle.level(options_.skyward);
            case '!': {
                const double radius = parameter(0.0);
                if (has_parameter_) return set_radius(radius);
                state_.radius = std::max(kThinnest, state_.radius * options_.thinning);
                return;
            }
            case '@':
                return set_flags(parameter(0.0));
            case '[':
                return push();
            case ']':
                return pop();
            case '~':
                return leaf(0);
            case '{':
                return open_outline();
            case '}':
                return close_outline();
            case '%':
                return cut();
            case 'G':
                if (outlines_ > 0) return draw(parameter(options_.step), false);
                parameter(0.0);
                return;
            case '.':
            case '\'':
            case ';':
                parameter(0.0);
                return;
            default:
                skip_symbol(symbol);
        }
    }

    void skip_symbol(char symbol) {
        if (!is_letter_or_digit(symbol))
            fail(begin_, quote_word({&symbol, 1}) + " is no symbol of an L-string.");
        if (options_.leaf_symbols.find(symbol) != std::string::npos) return leaf(symbol);
        parameter(0.0);
    }

    // Algorithm 6.
    void obey_paper(char symbol) {
        switch (symbol) {
            case 'F': {
                if (const double given = paper_parameter(0.0); has_parameter_) distance_ = given;
                const double spread = options_.angle_spread;
                const double yaw = (state_.yaw + random_.uniform(-spread, spread)) * kRadiansPerDegree;
                const double pitch = (state_.pitch + random_.uniform(-spread, spread)) * kRadiansPerDegree;
                const double scale = 1.0 + random_.uniform(-options_.length_spread, options_.length_spread);
                const double length = (distance_ < 0.0 ? options_.step : distance_) * scale;
                state_.turtle.position +=
                    length * DVec3(portable::cos(pitch) * portable::cos(yaw), portable::sin(pitch),
                                   portable::cos(pitch) * portable::sin(yaw));
                state_.depth++;
                state_.radius =
                    std::max(kThinnest, options_.radius * portable::pow(options_.taper, state_.depth));
                return add_node(state_.node, false);
            }
            case '+':
                state_.yaw = paper_parameter(options_.angle);
                return;
            case '-':
                state_.yaw = -paper_parameter(options_.angle);
                return;
            case '&':
                state_.pitch = paper_parameter(options_.angle);
                return;
            case '^':
                state_.pitch = -paper_parameter(options_.angle);
                return;
            case '[':
                return push();
            case ']':
                return pop();
            default:
                if (!is_letter_or_digit(symbol))
                    fail(begin_, quote_word({&symbol, 1}) + " is no symbol of the paper's L-strings.");
                parameter(0.0);
        }
    }

    LStringTree finish() {
        LStringTree result;
        Tree tree = Tree::from_arrays(parents_, positions_, radii_, flags_);
        if (progress_) progress_->check();
        for (const NodeId id : continuations_)
            tree.make_first_child(id);
        if (progress_) progress_->check();
        const std::vector<NodeId> order = tree.depth_first();
        result.tree = tree.compacted();
        if (leaves_.empty()) return result;
        std::vector<NodeId> rank(order.size());
        for (size_t i = 0; i < order.size(); i++)
            rank[order[i]] = static_cast<NodeId>(i);
        result.leaves = std::move(leaves_);
        for (LStringLeaf& leaf : result.leaves)
            leaf.node = rank[leaf.node];
        return result;
    }

    std::string_view text_;
    LStringOptions options_;
    const Progress* progress_;
    Random random_;
    size_t at_ = 0;
    size_t begin_ = 0;  // of the symbol being obeyed
    bool has_parameter_ = false;
    bool varied_ = false;
    bool has_root_radius_ = false;
    bool has_root_flags_ = false;
    double distance_ = -1.0;  // the paper's last F's
    State state_;
    std::vector<State> stack_;
    int outlines_ = 0;
    Outline outline_;
    std::vector<LStringLeaf> leaves_;
    std::vector<NodeId> parents_;
    std::vector<DVec3> positions_;
    std::vector<double> radii_;
    std::vector<uint8_t> flags_;
    std::vector<NodeId> continuations_;
};

}  // namespace

LStringTree read_lstring_with_leaves(std::string_view text, const LStringOptions& options,
                                     const Progress* progress) {
    return Reader(text, options, progress).read();
}

Tree read_lstring(std::string_view text, const LStringOptions& options, const Progress* progress) {
    return read_lstring_with_leaves(text, options, progress).tree;
}

}  // namespace treerec
