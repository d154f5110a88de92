// The table of Zhang 2013, 9.2: how much smaller a tree's file becomes, and what it costs to look at.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>

#include "bench.h"
#include "edit/lighten/lighten.h"
#include "error.h"
#include "exchange/tree_files.h"
#include "fidelity/silhouette.h"
#include "file_bytes.h"
#include "mesh/branch_tubes.h"
#include "pipeline/reconstruct.h"
#include "synth/grow.h"

namespace treerec::bench {

namespace {

// The three trees of the paper's table 9.2: kilobytes of the skeleton before and after.
constexpr struct { double before, after; } kMarks[] = {{50.3, 8.2}, {103.1, 15.1}, {31.5, 7.3}};

class Sizes {
  public:
    Sizes() : path_(utf8_of(std::filesystem::temp_directory_path() / "treerec_bench_lighter.txt")) {}
    ~Sizes() {
        std::error_code failure;
        std::filesystem::remove(path_of(path_), failure);
    }
    // Bytes of the tree as a tree file.
    double of(const Tree& tree) const {
        write_treefile(path_, tree);
        return static_cast<double>(std::filesystem::file_size(path_of(path_)));
    }

  private:
    std::string path_;
};

SilhouetteView change_of(const Mesh& before, const Tree& tree) {
    return compare_silhouettes(before, build_branch_tubes(tree)).all();
}

void print_way(const char* way, const Tree& tree, double kilobytes, const SilhouetteView& change,
               const std::string& how) {
    std::printf("    %-6s %7zu %8.1f %9.2f %9.2f   %s\n", way, tree.size(), kilobytes,
                100.0 * change.share_of_silhouette(), 100.0 * change.share_of_picture(), how.c_str());
}

void print_marks(const std::string& name, const Tree& tree) {
    const Sizes sizes;
    const Mesh mesh = build_branch_tubes(tree);
    const double bytes = sizes.of(tree);
    const size_t tips = tree.nodes_of_kind(NodeKind::kLeaf).size();
    std::printf("%s: %zu nodes, %zu tips, %.1f KB\n", name.c_str(), tree.size(), tips, bytes / 1024.0);
    for (const auto& mark : kMarks) {
        const double most = bytes * mark.after / mark.before;
        // Ours: the most nodes whose file is small enough.
        size_t fits = 2, too_many = tree.size();
        Tree ours;
        Lightened result;
        double milliseconds = 0.0;
        while (too_many - fits > std::max<size_t>(1, fits / 256)) {
            LightenOptions options;
            options.nodes = fits + (too_many - fits) / 2;
            Tree light = tree;
            const std::clock_t start = std::clock();
            const Lightened tried = lighten(light, options);
            const double spent = 1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
            if (sizes.of(light) > most) {
                too_many = options.nodes;
                continue;
            }
            fits = options.nodes;
            ours = light;
            result = tried;
            milliseconds = spent;
        }
        std::printf("  %.1f -> %.1f KB is 1 in %.2f\n", mark.before, mark.after, mark.before / mark.after);
        if (ours.empty()) {
            std::printf("    cannot be reached\n");
            continue;
        }
        char how[120];
        std::snprintf(how, sizeof how, "bark by %.1f cm, tips by %.0f cm; %.1f ms", 100.0 * result.deviation,
                      100.0 * result.tip_distance, milliseconds);
        print_way("ours", ours, sizes.of(ours) / 1024.0, change_of(mesh, ours), how);
        // The paper's: of several angles the one that is seen least, each with the distance that it takes.
        double least = 2.0;
        Tree best;
        SilhouetteView seen;
        for (const double angle : {10.0, 20.0, 30.0, 45.0, 60.0, 90.0, 180.0}) {
            double near = 0.0, far = 100.0;
            Tree light;
            for (int step = 0; step < 18; step++) {
                const double distance = step == 0 ? 0.0 : step == 1 ? far : 0.5 * (near + far);
                Tree tried = tree;
                merge_branches(tried, angle, distance);
                const bool small = sizes.of(tried) <= most;
                if (small) light = tried;
                if (step == 0 && small) {
                    far = 0.0;
                    break;
                }
                if (step == 1 && !small) break;
                if (step > 1) (small ? far : near) = distance;
            }
            if (light.empty()) continue;
            const SilhouetteView change = change_of(mesh, light);
            if (change.share_of_silhouette() >= least) continue;
            least = change.share_of_silhouette();
            best = light;
            seen = change;
            std::snprintf(how, sizeof how, "%g degrees, %.2f m", angle, far);
        }
        if (!best.empty()) print_way("paper", best, sizes.of(best) / 1024.0, seen, how);
    }
}

}  // namespace

void bench_lighter(const std::vector<std::string>& files) {
    std::printf(
        "                nodes       KB   outline   picture   (%% that differ; 4 sides, 1024 pixels)\n");
    for (const std::string& file : files)
        print_marks(stem_of(file),
                    is_skeleton_file(file) ? read_skeleton(file) : reconstruct_file(file, {}).tree);
    if (!files.empty()) return;
    for (const Habit habit : {Habit::kBroadleaf, Habit::kConifer, Habit::kBirch, Habit::kForked})
        print_marks(habit_name(habit), grow_tree({habit, 0.0, 1}));
}

}  // namespace treerec::bench
