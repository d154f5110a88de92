#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "cli/commands.h"
#include "cli/grow_from.h"
#include "cli/terminal_progress.h"
#include "exchange/lstring_file.h"
#include "file_bytes.h"
#include "lsystem/grammar.h"
#include "pipeline/export.h"
#include "tree/measure.h"

namespace treerec {

namespace {

std::string preset_list() {
    std::string names;
    for (const std::string& name : grammar_preset_names())
        names += (names.empty() ? "" : " ") + name;
    return names;
}

bool wants_string(const std::string& path) {
    return extension_of(path) == "lstring";
}

}  // namespace

std::string grammar_source(const std::string& name) {
    std::error_code failure;
    const std::vector<std::string> presets = grammar_preset_names();
    if (!std::filesystem::exists(path_of(name), failure)) {
        if (std::find(presets.begin(), presets.end(), name) != presets.end()) return grammar_preset(name);
        throw Error("There is no file '" + name + "', and no grammar of that name; there are " +
                    preset_list() + ".");
    }
    return std::string(read_file(name).view());
}

Grown grow_from(const std::string& name, const std::string& text, const Arguments& arguments,
                Progress& progress) {
    Grown grown;
    LStringOptions& options = grown.options;
    const bool grammatical = is_grammar(text);
    Grammar grammar;
    if (grammatical) {
        grammar = Grammar::parse(text);
        options = grammar.turtle;
        if (!grammar.leaf_preset.empty()) grown.leaf_preset = grammar.leaf_preset;
    } else {
        options = with_heading(text, options, "'" + name + "'");
        // What the command line says goes before what the file says.
        options.heeds_heading = false;
    }
    if (arguments.has("--dialect")) {
        options.dialect = dialect_from(arguments);
        options.dialect_is_told = true;
    }
    options.angle = arguments.number("--angle", options.angle, -360.0, 360.0);
    options.step = arguments.number("--step", options.step, 1e-6, 1e3);
    options.radius = arguments.number("--radius", options.radius, 1e-6, 1e3);
    options.angle_spread = arguments.number("--vary-angle", 0.0, 0.0, 90.0);
    options.length_spread = arguments.number("--vary-length", 0.0, 0.0, 0.9);
    options.seed = arguments.whole("--seed", grammatical ? grammar.seed : 1, 0, UINT64_MAX);
    if (!grammatical) {
        for (const char* option : {"--iterations", "--most-nodes", "--most-seconds"})
            if (arguments.has(option))
                throw UsageError(std::string(option) + " is for grammars; '" + name + "' is an L-string.");
        grown.read = parse_lstring_file(text, name, options, &progress);
        require_wood(grown.read.tree, "The L-string '" + name + "'");
        return grown;
    }
    RewriteOptions rewriting;
    rewriting.seed = options.seed;
    rewriting.iterations = static_cast<int>(
        arguments.whole("--iterations", static_cast<uint64_t>(grammar.iterations), 0, 10000));
    rewriting.most_seconds = arguments.number("--most-seconds", rewriting.most_seconds, 0.01, 1e6);
    options.most_nodes = arguments.whole("--most-nodes", 1000000, 1, kLargestId);
    SubProgress steps(&progress, 0.0, 0.4);
    grown.string = rewrite(grammar, rewriting, &steps);
    grown.read = read_lstring_with_leaves(grown.string, options, &progress);
    require_wood(grown.read.tree, "The string that the grammar '" + name + "' makes in " +
                                      std::to_string(rewriting.iterations) + " steps");
    return grown;
}

Foliage foliage_of(const Grown& grown, const Progress* progress) {
    if (grown.read.leaves.empty()) return {};
    std::vector<Vec3> places;
    for (const LStringLeaf& leaf : grown.read.leaves)
        places.push_back(Vec3(leaf.position));
    return gather_foliage(places, {}, progress);
}

const Command& grow_command() {
    static const Command command{
        "grow",
        "grow STRING-OR-GRAMMAR -o FILE [options]",
        "Makes a tree from an L-string or a grammar.",
        {{"-o", "FILE",
          "the file to write: .glb .gltf .obj .ply .txt .csv .mtg, or .lstring for the string; again for "
          "more",
          true},
         {"--seed", "N", "what is drawn by chance (default: the grammar's)"},
         {"--iterations", "N", "of the grammar (default: its own)"},
         {"--most-nodes", "N", "a grammar's tree may have; it is refused with more (default 1000000)"},
         {"--most-seconds", "S", "that a grammar may take (default 30)"},
         {"--dialect", "NAME", "of an L-string: turtle or paper (default: as it says itself, or turtle)"},
         {"--angle", "A", "degrees of + - & ^ \\ / without a number"},
         {"--step", "M", "metres of F without a number"},
         {"--radius", "M", "metres, where no ! says it"},
         {"--vary-angle", "A", "vary every segment's direction by up to so many degrees (default 0)"},
         {"--vary-length", "F", "vary every segment's length by up to this share (default 0)"},
         {"--leaves", "NAME", "the leaf preset of models (default: the grammar's, or generic; none)"},
         {"--levels", "N", "levels of detail in .glb and .gltf files, 1 to 5 (default 1)"},
         {"--pictures-beside", "", "the pictures of a .glb go into a folder beside it, as those of a .gltf"},
         {"--quiet", "", "print errors only"}},
        "STRING-OR-GRAMMAR: a file, or one of the program's own grammars: " + preset_list() + "."};
    return command;
}

void run_grow(const std::vector<std::string>& words) {
    const Arguments arguments(grow_command(), words);
    const std::vector<std::string>& positional = arguments.positional();
    if (positional.empty())
        throw UsageError("What should grow? Name an L-string, a grammar or one of: " + preset_list() + ".");
    if (positional.size() > 1)
        throw UsageError("'" + positional[1] + "' is too much; name files to write with -o.");
    const std::vector<std::string>& outs = arguments.all("-o");
    if (outs.empty()) throw UsageError("Where to? Name at least one file to write with -o.");
    ExportOptions exports;
    exports.levels = levels_from(arguments);
    exports.pictures_beside = arguments.has("--pictures-beside");
    try {
        if (arguments.has("--leaves")) leaf_preset(arguments.text("--leaves", ""));
        for (const std::string& out : outs)
            if (!wants_string(out))
                require_writable_format(out);
            else
                require_writable(out);
    } catch (const Error& error) {
        throw UsageError(error.what());
    }

    const bool quiet = arguments.has("--quiet");
    TerminalProgress progress(quiet);
    progress.update(0.0, "Growing");
    const Grown grown = grow_from(positional[0], grammar_source(positional[0]), arguments, progress);
    const Tree& tree = grown.read.tree;
    exports.textures =
        arguments.text("--leaves", grown.leaf_preset.empty() ? exports.textures : grown.leaf_preset);
    exports.leaves = leaf_preset(exports.textures);
    exports.seed = grown.options.seed;
    exports.foliage = foliage_of(grown, &progress);
    TreeExporter exporter(tree, exports, &progress);
    for (size_t i = 0; i < outs.size(); i++) {
        progress.check();
        progress.update(0.5 + 0.5 * static_cast<double>(i) / static_cast<double>(outs.size()), "Writing");
        if (wants_string(outs[i]) && !grown.string.empty())
            write_file(outs[i], lstring_file_text(grown.string, tree.frame(), grown.options));
        else
            exporter.write(outs[i]);
    }
    progress.clear();
    if (quiet) return;
    const Measurements m = measure(tree);
    std::printf("a %.2f m high tree, %zu nodes, %zu tips, %.1f m of wood\n", m.height, m.nodes, m.tips,
                m.total_length);
    for (const std::string& out : outs)
        std::printf("wrote %s\n", out.c_str());
}

}  // namespace treerec
