// treerec: scanned trees into game-ready trees, without an engine.
#include <cstdio>
#include <exception>
#include <new>

#include "cli/commands.h"
#include "cli/memory.h"
#include "cli/terminal_progress.h"
#include "exchange/ready_pictures.h"
#include "version.h"

namespace treerec {

namespace {

struct Entry {
    const Command& command;
    void (*run)(const std::vector<std::string>&);
};

std::vector<Entry> entries() {
    return {{reconstruct_command(), run_reconstruct},
            {photos_command(), run_photos},
            {marker_command(), run_marker},
            {split_command(), run_split},
            {info_command(), run_info},
            {edit_command(), run_edit},
            {lighten_command(), run_lighten},
            {score_command(), run_score},
            {synth_command(), run_synth},
            {lstring_command(), run_lstring},
            {grow_command(), run_grow},
            {sketch_command(), run_sketch},
            {bark_command(), run_bark},
            {textures_command(), run_textures}};
}

std::string general_help() {
    std::string text =
        "treerec turns scanned trees into game-ready trees.\n\n"
        "usage: treerec COMMAND ...\n\n";
    for (const Entry& entry : entries()) {
        std::string name = "  " + entry.command.name;
        name.resize(16, ' ');
        text += name + entry.command.summary + "\n";
    }
    text +=
        "\n'treerec COMMAND --help' tells more; 'treerec --version' the version.\n"
        "Exit code: 0 done, 1 it could not be done (one sentence on stderr says why), 2 a wrong command "
        "line.\n";
    return text;
}

int run(const std::vector<std::string>& words) {
    if (words.empty()) {
        std::fputs(general_help().c_str(), stderr);
        return 2;
    }
    const std::string& name = words[0];
    if (name == "--help" || name == "-h" || name == "help") {
        std::fputs(general_help().c_str(), stdout);
        return 0;
    }
    if (name == "--version") {
        std::printf("treerec %s\n", kVersion);
        return 0;
    }
    const std::vector<std::string> rest(words.begin() + 1, words.end());
    std::vector<std::string> names;
    for (const Entry& entry : entries()) {
        names.push_back(entry.command.name);
        if (entry.command.name != name) continue;
        for (const std::string& word : rest) {
            if (word == "--") break;
            if (word != "--help" && word != "-h") continue;
            std::fputs(help_text(entry.command).c_str(), stdout);
            return 0;
        }
        try {
            entry.run(rest);
            return 0;
        } catch (const UsageError& error) {
            std::fprintf(stderr, "%s\nusage: treerec %s\n", error.what(), entry.command.usage.c_str());
            return 2;
        }
    }
    const std::optional<std::string> nearest = nearest_word(name, names);
    std::fprintf(stderr, "There is no command '%s'%s See 'treerec --help'.\n", name.c_str(),
                 nearest ? ("; did you mean '" + *nearest + "'?").c_str() : ".");
    return 2;
}

}  // namespace

}  // namespace treerec

int main(int argc, char** argv) {
    treerec::keep_freed_memory();
    treerec::listen_for_interrupt();
    treerec::use_ready_pictures();
    try {
        const int code = treerec::run({argv + 1, argv + argc});
        if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return code;
        std::fputs("The output could not be written.\n", stderr);
    } catch (const treerec::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
    } catch (const std::bad_alloc&) {
        std::fputs(
            "There is not enough memory for this; thin the scan (--spacing) or close other programs.\n",
            stderr);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "Something went wrong inside the program, please report it: %s\n", error.what());
    }
    return 1;
}
