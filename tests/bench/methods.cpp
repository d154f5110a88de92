// The skeletonizers side by side, AdTree's over both of its trees, the flood also as Zhang 2013 prints it,
// and what guided completion makes of their trees.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>

#include "bench.h"
#include "completion/complete.h"
#include "completion/unexplained.h"
#include "error.h"
#include "exchange/tree_files.h"
#include "fidelity/doubtful.h"
#include "fidelity/score.h"
#include "geometry/capsule_tree.h"
#include "pipeline/reconstruct.h"
#include "tree/branches.h"
#include "tree/wood_segments.h"

namespace treerec::bench {

namespace {

constexpr double kNear = 0.02;        // metres from the true axis, or its radius
constexpr double kTolerance = 0.012;  // metres: finer than usual, as these scans are
constexpr double kAccepted = 0.8;     // of a branch's length: somebody who knows the truth accepts it
constexpr double kCut = 0.5;          // less than so much: cuts it

// What the skeletonizer alone takes, of all threads.
struct Run {
    Reconstruction made;
    double seconds = 0.0;
};

double processor_seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

struct Method {
    const char* name;
    SkeletonMethod method;
    FloodKind flood = FloodKind::kOurs;
    SpanningTreeKind spanning_tree = SpanningTreeKind::kShortestPaths;
};

constexpr Method kGeodesic{"geodesic", SkeletonMethod::kGeodesic};
constexpr Method kDelaunay{"delaunay", SkeletonMethod::kDelaunay};
constexpr Method kMinimum{"minimum", SkeletonMethod::kDelaunay, FloodKind::kOurs, SpanningTreeKind::kMinimum};
constexpr Method kFlood{"flood", SkeletonMethod::kFlood};
constexpr Method kPrinted{"printed", SkeletonMethod::kFlood, FloodKind::kPaper};

ReconstructOptions options_of(const Method& method) {
    ReconstructOptions options;
    options.skeleton.method = method.method;
    options.skeleton.flood = method.flood;
    options.skeleton.spanning_tree = method.spanning_tree;
    options.skeleton.keep_raw = false;
    return options;
}

Run run_method(const std::string& scan, const Method& method) {
    Run run;
    const double start = processor_seconds();
    run.made = reconstruct_file(scan, options_of(method));
    run.seconds = processor_seconds() - start;
    return run;
}

// How a tree stands to the truth, both in scan coordinates.
class Truth {
  public:
    explicit Truth(const std::string& file) : tree_(read_skeleton(file)), wood_(wood_segments(tree_)) {}

    const Tree& tree() const { return tree_; }

    // The share of the wood above each of these nodes' parents, node by node, that lies on true wood.
    double share_true(const Tree& tree, const std::vector<NodeId>& nodes) const {
        double length = 0.0;
        double right = 0.0;
        for (const NodeId id : nodes) {
            const Node& node = tree.node(id);
            if (node.parent == kNoNode) continue;
            const DVec3 from = tree.node(node.parent).position;
            const int steps = std::max(1, static_cast<int>(glm::distance(from, node.position) / 0.005));
            for (int i = 0; i < steps; i++) {
                const DVec3 p = from + (i + 0.5) / steps * (node.position - from);
                const DVec3 place = tree_.frame().to_tree(tree.frame().to_scan(p));
                const CapsuleTree::Hit hit = wood_.nearest_axis(place);
                const double step = glm::distance(from, node.position) / steps;
                length += step;
                if (hit.distance <= std::max(kNear, wood_.segment(hit.segment).radius)) right += step;
            }
        }
        return length > 0.0 ? right / length : 0.0;
    }

