#include <cstdio>

#include "cli/commands.h"
#include "cli/reconstruct_options.h"
#include "file_bytes.h"
#include "photos/marker_code.h"
#include "photos/marker_page.h"
#include "pipeline/marker_file.h"

namespace treerec {

const Command& marker_command() {
    static const Command command{
        "marker",
        "marker -o FILE [options]",
        "Makes a marker to print, which tells photos their scale.",
        {{"-o", "FILE", "what to write: a .svg in exact millimetres, or a .png at 300 dpi"},
         {"--id", "N", "which marker, 0 to 49 (default 0); two in one scene must not be the same"},
         {"--side", "SIDE",
          "the side of the black square, such as 150mm, 6in or 0.15 (metres; default 150mm); up to 200mm on "
          "A4"},
         {"--quiet", "", "print errors only"}},
        "Print it at 100 % and measure the black square: what you measure is what 'treerec photos --marker'\n"
        "is to be told. Lay it flat beside the tree, or fix it to a board, so that several photos from all\n"
        "sides show it. Any marker of ArUco's DICT_4X4_50 will do."};
    return command;
}

void run_marker(const std::vector<std::string>& words) {
    const Arguments arguments(marker_command(), words);
    if (!arguments.positional().empty())
        throw UsageError("'" + arguments.positional()[0] + "' is too much; name the file with -o.");
    if (!arguments.has("-o")) throw UsageError("Where to? Name a file with -o, such as marker.svg.");
    const std::string path = arguments.text("-o", "");
    const auto id = static_cast<int>(arguments.whole("--id", 0, 0, kMarkerCount - 1));
    const double side = length_from(arguments, "--side", kUsualMarkerSide, kLeastMarkerSide, kMostMarkerSide);
    as_usage([&] {
        require_marker_format(path);
        require_writable(path);
    });
    write_marker(path, id, side);
    if (arguments.has("--quiet")) return;
    const MarkerPage page = marker_page(id, side);
    std::printf("wrote %s (A%d)\n%s\n", path.c_str(), page.paper, marker_caption(page).c_str());
}

}  // namespace treerec
