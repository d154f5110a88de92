#include <cstdio>

#include "cli/commands.h"
#include "cli/describe_parameter.h"
#include "cli/terminal_progress.h"
#include "edit/commands/script.h"
#include "exchange/tree_files.h"
#include "file_bytes.h"
#include "pipeline/export.h"

namespace treerec {

namespace {

void print_commands() {
    for (const EditCommand& command : edit_commands())
        print_command(command.name, command.summary, command.parameters);
}

}  // namespace

const Command& edit_command() {
    static const Command command{
        "edit",
        "edit IN --script FILE -o OUT [options]",
        "Prunes, shapes and mends a tree by a script of commands.",
        {{"--script", "FILE", "one command per line, # begins a comment; a log of the editor will do", true},
         {"-c", "COMMAND", "one command; after the scripts, in the order given", true},
         {"-o", "FILE", "what to write: .glb .gltf .obj, or .txt .ply .csv .mtg .lstring (the skeleton)",
          true},
         {"--log", "FILE", "writes what was done, nodes by their places too, to be replayed on another tree"},
         {"--keep-going", "", "leaves out what does not fit the tree, and tells it"},
         {"--tolerance", "M", "how far away a log's nodes are looked for (default: 1 % of the height)"},
         {"--leaves", "PRESET", "the leaves and bark of models (default generic; see 'treerec textures')"},
         {"--seed", "N", "of the leaves (default 1)"},
         {"--levels", "N", "levels of detail in .glb and .gltf files, 1 to 5 (default 1)"},
         {"--pictures-beside", "", "the pictures of a .glb go into a folder beside it, as those of a .gltf"},
         {"--up", "AXIS", "the axis to the sky of a skeleton that does not say: x y z -x -y -z (default z)"},
         {"--tree", "N", "which tree of a file with several, in its order (default: the largest)"},
         {"--dialect", "NAME", "of an L-string: turtle or paper (default: as it says itself, or turtle)"},
         {"--commands", "", "lists the commands and what they take"},
         {"--quiet", "", "print errors only"}},
        "IN: a skeleton (see 'treerec info'). Places and lengths in a script are metres from the tree's "
        "base, Y\n"
        "up; those of nodes (node=@x:y:z) are the scan's own coordinates."};
    return command;
}

void run_edit(const std::vector<std::string>& words) {
    const Arguments arguments(edit_command(), words);
    if (arguments.has("--commands")) {
        print_commands();
        return;
    }
    if (arguments.positional().size() != 1) throw UsageError("Name one skeleton to edit.");
    if (!arguments.has("--script") && !arguments.has("-c"))
        throw UsageError("What is to be done? Name a script with --script, or a command with -c.");
    if (!arguments.has("-o") && !arguments.has("--log")) throw UsageError("Where to? Name a file with -o.");
    const std::vector<std::string> none;
    const std::vector<std::string>& outs = arguments.has("-o") ? arguments.all("-o") : none;
    for (const std::string& out : outs)
        require_writable_format(out);
    if (arguments.has("--log"))
        require_own(arguments.text("--log", ""), "# treerec edit log ", "no log of edits");
    const ExportOptions exports = exports_from(arguments);
    const bool quiet = arguments.has("--quiet");
    TerminalProgress progress(quiet);
    ScriptOptions options;
    options.keep_going = arguments.has("--keep-going");
    options.tolerance = arguments.number("--tolerance", 0.0, 0.0, 1000.0);
    options.progress = &progress;

    std::vector<std::pair<std::string, std::string>> scripts;  // name and text
    if (arguments.has("--script"))
        for (const std::string& path : arguments.all("--script"))
            scripts.emplace_back("'" + path + "': ", read_file(path).view());
    if (arguments.has("-c"))
        for (const std::string& line : arguments.all("-c"))
            scripts.emplace_back("", line);

    Tree tree = skeleton_from(arguments, arguments.positional()[0], "--tree", told_dialect_from(arguments));
    const size_t before = tree.size();
    EditLog log;
    size_t done = 0, left_out = 0;
    for (const auto& [name, text] : scripts) {
        ScriptResult result;
        try {
            result = run_script(tree, text, options);
        } catch (const Cancelled&) {
            throw;
        } catch (const Error& error) {
            throw Error(name + error.what());
        }
        done += result.done;
        left_out += result.left_out.size();
        for (const EditLog::Entry& entry : result.log.entries())
            log.add(entry);
        progress.clear();
        for (const LeftOut& one : result.in_part)
            std::fprintf(stderr, "Done in part: %sline %zu: %s\n", name.c_str(), one.line,
                         one.reason.c_str());
        for (const std::string& sentence : result.said)
            if (!quiet) std::printf("%s\n", sentence.c_str());
        for (const LeftOut& one : result.left_out)
            std::fprintf(stderr, "Left out: %sline %zu: %s: %s\n", name.c_str(), one.line,
                         one.command.c_str(), one.reason.c_str());
    }
    TreeExporter exporter(tree, exports, &progress);
    for (const std::string& out : outs)
        exporter.write(out);
    if (arguments.has("--log")) write_file(arguments.text("--log", ""), log.text());
    progress.clear();
    if (quiet) return;
    std::printf("%zu command%s done, %zu left out; %zu nodes before, %zu after\n", done, done == 1 ? "" : "s",
                left_out, before, tree.size());
    for (const std::string& out : outs)
        std::printf("wrote %s\n", out.c_str());
    if (arguments.has("--log")) std::printf("wrote %s\n", arguments.text("--log", "").c_str());
}

}  // namespace treerec
