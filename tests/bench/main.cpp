// The benchmarks' program; ./dev bench builds and calls it.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "bench.h"
#include "error.h"
#include "exchange/ready_pictures.h"
#include "file_bytes.h"

namespace {

using namespace treerec;
using namespace treerec::bench;

const char* const kUsage =
    "usage: bench [options] [SCAN…]            time and memory of every stage\n"
    "       bench --scaling [SCAN]             whole runs of 10k to 10M points made from a scan\n"
    "       bench --resize N OUT SCAN          makes such a cloud, to look at or to run --beside on\n"
    "       bench --scans [SCAN…|FOLDER]       one line per scan: time, memory, measurements, fit\n"
    "       bench --methods [SCAN…|FOLDER]     all skeletonizers on every scan: time, fidelity, nodes\n"
    "       bench --clicks [SCAN…]             length error as proposals are accepted (needs --truth)\n"
    "       bench --beside PROGRAM SCAN… [-- ARG…]  whole runs of ours and of PROGRAM in turns, called as\n"
    "                                          PROGRAM SCAN.xyz FOLDER ARG…\n"
    "       bench --lighter [SCAN…|SKELETON…]  size and outline of lighter trees, ours and Zhang's (2013)\n"
    "       bench --bytes [SCAN…|FOLDER]       bytes of the cloud, of its skeleton and of lighter ones\n"
    "       bench --looks [SCAN…|FOLDER]       what a vegetation artist sees: leaf area, twigs, bark, "
    "sections\n"
    "       bench --fidelity [SCAN…]           how quickly the fidelity follows edits\n"
    "       bench --synth                      precision, recall, radius and DBH errors on grown trees\n"
    "       bench --ablate [SCAN…|FOLDER] [-- PASS…]  what is worse without each pass of the skeleton\n"
    "       bench --strings                    L-strings of 10 MB: written, read, rewritten\n"
    "       bench --sketch                     strokes to trees: time, and crowns against their outlines\n"
    "       bench --growth                     bark of Mizoguchi and Miyata's (2014) sizes: seconds, and us "
    "per vertex and "
    "step\n"
    "       bench --drawn                      branches removed from grown trees and drawn anew over their "
    "scans\n"
    "       bench --plots                      stems and points of plots of 2 to 12 grown trees\n"
    "       bench --edits                      commands, undo and new bark; 5,000 and 100,000 nodes\n"
    "       bench --variants [SCAN…|SKELETON…] new individuals of a tree, with bark, in a second\n"
    "       bench --photos FOLDER… [-- ARG…]   photos matched by sift, pyrlk and both; ARG: of 'treerec "
    "photos'\n"
    "       bench --tracks [FOLDER MODEL]      corners tracked plainly and better: on drawn warps, or "
    "between\n"
    "                                          photos, judged by their COLMAP model\n"
    "       bench --leaf-inputs FOLDER [--weights FOLDER] [SCAN…]  what fit_leaves.py fits to\n"
    "       bench --twig-inputs FOLDER                             likewise\n"
    "       bench --guard, --record            a small table of the same against the recorded one\n"
    "options: --repetitions N, --seeds N (of --synth, --drawn, --plots and --ablate), --labelled (of "
    "--synth: with "
    "the\n"
    "         truth about leaves in the scans), --most-points N (of --scaling),\n"
    "         --truth FOLDER (its STEM_skeleton_corrected*.csv are compared),\n"
    "         --models FOLDER (of --scans: its tree files STEM.txt, another program's, below ours),\n"
    "         --program TREEREC, --sample SCAN, --table FILE (as ./dev sets them)\n";

struct CommandLine {
    std::string mode;
    std::string sample;
    std::string out;  // of --resize
    std::vector<std::string> scans;
    Settings settings;
};

size_t whole(const std::string& word) {
    if (word.empty() || word.find_first_not_of("0123456789") != std::string::npos || word.size() > 9)
        throw Error("'" + word + "' is not a whole number.");
    return std::stoul(word);
}

CommandLine parse(const std::vector<std::string>& words) {
    CommandLine line;
    for (size_t i = 0; i < words.size(); i++) {
        const std::string& word = words[i];
        const auto value = [&]() -> const std::string& {
            if (i + 1 >= words.size()) throw Error(word + " needs a value.");
            return words[++i];
        };
        if (word == "--") {
            line.settings.args.assign(words.begin() + static_cast<ptrdiff_t>(i) + 1, words.end());
            break;
        }
        if (word == "--scaling" || word == "--scans" || word == "--synth" || word == "--strings" ||
            word == "--guard" || word == "--record" || word == "--beside" || word == "--resize" ||
            word == "--methods" || word == "--clicks" || word == "--lighter" || word == "--fidelity" ||
            word == "--bytes" || word == "--looks" || word == "--photos" || word == "--tracks" ||
            word == "--edits" || word == "--variants" || word == "--drawn" || word == "--sketch" ||
            word == "--growth" || word == "--plots" || word == "--ablate" || word == "--leaf-inputs" ||
            word == "--twig-inputs" || word == "--help") {
            if (!line.mode.empty()) throw Error(line.mode + " and " + word + " are two things.");
            line.mode = word;
            if (word == "--beside") line.settings.beside = value();
            if (word == "--leaf-inputs" || word == "--twig-inputs") line.settings.out = value();
            if (word == "--resize") {
                line.settings.most_points = whole(value());
                line.out = value();
            }
        } else if (word == "--repetitions") {
            line.settings.repetitions = static_cast<int>(std::clamp<size_t>(whole(value()), 1, 1000));
        } else if (word == "--seeds") {
            line.settings.seeds = static_cast<int>(std::min<size_t>(whole(value()), 1000));
        } else if (word == "--weights") {
            line.settings.weights = value();
        } else if (word == "--labelled") {
            line.settings.labelled = true;
        } else if (word == "--most-points") {
            line.settings.most_points = whole(value());
        } else if (word == "--program") {
            line.settings.program = value();
        } else if (word == "--sample") {
            line.sample = value();
        } else if (word == "--truth") {
            line.settings.truth = value();
        } else if (word == "--models") {
            line.settings.models = value();
        } else if (word == "--table") {
            line.settings.record = value();
        } else if (word.starts_with("--")) {
            throw Error("There is no option " + word + ".");
        } else {
            line.scans.push_back(word);
        }
    }
    return line;
}

// The files of a folder, by name; a file is itself.
std::vector<std::string> files_of(const std::vector<std::string>& paths) {
    std::vector<std::string> files;
    for (const std::string& path : paths) {
        if (!std::filesystem::is_directory(path_of(path))) {
            files.push_back(path);
            continue;
        }
        std::vector<std::string> inside;
        for (const auto& entry : std::filesystem::directory_iterator(path_of(path)))
            if (entry.is_regular_file()) inside.push_back(utf8_of(entry.path()));
        std::sort(inside.begin(), inside.end());
        files.insert(files.end(), inside.begin(), inside.end());
    }
    return files;
}

int run(CommandLine line) {
    if (line.mode != "--ablate") line.settings.seeds = std::max(1, line.settings.seeds);
    if (line.mode == "--help") {
        std::fputs(kUsage, stdout);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--twig-inputs") {
        bench_twig_inputs(line.settings);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--leaf-inputs") {
        bench_leaf_inputs(line.scans, line.settings);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--synth") {
        bench_synth(line.settings);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--ablate") {
        bench_ablation(files_of(line.scans), line.settings);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--sketch") {
        bench_sketches(line.settings);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--growth") {
        bench_growth(line.settings);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--drawn") {
        bench_drawn_branches(line.settings);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--plots") {
        bench_plots(line.settings);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--strings") {
        bench_strings(line.settings);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--edits") {
        bench_edits(line.settings);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--guard" || line.mode == "--record") {
        if (line.settings.record.empty()) throw Error("Name the recorded table with --table.");
        if (line.mode == "--guard") return guard_accuracy(line.settings) ? EXIT_SUCCESS : EXIT_FAILURE;
        record_accuracy(line.settings);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--photos") {
        bench_photos(line.scans, line.settings);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--tracks") {
        if (line.scans.empty())
            bench_warps();
        else if (line.scans.size() == 2)
            bench_pairs(line.scans[0], line.scans[1]);
        else
            throw Error("Name a folder of photos, and one with their COLMAP model.");
        return EXIT_SUCCESS;
    }
    if (line.mode == "--lighter") {
        bench_lighter(files_of(line.scans));
        return EXIT_SUCCESS;
    }
    if (line.mode == "--variants") {
        bench_variants(files_of(line.scans), line.settings);
        return EXIT_SUCCESS;
    }
    if (line.scans.empty() && (line.mode == "--scans" || line.mode == "--methods" || line.mode == "--clicks"))
        throw Error("Name scans, or a folder of scans, after " + line.mode + ".");
    if (line.scans.empty() && !line.sample.empty()) line.scans.push_back(line.sample);
    const std::vector<std::string> scans = files_of(line.scans);
    if (scans.empty()) throw Error("Name a scan.");
    if (line.mode == "--resize") {
        write_resized(scans.front(), line.settings.most_points, line.out);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--bytes") {
        bench_bytes(scans);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--looks") {
        bench_looks(scans);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--fidelity") {
        bench_fidelity(scans, line.settings);
        return EXIT_SUCCESS;
    }
    if (line.mode == "--methods" || line.mode == "--clicks") {
        line.mode == "--methods" ? bench_methods(scans, line.settings) : bench_clicks(scans, line.settings);
        return EXIT_SUCCESS;
    }
    if (!line.mode.empty() && line.settings.program.empty())
        throw Error("Name the treerec program with --program.");
    if (line.mode == "--beside") {
        bench_beside(scans, line.settings);
    } else if (line.mode == "--scans") {
        bench_scans(scans, line.settings);
    } else {
        for (const std::string& scan : scans)
            line.mode == "--scaling" ? bench_scaling(scan, line.settings) : bench_stages(scan, line.settings);
    }
    return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
    use_ready_pictures();
    try {
        return run(parse({argv + 1, argv + argc}));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return EXIT_FAILURE;
    }
}
