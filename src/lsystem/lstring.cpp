#include "lsystem/lstring.h"

#include <algorithm>

#include "error.h"

namespace treerec {

LStringDialect parse_lstring_dialect(std::string_view name) {
    if (name == "turtle") return LStringDialect::kTurtle;
    if (name == "paper") return LStringDialect::kPaper;
    throw Error("There is no dialect " + quote_word(name) + " of L-strings; there are turtle and paper.");
}

void require_wood(const Tree& tree, const std::string& who) {
    if (tree.size() < 2)
        throw Error(who +
                    " draws no wood: there is no F in it outside of leaves. F(0.5) draws half a metre.");
    for (const NodeId id : tree.depth_first())
        if (tree.node(id).position != tree.node(tree.root()).position) return;
    throw Error(who + " draws no wood: every F in it has a length of 0.");
}

std::string place_in_text(std::string_view text, size_t offset) {
    const std::string_view before = text.substr(0, offset);
    const size_t line = 1 + static_cast<size_t>(std::count(before.begin(), before.end(), '\n'));
    const size_t last = before.rfind('\n');
    const size_t column = before.size() - (last == std::string_view::npos ? 0 : last + 1) + 1;
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

}  // namespace treerec
