#include "scan/leaves/leaf_presence.h"

#include <algorithm>
#include <array>
#include <vector>

#include "geometry/quantile.h"
#include "scan/leaves/leaf_classifier.h"
#include "scan/leaves/shape_terms.h"

namespace treerec {

namespace {

// A cloud with fewer cells along its extent, or with fewer ones finer than a leaf, shows neither leaves nor
// twigs, unless it is filled as no bare crown is.
constexpr double kLeastResolution = 95.0;
constexpr double kFineCell = 0.06;  // metres
constexpr double kLeastFineResolution = 60.0;
struct Filled {
    double resolution;
    double filled;
    double scattered;
};
// The coarser the cells, the fuller is a bare crown: 0.49 and 0.46 at 46 cells, 0.57 and 0.55 at 27.
constexpr Filled kFilled[] = {{40.0, 0.58, 0.5}, {20.0, 0.62, 0.59}};

// Of fewer cells the leafiness may tell, in crowns that are at least as full as this: there it is below -0.7
// for bare trees and above 1 for leafy ones.
constexpr double kLeastLushResolution = 60.0;
constexpr double kLushFilled = 0.4;
constexpr double kLush = 0.5;

// Blur makes bare crowns fuller and lush, but then nearly all of them looks like leaves: at a leafiness above
// 3 a share of 0.78 and more.
constexpr double kMostBlurFilled = 0.55;
constexpr double kMostBlurShare = 0.6;
constexpr double kLushNotBlur = 3.5;

// A tree with a smaller share of leaves counts as bare, unless its leafiness is far from that of bare trees:
// by shape leafless trees of dense twigs reach 0.36 by chance, and 0.45 where they were thinned; by the
// classifier those that are lush at all reach 0.23.
constexpr double kLeastShare = 0.4, kLeastCloseShare = 0.3;
constexpr double kSureShare = 0.5;
constexpr double kSurelyLush = 3.0;
// Bare trees that were thinned to a tenth fill 0.36 at most, where they have a leafy tree's share.
constexpr double kSparseFilled = 0.37;

// Of blurred bare trees none is as lush as that and fills more than 0.43; leafy ones are at 5.3 and 0.46 or
// more.
constexpr double kSurelyFilled = 0.445;

// Means of so many points have less than half of their noise: bare trees reach a leafiness of 4.5 then, with
// noise of 3 cm, and leafy ones with 2 cm are above 6.6. (With 4 points, bare ones reach 8.3.)
constexpr double kLeastInMean = 5.0;
constexpr double kOutshining = 5.3;

constexpr double kFrondPlanarity = 0.33;  // crowns of broad leaves have 0.16 to 0.25
// Leaves of many cells, as a sapling's are: 0.41 to 0.56, and bare trees no more than 0.37.
constexpr double kBroadPlanarity = 0.4;

// A logistic rule, for shapes on the coarser grids alone, which are quick to find.
constexpr float kQuickBias = -0.6825F;
constexpr double kSurelyBare = -1.6;  // leafy clouds have a mean above -1.4, most bare ones one below -1.6
constexpr ShapeTerms kQuickTerms{{
    {{{0.0F, 1.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 1.0F, 0.0F}}},
    {{{0.3997F, 0.2186F, -0.168F},
      {0.2666F, 0.1669F, -0.030F},
      {0.3336F, 0.1836F, 0.165F},
      {0.4283F, 0.1876F, 0.442F},
      {2.778F, 0.6209F, -0.512F}}},
    {{{0.3375F, 0.1858F, -0.217F},
      {0.2553F, 0.1533F, 0.189F},
      {0.4072F, 0.1842F, 0.061F},
      {0.5084F, 0.2021F, 0.225F},
      {3.366F, 0.7300F, -0.591F}}},
    {{{0.0F, 1.0F, 0.0F},
      {0.0F, 1.0F, 0.0F},
      {0.5064F, 0.1801F, 0.553F},
      {0.6387F, 0.2271F, -1.276F},
      {4.113F, 0.7961F, 2.616F}}},
}};

constexpr double kLeafyTree = 1.25;  // half way between the leafiest bare tree and the barest leafy one
// Fitted to virtual scans of all habits but the palm, with and without noise and shadows, some with their
// leaves thickened to dense foliage; to a split tree, bare ones and dense real crowns. Of the mean of all
// points' cells.
constexpr std::array<Term, kCellInputs> kTreeTerms{{
    {0.3253F, 0.1126F, -0.2589F}, {0.3098F, 0.1074F, -0.03627F}, {0.3628F, 0.1691F, 0.2015F},
    {0.448F, 0.138F, 0.0107F},    {2.434F, 0.2716F, 0.09058F},   {0.3292F, 0.0988F, -0.287F},
    {0.2771F, 0.09153F, 0.3848F}, {0.3929F, 0.1412F, -0.05276F}, {0.5065F, 0.1519F, 0.07377F},
    {3.05F, 0.4639F, 0.05652F},   {0.3205F, 0.07541F, -0.5299F}, {0.2418F, 0.05288F, 0.8752F},
    {0.437F, 0.1081F, -0.06601F}, {0.557F, 0.1361F, 0.04562F},   {3.652F, 0.5818F, 0.07099F},
    {0.5056F, 0.09426F, 0.3039F}, {0.6303F, 0.1198F, -0.1075F},  {4.334F, 0.6787F, 0.09426F},
    {1.548F, 0.3126F, -0.7314F},  {2.119F, 0.3295F, -0.9717F},   {2.066F, 0.3643F, -0.8432F},
    {0.844F, 0.06719F, -0.541F},  {0.8474F, 0.02639F, -0.5291F}, {0.79F, 0.04808F, 0.2612F},
    {0.9566F, 0.1374F, 0.2384F},  {0.7782F, 0.1804F, 0.4087F},   {1.128F, 0.2992F, 0.4945F},
    {1.553F, 0.4705F, 0.4712F},
}};
constexpr double kTreeBias = 2.98;

double extent_of(const std::vector<Vec3>& points) {
    double extent = 0.0;
    std::vector<float> values(points.size());
    for (int axis = 0; axis < 3; axis++) {
        for (size_t v = 0; v < points.size(); v++)
            values[v] = points[v][axis];
        extent = std::max<double>(extent, quantile(values, 0.99) - quantile(values, 0.01));
    }
    return extent;
}

}  // namespace

double mean_leafiness(const Cells& cells, const CellShapes& shapes, const CellPaths& paths) {
    std::array<double, kCellInputs> sums{};
    std::array<float, kCellInputs> inputs{};
    for (const uint32_t v : cells.of_point) {
        cell_inputs(&shapes[v * kShapeScales], paths.paths[v], inputs.data());
        for (size_t i = 0; i < kCellInputs; i++)
            sums[i] += static_cast<double>(inputs[i]);
    }
    double logit = kTreeBias - kLeafyTree;
    for (size_t i = 0; i < kCellInputs; i++)
        logit += static_cast<double>(value_of(
            static_cast<float>(sums[i] / static_cast<double>(cells.of_point.size())), kTreeTerms[i]));
    return logit;
}

bool surely_bare(const Cells& cells, const CellShapes& shapes) {
    double sum = 0.0, flat = 0.0;
    for (const uint32_t v : cells.of_point) {
        sum += sum_of_terms(&shapes[v * kShapeScales], kQuickTerms);
        flat += shapes[v * kShapeScales + 1].planarity;
    }
    const auto points = static_cast<double>(cells.of_point.size());
    return sum / points + kQuickBias < kSurelyBare && flat / points < kBroadPlanarity;
}

CrownLooks look_at_crown(const Cells& cells, const CellShapes& shapes) {
    CrownLooks looks;
    for (const uint32_t v : cells.of_point) {
        looks.filled += shapes[v * kShapeScales].occupied / 26.0;
        looks.scattered += shapes[v * kShapeScales].scatter;
        looks.flat += shapes[v * kShapeScales + 1].planarity;
    }
    const auto points = static_cast<double>(cells.of_point.size());
    looks.filled /= points;
    looks.scattered /= points;
    looks.flat /= points;
    looks.cell = cells.size;
    looks.resolution = extent_of(cells.centres) / cells.size;
    return looks;
}

bool resolves_leaves(const CrownLooks& looks) {
    if (looks.resolution > kLeastResolution) return true;
    if (looks.cell < kFineCell && looks.resolution > kLeastFineResolution) return true;
    return std::any_of(std::begin(kFilled), std::end(kFilled), [&](const Filled& least) {
        return looks.resolution > least.resolution && looks.filled > least.filled &&
               looks.scattered > least.scattered;
    });
}

bool may_resolve_leaves(const CrownLooks& looks) {
    return looks.resolution > kLeastLushResolution && looks.filled > kLushFilled;
}

bool is_lush(double leafiness) {
    return leafiness > kLush;
}

bool may_be_leaves_not_blur(const CrownLooks& looks) {
    return looks.resolution > kLeastLushResolution && looks.filled < kMostBlurFilled;
}

bool are_leaves_not_blur(double share, double leafiness) {
    return share < kMostBlurShare && leafiness > kLushNotBlur;
}

bool may_outshine_blur(const CrownLooks& looks, double points) {
    return looks.resolution > kLeastResolution && points > kLeastInMean;
}

bool outshines_blur(double leafiness) {
    return leafiness > kOutshining;
}

bool looks_like_fronds(const CrownLooks& looks) {
    return looks.flat > kFrondPlanarity;
}

bool is_in_leaf(const CrownLooks& looks, const LeafShare& share, double leafiness) {
    if (share.of_points < (share.closely ? kLeastCloseShare : kLeastShare)) return leafiness > kSurelyLush;
    // Of a bare tree's twigs too few points may be left to look like twigs.
    return leafiness > 0.0 || (share.of_points >= kSureShare && looks.filled >= kSparseFilled);
}

bool is_surely_in_leaf(const CrownLooks& looks, const LeafShare& share, double leafiness) {
    return is_in_leaf(looks, share, leafiness) && leafiness > kSurelyLush && looks.filled > kSurelyFilled;
}

}  // namespace treerec
