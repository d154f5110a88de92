#include <cstdio>
#include <optional>

#include "cli/commands.h"
#include "cli/describe_parameter.h"
#include "cli/terminal_progress.h"
#include "file_bytes.h"
#include "growth/bark_fit.h"
#include "growth/grow_bark.h"
#include "growth/lumps.h"
#include "growth/presets.h"
#include "pipeline/export.h"
#include "pipeline/report.h"
#include "scan/formats/read_cloud.h"

namespace treerec {

namespace {

void print_check(const GrowthStep& step) {
    std::printf(
        "{\"step\": %d, \"V\": %zu, \"E\": %zu, \"F\": %zu, \"chi\": %ld, \"components\": %zu, \"closed\": "
        "%s, "
        "\"outward\": %s, \"above_longest\": %zu, \"under_shortest\": {\"apical\": %zu, \"parting\": %zu, "
        "\"link\": %zu, \"fold\": %zu, \"contact\": %zu, \"unexplained\": %zu}, \"intersections\": %zu, "
        "\"frozen\": %zu, \"frozen_away_from_contacts\": %zu}\n",
        step.step, step.vertices, step.edges, step.faces, step.chi, step.components,
        step.closed ? "true" : "false", step.outward ? "true" : "false", step.above_longest, step.apical,
        step.parting, step.link, step.fold, step.contact, step.unexplained, step.intersections, step.frozen,
        step.frozen_free);
}

void print_levels(const GrownBark& bark) {
    for (int level = 0; level < kMostLevels; level++) {
        const LevelError error = measure_level(bark, level);
        std::printf(
            "{\"level\": %d, \"triangles\": %zu, \"mean_mm\": %.2f, \"most_mm\": %.2f, \"outside_mm\": "
            "%.2f, \"normals_degrees\": %.1f}\n",
            level, error.triangles, 1000.0 * error.mean, 1000.0 * error.most, 1000.0 * error.out, error.turn);
    }
}

// The recipe's text as the options have it.
std::string recipe_from(const Arguments& arguments, const Tree& tree) {
    std::string text;
    if (arguments.has("--preset")) {
        const GrowthPreset* preset = nullptr;
        try {
            preset = &find_growth_preset(arguments.text("--preset", ""));
        } catch (const Error& error) {
            throw UsageError(error.what());
        }
        text = preset_recipe(*preset, tree);
    }
    if (arguments.has("--recipe")) text += read_file(arguments.text("--recipe", "")).view();
    if (arguments.has("-c"))
        for (const std::string& line : arguments.all("-c"))
            text += "\n" + line;
    return text;
}

// With what the scan shows, which is told.
GrowthRecipe with_lumps(const Tree& tree, const GrowthRecipe& recipe, const PointCloud& scan, bool quiet,
                        Progress* progress) {
    const GrowthProposal proposal = propose_growth(tree, scan, recipe, progress);
    for (const std::string& remark : proposal.remarks)
        std::fprintf(stderr, "%s\n", remark.c_str());
    if (!quiet)
        std::fprintf(stderr,
                     "The scan shows %zu burls, %zu hollows and %zu outlines of wood that is not round.\n",
                     proposal.burls, proposal.hollows, proposal.sections);
    return read_growth_recipe(tree, recipe.text + proposal.recipe);
}

void print_fit(const BarkFit& fit) {
    std::printf("scan: %zu points on the bark; mean distance %.1f mm, of tubes %.1f mm\n", fit.all.points,
                1000.0 * fit.all.grown.mean, 1000.0 * fit.all.tubes.mean);
    std::printf("radii: median error %.1f %%, p95 %.1f %%\n", 100.0 * fit.radius_median,
                100.0 * fit.radius_p95);
}

bool sound(const GrowthStep& step) {
    return step.closed && step.outward && step.above_longest == 0 && step.unexplained == 0 &&
           step.intersections == 0;
}

}  // namespace

const Command& bark_command() {
    static const Command command{
        "bark",
        "bark TREE -o FILE [-c COMMAND] [--recipe FILE] [--scan CLOUD --from-scan] [options]",
        "Grows bark around a tree as one closed surface, with burls, hollows, obstacles and winding grain.",
        {{"-o", "FILE", "what to write: .glb .gltf .obj; again for more", true},
         {"-c", "COMMAND", "one line of the recipe; after the recipe's own, in the order given", true},
         {"--recipe", "FILE", "one command per line, # begins a comment"},
         {"--preset", "NAME",
          "begins with a recipe that ships with us, scaled to the trunk, edges too: fence_post_swallowed "
          "hollow_refuge old_oak spiral_grain"},
         {"--scan", "CLOUD", "the scan that the tree was made of, best as 'reconstruct --cloud' writes it"},
         {"--from-scan", "",
          "adds to the recipe the lumps and dents that the scan shows; see them with --log"},
         {"--report", "FILE", "writes how true the bark is to the scan, beside tubes, as JSON: docs/bark.md"},
         {"--columns", "LIST", "names of a text scan's columns, such as x,y,z,r,g,b; - skips one"},
         {"--classes", "LIST",
          "classes of LAS points to read, such as 2,4-5, or all (default: all but noise, 7 and 18)"},
         {"--log", "FILE", "writes the recipe as it was found on this tree"},
         {"--check", "N", "judges the surface every N steps and prints what it is, a line of JSON each"},
         {"--level-errors", "",
          "prints how far the lighter levels are from the full surface, a line of JSON each"},
         {"--trace", "DIR", "writes what each vertex did in each step there, as CSV: docs/growth_trace.md"},
         {"--leaves", "PRESET", "the leaves and bark of models (default generic; see 'treerec textures')"},
         {"--seed", "N", "of the leaves (default 1)"},
         {"--levels", "N", "levels of detail in .glb and .gltf files, 1 to 5 (default 1)"},
         {"--pictures-beside", "", "the pictures of a .glb go into a folder beside it, as those of a .gltf"},
         {"--up", "AXIS", "the axis to the sky of a skeleton that does not say: x y z -x -y -z (default z)"},
         {"--tree", "N", "which tree of a file with several, in its order (default: the largest)"},
         {"--commands", "", "lists the commands and what they take"},
         {"--quiet", "", "print errors only"}},
        "TREE: a skeleton (see 'treerec info'). Lengths are metres. Branches thinner than the shortest edge "
        "stay\ntubes, which begin inside the surface."};
    return command;
}

void run_bark(const std::vector<std::string>& words) {
    const Arguments arguments(bark_command(), words);
    if (arguments.has("--commands")) {
        for (const GrowthCommand& one : growth_commands())
            print_command(one.name, one.summary, one.parameters);
        return;
    }
    if (arguments.positional().size() != 1) throw UsageError("Name one skeleton that bark is to grow on.");
    const bool grows = arguments.has("-o") || arguments.has("--check") || arguments.has("--report") ||
                       arguments.has("--level-errors");
    if (!grows && !(arguments.has("--from-scan") && arguments.has("--log")))
        throw UsageError("Where to? Name a file with -o.");
    for (const char* name : {"--from-scan", "--report"})
        if (arguments.has(name) && !arguments.has("--scan"))
            throw UsageError(std::string(name) + " needs the scan: name it with --scan.");
    if (arguments.has("--scan") && !arguments.has("--from-scan") && !arguments.has("--report"))
        throw UsageError("What is the scan for? Add --from-scan, --report or both.");
    if (arguments.has("--report"))
        require_own(arguments.text("--report", ""), kBarkFitMark, "no report of grown bark");
    const ReadCloudOptions read = read_options_from(arguments);
    const std::vector<std::string> none;
    const std::vector<std::string>& outs = arguments.has("-o") ? arguments.all("-o") : none;
    for (const std::string& out : outs)
        require_writable_format(out);
    if (arguments.has("--log"))
        require_own(arguments.text("--log", ""), kGrowthRecipeMark, "no recipe of growth");
    ExportOptions exports = exports_from(arguments);
    const bool quiet = arguments.has("--quiet");
    TerminalProgress progress(quiet);
    GrowBarkOptions options;
    options.trace = arguments.text("--trace", "");
    options.check_every = static_cast<int>(arguments.whole("--check", 0, 0, 100000));

    const Tree tree = skeleton_from(arguments, arguments.positional()[0]);
    GrowthRecipe recipe = read_growth_recipe(tree, recipe_from(arguments, tree));
    PointCloud scan;
    if (arguments.has("--scan")) scan = read_cloud(arguments.text("--scan", ""), read, nullptr);
    if (arguments.has("--from-scan")) recipe = with_lumps(tree, recipe, scan, quiet, &progress);
    if (arguments.has("--log"))
        write_file(arguments.text("--log", ""), std::string(kGrowthRecipeMark) + "1\n" + recipe.text);
    if (!grows) {
        progress.clear();
        return;
    }
    if (!options.trace.empty()) make_folder(options.trace);
    const GrownTree grown = grow_bark(tree, recipe, options, &progress);
    exports.grown = &grown.bark;
    TreeExporter exporter(tree, exports, &progress);
    for (const std::string& out : outs)
        exporter.write(out);
    std::optional<BarkFit> fit;
    if (arguments.has("--report")) {
        fit = measure_bark_fit(tree, recipe, grown.bark, scan, &progress);
        write_file(arguments.text("--report", ""), bark_fit_json(*fit, grown));
    }
    progress.clear();
    for (const std::string& remark : grown.remarks)
        std::fprintf(stderr, "%s\n", remark.c_str());
    if (arguments.has("--level-errors")) print_levels(grown.bark);
    bool all_sound = true;
    for (const GrowthStep& step : grown.checks) {
        print_check(step);
        all_sound &= sound(step);
    }
    if (!quiet && !arguments.has("--check")) {
        std::printf("%zu branches covered in %d steps: %zu vertices, %zu triangles\n",
                    grown.bark.branches.size(), grown.steps, grown.bark.vertices.size(),
                    grown.bark.indices.size() / 3);
        if (recipe.fuse) std::printf("fused in %zu places: chi %ld\n", grown.fused, grown.chi);
        for (const std::string& out : outs)
            std::printf("wrote %s\n", out.c_str());
        if (fit) print_fit(*fit);
    }
    if (!all_sound) throw Error("The surface is not sound: see the lines above.");
}

}  // namespace treerec
