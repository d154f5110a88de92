// What tests/bench/fit_leaves.py fits the rule of skeleton/twigs/leaf_twigs.h to.
#include <cstdio>

#include "bench.h"
#include "file_bytes.h"
#include "geometry/capsule_tree.h"
#include "grown_settings.h"
#include "scan/leaves/wood_leaf.h"
#include "skeleton/skeleton.h"
#include "skeleton/twigs/leaf_twigs.h"
#include "synth/scan.h"
#include "tree/wood_segments.h"

namespace treerec::bench {

namespace {

constexpr uint64_t kFirstSeed = 2000;  // no other table's

// Sharp and blurred, half and fully in leaf, as dense as a mobile scanner's and as a terrestrial one's.
constexpr GrownSetting kSettings[] = {
    {0.003, 0.8, 0.0, 15000},  {0.01, 0.4, 0.3, 20000},  {0.003, 0.3, 0.0, 250000},
    {0.003, 0.8, 0.3, 120000}, {0.01, 0.5, 0.0, 150000}, {0.003, 0.2, 0.0, 40000},
};

// The share of a line that lies within true wood, or a centimetre of its axis.
double true_share(const std::vector<DVec3>& line, const CapsuleTree& truth) {
    constexpr double kStep = 0.01, kNear = 0.01;  // metres
    double right = 0.0, all = 0.0;
    for (size_t i = 1; i < line.size(); i++) {
        const double length = glm::distance(line[i - 1], line[i]);
        const int steps = static_cast<int>(length / kStep) + 1;
        for (int k = 0; k < steps; k++) {
            const DVec3 p = glm::mix(line[i - 1], line[i], (k + 0.5) / steps);
            const double weight = length / steps;
            all += weight;
            const bool in_wood = truth.find_solid(p, 0.0) >= 0 || truth.nearest_axis(p).distance <= kNear;
            right += in_wood ? weight : 0.0;
        }
    }
    return all > 0.0 ? right / all : 0.0;
}

double length_of(const std::vector<DVec3>& line) {
    double length = 0.0;
    for (size_t i = 1; i < line.size(); i++)
        length += glm::distance(line[i - 1], line[i]);
    return length;
}

// The looks of each stretch of the skeleton that a scan in leaf gives, its length and its true share. Nothing
// where the scan is not told to be in leaf.
std::string inputs_of(PointCloud cloud, const Tree& truth) {
    cloud.colors.clear();
    const WoodLeaf told = tell_wood_from_leaves(cloud);
    std::string bytes;
    if (told.leafiness.empty()) return bytes;
    PointCloud followed = cloud;
    if (!told.wood_path.empty()) followed.keep_only(told.wood_path);
    SkeletonOptions options;
    options.noise = told.noise;
    const Tree tree = skeletonize(followed, options).tree;
    const DVec3 moved = tree.frame().origin - cloud.frame.origin;
    for (Vec3& p : cloud.positions)
        p -= Vec3(moved);
    const CapsuleTree wood(wood_segments(truth));
    const SubProgress progress(nullptr, 0.0, 1.0);
    for (TwigSample& sample : look_at_twigs(tree, cloud.positions, told.leafiness, progress)) {
        for (DVec3& p : sample.line)
            p += moved;
        std::vector<float> row(sample.looks.begin(), sample.looks.end());
        row.push_back(static_cast<float>(length_of(sample.line)));
        row.push_back(static_cast<float>(true_share(sample.line, wood)));
        bytes.append(reinterpret_cast<const char*>(row.data()), row.size() * sizeof(float));
    }
    return bytes;
}

}  // namespace

void bench_twig_inputs(const Settings& settings) {
    make_folder(settings.out);
    std::vector<Habit> habits = all_habits();
    std::erase(habits, Habit::kPalm);
    for (const auto& [setting, name] : named_cases(kSettings, habits, kFirstSeed, settings.seeds)) {
        const Tree truth = grow_tree({setting.habit, 0.0, setting.seed});
        const PointCloud cloud = scan_tree(truth, scan_options_of(setting)).cloud;
        write_file(settings.out + "/" + name + ".bin", inputs_of(cloud, truth));
        std::printf("%s: %zu points\n", name.c_str(), cloud.size());
        std::fflush(stdout);
    }
}

}  // namespace treerec::bench
