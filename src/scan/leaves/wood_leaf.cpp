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
#include "scan/leaves/leaf_colour.h"
#include "scan/leaves/leaf_limbs.h"
#include "scan/leaves/leaf_paths.h"
#include "scan/leaves/leaf_presence.h"
#include "scan/leaves/leaf_rule.h"
#include "scan/leaves/shape_terms.h"
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
constexpr int kSmoothings = 3;
constexpr float kSmoothWeight = 0.5F;

constexpr float kBias = -0.912F;
constexpr ShapeTerms kShapeTerms{{
    {{{0.4209F, 0.2340F, -0.425F},
      {0.2754F, 0.1797F, -0.203F},
      {0.3027F, 0.1816F, 0.528F},
      {0.3599F, 0.1624F, -0.468F},
      {2.248F, 0.4428F, -0.050F}}},
    {{{0.3997F, 0.2186F, -0.011F},
      {0.2666F, 0.1669F, 0.037F},
      {0.3336F, 0.1836F, -0.178F},
      {0.4283F, 0.1876F, 0.451F},
      {2.778F, 0.6209F, -0.313F}}},
    {{{0.3375F, 0.1858F, -0.060F},
      {0.2553F, 0.1533F, 0.167F},
      {0.4072F, 0.1842F, 0.001F},
      {0.5084F, 0.2021F, 0.211F},
      {3.366F, 0.7300F, -0.291F}}},
    {{{0.0F, 1.0F, 0.0F},
      {0.0F, 1.0F, 0.0F},
      {0.5064F, 0.1801F, 0.470F},
      {0.6387F, 0.2271F, -0.890F},
      {4.113F, 0.7961F, 1.988F}}},
}};
struct PathTerm {
    float CellPath::*member;
    Term term;
};
constexpr std::array<PathTerm, 10> kPathTerms{{
    {&CellPath::height, {1.440F, 1.436F, 1.369F}},
    {&CellPath::mass, {1.959F, 2.063F, -1.626F}},
    {&CellPath::chain, {2.004F, 1.562F, -0.888F}},
    {&CellPath::chain_mass, {0.7715F, 0.8626F, 1.002F}},
    {&CellPath::straight_short, {0.8464F, 0.08296F, -0.318F}},
    {&CellPath::straight_long, {0.7992F, 0.09439F, -0.265F}},
    {&CellPath::gap, {0.8606F, 0.6965F, 0.889F}},
    {&CellPath::bush_8, {0.7731F, 0.5515F, 0.041F}},
    {&CellPath::bush_16, {1.079F, 0.6568F, 0.332F}},
    {&CellPath::bush_32, {1.454F, 0.8011F, 0.783F}},
}};

constexpr float kColourWeight = 8.0F;  // logit between the groups' means

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
constexpr size_t kVotes = 20000;    // cells, at most, that the branches are judged by
constexpr double kNearlyAll = 0.9;  // of the points are leaves: what wood there is was guessed

float logit_by_shape(const CellShape* shapes, const CellPath& path) {
    float sum = kBias + sum_of_terms(shapes, kShapeTerms);
    for (const PathTerm& p : kPathTerms)
        sum += value_of(path.*p.member, p.term);
    return sum;
}

std::vector<CellInputs> gather_inputs(const CellShapes& shapes, const CellPaths& paths) {
    std::vector<CellInputs> inputs(paths.paths.size());
    for (size_t v = 0; v < inputs.size(); v++)
        inputs[v] = inputs_of(&shapes[v * kShapeScales], paths.paths[v]);
    return inputs;
}

