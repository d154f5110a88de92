// Time and memory of every stage, for each scan named on the command line (google benchmark's own options
// work too).
#include <benchmark/benchmark.h>

#ifdef __linux__
#include <sys/resource.h>
#endif

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "error.h"
#include "foliage/leaves.h"
#include "mesh/branch_tubes.h"
#include "mesh/leaf_cards.h"
#include "pipeline/reconstruct.h"

namespace {

using namespace treerec;

// Every stage's input, made once per scan.
struct Stages {
    std::string path;
    PointCloud raw, oriented, clean;
    Tree tree;
    std::vector<LeafPlacement> leaves;
};

double peak_megabytes() {
#ifdef __linux__
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024.0;
#else
    return 0.0;
#endif
}

template <typename Work>
void add(const std::string& scan, const char* stage, size_t items, Work work) {
    benchmark::RegisterBenchmark((scan + "/" + stage).c_str(), [=](benchmark::State& state) {
        for ([[maybe_unused]] auto step : state)
            work();
        const double rounds = static_cast<double>(state.iterations()) * static_cast<double>(items);
        state.counters["items"] = static_cast<double>(items);
        state.counters["per_item"] =
            benchmark::Counter(rounds, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
        state.counters["peak_MB"] = peak_megabytes();
    })->Unit(benchmark::kMillisecond);
}

void add_scan(const std::string& path) {
    auto stages = std::make_shared<Stages>();
    stages->path = path;
    stages->raw = read_cloud(path);
    stages->oriented = stages->raw;
    orient_cloud(stages->oriented, {});
    stages->clean = stages->oriented;
    clean_cloud(stages->clean, {});
    stages->tree = skeletonize(stages->clean, {}).tree;
    const LeafRules rules = leaf_preset("generic");
    stages->leaves = place_leaves(stages->tree, rules, 1);
    const std::string name = std::filesystem::path(path).filename().string();
    const size_t points = stages->raw.size();
    add(name, "read", points, [stages] { benchmark::DoNotOptimize(read_cloud(stages->path)); });
    add(name, "orient", points, [stages] {
        PointCloud cloud = stages->raw;
        benchmark::DoNotOptimize(orient_cloud(cloud, {}));
    });
    add(name, "clean", points, [stages] {
        PointCloud cloud = stages->oriented;
        benchmark::DoNotOptimize(clean_cloud(cloud, {}));
    });
    add(name, "skeletonize", points, [stages] { benchmark::DoNotOptimize(skeletonize(stages->clean, {})); });
    add(name, "tubes", stages->tree.size(),
        [stages] { benchmark::DoNotOptimize(build_branch_tubes(stages->tree)); });
    add(name, "leaves", stages->leaves.size(),
        [stages, rules] { benchmark::DoNotOptimize(place_leaves(stages->tree, rules, 1)); });
    add(name, "leaf_buffer", stages->leaves.size(),
        [stages] { benchmark::DoNotOptimize(leaf_buffer(stages->leaves)); });
    add(name, "write_glb", stages->tree.size(), [stages, rules] {
        const std::filesystem::path out = std::filesystem::temp_directory_path() / "treerec_bench.glb";
        export_tree(out.string(), stages->tree, rules, 1);
        std::filesystem::remove(out);
    });
    add(name, "file_to_glb", points, [stages, rules] {
        const std::filesystem::path out = std::filesystem::temp_directory_path() / "treerec_bench.glb";
        export_tree(out.string(), reconstruct_file(stages->path, {}).tree, rules, 1);
        std::filesystem::remove(out);
    });
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    try {
        for (int i = 1; i < argc; i++)
            add_scan(argv[i]);
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return EXIT_FAILURE;
    }
    benchmark::RunSpecifiedBenchmarks();
    return EXIT_SUCCESS;
}
