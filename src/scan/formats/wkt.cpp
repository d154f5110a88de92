#include "scan/formats/wkt.h"

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <string>
#include <vector>

namespace treerec {

namespace {

constexpr int kDeepest = 32;

// KEYWORD[value, "value", CHILD[…], …]; brackets may be round.
struct Node {
    std::string keyword;  // in capitals
    std::vector<std::string_view> values;
    std::vector<Node> children;

    bool is(std::initializer_list<std::string_view> keywords) const {
        return std::find(keywords.begin(), keywords.end(), keyword) != keywords.end();
    }
};

class Parser {
  public:
    explicit Parser(std::string_view text) : text_(text) {}

    // False where there is no such thing.
    bool parse(Node& node, int depth = 0) {
        skip_blanks();
        const std::string_view word = take_word();
        for (const char c : word)
            node.keyword += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
        skip_blanks();
        if (word.empty() || depth > kDeepest || !take_one_of("[(")) return false;
        for (;;) {
            skip_blanks();
            if (take_one_of("])")) return true;
            if (take_one_of(",")) continue;
            if (take_one_of("\"")) {
                const size_t end = text_.find('"', at_);
                if (end == text_.npos) return false;
                node.values.push_back(text_.substr(at_, end - at_));
                at_ = end + 1;
                continue;
            }
            const size_t begin = at_;
            const std::string_view value = take_word();
            if (value.empty()) return false;
            skip_blanks();
            if (at_ < text_.size() && (text_[at_] == '[' || text_[at_] == '(')) {
                at_ = begin;
                if (!parse(node.children.emplace_back(), depth + 1)) return false;
            } else {
                node.values.push_back(value);
            }
        }
    }

  private:
    void skip_blanks() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }
    std::string_view take_word() {
        const size_t end = std::min(text_.find_first_of(" \t\r\n,[]()\"", at_), text_.size());
        const std::string_view word = text_.substr(at_, end - at_);
        at_ = end;
        return word;
    }
    bool take_one_of(std::string_view characters) {
        if (at_ >= text_.size() || characters.find(text_[at_]) == characters.npos) return false;
        at_++;
        return true;
    }

    std::string_view text_;
    size_t at_ = 0;
};

double metres_of(const Node& unit) {
    double metres = 0.0;
    if (unit.values.size() < 2) return 0.0;
    const std::string_view text = unit.values[1];
    const std::from_chars_result read = std::from_chars(text.data(), text.data() + text.size(), metres);
    return read.ec == std::errc() ? metres : 0.0;
}

double own_unit(const Node& system) {
    for (const Node& child : system.children)
        if (child.is({"UNIT", "LENGTHUNIT"})) return metres_of(child);
    return 0.0;
}

bool points_up(const Node& axis) {
    return std::any_of(axis.values.begin(), axis.values.end(),
                       [](std::string_view value) { return value == "up" || value == "UP"; });
}

// The unit of the system, or else of its axes; up: of those that point to the sky.
double unit_of(const Node& system, bool up) {
    for (const Node& child : system.children)
        if (child.is({"AXIS"}) && points_up(child) == up)
            if (const double own = own_unit(child); own > 0.0) return own;
    return own_unit(system);
}

bool is_geographic(const Node& system) {
    return system.is({"GEOGCS", "GEOGCRS", "GEOGRAPHICCRS"}) ||
           (system.is({"GEODCRS", "GEODETICCRS"}) &&
            std::any_of(system.children.begin(), system.children.end(), [](const Node& child) {
                return child.is({"CS"}) && !child.values.empty() && child.values[0] == "ellipsoidal";
            }));
}

void gather(const Node& node, WktUnits& units) {
    if (node.is({"COMPD_CS", "COMPOUNDCRS", "BOUNDCRS", "SOURCECRS"})) {
        for (const Node& child : node.children)
            gather(child, units);
    } else if (node.is({"PROJCS", "PROJCRS", "PROJECTEDCRS", "LOCAL_CS", "ENGCRS", "ENGINEERINGCRS",
                        "DERIVEDPROJCRS"})) {
        units.named = true;
        units.plan = unit_of(node, false);
        for (const Node& child : node.children)
            if (child.is({"AXIS"}) && points_up(child)) units.height = unit_of(node, true);
    } else if (node.is({"VERT_CS", "VERTCRS", "VERTICALCRS"})) {
        units.named = true;
        units.height = unit_of(node, true);
    } else if (is_geographic(node)) {
        units.named = true;
        units.degrees = true;
    }
}

}  // namespace

WktUnits wkt_units(std::string_view text) {
    WktUnits units;
    Node root;
    if (Parser(text.substr(0, text.find('\0'))).parse(root)) gather(root, units);
    return units;
}

}  // namespace treerec
