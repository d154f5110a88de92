#include "cli/commands.h"
#include "scan/read_cloud.h"

namespace treerec {

UpAxis up_axis_from(const Arguments& arguments) {
    try {
        return parse_up_axis(arguments.text("--up", "z"));
    } catch (const Error& error) {
        throw UsageError(error.what());
    }
}

std::vector<std::string> columns_from(const Arguments& arguments) {
    return parse_columns(arguments.text("--columns", ""));
}

}  // namespace treerec
