#include "scan/leaves/wood_leaf.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/parallel.h"
#include "scan/cleaning/samples.h"
#include "scan/leaves/label_leaves.h"
#include "scan/leaves/leaf_blur.h"
#include "scan/leaves/leaf_cells.h"
#include "scan/leaves/leaf_classifier.h"
#include "scan/leaves/leaf_colour.h"
#include "scan/leaves/leaf_paths.h"
#include "scan/leaves/leaf_presence.h"
#include "scan/leaves/leaf_shape_rule.h"
#include "scan/leaves/leaf_verdict.h"
#include "scan/stems/lone_trunk.h"
#include "scan/usual_size.h"

namespace treerec {

namespace {

constexpr size_t kMostSamples = 400000;
constexpr size_t kLeastPoints = 300;
constexpr size_t kGrain = 512;
// Of what the shape rule says.
constexpr int kSmoothings = 3;
constexpr double kTrustInShape = 0.5;  // in the share of leaves that it finds
// The classifier finds it within a few hundredths.
constexpr double kTrustClosely = 0.8;

// Of the wood that may be expected, so much is followed, as F and the length of grown trees like it; but
// nothing that is leafier than this beyond the threshold, in logits.
constexpr double kFollowedWood = 0.94;
constexpr float kMostFollowed = 1.45F;

constexpr float kColourWeight = 8.0F;  // logit between the groups' means
constexpr float kMostByShape = 3.0F;   // logit, where colours tell, too: photos make bark as wavy as leaves

// Where light has bleached the colours, shape has to agree with them on so many of the points: 74 % and more
// of virtual leafy scans, 33 to 59 % of photos' that were turned and thinned.
constexpr double kLeastAgreement = 0.67;
constexpr int kTintSmoothings = 4;  // times as many

// Half of the points of bark that noise blurs lie further than 0.67 of its standard deviation off.
constexpr double kSharp = 0.35;
// Sharp bark, and that of a mobile scanner.
constexpr std::array<RoundStemSearch, 2> kBarkSearches{{{}, kRoughBark}};

// The mean of so many points, within so many times their noise, is sharp enough.
constexpr double kFewestInMean = 1.5;
constexpr double kMeanWidth = 3.0;

constexpr char kPalm[] =
    "The leaves are fronds: the tree was taken for a palm, which has one stem and no branches.";
constexpr double kMuchHidden = 0.3;
constexpr double kNearlyAll = 0.9;  // of the points are leaves: what wood there is was guessed

// Tells them by samples of the cloud, or by means of a blurred one's points, where bare twigs still look
// leafy.
class SampleTeller {
  public:
    SampleTeller(const PointCloud& cloud, const Samples& samples, bool averaged, const Progress& progress)
        : cloud_(cloud), samples_(samples), averaged_(averaged), progress_(progress) {}

    WoodLeaf tell();

  private:
    bool see_crown();
    void trace();
    void classify();
    double find_noise();
    void find_greens();
    double agreement() const;
    void tell_by_tint();
    LeafVerdict judge(std::vector<float> logits, float threshold, bool palms) const;
    LeafVerdict judge_by_shape();
    std::vector<float> close_logits();
    LeafVerdict judge_closely(bool palms);
    void tell_points(const LeafVerdict& verdict, bool closely);
    void tell_leafiness();
    void follow_hardly_leafy(const LeafVerdict& verdict);
    void warn();

    bool colored() const { return cloud_.has_colors(); }
    float coloured_logit(float logit, double green) const {
        return std::clamp(logit, -kMostByShape, kMostByShape) + kColourWeight * greenness(green, greens_);
    }
    double green_of(size_t point) const {
        return cloud_.labels.by_colour ? cloud_.labels.values[point] : excess_green(cloud_.colors[point]);
    }
    double share_of(const std::vector<float>& logits) const {
        return find_leaf_share(logits, weights_, progress_);
    }

    const PointCloud& cloud_;
    const Samples& samples_;
    const bool averaged_;
    const Progress& progress_;
    WoodLeaf result_;

    Cells cells_;
    std::vector<uint32_t> weights_;        // samples by cell
    std::vector<uint32_t> cell_of_point_;  // of the cloud
    CellShapes shapes_;
    CrownLooks looks_;
    // Once they were asked for.
    std::optional<CellPaths> paths_;
    double lush_ = 0.0;
    std::vector<float> by_shape_;  // logits by cell,
    double shape_share_ = 0.0;     // and the share of leaves under them
    std::vector<float> closely_;   // logits by sample, of the classifier
    std::optional<std::vector<RoundStem>> stems_;

