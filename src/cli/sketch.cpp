#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "cli/commands.h"
#include "cli/terminal_progress.h"
#include "file_bytes.h"
#include "pipeline/export.h"
#include "pipeline/sketch_report.h"
#include "sketch/read_branch.h"
#include "sketch/read_sketch.h"
#include "sketch/read_twigs.h"
#include "sketch/sketch.h"
#include "sketch/species.h"
#include "sketch/twig_stock.h"
#include "tree/measure.h"

namespace treerec {

namespace {

std::string species_list() {
    std::string names;
    for (const std::string& name : sketch_species_names())
        names += (names.empty() ? "" : " ") + name;
    return names;
}

std::string file_stem(const std::string& path) {
    const std::u8string stem = path_of(path).stem().u8string();
    return {stem.begin(), stem.end()};
}

std::string one_of(const Arguments& arguments, const std::string& option,
                   const std::vector<std::string>& words) {
    const std::string word = arguments.text(option, words[0]);
    std::string list;
    for (const std::string& known : words) {
        if (known == word) return word;
        list += (list.empty() ? "" : ", ") + known;
    }
    throw UsageError(option + " is one of " + list + ", not '" + word + "'.");
}

TwigStock twigs_from(const Arguments& arguments) {
    if (arguments.has("--twigs-of")) {
        const std::string path = arguments.text("--twigs-of", "");
        return stock_of_tree(skeleton_from(arguments, path), file_stem(path));
    }
    std::vector<std::string> strings;
    for (const std::string& path : arguments.all("--twigs"))
        for (std::string& string : read_twig_strings(path))
            strings.push_back(std::move(string));
    return stock_of_twigs(strings, file_stem(arguments.all("--twigs")[0]));
}

bool wants_sketch(const std::string& path) {
    return extension_of(path) == "json";
}

}  // namespace

const Command& sketch_command() {
    static const Command command{
        "sketch",
        "sketch STROKES -o FILE [options]\n       treerec sketch BRANCH.json --onto TREE [--scan SCAN] -o "
        "FILE "
        "[options]",
        "Makes a whole tree of a few freehand strokes, or draws missing branches over a scan.",
        {{"-o", "FILE",
          "the file to write: .glb .gltf .obj .ply .txt .csv .mtg .lstring, or .json for the strokes; again "
          "for "
          "more",
          true},
         {"--report", "", "print what became of each stroke, and how well the crown is filled, as JSON"},
         {"--species", "NAME",
          "whose twigs, leaves and bark it gets: " + species_list() +
              "\n(default: as the sketch says, or maple)"},
         {"--twigs-of", "TREE",
          "a tree, as one of 'treerec reconstruct', whose own twigs it gets, at their angles and as thick as "
          "there;\n--species is then any kind of leaves (see 'treerec info')"},
         {"--twigs", "FILE",
          "a library of twigs (.tres of Godot, saved as text) or one as an L-string; again for more", true},
         {"--height", "M", "metres (default: as the sketch says, or what is usual for the species)"},
         {"--trunk-radius", "M", "metres at the base (default: as drawn with two lines, or height / 40)"},
         {"--seed", "N", "what is drawn by chance (default: the sketch's, or 1)"},
         {"--depth", "HOW",
          "true: the front stays as drawn, with branches that the drawing doesn't show in front and behind;\n"
          "paper: branches are turned by up to 60 degrees (default true)"},
         {"--crown", "HOW",
          "what bounds the twigs: sections of the outline, or alpha shapes (default sections)"},
         {"--density", "F", "of twigs, 0 to 4 (default 1)"},
         {"--levels", "N", "levels of detail in .glb and .gltf files, 1 to 5 (default 1)"},
         {"--pictures-beside", "", "the pictures of a .glb go into a folder beside it, as those of a .gltf"},
         {"--onto", "TREE", "the skeleton that gets the branches of BRANCH.json (see 'treerec info')"},
         {"--scan", "SCAN",
          "its point cloud, with --onto: tells how far away a branch is, and how true the tree"},
         {"--log", "FILE", "with --onto: writes the branches as edits, to be replayed ('treerec edit')"},
         {"--up", "AXIS",
          "with --onto or --twigs-of: the axis to the sky of a skeleton that does not say (default z)"},
         {"--tree", "N",
          "with --onto or --twigs-of: which tree of a file with several (default: the largest)"},
         {"--quiet", "", "print errors only"}},
        "STROKES: our own .json, an .svg of paths, or a .png of a drawing: a crown's outline, a trunk, and "
        "its branches, in any order.\n"
        "BRANCH.json: a camera and a stroke along each missing branch, each of which becomes an edit; see "
        "docs/sketch.md. With --report its fidelity before and after is printed, too."};
    return command;
}

void run_sketch(const std::vector<std::string>& words) {
    const Arguments arguments(sketch_command(), words);
    const std::vector<std::string>& positional = arguments.positional();
    if (positional.empty()) throw UsageError("Of which strokes? Name a .json, .svg or .png file.");
    if (positional.size() > 1)
        throw UsageError("'" + positional[1] + "' is too much; name files to write with -o.");
    if (!arguments.has("--onto"))
        for (const char* option : {"--scan", "--log", "--up", "--tree"}) {
            const std::string name = option;
            const bool of_twigs = arguments.has("--twigs-of") && (name == "--up" || name == "--tree");
            if (arguments.has(name) && !of_twigs)
                throw UsageError(name + " is for branches: name the tree that gets them with --onto.");
        }
    const std::vector<std::string>& outs = arguments.all("-o");
    const bool report = arguments.has("--report");
    if (outs.empty() && !report)
        throw UsageError("Where to? Name at least one file to write with -o, or ask for --report.");
    if (arguments.has("--onto")) return run_sketch_onto(arguments);
    const bool own_twigs = arguments.has("--twigs-of") || arguments.has("--twigs");
    if (arguments.has("--twigs-of") && arguments.has("--twigs"))
        throw UsageError("--twigs-of and --twigs both tell whose twigs it gets; name one of them.");
    // What is wrong with these is told before anything is read.
    const bool paper = one_of(arguments, "--depth", {"true", "paper"}) == "paper";
    const bool alpha = one_of(arguments, "--crown", {"sections", "alpha"}) == "alpha";
    const double radius = arguments.number("--trunk-radius", 0.0, 0.001, 20.0);
    const double density = arguments.number("--density", 1.0, 0.0, 4.0);
    ExportOptions exports;
    exports.levels = levels_from(arguments);
    exports.pictures_beside = arguments.has("--pictures-beside");
    try {
        // With twigs of one's own, which the sketch may bring along, any kind of leaves will do.
        const std::vector<std::string> presets = leaf_preset_names();
        const std::string named = arguments.text("--species", "maple");
        if (own_twigs)
            leaf_preset(named);
        else if (std::find(presets.begin(), presets.end(), named) == presets.end())
            sketch_species(named);
        for (const std::string& out : outs)
            if (wants_sketch(out))
                require_writable(out);
            else
                require_writable_format(out);
    } catch (const Error& error) {
        throw UsageError(error.what());
    }

    const bool quiet = arguments.has("--quiet");
    TerminalProgress progress(quiet || report);
    progress.update(0.0, "Reading");
    if (wants_sketch(positional[0]) && is_branch_file(positional[0]))
        throw Error("'" + positional[0] +
                    "' has branches to be drawn onto a tree: name the tree with --onto.");
    SketchOptions options;
    Sketch sketch = read_sketch(positional[0], &options);
    if (arguments.has("--depth")) options.depth = paper ? SketchDepth::kPaper : SketchDepth::kTrue;
    if (arguments.has("--crown")) options.crown = alpha ? SketchCrown::kAlpha : SketchCrown::kSections;
    if (arguments.has("--trunk-radius")) options.trunk_radius = radius;
    if (arguments.has("--density")) options.density = density;
    if (arguments.has("--species")) {
        sketch.species = arguments.text("--species", "");
        // A species of ours has its own.
        const std::vector<std::string> known = sketch_species_names();
        if (std::find(known.begin(), known.end(), sketch.species) != known.end()) sketch.twigs = nullptr;
    }
    if (own_twigs) sketch.twigs = std::make_shared<const TwigStock>(twigs_from(arguments));
    sketch.height = arguments.number("--height", sketch.height, 0.05, 200.0);
    sketch.seed = arguments.whole("--seed", sketch.seed, 0, UINT64_MAX);
    progress.update(0.1, "Sketch");
    const SketchedTree sketched = sketch_tree(sketch, options, &progress);
    exports.textures = sketched.species;
    exports.leaves = leaf_preset(sketched.species);
    exports.seed = sketch.seed;
    TreeExporter exporter(sketched.tree, exports, &progress);
    for (size_t i = 0; i < outs.size(); i++) {
        progress.check();
        progress.update(0.3 + 0.6 * static_cast<double>(i) / static_cast<double>(outs.size()), "Writing");
        if (wants_sketch(outs[i]))
            write_file(outs[i], sketch_json(sketch, options));
        else
            exporter.write(outs[i]);
    }
    std::optional<CrownOverlap> overlap;
    if (report) {
        const std::vector<OutlinePart> parts =
            outline_parts(sketched.tree, exports.leaves, exports.textures, exports.seed, {}, &progress);
        overlap = measure_crown_overlap(sketched, sketch, parts, 512, &progress);
    }
    progress.clear();
    if (report) std::fputs(sketch_report_json(sketch, sketched, &*overlap).c_str(), stdout);
    if (quiet || report) return;
    for (size_t i = 0; i < sketched.understood.strokes.size(); i++) {
        const StrokeReading& reading = sketched.understood.strokes[i];
        if (!reading.fault.empty()) std::fprintf(stderr, "stroke %zu: %s\n", i + 1, reading.fault.c_str());
    }
    for (const std::string& remark : sketched.remarks)
        std::fprintf(stderr, "%s\n", remark.c_str());
    const Measurements m = measure(sketched.tree);
    std::printf("a %.2f m high %s, %zu nodes, %zu tips, %.1f m of wood\n", m.height, sketched.species.c_str(),
                m.nodes, m.tips, m.total_length);
    for (const std::string& out : outs)
        std::printf("wrote %s\n", out.c_str());
}

}  // namespace treerec
