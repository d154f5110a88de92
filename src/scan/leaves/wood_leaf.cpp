#include "scan/leaves/wood_leaf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "scan/cleaning/samples.h"
#include "scan/leaves/label_leaves.h"
#include "scan/leaves/leaf_blur.h"
#include "scan/leaves/leaf_cells.h"
#include "scan/leaves/leaf_classifier.h"
#include "scan/leaves/leaf_colour.h"
#include "scan/leaves/leaf_limbs.h"
#include "scan/leaves/leaf_paths.h"
#include "scan/leaves/leaf_presence.h"
#include "scan/leaves/leaf_shape_rule.h"
#include "scan/stems/lone_trunk.h"
#include "scan/stems/round_stems.h"
#include "scan/usual_size.h"

namespace treerec {

namespace {

constexpr size_t kMostSamples = 400000;
constexpr size_t kLeastPoints = 300;
constexpr size_t kGrain = 512;

constexpr double kMostShare = 0.85;  // that the threshold follows
constexpr double kThresholdShare =
    0.5;  // of the logit of the share: between the most likely and the even-handed
constexpr float kSmoothWeight = 0.5F;
constexpr int kSmoothings = 3;

constexpr float kFollowed = 1.0F;      // logits above the threshold: best for F of grown trees, seeds 41
constexpr float kColourWeight = 8.0F;  // logit between the groups' means
constexpr float kMostByShape = 3.0F;   // logit, where colours tell, too: photos make bark as wavy as leaves

// Where light has bleached the colours, shape has to agree with them on so many of the points: 74 % and more
// of virtual leafy scans, 33 to 59 % of photos' that were turned and thinned.
constexpr double kLeastAgreement = 0.67;
constexpr int kTintSmoothings = 4;

// Half of the points of bark that noise blurs lie further than 0.67 of its standard deviation off.
constexpr double kSharp = 0.35;
// Sharp bark, and that of a mobile scanner.
constexpr std::array<RoundStemSearch, 2> kBarkSearches{{{}, kRoughBark}};

// The mean of so many points, within so many times their noise, is sharp enough.
constexpr double kFewestInMean = 1.5;
constexpr double kMeanWidth = 3.0;

constexpr double kMuchHidden = 0.3;
constexpr double kNearlyAll = 0.9;  // of the points are leaves: what wood there is was guessed

// The means of the points of each cell.
std::vector<float> by_cell(const std::vector<float>& of_point, const Cells& cells,
                           const std::vector<uint32_t>& weights) {
    std::vector<double> sums(cells.count(), 0.0);
    for (size_t i = 0; i < of_point.size(); i++)
        sums[cells.of_point[i]] += static_cast<double>(of_point[i]);
    std::vector<float> means(cells.count());
    for (size_t v = 0; v < means.size(); v++)
        means[v] = static_cast<float>(sums[v] / static_cast<double>(weights[v]));
    return means;
}

double logit(double p) {
    return portable::log(p / (1.0 - p));
}

// The share of leaves under which the chances agree with themselves. logits: at even odds.
double find_share(const std::vector<float>& logits, const std::vector<uint32_t>& weights,
                  const Progress& progress) {
    constexpr int kSteps = 60;
    constexpr double kLeast = 1e-3;
    // One look at the distribution is enough for all steps.
    constexpr int kBins = 400;
    constexpr double kSpan = 20.0;
    std::array<double, kBins> histogram{};
    double all = 0.0;
    for (size_t i = 0; i < logits.size(); i++) {
        const double at = (std::clamp<double>(logits[i], -kSpan, kSpan) + kSpan) / (2.0 * kSpan);
        histogram[static_cast<size_t>(at * (kBins - 1) + 0.5)] += weights[i];
        all += weights[i];
    }
    progress.check();
    double share = 0.5;
    for (int step = 0; step < kSteps; step++) {
        const double offset = logit(share);
        double sum = 0.0;
        for (int b = 0; b < kBins; b++) {
            const double z = 2.0 * kSpan * b / (kBins - 1) - kSpan + offset;
            sum += histogram[static_cast<size_t>(b)] / (1.0 + portable::exp(-z));
        }
        share = std::clamp(sum / all, kLeast, 1.0 - kLeast);
    }
    return share;
}

void smooth(std::vector<float>& logits, int times, const Cells& cells, const Progress& progress) {
    const std::vector<float> own = logits;
    std::vector<float> next(logits.size());
    for (int i = 0; i < times; i++) {
        parallel_for(logits.size(), kGrain, [&](size_t begin, size_t end) {
            progress.check();
            for (size_t v = begin; v < end; v++) {
                float sum = 0.0F;
                for (uint32_t e = cells.near_begin[v]; e < cells.near_begin[v + 1]; e++)
                    sum += logits[cells.near[e]];
                const auto count = static_cast<float>(cells.near_begin[v + 1] - cells.near_begin[v]);
                const float around = count > 0.0F ? sum / count : own[v];
                next[v] = (1.0F - kSmoothWeight) * own[v] + kSmoothWeight * around;
            }
        });
        std::swap(logits, next);
    }
}

// Of logits, under that share of leaves.
float threshold_of(double share) {
    return static_cast<float>(-kThresholdShare * logit(std::clamp(share, 1.0 - kMostShare, kMostShare)));
}

// The share of the points on which shape and colour agree. logits: by shape alone.
double agreement(std::vector<float> logits, double share, const std::vector<float>& green,
                 const GreenGroups& groups, const std::vector<uint32_t>& weights, const Cells& cells,
                 const Progress& progress) {
    smooth(logits, kSmoothings, cells, progress);
    const float threshold = threshold_of(share);
    double all = 0.0, agreed = 0.0;
    for (size_t v = 0; v < logits.size(); v++) {
        all += weights[v];
        if ((logits[v] > threshold) == (green[v] > groups.middle)) agreed += weights[v];
    }
    return agreed / all;
}

// Photos give bark as wavy as leaves, and of a crown its skin alone: the colours around a point tell what it
// is, and limbs are looked for wherever points lead.
void tell_by_tint(const std::vector<float>& green, const GreenGroups& groups, const Cells& cells,
                  const std::vector<uint32_t>& cell_of_point, WoodLeaf& result, const Progress& progress) {
    std::vector<float> around(green.size());
    for (size_t v = 0; v < green.size(); v++)
        around[v] = greenness(green[v], groups);
    smooth(around, kTintSmoothings, cells, progress);
    result.by_colour = true;
    result.foliage = true;
    result.leaf.resize(cell_of_point.size());
    result.wood_path.assign(cell_of_point.size(), 1);
    for (size_t i = 0; i < cell_of_point.size(); i++)
        result.leaf[i] = around[cell_of_point[i]] > 0.0F;
    result.leaf_share = static_cast<double>(std::count(result.leaf.begin(), result.leaf.end(), uint8_t{1})) /
                        static_cast<double>(result.leaf.size());
}

struct Verdict {
    std::vector<float> logits;  // by cell
    float threshold = 0.0F;
    std::vector<uint8_t> leaf;   // by cell
    std::vector<uint8_t> other;  // by cell: 1 for what is none of the tree; empty where there is none
    Limbs limbs;
};

Verdict judge(std::vector<float> logits, double share, const Cells& cells, const CellShapes& shapes,
              const CellPaths& paths, const Progress& progress) {
    Verdict verdict;
    verdict.threshold = threshold_of(share);
    verdict.leaf.resize(logits.size());
    for (size_t v = 0; v < logits.size(); v++)
        verdict.leaf[v] = logits[v] > verdict.threshold;
    verdict.limbs = follow_limbs(cells, shapes, paths, verdict.leaf, progress);
    verdict.logits = std::move(logits);
    return verdict;
}

// Bark that is seen between leaves is wood, however bushy it looks.
void keep_stems(const std::vector<RoundStem>& stems, const std::vector<Vec3>& points, const Cells& cells,
                const CellShapes& shapes, const CellPaths& paths, Verdict& verdict,
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
    verdict.limbs = follow_limbs(cells, shapes, paths, verdict.leaf, progress);
    // What lies around the foot grows by itself.
    verdict.other = points_around_feet(cells.centres, stems);
    for (size_t v = 0; v < surplus.size(); v++)
        verdict.other[v] = verdict.other[v] && surplus[v] < 0;
}

// averaged: the samples are means of a blurred scan's points, where bare twigs still look leafy.
WoodLeaf tell_by_samples(const PointCloud& cloud, const Samples& samples, bool averaged,
                         const Progress& progress) {
    WoodLeaf result;
    if (samples.points.size() < kLeastPoints) return result;
    const Cells cells = make_cells(samples.points, progress);
    const size_t count = cells.count();
    CellShapes shapes;
    measure_shapes(cells, 1, kShapeScales - 1, shapes, progress);
    const bool colored = cloud.has_colors();
    if (!colored && surely_bare(cells, shapes)) return result;
    measure_shapes(cells, 0, 0, shapes, progress);
    const CrownLooks looks = look_at_crown(cells, shapes);
    std::vector<uint32_t> weights(count, 0);
    for (const uint32_t v : cells.of_point)
        weights[v]++;
    bool resolved = resolves_leaves(looks);
    std::optional<CellPaths> paths;
    std::vector<float> of_point;  // logits
    std::vector<float> logits;    // by cell
    double lush = 0.0, share = 0.0;
    const auto look_closer = [&] {
        if (paths) return;
        paths = trace_paths(cells, progress);
        lush = mean_leafiness(cells, shapes, *paths);
    };
    const auto classify = [&] {
        look_closer();
        if (!of_point.empty()) return;
        of_point = LeafClassifier(samples.points, cells, shapes, *paths, progress).logits();
        logits = by_cell(of_point, cells, weights);
        share = find_share(logits, weights, progress);
    };
    if (!resolved && may_resolve_leaves(looks)) {
        look_closer();
        resolved = is_lush(lush);
    }
    if (resolved) result.noise = blur_of(samples.points, progress);
    std::optional<std::vector<RoundStem>> stems;
    // Dense leaves look like blur, but not where bark shows between them.
    for (const RoundStemSearch& search : kBarkSearches) {
        if (!(result.noise > 0.0)) break;
        std::vector<RoundStem> found = find_round_stems(samples.points, &progress, search);
        const double most = 2.0 * result.noise;
        if (!found.empty() && spread_on_stems(samples.points, found, most) < kSharp * result.noise)
            result.noise = 0.0;
        if (!stems || stems->empty()) stems = std::move(found);
    }
    if (result.noise > 0.0 && may_be_leaves_not_blur(looks)) {
        classify();
        if (are_leaves_not_blur(share, lush)) result.noise = 0.0;
    }
    const auto points = static_cast<double>(cloud.size()), means = static_cast<double>(samples.points.size());
    if (result.noise > 0.0 && averaged && may_outshine_blur(looks, points / means)) {
        look_closer();
        if (outshines_blur(lush)) result.noise = 0.0;
    }
    const bool told_by_shape = resolved && !(result.noise > 0.0);
    // Even blurred, fronds are flat; and their stem may have most of the points.
    const bool frond_like = looks_like_fronds(looks);
    look_closer();
    // Most bare trees need no look at each point.
    if (!colored && !frond_like && !(told_by_shape && may_be_in_leaf(lush))) return result;
    classify();

    std::vector<uint32_t> cell_of_point(cloud.size());
    for (size_t i = 0; i < cloud.size(); i++)
        cell_of_point[i] = cells.of_point[samples.of_point[i]];
    std::vector<float> green;
    GreenGroups groups;
    if (colored) {
        green = excess_green(cloud.colors, cell_of_point, count);
        groups = part_greens(green, weights, samples.points, cells.of_point);
    }
    if (cloud.labels.by_colour) {
        green = shares_of(cloud.labels.values, cell_of_point, count);
        groups = {true, false, 0.5, 0.5, groups.share};
    }
    std::vector<float> by_shape(groups.tinted && !frond_like ? count : 0);
    for (size_t v = 0; v < by_shape.size(); v++)
        by_shape[v] = logit_by_shape(&shapes[v * kShapeScales], paths->paths[v]);
    if (!by_shape.empty() && agreement(by_shape, find_share(by_shape, weights, progress), green, groups,
                                       weights, cells, progress) < kLeastAgreement) {
        tell_by_tint(green, groups, cells, cell_of_point, result, progress);
        return result;
    }
    if (groups.apart) {
        result.by_colour = true;
        for (size_t v = 0; v < count; v++)
            logits[v] = std::clamp(logits[v], -kMostByShape, kMostByShape) +
                        kColourWeight * greenness(green[v], groups);
        share = find_share(logits, weights, progress);
    }
    const bool leafy = result.by_colour || (told_by_shape && (averaged ? is_surely_in_leaf(looks, share, lush)
                                                                       : is_in_leaf(looks, share, lush)));
    Verdict verdict;
    if (leafy) verdict = judge(logits, share, cells, shapes, *paths, progress);
    if (!result.by_colour && frond_like && !verdict.limbs.fronds) {
        Verdict palm = judge(logits, share, cells, shapes, *paths, progress);
        if (palm.limbs.fronds) verdict = std::move(palm);
    }
    const auto add_leafiness = [&] {
        result.leafiness.resize(cloud.size());
        for (size_t i = 0; i < cloud.size(); i++)
            result.leafiness[i] = of_point[samples.of_point[i]];
        for (size_t i = 0; groups.apart && i < cloud.size(); i++)
            result.leafiness[i] = std::clamp(result.leafiness[i], -kMostByShape, kMostByShape) +
                                  kColourWeight * greenness(green[cell_of_point[i]], groups);
    };
    const bool in_leaf = leafy || verdict.limbs.fronds;
    if (in_leaf && !result.by_colour && is_lone_trunk(samples.points, progress)) return result;
    if (!in_leaf) {
        if (told_by_shape && lush > 0.0) add_leafiness();
        return result;
    }
    if (!verdict.limbs.fronds) {
        if (!stems) stems = find_round_stems(samples.points, &progress);
        keep_stems(*stems, samples.points, cells, shapes, *paths, verdict, progress);
    }
    const auto& [cell_logits, threshold, leaf, other, limbs] = verdict;
    result.hidden_share = limbs.hidden_share;
    result.fronds = limbs.fronds;
    result.reach = limbs.reach;
    progress.check();

    result.foliage = true;
    result.leaf.resize(cloud.size());
    result.wood_path.resize(cloud.size());
    size_t leaves = 0;
    for (size_t i = 0; i < cloud.size(); i++) {
        const uint32_t v = cell_of_point[i];
        if (!other.empty() && other[v]) continue;
        bool is_leaf = leaf[v] != 0;
        const bool as_found = leaf[v] == (cell_logits[v] > threshold);
        if (!result.by_colour && !limbs.fronds && as_found)
            is_leaf = of_point[samples.of_point[i]] > threshold;
        // A frond's brown tip is no wood.
        if (result.by_colour && !limbs.fronds && as_found) {
            const float own = greenness(
                cloud.labels.by_colour ? cloud.labels.values[i] : excess_green(cloud.colors[i]), groups);
            is_leaf = cell_logits[v] + kColourWeight * (own - greenness(green[v], groups)) > threshold;
        }
        result.leaf[i] = is_leaf;
        result.wood_path[i] = limbs.path[v] || !is_leaf;
        leaves += is_leaf;
    }
    result.leaf_share = static_cast<double>(leaves) / static_cast<double>(cloud.size());
    if (told_by_shape && !result.fronds && lush > 0.0 && result.leaf_share < kNearlyAll) {
        add_leafiness();
        // What is hardly leafier than wood is followed, since its branches get a second look.
        for (size_t i = 0; !result.by_colour && i < cloud.size(); i++)
            if (result.leafiness[i] < threshold + kFollowed && (other.empty() || !other[cell_of_point[i]]))
                result.wood_path[i] = 1;
    }
    if (result.hidden_share > kMuchHidden)
        result.warnings.push_back(
            "Leaves hide much of the wood: " + std::to_string(std::lround(100.0 * result.hidden_share)) +
            " % of the branches in the crown were guessed from the paths through the leaves.");
    if (result.fronds)
        result.warnings.emplace_back(
            "The leaves are fronds: the tree was taken for a palm, which has one stem and no branches.");
    return result;
}

}  // namespace

namespace {

WoodLeaf tell_by_labels(const PointCloud& cloud, const LabelledLeaves& labels) {
    WoodLeaf result;
    result.by_labels = true;
    result.foliage = true;
    result.leaf.resize(cloud.size());
    result.wood_path.resize(cloud.size());
    size_t leaves = 0;
    for (size_t i = 0; i < cloud.size(); i++) {
        result.leaf[i] = cloud.labels.values[i] == *labels.leaf;
        result.wood_path[i] = cloud.labels.values[i] == *labels.wood;
        leaves += result.leaf[i];
    }
    result.leaf_share = static_cast<double>(leaves) / static_cast<double>(cloud.size());
    return result;
}

WoodLeaf tell_by_looks(const PointCloud& cloud, Progress* listener) {
    if (const double factor = enlargement_to_usual(cloud.positions); factor != 1.0) {
        WoodLeaf result = tell_by_looks(enlarged(cloud, factor), listener);
        result.reach /= factor;
        result.noise /= factor;
        return result;
    }
    const SubProgress progress(listener, 0.0, 1.0);
    const Samples samples = take_samples(cloud.positions, kMostSamples, &progress);
    WoodLeaf result = tell_by_samples(cloud, samples, false, progress);
    if (!(result.noise > 0.0) || result.foliage) return result;
    // Many points of a blurred scan together are sharp, and may show leaves.
    const Samples means =
        average_points(cloud.positions, samples.ranges, kMeanWidth * result.noise, &progress);
    if (kFewestInMean * static_cast<double>(means.points.size()) > static_cast<double>(samples.points.size()))
        return result;
    WoodLeaf sharp = tell_by_samples(cloud, means, true, progress);
    if (!sharp.foliage || sharp.noise > 0.0) return result;
    sharp.noise = result.noise;
    return sharp;
}

}  // namespace

WoodLeaf tell_wood_from_leaves(const PointCloud& cloud, Progress* progress) {
    if (progress) progress->check();
    const LabelledLeaves labels = find_labelled_leaves(cloud);
    WoodLeaf result;
    if (labels.leaf)
        result = tell_by_labels(cloud, labels);
    else if (!labels.wood)
        result = tell_by_looks(cloud, progress);
    if (!labels.sentence.empty()) result.warnings.insert(result.warnings.begin(), labels.sentence);
    return result;
}

}  // namespace treerec
