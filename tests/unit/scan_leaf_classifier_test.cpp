#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "error.h"
#include "scan/cleaning/samples.h"
#include "scan/leaves/leaf_classifier.h"
#include "synth/scan.h"

namespace treerec {
namespace {

TEST(LeafNetwork, IsAPerceptronOfTwoHiddenLayers) {
    constexpr size_t kInputs = 2;
    std::vector<float> weights(LeafNetwork::weights_for(kInputs), 0.0F);
    // Means, deviations; the first unit of both layers sees the first input alone.
    weights[0] = 1.0F;
    weights[2] = 2.0F;
    weights[3] = 1.0F;
    const size_t first = 2 * kInputs, second = first + (kInputs + 1) * LeafNetwork::kFirst;
    const size_t last = second + (LeafNetwork::kFirst + 1) * LeafNetwork::kSecond;
    weights[first] = 3.0F;
    weights[first + kInputs * LeafNetwork::kFirst] = 0.5F;
    weights[second] = 2.0F;
    weights[last] = -1.0F;
    weights[last + LeafNetwork::kSecond] = 0.25F;
    const LeafNetwork network(weights, kInputs);
    const auto at = [&](float x) { return network.logit(std::array{x, 7.0F}.data()); };
    EXPECT_FLOAT_EQ(at(2.0F), 0.25F - 2.0F * (3.0F * 0.5F + 0.5F));
    EXPECT_FLOAT_EQ(at(-100.0F), 0.25F);                               // rectified
    EXPECT_FLOAT_EQ(at(100.0F), 0.25F - 2.0F * (3.0F * 3.0F + 0.5F));  // three deviations, at most
}

TEST(LeafNetwork, WantsAsManyWeightsAsItsInputs) {
    EXPECT_THROW(LeafNetwork(std::vector<float>(7), 2), Error);
    EXPECT_NO_THROW(LeafNetwork(LeafWeights::fitted().point, kPointInputs));
    EXPECT_NO_THROW(LeafNetwork(LeafWeights::fitted().context, kContextInputs));
}

struct Told {
    std::vector<float> logits;  // by sample
    std::vector<float> leaf;    // share of the sample's points
};

Told tell(const VirtualScan& scan) {
    const SubProgress progress(nullptr, 0.0, 1.0);
    const Samples samples = take_samples(scan.cloud.positions, 400000, &progress);
    const Cells cells = make_cells(samples.points, progress);
    CellShapes shapes;
    measure_shapes(cells, 0, kShapeScales - 1, shapes, progress);
    const CellPaths paths = trace_paths(cells, progress);
    Told told{LeafClassifier(samples.points, cells, shapes, paths, progress).logits(), {}};
    std::vector<float> number(samples.points.size(), 0.0F);
    told.leaf.assign(samples.points.size(), 0.0F);
    for (size_t i = 0; i < scan.origin.size(); i++) {
        told.leaf[samples.of_point[i]] += scan.origin[i] == kFromLeaf ? 1.0F : 0.0F;
        number[samples.of_point[i]] += 1.0F;
    }
    for (size_t i = 0; i < number.size(); i++)
        told.leaf[i] /= number[i];
    return told;
}

// The chance that a point of a leaf looks leafier than one of wood.
double area_under_curve(const Told& told) {
    std::vector<size_t> order(told.logits.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::ranges::sort(order, [&](size_t a, size_t b) { return told.logits[a] < told.logits[b]; });
    double wood = 0.0, leaves = 0.0, pairs = 0.0;
    for (const size_t i : order) {
        if (told.leaf[i] > 0.5F) {
            leaves += 1.0;
            pairs += wood;
        } else {
            wood += 1.0;
        }
    }
    return pairs / (wood * leaves);
}

VirtualScan leafy_scan(Habit habit, double noise) {
    VirtualScanOptions options = scan_options_for(habit);
    options.seed = 77;
    options.points = 44000;
    options.leaves = 0.4;
    options.noise = noise;
    return scan_tree(grow_tree({habit, 0.0, 77}), options);
}

TEST(LeafClassifier, LeavesLookLeafierThanWoodEvenBlurred) {
    for (const Habit habit : {Habit::kBroadleaf, Habit::kForked, Habit::kLeaning})
        for (const double noise : {0.003, 0.01, 0.02})
            EXPECT_GT(area_under_curve(tell(leafy_scan(habit, noise))), 0.85)
                << habit_name(habit) << " " << noise;
}

}  // namespace
}  // namespace treerec
