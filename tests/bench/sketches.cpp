// How soon a tree follows the pen.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>

#include "../unit/steady_sketches.h"
#include "bench.h"
#include "foliage/leaves.h"
#include "mesh/branch_tubes.h"
#include "mesh/leaf_cards.h"
#include "pipeline/sketch_report.h"
#include "sketch/read_sketch.h"
#include "sketch/sketch.h"
#include "sketch/species.h"

namespace treerec::bench {

namespace {

double ms_of(const std::function<void()>& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

double share(std::vector<double> values, double of) {
    std::sort(values.begin(), values.end());
    return values[static_cast<size_t>(of * static_cast<double>(values.size() - 1))];
}

// The paper's table 2 (Ma and Liu 2020): how long its authors drew and how long their program then took,
// beside what ours takes for the same four trees, drawn anew.
void bench_table2() {
    struct Row {
        const char* species;
        int strokes;
        double drawn, paper;  // seconds
    };
    constexpr Row kRows[] = {{"poplar", 8, 18.0, 33.0},
                             {"maple", 5, 14.0, 26.0},
                             {"magnolia", 7, 20.0, 41.0},
                             {"ginkgo", 5, 15.0, 22.0}};
    std::printf("\nthe paper's table 2, s; ours with the finest mesh and leaves, the median of 9\n");
    std::printf("%-10s %15s %8s %8s %14s %9s\n", "species", "paper's strokes", "drawing", "paper",
                "our strokes", "ours");
    for (const Row& row : kRows) {
        const std::string path = std::string("tests/sketch/cases/") + row.species + ".json";
        const Sketch sketch = read_sketch(path);
        std::vector<double> times;
        for (int i = 0; i < 9; i++)
            times.push_back(ms_of([&] {
                const SketchedTree made = sketch_tree(sketch, {});
                build_branch_tubes(made.tree);
                leaf_buffer(place_leaves(made.tree, leaf_preset(row.species), 1));
            }));
        std::printf("%-10s %15d %8.0f %8.0f %14zu %9.3f\n", row.species, row.strokes, row.drawn, row.paper,
                    sketch.strokes.size(), 1e-3 * share(times, 0.5));
    }
}

}  // namespace

void bench_sketches(const Settings& settings) {
    const int sketches = settings.repetitions > 0 ? settings.repetitions : 25;
    std::printf("strokes to a tree with its finest mesh, ms; the crown against its outline\n");
    std::printf("%-10s %7s %7s %7s %7s %7s %7s %7s %7s %8s\n", "species", "tree", "all", "95 %", "alpha",
                "nodes", "leaves", "IoU", "worst", "outside");
    for (const std::string& species : sketch_species_names()) {
        std::vector<double> trees, wholes, alphas, ious, outsides;
        size_t nodes = 0, leaves = 0;
        const LeafRules rules = leaf_preset(species);
        for (int i = 1; i <= sketches; i++) {
            Sketch sketch = drawn_sketch(static_cast<uint64_t>(i));
            sketch.species = species;
            SketchedTree made;
            trees.push_back(ms_of([&] { made = sketch_tree(sketch, {}); }));
            std::vector<float> buffer;
            wholes.push_back(trees.back() + ms_of([&] {
                                 build_branch_tubes(made.tree);
                                 buffer = leaf_buffer(place_leaves(made.tree, rules, 1));
                             }));
            nodes += made.tree.size();
            leaves += buffer.size() / 20;
            SketchOptions printed;
            printed.depth = SketchDepth::kPaper;
            printed.crown = SketchCrown::kAlpha;
            alphas.push_back(ms_of([&] { sketch_tree(sketch, printed); }));
            if (i > 8) continue;  // seconds each
            const CrownOverlap overlap =
                measure_crown_overlap(made, sketch, outline_parts(made.tree, rules, species, 1, {}));
            ious.push_back(overlap.overlap.iou);
            outsides.push_back(overlap.outside);
        }
        double mean = 0.0;
        for (const double iou : ious)
            mean += iou / static_cast<double>(ious.size());
        std::printf("%-10s %7.1f %7.1f %7.1f %7.1f %7zu %7zu %7.3f %7.3f %7.1f%%\n", species.c_str(),
                    share(trees, 0.5), share(wholes, 0.5), share(wholes, 0.95), share(alphas, 0.5),
                    nodes / static_cast<size_t>(sketches), leaves / static_cast<size_t>(sketches), mean,
                    share(ious, 0.0), 100.0 * share(outsides, 1.0));
        std::fflush(stdout);
    }
    bench_table2();
}

}  // namespace treerec::bench