  private:
    Tree tree_;
    CapsuleTree wood_;
};

void print_clicks(const char* method, int clicks, const Tree& tree, const Truth& truth, const Fidelity& fit) {
    const SkeletonScore score = score_skeleton(tree, truth.tree());
    std::printf("%-12s %6d %9.1f %8.3f %9.3f %11.1f\n", method, clicks, 100.0 * score.length_error,
                score.match.recall, score.match.precision, 100.0 * fit.all.explained);
}

// Every third side branch is lost, as a scan with worse light, or another program, would lose it.
void lose_branches(Tree& tree) {
    size_t number = 0;
    const BranchList list = list_branches(tree);
    for (const Branch& branch : list.branches) {
        const NodeId first = list.nodes_of(branch).front();
        if (branch.order == 0 || number++ % 3 != 0 || !tree.contains(first)) continue;
        tree.remove_subtree(first);
    }
}

void click_through(const Reconstruction& made, const char* method, const Truth& truth, bool lose = false) {
    constexpr int kMostClicks = 160;
    Tree tree = made.tree;
    if (lose) lose_branches(tree);
    FidelityOptions measuring;
    measuring.tolerance = kTolerance;
    FidelityTracker tracker(made.cloud, measuring);
    print_clicks(method, 0, tree, truth, tracker.update(tree));
    int clicks = 0;
    int next = 5;
    const auto click = [&] {
        if (++clicks < next) return;
        next *= 2;
        print_clicks(method, clicks, tree, truth, tracker.update(tree));
    };
    // What is missing, the largest first.
    CompleteOptions completing;
    completing.tolerance = kTolerance;
    Completer completer(tree, made.cloud, completing, made.wood);
    for (const UnexplainedCluster& cluster :
         find_unexplained(tree, made.cloud, tracker.update(tree), made.wood)) {
        if (clicks >= kMostClicks / 2) break;
        try {
            const Completion done =
                completer.complete(tree, cluster.joint, cluster.direction, 1.5 * cluster.gap + 0.05);
            if (truth.share_true(tree, done.added) < kAccepted) tree.remove_subtree(done.added.front());
        } catch (const Error&) {
            // Nothing hangs together there: a click all the same.
        }
        click();
    }
    // What is doubtful, the most doubtful first.
    for (const DoubtfulBranch& branch : find_doubtful(tree, tracker.update(tree))) {
        if (clicks >= kMostClicks) break;
        if (!tree.contains(branch.node)) continue;
        std::vector<NodeId> below = tree.depth_first(branch.node);
        if (truth.share_true(tree, below) < kCut) tree.remove_subtree(branch.node);
        click();
    }
    print_clicks(method, clicks, tree, truth, tracker.update(tree));
}

}  // namespace

void bench_methods(const std::vector<std::string>& scans, const Settings& settings) {
    std::printf("%-36s %-9s %7s %9s %7s %6s %18s %9s  recall precision length %%\n", "scan", "method",
                "CPU s", "voxel mm", "nodes", "tips", "mm median/p95", "in 2 cm %");
    for (const std::string& scan : scans)
        for (const Method& method : {kGeodesic, kDelaunay, kMinimum, kFlood, kPrinted}) {
            const std::string name = std::filesystem::path(scan).filename().string();
            try {
                const Run run = run_method(scan, method);
                const Reconstruction& made = run.made;
                std::printf("%-36s %-9s %7.2f %9.1f %7zu %6zu %9.1f / %6.1f %9.1f", name.c_str(), method.name,
                            run.seconds, 1000.0 * made.voxel, made.measured.nodes, made.measured.tips,
                            made.fit.median_mm, made.fit.p95_mm, 100.0 * made.fit.explained_2cm);
                const std::string truth = truth_of(scan, settings.truth);
                if (!truth.empty()) {
                    const SkeletonScore score = score_skeleton(made.tree, read_skeleton(truth));
                    std::printf("  %6.3f %9.3f %+8.1f", score.match.recall, score.match.precision,
                                100.0 * score.length_error);
                }
                std::printf("\n");
            } catch (const Error& error) {
                std::printf("%-36s %-9s %s\n", name.c_str(), method.name, error.what());
            }
            std::fflush(stdout);
        }
}

void bench_clicks(const std::vector<std::string>& scans, const Settings& settings) {
    for (const std::string& scan : scans) {
        const std::string file = truth_of(scan, settings.truth);
        if (file.empty()) continue;
        const Truth truth(file);
        std::printf("%s\n%-12s %6s %9s %8s %9s %11s\n", std::filesystem::path(scan).filename().c_str(),
                    "method", "clicks", "length %", "recall", "precision", "explained %");
        for (const Method& method : {kGeodesic, kFlood}) {
            click_through(run_method(scan, method).made, method.name, truth);
            std::fflush(stdout);
        }
        click_through(run_method(scan, kGeodesic).made, "a third lost", truth, true);
    }
}

}  // namespace treerec::bench
