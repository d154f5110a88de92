#include "cli/commands.h"
#include "pipeline/export.h"
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

int levels_from(const Arguments& arguments) {
    return static_cast<int>(arguments.whole("--levels", 1, 1, kMostLevels));
}

}  // namespace treerec
