#include "scan/leaves/leaf_verdict.h"

#include <algorithm>
#include <array>
#include <utility>

#include "geometry/parallel.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr size_t kGrain = 512;
constexpr double kMostShare = 0.85;  // that the threshold follows
constexpr float kSmoothWeight = 0.5F;

double logit(double p) {
    return portable::log(p / (1.0 - p));
}

// Of logits; those beyond the span count as at its end.
struct Histogram {
    static constexpr size_t kBins = 400;

    explicit Histogram(double to) : span(to) {}

    void add(double logit, double much) {
        const double at = (std::clamp(logit, -span, span) + span) / (2.0 * span);
        weight[static_cast<size_t>(at * (kBins - 1) + 0.5)] += much;
    }
    double logit_of(size_t bin) const { return 2.0 * span * static_cast<double>(bin) / (kBins - 1) - span; }

    const double span;
    std::array<double, kBins> weight{};
};

}  // namespace

double find_leaf_share(const std::vector<float>& logits, const std::vector<uint32_t>& weights,
                       const Progress& progress) {
    constexpr int kSteps = 60;
    constexpr double kLeast = 1e-3;
    // One look at the distribution is enough for all steps.
    Histogram leaves(20.0);
    double all = 0.0;
    for (size_t i = 0; i < logits.size(); i++) {
        leaves.add(logits[i], weights[i]);
        all += weights[i];
    }
    progress.check();
    double share = 0.5;
    for (int step = 0; step < kSteps; step++) {
        const double offset = logit(share);
        double sum = 0.0;
        for (size_t b = 0; b < Histogram::kBins; b++)
            sum += leaves.weight[b] / (1.0 + portable::exp(-(leaves.logit_of(b) + offset)));
        share = std::clamp(sum / all, kLeast, 1.0 - kLeast);
    }
    return share;
}

float wood_reach(const std::vector<float>& logits, double share, double recall) {
    const double offset = logit(share);
    Histogram wood(10.0);
    double all = 0.0;
    for (const float z : logits) {
        const double chance = 1.0 / (1.0 + portable::exp(z + offset));
        wood.add(z, chance);
        all += chance;
    }
    size_t b = 0;
    for (double sum = wood.weight[0]; sum < recall * all && b + 1 < Histogram::kBins;)
        sum += wood.weight[++b];
    return static_cast<float>(wood.logit_of(b));
}

float leaf_threshold(double share, double trust) {
    return static_cast<float>(-trust * logit(std::clamp(share, 1.0 - kMostShare, kMostShare)));
}

void smooth_over_cells(std::vector<float>& values, int times, const Cells& cells, const Progress& progress) {
    const std::vector<float> own = values;
    std::vector<float> next(values.size());
    for (int i = 0; i < times; i++) {
        parallel_for(values.size(), kGrain, [&](size_t begin, size_t end) {
            progress.check();
            for (size_t v = begin; v < end; v++) {
                float sum = 0.0F;
                for (uint32_t e = cells.near_begin[v]; e < cells.near_begin[v + 1]; e++)
                    sum += values[cells.near[e]];
                const auto count = static_cast<float>(cells.near_begin[v + 1] - cells.near_begin[v]);
                const float around = count > 0.0F ? sum / count : own[v];
                next[v] = (1.0F - kSmoothWeight) * own[v] + kSmoothWeight * around;
            }
        });
        std::swap(values, next);
    }
}

LeafVerdict judge_cells(std::vector<float> logits, float threshold, const Cells& cells,
                        const CellShapes& shapes, const CellPaths& paths, bool palms,
                        const Progress& progress) {
    LeafVerdict verdict;
    verdict.threshold = threshold;
    verdict.leaf.resize(logits.size());
    for (size_t v = 0; v < logits.size(); v++)
        verdict.leaf[v] = logits[v] > verdict.threshold;
    verdict.followed = follow_branches(cells, shapes, paths, verdict.leaf, palms, progress);
    verdict.logits = std::move(logits);
    return verdict;
}

void keep_stems(const std::vector<RoundStem>& stems, const std::vector<Vec3>& points, const Cells& cells,
                const CellShapes& shapes, const CellPaths& paths, LeafVerdict& verdict,
                const Progress& progress) {
    const std::vector<uint8_t> on = points_on_stems(points, stems);
    std::vector<int32_t> surplus(cells.count(), 0);  // of points on a stem
    for (size_t i = 0; i < points.size(); i++)
        surplus[cells.of_point[i]] += on[i] ? 1 : -1;
    bool changes = false;
    for (size_t v = 0; v < surplus.size(); v++)
        changes = changes || (surplus[v] >= 0 && verdict.leaf[v]);
    if (!changes) return;
    for (size_t v = 0; v < surplus.size(); v++)
        verdict.leaf[v] = verdict.logits[v] > verdict.threshold && surplus[v] < 0;
    verdict.followed = follow_branches(cells, shapes, paths, verdict.leaf, false, progress);
    verdict.other = points_around_feet(cells.centres, stems);
    for (size_t v = 0; v < surplus.size(); v++)
        verdict.other[v] = verdict.other[v] && surplus[v] < 0;
}

}  // namespace treerec
