// What a user waits for while gardening: commands, undo, and the bark built anew.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>

#include "bench.h"
#include "edit/commands/commands.h"
#include "edit/prune/prune.h"
#include "mesh/branch_tubes.h"
#include "synth/grow.h"
#include "tree/trunk.h"

namespace treerec::bench {

namespace {

// A grown tree of exactly so many nodes, its finest twigs left out; a large one is a clump of several.
Tree tree_of(size_t nodes) {
    GrowOptions grow;
    grow.seed = 2;
    const Tree one = grow_tree(grow);
    Tree tree = one;
    const std::vector<NodeId> order = one.depth_first();
    for (int copy = 1; tree.size() < nodes; copy++) {
        std::vector<NodeId> placed(static_cast<size_t>(one.id_end()), kNoNode);
        const DVec3 offset(6.0 * (copy % 4), 0.0, 6.0 * (copy / 4));
        for (const NodeId id : order) {
            const Node& node = one.node(id);
            const NodeId parent = node.parent == kNoNode ? tree.root() : placed[node.parent];
            placed[id] = tree.add_child(parent, node.position + offset, node.radius, node.flags);
        }
    }
    std::vector<NodeId> kept = tree.breadth_first();
    kept.resize(nodes);
    keep_only(tree, kept);
    return tree.compacted();
}

// Milliseconds: the least of `times` runs, since other programs only ever make it slower.
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

}  // namespace

void bench_edits(const Settings& settings) {
    const int times = settings.repetitions > 0 ? settings.repetitions : 20;
    std::printf("\nEdits, milliseconds, the least of %d\n", times);
    std::printf("%8s %8s %8s %8s %8s %8s %10s %10s %10s\n", "nodes", "copy", "prune", "graft", "move", "undo",
                "undo kB", "all bark", "together");
    for (const size_t nodes : {size_t{5'000}, size_t{100'000}}) {
        const Tree tree = tree_of(nodes);
        const std::vector<NodeId> leaves = tree.nodes_of_kind(NodeKind::kLeaf);
        const std::string leaf = std::to_string(leaves[leaves.size() / 2]);
        const std::string prune = "prune factor=1.2", graft = "graft node=" + leaf;
        const std::string move = "move nodes=" + leaf + " by=0.1,0,0 falloff=1";
        Tree pruned, grafted, moved, copy;
        Edit edit;
        const double copy_ms = least_ms(times, [&] { copy = tree; });
        const double prune_ms = least_ms(times, [&] { edit = perform_on_copy(tree, prune, pruned); });
        const size_t kilobytes = edit.delta.bytes() / 1024;
        const double graft_ms = least_ms(times, [&] { perform_on_copy(tree, graft, grafted); });
        const double move_ms = least_ms(times, [&] { perform_on_copy(tree, move, moved); });
        const double undo_ms = least_ms(times, [&] {
            copy = pruned;
            edit.delta.revert(copy);
        });
        const double bark_ms = least_ms(times, [&] { build_branch_tubes(grafted); });
        std::printf("%8zu %8.2f %8.2f %8.2f %8.2f %8.2f %10zu %10.2f %10.2f\n", nodes, copy_ms, prune_ms,
                    graft_ms, move_ms, undo_ms, kilobytes, bark_ms, prune_ms + graft_ms + bark_ms);
        std::fflush(stdout);
    }
}

}  // namespace treerec::bench
