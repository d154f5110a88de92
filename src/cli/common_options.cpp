#include "cli/commands.h"

namespace treerec {

UpAxis up_axis_from(const Arguments& arguments) {
    try {
        return parse_up_axis(arguments.text("--up", "z"));
    } catch (const Error& error) {
        throw UsageError(error.what());
    }
}

std::vector<std::string> columns_from(const Arguments& arguments) {
    if (!arguments.has("--columns")) return {};
    std::vector<std::string> columns(1);
    for (char c : arguments.text("--columns", "")) {
        if (c == ',')
            columns.emplace_back();
        else if (c != ' ')
            columns.back() += c;
    }
    return columns;
}

}  // namespace treerec