    std::vector<float> green_;  // by cell
    GreenGroups greens_;
    bool told_by_shape_ = false;
};

// Whether there is anything to look for; without the finest shapes where there isn't.
bool SampleTeller::see_crown() {
    cells_ = make_cells(samples_.points, progress_);
    measure_shapes(cells_, 1, kShapeScales - 1, shapes_, progress_);
    if (!colored() && surely_bare(cells_, shapes_)) return false;
    measure_shapes(cells_, 0, 0, shapes_, progress_);
    looks_ = look_at_crown(cells_, shapes_);
    weights_.assign(cells_.count(), 0);
    for (const uint32_t v : cells_.of_point)
        weights_[v]++;
    return true;
}

void SampleTeller::trace() {
    if (paths_) return;
    paths_ = trace_paths(cells_, progress_);
    lush_ = mean_leafiness(cells_, shapes_, *paths_);
    by_shape_.resize(cells_.count());
    parallel_for(by_shape_.size(), kGrain, [&](size_t begin, size_t end) {
        progress_.check();
        for (size_t v = begin; v < end; v++)
            by_shape_[v] = logit_by_shape(&shapes_[v * kShapeScales], paths_->paths[v]);
    });
    shape_share_ = share_of(by_shape_);
}

void SampleTeller::classify() {
    if (closely_.empty())
        closely_ = LeafClassifier(samples_.points, cells_, shapes_, *paths_, progress_).logits();
}

// Metres; 0 where shape can tell leaves.
double SampleTeller::find_noise() {
    const double noise = blur_of(samples_.points, progress_);
    if (!(noise > 0.0)) return 0.0;
    // Dense leaves look like blur, but not where bark shows between them.
    for (const RoundStemSearch& search : kBarkSearches) {
        std::vector<RoundStem> found = find_round_stems(samples_.points, &progress_, search);
        const bool sharp =
            !found.empty() && spread_on_stems(samples_.points, found, 2.0 * noise) < kSharp * noise;
        if (!stems_ || stems_->empty()) stems_ = std::move(found);
        if (sharp) return 0.0;
    }
    if (may_be_leaves_not_blur(looks_)) {
        trace();
        if (are_leaves_not_blur(shape_share_, lush_)) return 0.0;
    }
    const double to_a_mean = static_cast<double>(cloud_.size()) / static_cast<double>(samples_.points.size());
    if (averaged_ && may_outshine_blur(looks_, to_a_mean)) {
        trace();
        if (outshines_blur(lush_)) return 0.0;
    }
    return noise;
}

void SampleTeller::find_greens() {
    if (colored()) {
        green_ = excess_green(cloud_.colors, cell_of_point_, cells_.count());
        greens_ = part_greens(green_, weights_, samples_.points, cells_.of_point);
    }
    if (cloud_.labels.by_colour) {
        green_ = shares_of(cloud_.labels.values, cell_of_point_, cells_.count());
        greens_ = {true, false, 0.5, 0.5, greens_.share};
    }
}

// The share of the points on which shape and colour agree.
double SampleTeller::agreement() const {
    std::vector<float> logits = by_shape_;
    smooth_over_cells(logits, kSmoothings, cells_, progress_);
    const float threshold = leaf_threshold(shape_share_, kTrustInShape);
    double all = 0.0, agreed = 0.0;
    for (size_t v = 0; v < logits.size(); v++) {
        all += weights_[v];
        if ((logits[v] > threshold) == (green_[v] > greens_.middle)) agreed += weights_[v];
    }
    return agreed / all;
}

// Photos give bark as wavy as leaves, and of a crown its skin alone: the colours around a point tell what it
// is, and branches are looked for wherever points lead.
void SampleTeller::tell_by_tint() {
    std::vector<float> around(green_.size());
    for (size_t v = 0; v < green_.size(); v++)
        around[v] = greenness(green_[v], greens_);
    for (int i = 0; i < kTintSmoothings; i++)
        smooth_over_cells(around, kSmoothings, cells_, progress_);
    result_.by_colour = true;
    result_.foliage = true;
    result_.leaf.resize(cloud_.size());
    result_.wood_path.assign(cloud_.size(), 1);
    for (size_t i = 0; i < cloud_.size(); i++)
        result_.leaf[i] = around[cell_of_point_[i]] > 0.0F;
    result_.leaf_share =
        static_cast<double>(std::count(result_.leaf.begin(), result_.leaf.end(), uint8_t{1})) /
        static_cast<double>(cloud_.size());
}

LeafVerdict SampleTeller::judge(std::vector<float> logits, float threshold, bool palms) const {
    return judge_cells(std::move(logits), threshold, cells_, shapes_, *paths_, palms, progress_);
}

LeafVerdict SampleTeller::judge_by_shape() {
    std::vector<float> logits = by_shape_;
    double share = shape_share_;
    if (result_.by_colour) {
        for (size_t v = 0; v < logits.size(); v++)
            logits[v] += kColourWeight * greenness(green_[v], greens_);
        share = share_of(logits);
    }
    smooth_over_cells(logits, kSmoothings, cells_, progress_);
    return judge(std::move(logits), leaf_threshold(share, kTrustInShape), true);
}

// By the classifier, of which a cell has its points' mean.
std::vector<float> SampleTeller::close_logits() {
    classify();
    std::vector<double> sums(cells_.count(), 0.0);
    for (size_t i = 0; i < closely_.size(); i++)
        sums[cells_.of_point[i]] += static_cast<double>(closely_[i]);
    std::vector<float> logits(sums.size());
    for (size_t v = 0; v < logits.size(); v++) {
        logits[v] = static_cast<float>(sums[v] / weights_[v]);
        if (result_.by_colour) logits[v] = coloured_logit(logits[v], green_[v]);
    }
    return logits;
}

LeafVerdict SampleTeller::judge_closely(bool palms) {
    std::vector<float> logits = close_logits();
    const float threshold = leaf_threshold(share_of(logits), kTrustClosely);
    return judge(std::move(logits), threshold, palms);
}

WoodLeaf SampleTeller::tell() {
    if (samples_.points.size() < kLeastPoints || !see_crown()) return std::move(result_);
    bool resolved = resolves_leaves(looks_);
    if (!resolved && may_resolve_leaves(looks_)) {
        trace();
        resolved = is_lush(lush_);
    }
    if (resolved) result_.noise = find_noise();
    told_by_shape_ = resolved && !(result_.noise > 0.0);
    // Even blurred, fronds are flat; and their stem may have most of the points.
    const bool frond_like = looks_like_fronds(looks_);
    if (!colored() && !told_by_shape_ && !frond_like) return std::move(result_);
    trace();

    cell_of_point_.resize(cloud_.size());
    for (size_t i = 0; i < cloud_.size(); i++)
        cell_of_point_[i] = cells_.of_point[samples_.of_point[i]];
    find_greens();
    if (greens_.tinted && !frond_like && agreement() < kLeastAgreement) {
        tell_by_tint();
        return std::move(result_);
    }
    result_.by_colour = greens_.apart;

    const auto& decide = averaged_ ? is_surely_in_leaf : is_in_leaf;
    bool leafy = result_.by_colour || (told_by_shape_ && decide(looks_, {shape_share_, false}, lush_));
    const bool closely = told_by_shape_ && lush_ > 0.0;  // else the classifier would find no leaves at all
    LeafVerdict verdict;
    if (!leafy && closely) leafy = decide(looks_, {share_of(close_logits()), true}, lush_);
    if (leafy) verdict = judge_by_shape();
    if (!result_.by_colour && frond_like && !verdict.followed.fronds && (closely || !told_by_shape_)) {
        LeafVerdict palm = closely ? judge_closely(true) : judge_by_shape();
        if (palm.followed.fronds) verdict = std::move(palm);
    }
    const bool in_leaf = leafy || verdict.followed.fronds;
    if (in_leaf && !result_.by_colour && is_lone_trunk(samples_.points, progress_)) return std::move(result_);
    if (!in_leaf) {
        if (closely) tell_leafiness();
        return std::move(result_);
    }
    if (!verdict.followed.fronds) {
        if (closely) verdict = judge_closely(false);
        if (!stems_) stems_ = find_round_stems(samples_.points, &progress_);
        keep_stems(*stems_, samples_.points, cells_, shapes_, *paths_, verdict, progress_);
    }
    progress_.check();
    tell_points(verdict, closely);
    if (closely && !result_.fronds && result_.leaf_share < kNearlyAll) {
        tell_leafiness();
        follow_hardly_leafy(verdict);
    }
    warn();
    return std::move(result_);
}

void SampleTeller::tell_points(const LeafVerdict& verdict, bool closely) {
    const auto& [logits, threshold, leaf, other, followed] = verdict;
    result_.foliage = true;
    result_.hidden_share = followed.hidden_share;
    result_.fronds = followed.fronds;
    result_.reach = followed.reach;
    result_.leaf.resize(cloud_.size());
    result_.wood_path.resize(cloud_.size());
    size_t leaves = 0;
    for (size_t i = 0; i < cloud_.size(); i++) {
        const uint32_t v = cell_of_point_[i];
        if (!other.empty() && other[v]) continue;
        bool is_leaf = leaf[v] != 0;
        const bool as_found = !followed.fronds && leaf[v] == (logits[v] > threshold);
        // A frond's brown tip is no wood.
        if (as_found && result_.by_colour)
            is_leaf = logits[v] +
                          kColourWeight * (greenness(green_of(i), greens_) - greenness(green_[v], greens_)) >
                      threshold;
        else if (as_found && closely)
            is_leaf = closely_[samples_.of_point[i]] > threshold;
        result_.leaf[i] = is_leaf;
        result_.wood_path[i] = followed.path[v] || !is_leaf;
        leaves += is_leaf;
    }
    result_.leaf_share = static_cast<double>(leaves) / static_cast<double>(cloud_.size());
}

void SampleTeller::tell_leafiness() {
    classify();
    result_.leafiness.resize(cloud_.size());
    for (size_t i = 0; i < cloud_.size(); i++) {
        const float logit = closely_[samples_.of_point[i]];
        result_.leafiness[i] = result_.by_colour ? coloured_logit(logit, green_[cell_of_point_[i]]) : logit;
    }
}

// What is hardly leafier than wood is followed, since its branches get a second look.
void SampleTeller::follow_hardly_leafy(const LeafVerdict& verdict) {
    if (result_.by_colour) return;
    const float wood = wood_reach(closely_, share_of(verdict.logits), kFollowedWood);
    const float reach = verdict.threshold + std::clamp(wood - verdict.threshold, 0.0F, kMostFollowed);
    for (size_t i = 0; i < cloud_.size(); i++) {
        if (!verdict.other.empty() && verdict.other[cell_of_point_[i]]) continue;
        if (result_.leafiness[i] < reach) result_.wood_path[i] = 1;
    }
}

void SampleTeller::warn() {
    if (result_.hidden_share > kMuchHidden)
        result_.warnings.push_back(
            "Leaves hide much of the wood: " + std::to_string(std::lround(100.0 * result_.hidden_share)) +
            " % of the branches in the crown were guessed from the paths through the leaves.");
    if (result_.fronds) result_.warnings.emplace_back(kPalm);
}

// Where what is labelled as leaves are fronds, the skeleton follows one stem.
void look_for_fronds(const PointCloud& cloud, WoodLeaf& result, Progress* listener) {
    const SubProgress progress(listener, 0.0, 1.0);
    const double factor = enlargement_to_usual(cloud.positions);
    const std::vector<Vec3> points = factor == 1.0 ? cloud.positions : enlarged(cloud.positions, factor);
    const Samples samples = take_samples(points, kMostSamples, &progress);
    if (samples.points.size() < kLeastPoints) return;
    const Cells cells = make_cells(samples.points, progress);
    CellShapes shapes;
    measure_shapes(cells, 0, kShapeScales - 1, shapes, progress);
    std::vector<uint32_t> cell_of_point(cloud.size());
    for (size_t i = 0; i < cloud.size(); i++)
        cell_of_point[i] = cells.of_point[samples.of_point[i]];
    std::vector<float> shares = shares_of(result.leaf, cell_of_point, cells.count());
    const LeafVerdict verdict =
        judge_cells(std::move(shares), 0.5F, cells, shapes, trace_paths(cells, progress), true, progress);
    if (!verdict.followed.fronds) return;
    result.fronds = true;
    result.reach = verdict.followed.reach / factor;
    result.warnings.emplace_back(kPalm);
    for (size_t i = 0; i < cloud.size(); i++)
        result.wood_path[i] = verdict.followed.path[cell_of_point[i]];
}

WoodLeaf tell_by_labels(const PointCloud& cloud, const LabelledLeaves& labels, Progress* progress) {
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
    look_for_fronds(cloud, result, progress);
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
    WoodLeaf result = SampleTeller(cloud, samples, false, progress).tell();
    if (!(result.noise > 0.0) || result.foliage) return result;
    // Many points of a blurred scan together are sharp, and may show leaves.
    const Samples means =
        average_points(cloud.positions, samples.ranges, kMeanWidth * result.noise, &progress);
    if (kFewestInMean * static_cast<double>(means.points.size()) > static_cast<double>(samples.points.size()))
        return result;
    WoodLeaf sharp = SampleTeller(cloud, means, true, progress).tell();
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
        result = tell_by_labels(cloud, labels, progress);
    else if (!labels.wood)
        result = tell_by_looks(cloud, progress);
    if (!labels.sentence.empty()) result.warnings.insert(result.warnings.begin(), labels.sentence);
    return result;
}

}  // namespace treerec
