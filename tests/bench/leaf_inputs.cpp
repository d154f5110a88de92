// What tests/bench/fit_leaves.py fits the classifier of leaves to.
#include <charconv>
#include <cstdio>
#include <filesystem>

#include "bench.h"
#include "error.h"
#include "file_bytes.h"
#include "grown_settings.h"
#include "scan/cleaning/clean_cloud.h"
#include "scan/cleaning/samples.h"
#include "scan/formats/read_cloud.h"
#include "scan/leaves/leaf_classifier.h"
#include "scan/usual_size.h"
#include "synth/scan.h"

namespace treerec::bench {

namespace {

constexpr size_t kMostSamples = 400000;  // as in scan/leaves/wood_leaf.cpp
constexpr size_t kRows = 3000;           // of a scan
constexpr uint64_t kFirstSeed = 1000;    // no other table's

// From sharp to blurred, bare to full, sparse to dense.
constexpr GrownSetting kSettings[] = {
    {0.0, 0.4, 0.0, 20000},  {0.01, 0.4, 0.3, 20000},  {0.003, 0.8, 0.0, 15000}, {0.003, 0.8, 0.3, 60000},
    {0.02, 0.8, 0.0, 20000}, {0.01, 0.8, 0.6, 20000},  {0.005, 0.6, 0.6, 8000},  {0.01, 0.2, 0.0, 40000},
    {0.02, 0.4, 0.3, 40000}, {0.003, 0.0, 0.0, 20000}, {0.02, 0.0, 0.0, 20000},  {0.01, 0.0, 0.3, 8000},
};

std::vector<float> read_weights(const std::string& path) {
    const FileBytes bytes = read_file(path);
    const std::string_view text = bytes.view();
    std::vector<float> weights;
    for (const char *at = text.data(), *end = at + text.size(); at < end;) {
        float value = 0.0F;
        const auto [next, error] = std::from_chars(at, end, value);
        if (error == std::errc()) weights.push_back(value);
        at = error == std::errc() ? next : at + 1;
    }
    return weights;
}

// truth: by point, the share of it that is leaf.
void write_inputs(const std::string& name, std::vector<Vec3> positions, const std::vector<uint8_t>& truth,
                  const std::string& weights, const std::string& folder) {
    const double factor = enlargement_to_usual(positions);
    for (Vec3& p : positions)
        p = Vec3(DVec3(p) * factor);
    const SubProgress progress(nullptr, 0.0, 1.0);
    const Samples samples = take_samples(positions, kMostSamples, &progress);
    const Cells cells = make_cells(samples.points, progress);
    CellShapes shapes;
    measure_shapes(cells, 0, kShapeScales - 1, shapes, progress);
    const CellPaths paths = trace_paths(cells, progress);
    const LeafClassifier classifier(samples.points, cells, shapes, paths, progress);
    std::vector<float> inputs = classifier.point_inputs();
    size_t width = kPointInputs;
    if (!weights.empty()) {
        const LeafNetwork network(read_weights(weights), kPointInputs);
        std::vector<float> logits(samples.points.size());
        for (size_t i = 0; i < logits.size(); i++)
            logits[i] = network.logit(&inputs[i * kPointInputs]);
        inputs = classifier.context_inputs(logits);
        width = kContextInputs;
    }
    const size_t count = samples.points.size();
    std::vector<float> leaf(count, 0.0F), number(count, 0.0F);
    for (size_t i = 0; i < truth.size(); i++) {
        leaf[samples.of_point[i]] += truth[i] != 0 ? 1.0F : 0.0F;
        number[samples.of_point[i]] += 1.0F;
    }
    std::string bytes;
    const size_t stride = std::max<size_t>(1, count / kRows);
    for (size_t i = stride / 2; i < count; i += stride) {
        if (number[i] == 0.0F) continue;
        const float y = leaf[i] / number[i];
        bytes.append(reinterpret_cast<const char*>(&inputs[i * width]), width * sizeof(float));
        bytes.append(reinterpret_cast<const char*>(&y), sizeof(float));
    }
    write_file(folder + "/" + name + ".bin", bytes);
    std::printf("%s: %zu points\n", name.c_str(), count);
    std::fflush(stdout);
}

}  // namespace

void bench_leaf_inputs(const std::vector<std::string>& scans, const Settings& settings) {
    make_folder(settings.out);
    size_t number = 0;
    // Each half of the scans is seen by a network that was fitted to the other.
    const auto weights = [&] {
        return settings.weights.empty() ? std::string()
                                        : settings.weights + (number % 2 == 0 ? "/even.txt" : "/odd.txt");
    };
    for (const auto& [setting, name] : named_cases(kSettings, all_habits(), kFirstSeed, settings.seeds)) {
        const VirtualScan scan =
            scan_tree(grow_tree({setting.habit, 0.0, setting.seed}), scan_options_of(setting));
        std::vector<uint8_t> truth;
        for (const uint8_t origin : scan.origin)
            truth.push_back(origin == kFromLeaf ? 1 : 0);
        write_inputs(name, scan.cloud.positions, truth, weights(), settings.out);
        number++;
    }
    for (const std::string& path : scans) {
        PointCloud cloud = read_cloud(path);
        orient_cloud(cloud, {});
        clean_cloud(cloud, {});
        const std::vector<uint8_t> truth =
            cloud.labels.empty() ? std::vector<uint8_t>(cloud.size(), 0) : cloud.labels.values;
        write_inputs("real " + std::to_string(number) + " " + path_of(path).stem().string(), cloud.positions,
                     truth, weights(), settings.out);
        number++;
    }
}

}  // namespace treerec::bench
