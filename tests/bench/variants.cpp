// How many new individuals of a tree are made in a second, with their bark and their leaves.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>

#include "bench.h"
#include "edit/lighten/lighten.h"
#include "edit/vary/vary.h"
#include "exchange/tree_files.h"
#include "foliage/leaves.h"
#include "geometry/parallel.h"
#include "mesh/branch_tubes.h"
#include "mesh/joined_leaves.h"
#include "mesh/leaf_cards.h"
#include "pipeline/reconstruct.h"
#include "synth/grow.h"

namespace treerec::bench {

namespace {

constexpr size_t kTriangles = 5000;  // of the tree that a game would use

double least_ms(int times, const std::function<void()>& work) {
    double least = 1e300;
    for (int i = 0; i < times; i++) {
        const auto begin = std::chrono::steady_clock::now();
        work();
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
        least = std::min(least, took.count());
    }
    return least;
}

size_t triangles_of(const Tree& tree) {
    return build_branch_tubes(tree).indices.size() / 3;
}

// As the engine keeps it: normal and tangent in 8 bytes, colours in 4.
size_t bytes_of(const Mesh& mesh, bool leaves) {
    constexpr size_t kBark = 12 + 8 + 4 + 8 + 16 + 4, kLeaf = 12 + 8 + 4 + 8 + 16 + 4 + 4;
    return mesh.positions.size() * (leaves ? kLeaf : kBark) + mesh.indices.size() * 4;
}

void measure_tree(const char* name, const Tree& tree, const Foliage& foliage, int times) {
    set_thread_count(1);
    const double look_ms = least_ms(3, [&] { const VariantMaker maker(tree, foliage); });
    const VariantMaker maker(tree, foliage);
    const LeafRules rules = leaf_preset("oak");
    const Mesh card = build_leaf_card(rules, 0);
    uint64_t seed = 0;
    TreeVariant variant;
    const double make_ms = least_ms(times, [&] { variant = maker.make(seed++, 0.5); });
    const double young_ms = least_ms(times, [&] { maker.make(seed++, 0.5, 0.5); });
    Mesh bark;
    const double bark_ms = least_ms(times, [&] { bark = build_branch_tubes(variant.tree); });
    JoinedLeaves leaves;
    const double leaf_ms = least_ms(std::min(times, 20), [&] {
        leaves = join_leaves(place_leaves(variant.tree, rules, 1, variant.foliage), card);
    });
    std::printf("%-30.30s %8zu %8zu %8.2f %8.3f %8.3f %8zu %8.3f %8.0f %8zu %8.2f %8.0f %8.0f\n", name,
                tree.size(), foliage.cells.size(), look_ms, make_ms, young_ms, triangles_of(tree), bark_ms,
                1000.0 / (make_ms + bark_ms), leaves.mesh.triangle_count(), leaf_ms,
                1000.0 / (make_ms + bark_ms + leaf_ms),
                static_cast<double>(bytes_of(bark, false) + bytes_of(leaves.mesh, true)) / 1000.0);
    std::fflush(stdout);
    set_thread_count(0);
}

}  // namespace

void bench_variants(const std::vector<std::string>& files, const Settings& settings) {
    const int times = settings.repetitions > 0 ? settings.repetitions : 100;
    std::printf(
        "\nVariants, milliseconds on one core, the least of %d: looking at a tree once; making one, and one "
        "of half its age; its bark\nand how many of both are made in a second; its leaves (an oak's), and "
        "all three; kB as the engine keeps them\n",
        times);
    std::printf("%-30s %8s %8s %8s %8s %8s %8s %8s %8s %8s %8s %8s %8s\n", "tree", "nodes", "cells", "look",
                "make", "young", "bark tri", "ms", "each s", "leaf tri", "ms", "each s", "kB");
    const auto measure_both = [&](const std::string& name, const Tree& tree, const Foliage& foliage) {
        measure_tree(name.c_str(), tree, foliage, times);
        Tree light = tree;
        for (size_t nodes = tree.size(); nodes > 16 && triangles_of(light) > kTriangles; nodes -= nodes / 8) {
            light = tree;
            LightenOptions options;
            options.nodes = nodes;
            lighten(light, options);
        }
        measure_tree("  lighter", light.compacted(), {}, times);
    };
    for (const std::string& file : files) {
        const std::string name = file.substr(file.find_last_of("/\\") + 1);
        if (is_skeleton_file(file)) {
            measure_both(name, read_skeleton(file), {});
        } else {
            const Reconstruction made = reconstruct_file(file, {});
            measure_both(name, made.tree, made.foliage);
        }
    }
    if (!files.empty()) return;
    GrowOptions grow;
    grow.seed = 2;
    measure_both("a grown broadleaf", grow_tree(grow), {});
}

}  // namespace treerec::bench