// By leaf_rule.h: of the mean of all points' cells.
double mean_leafiness(const std::vector<CellInputs>& inputs, const std::vector<uint32_t>& weights) {
    std::array<double, kCellInputs> sums{};
    double all = 0.0;
    for (size_t v = 0; v < inputs.size(); v++) {
        all += weights[v];
        for (size_t i = 0; i < kCellInputs; i++)
            sums[i] += static_cast<double>(weights[v]) * inputs[v][i];
    }
    CellInputs means{};
    for (size_t i = 0; i < kCellInputs; i++)
        means[i] = static_cast<float>(sums[i] / all);
    return leafiness(means);
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

void smooth(std::vector<float>& logits, const Cells& cells, const Progress& progress) {
    const std::vector<float> own = logits;
    std::vector<float> next(logits.size());
    for (int i = 0; i < kSmoothings; i++) {
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
    smooth(logits, cells, progress);
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
    for (int i = 0; i < kTintSmoothings; i++)
        smooth(around, cells, progress);
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
    std::vector<float> logits;  // by cell, smoothed
    float threshold = 0.0F;
    std::vector<uint8_t> leaf;   // by cell
    std::vector<uint8_t> other;  // by cell: 1 for what is none of the tree; empty where there is none
    Limbs limbs;
};

Verdict judge(std::vector<float> logits, double share, const Cells& cells, const CellShapes& shapes,
              const CellPaths& paths, const Progress& progress) {
    Verdict verdict;
    smooth(logits, cells, progress);
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
    std::vector<CellInputs> inputs;
    std::vector<float> logits;
    double lush = 0.0, share = 0.0;
    const auto look_closer = [&] {
        if (paths) return;
        paths = trace_paths(cells, progress);
        inputs = gather_inputs(shapes, *paths);
        lush = mean_leafiness(inputs, weights);
        logits.resize(count);
        parallel_for(count, kGrain, [&](size_t begin, size_t end) {
            progress.check();
            for (size_t v = begin; v < end; v++)
                logits[v] = logit_by_shape(&shapes[v * kShapeScales], paths->paths[v]);
        });
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
        look_closer();
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
    if (!colored && !told_by_shape && !frond_like) return result;
    look_closer();

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
    if (groups.tinted && !frond_like &&
        agreement(logits, share, green, groups, weights, cells, progress) < kLeastAgreement) {
        tell_by_tint(green, groups, cells, cell_of_point, result, progress);
        return result;
    }
    if (groups.apart) {
        result.by_colour = true;
        for (size_t v = 0; v < count; v++)
            logits[v] += kColourWeight * greenness(green[v], groups);
        share = find_share(logits, weights, progress);
    }
    const auto& decide = averaged ? is_surely_in_leaf : is_in_leaf;
    const bool leafy = result.by_colour || (told_by_shape && decide(looks, share, lush));
    // By leaf_rule.h; empty where it finds no leaves at all.
    const auto finer_logits = [&](const LeafLooks& where) {
        if (lush <= 0.0) return std::vector<float>();
        return leaf_logits(samples.points, cells, *paths, inputs, where, progress);
    };
    Verdict verdict;
    if (leafy) verdict = judge(std::move(logits), share, cells, shapes, *paths, progress);
    if (!result.by_colour && frond_like && !verdict.limbs.fronds) {
        if (told_by_shape) logits = finer_logits({});
        if (!logits.empty()) {
            share = find_share(logits, weights, progress);
            Verdict palm = judge(std::move(logits), share, cells, shapes, *paths, progress);
            if (palm.limbs.fronds) verdict = std::move(palm);
        }
    }
    const auto add_leafiness = [&] {
        const std::vector<float> finer = finer_logits({1, count / kVotes + 1});
        if (finer.empty()) return;
        result.leafiness.resize(cloud.size());
        for (size_t i = 0; i < cloud.size(); i++)
            result.leafiness[i] = finer[cell_of_point[i]];
    };
    const bool in_leaf = leafy || verdict.limbs.fronds;
    if (in_leaf && !result.by_colour && is_lone_trunk(samples.points, progress)) return result;
    if (!in_leaf) {
        if (told_by_shape) add_leafiness();
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
        // A frond's brown tip is no wood.
        if (result.by_colour && !limbs.fronds && leaf[v] == (cell_logits[v] > threshold)) {
            const float own = greenness(
                cloud.labels.by_colour ? cloud.labels.values[i] : excess_green(cloud.colors[i]), groups);
            is_leaf = cell_logits[v] + kColourWeight * (own - greenness(green[v], groups)) > threshold;
        }
        result.leaf[i] = is_leaf;
        result.wood_path[i] = limbs.path[v] || !is_leaf;
        leaves += is_leaf;
    }
    result.leaf_share = static_cast<double>(leaves) / static_cast<double>(cloud.size());
    if (told_by_shape && !result.fronds && result.leaf_share < kNearlyAll) add_leafiness();
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
