// How quickly the fidelity follows edits, and what both it and the review lists say of real scans.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "bench.h"
#include "completion/unexplained.h"
#include "fidelity/doubtful.h"
#include "fidelity/fidelity.h"
#include "file_bytes.h"
#include "pipeline/reconstruct.h"

namespace treerec::bench {

namespace {

// The kinds of edits that are timed, each on a fresh copy of the tree.
struct Edit {
    const char* name;
    std::function<void(Tree&)> apply;
};

// The node whose subtree holds about this share of all nodes, not on the trunk where that can be had.
NodeId subtree_of(const Tree& tree, double share) {
    std::vector<size_t> sizes(static_cast<size_t>(tree.id_end()), 0);
    const std::vector<NodeId> ids = tree.depth_first();
    for (size_t i = ids.size(); i-- > 0;) {
        const Node& node = tree.node(ids[i]);
        sizes[static_cast<size_t>(ids[i])]++;
        if (node.parent != kNoNode)
            sizes[static_cast<size_t>(node.parent)] += sizes[static_cast<size_t>(ids[i])];
    }
    const double wanted = share * static_cast<double>(tree.size());
    NodeId best = ids[1];
    double least = 1e300;
    for (size_t i = 1; i < ids.size(); i++) {
        const double off = std::abs(static_cast<double>(sizes[static_cast<size_t>(ids[i])]) - wanted);
        if (off < least) {
            least = off;
            best = ids[i];
        }
    }
    return best;
}

std::vector<Edit> edits_for(const Tree& tree) {
    const NodeId bough = subtree_of(tree, 0.1), branch = subtree_of(tree, 0.01), twig = subtree_of(tree, 0.0);
    return {
        {"a twig moves", [=](Tree& t) { t.set_position(twig, t.node(twig).position + DVec3(0.02)); }},
        {"a branch moves",
         [=](Tree& t) {
             for (NodeId id : t.depth_first(branch))
                 t.set_position(id, t.node(id).position + DVec3(0.0, 0.02, 0.0));
         }},
        {"a branch goes", [=](Tree& t) { t.remove_subtree(branch); }},
        {"a tenth moves",
         [=](Tree& t) {
             for (NodeId id : t.depth_first(bough))
                 t.set_position(id, t.node(id).position + DVec3(0.0, 0.02, 0.0));
         }},
        {"a tenth goes", [=](Tree& t) { t.remove_subtree(bough); }},
    };
}

double milliseconds_of(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void bench_fidelity(const std::vector<std::string>& scans, const Settings& settings) {
    const int repetitions = settings.repetitions > 0 ? settings.repetitions : 5;
    for (const std::string& scan : scans) {
        const Reconstruction made = reconstruct_file(scan, {});
        PointCloud wood = made.cloud;
        if (!made.wood.empty() && made.leaf_points < wood.size()) wood.keep_only(made.wood);
        double first = 1e300;
        for (int i = 0; i < repetitions; i++)
            first = std::min(first, milliseconds_of([&] { measure_fidelity(made.tree, wood); }));
        const Fidelity fidelity = measure_fidelity(made.tree, wood);
        const double missing = milliseconds_of([&] { find_unexplained(made.tree, wood, fidelity); });
        std::printf(
            "\n%s: %zu points of wood, %zu nodes; R_s %.3f, explained %.1f %%, covered %.1f %%; "
            "%zu clusters unexplained, %zu branches doubtful\n\n",
            stem_of(scan).c_str(), wood.size(), made.tree.size(), fidelity.skeleton,
            100.0 * fidelity.all.explained, 100.0 * fidelity.all.coverage,
            find_unexplained(made.tree, wood, fidelity).size(), find_doubtful(made.tree, fidelity).size());
        std::printf("| | points measured | ms |\n|---|---|---|\n| first | %zu | %.1f |\n", wood.size(),
                    first);
        for (const Edit& edit : edits_for(made.tree)) {
            double least = 1e300;
            size_t measured = 0;
            for (int i = 0; i < repetitions; i++) {
                FidelityTracker tracker(wood);
                tracker.update(made.tree);
                Tree edited = made.tree;
                edit.apply(edited);
                least = std::min(least, milliseconds_of([&] { tracker.update(edited); }));
                measured = tracker.points_measured();
            }
            std::printf("| %s | %zu | %.1f |\n", edit.name, measured, least);
        }
        std::printf("| unexplained clusters | | %.1f |\n", missing);
    }
}

}  // namespace treerec::bench
