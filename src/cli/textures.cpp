#include <cstdio>
#include <filesystem>

#include "cli/commands.h"
#include "cli/terminal_progress.h"
#include "exchange/material_textures.h"
#include "file_bytes.h"
#include "foliage/leaves.h"

namespace treerec {

namespace {

// A picture of one of our names that stands there alone is somebody else's.
void require_own_pictures(const std::string& folder, const std::string& preset) {
    std::error_code failure;
    std::string found;
    bool all = true;
    for (const std::string& name : picture_names()) {
        const std::string path = folder + "/" + preset + "_" + name + picture_ending(name);
        const bool there = std::filesystem::exists(path_of(path), failure);
        all = all && there;
        if (there && found.empty()) found = path;
    }
    if (!found.empty() && !all)
        throw UsageError("'" + found +
                         "' is there already, without the other pictures of its kind, and was left as it is; "
                         "name another folder.");
}

}  // namespace

const Command& textures_command() {
    static const Command command{"textures",
                                 "textures -o DIR [options]",
                                 "Writes the bark and leaf pictures as JPEG and PNG.",
                                 {{"-o", "DIR", "the folder to write to; it is made"},
                                  {"--preset", "NAME", "only this leaf preset (default: all)"},
                                  {"--size", "N", "pixels along an edge, 16 to 4096 (default 512)"},
                                  {"--seed", "N", "of everything random (default 1)"},
                                  {"--quiet", "", "print errors only"}},
                                 ""};
    return command;
}

void run_textures(const std::vector<std::string>& words) {
    const Arguments arguments(textures_command(), words);
    if (!arguments.positional().empty())
        throw UsageError("'" + arguments.positional()[0] + "' is too much; name the folder with -o.");
    if (!arguments.has("-o")) throw UsageError("Where to? Name a folder with -o.");
    std::vector<std::string> presets;
    for (const std::string& name : leaf_preset_names())
        if (leaf_preset(name).enabled &&
            (!arguments.has("--preset") || arguments.text("--preset", "") == name))
            presets.push_back(name);
    if (presets.empty())
        throw UsageError("There are no pictures for '" + arguments.text("--preset", "") + "'.");
    const int size = static_cast<int>(arguments.whole("--size", kTextureSize, 16, 4096));
    const uint64_t seed = arguments.whole("--seed", 1, 0, UINT64_MAX);
    for (const std::string& preset : presets)
        require_own_pictures(arguments.text("-o", ""), preset);
    const bool quiet = arguments.has("--quiet");
    TerminalProgress progress(quiet);
    for (size_t i = 0; i < presets.size(); i++) {
        progress.update(static_cast<double>(i) / static_cast<double>(presets.size()), presets[i].c_str());
        progress.check();
        const std::vector<std::string> written =
            write_pictures(arguments.text("-o", ""), presets[i], make_pictures(presets[i], size, seed));
        progress.clear();
        if (quiet) continue;
        for (const std::string& path : written)
            std::printf("%s\n", path.c_str());
    }
}

}  // namespace treerec
