#include <cstdio>
#include <filesystem>
#include <fstream>

#include "cli/commands.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"
#include "pipeline/cleaned_cloud.h"
#include "pipeline/export.h"
#include "scan/formats/read_cloud.h"

namespace treerec {

UpAxis up_axis_from(const Arguments& arguments) {
    try {
        return parse_up_axis(arguments.text("--up", "z"));
    } catch (const Error& error) {
        throw UsageError(error.what());
    }
}

ReadCloudOptions read_options_from(const Arguments& arguments) {
    ReadCloudOptions options;
    options.columns = parse_columns(arguments.text("--columns", ""));
    try {
        options.classes = parse_classes(arguments.text("--classes", ""));
    } catch (const Error& error) {
        throw UsageError(error.what());
    }
    return options;
}

Tree skeleton_from(const Arguments& arguments, const std::string& path, const std::string& option,
                   std::optional<LStringDialect> dialect) {
    const SkeletonChoice choice(up_axis_from(arguments), arguments.whole(option, 0, 1, 1'000'000'000),
                                dialect);
    SkeletonReport report;
    Tree tree = read_skeleton(path, choice, &report);
    for (const std::string& warning : report.warnings)
        std::fprintf(stderr, "Warning: %s\n", warning.c_str());
    return tree;
}

int levels_from(const Arguments& arguments) {
    return static_cast<int>(arguments.whole("--levels", 1, 1, kMostLevels));
}

ExportOptions exports_from(const Arguments& arguments, const std::string& leaves) {
    ExportOptions exports;
    exports.textures = arguments.text(leaves, exports.textures);
    exports.seed = arguments.whole("--seed", 1, 0, UINT64_MAX);
    exports.levels = levels_from(arguments);
    exports.pictures_beside = arguments.has("--pictures-beside");
    try {
        exports.leaves = leaf_preset(exports.textures);
    } catch (const Error& error) {
        throw UsageError(error.what());
    }
    return exports;
}

void require_own(const std::string& path, std::string_view mark, const std::string& what) {
    std::error_code failure;
    if (!std::filesystem::is_regular_file(path_of(path), failure)) return;
    std::ifstream stream(path_of(path), std::ios::binary);
    std::string begin(4096, '\0');
    stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    begin.resize(static_cast<size_t>(stream.gcount()));
    if (stream.bad() || (!begin.empty() && begin.find(mark) == std::string::npos))
        throw UsageError("'" + path + "' is there already and " + what +
                         "; it was left as it is. Name another file, or remove that one.");
}

void require_own_cloud(const std::string& path) {
    require_own(path, kCleanedMark,
                extension_of(path) == "ply" ? "no cloud that treerec has cleaned"
                                            : "does not tell whether treerec has made it");
}

}  // namespace treerec
