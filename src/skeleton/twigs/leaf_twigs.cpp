#include "skeleton/twigs/leaf_twigs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/capsule_tree.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "scan/usual_size.h"
#include "tree/wood_segments.h"

namespace treerec {

namespace {

constexpr size_t kGrain = 512;
constexpr double kNearBark = 0.02;  // metres, and the radius: points no farther from bark lie on it,
constexpr double kThickest = 0.05;  // that of thicker wood counting as this
constexpr double kSteps = 1024.0;   // of a logit: sums over whole numbers do not feel the points' order
constexpr double kAllPoints = 2.0;  // points as leafy as all of them that count for every segment's own

// By tests/bench/fit_leaves.py --twigs, of looks_of(); the last one is the bias. Fitted where all points up
// to 1 beyond the threshold were followed: fitted to what is followed now, it keeps more of a dense scan's
// stalks.
constexpr std::array<double, kTwigLooks + 1> kWeights{
#include "skeleton/twigs/leaf_twig_weights.inc"
};
constexpr double kLeastLength = 1e-3;    // metres
constexpr double kRootLeafiness = -3.0;  // of what the trunk grows from
constexpr double kLeastDensity = 0.05;   // of all wood's
constexpr double kLeastCarried = 0.001;  // tree's extents
constexpr double kLeastRadius = 1e-4;    // metres
// What a stretch has to have, at least: best for F on the same scans, and for the length. Where most points
// were told to be leaves, much of the wood was missed, and the tree would become too short.
constexpr double kLeastChance = 0.16;
constexpr double kLeastByColour = 0.1;  // colour has told most leaves from the wood
constexpr double kLeastAnew = 0.5;  // of these, where the worst has gone before: else the tree is too short
constexpr double kManyLeaves = 0.8, kNearlyAllLeaves = 0.9;

// By point the node at the end of the segment on which it lies, or kNoNode.
class LiesOn {
  public:
    LiesOn(const std::vector<Vec3>& points, const Tree& tree)
        : points_(points), wood_(wood_segments(tree)), on_(points.size(), kNoNode) {}

    // Finds those of the points that wanted() names by their index.
    template <typename Wanted>
    void find(const Wanted& wanted, const Progress& progress) {
        parallel_for(points_.size(), kGrain, [&](size_t begin, size_t end) {
            progress.check();
            int32_t hint = -1;
            for (size_t i = begin; i < end; i++) {
                if (!wanted(i)) continue;
                const DVec3 p(points_[i]);
                BarkHit hit{kNoNode, reach_of(kThickest), -1};
                if (hint >= 0) {
                    const double error = bark_error(wood_.segment(hint), p);
                    if (std::abs(error) <= hit.error) hit = {wood_.segment(hint).child, error, hint};
                }
                wood_.find_bark(p, hit);
                if (hit.segment < 0) continue;
                hint = hit.segment;
                if (std::abs(hit.error) <= reach_of(wood_.segment(hint).radius)) on_[i] = hit.child;
            }
        });
    }
    const std::vector<NodeId>& on() const { return on_; }

  private:
    static double reach_of(double radius) { return kNearBark + std::min(radius, kThickest); }

    const std::vector<Vec3>& points_;
    CapsuleTree wood_;
    std::vector<NodeId> on_;
};

// Wood without a fork, from where it grows out of other wood to the next fork or the tip.
struct Stretch {
    NodeId first = kNoNode;  // its lowest segment, by the node at the end
    NodeId last = kNoNode;
    int32_t below = -1;  // the one that it grows from; -1 for none
    double length = 0.0;
    double carried = 0.0;  // metres of wood of it and beyond it
    double reach = 0.0;    // metres from its start to the farthest tip
    int64_t sum = 0;       // of its points' logits, in steps
    int64_t voices = 0;    // so many points
};

struct Stretches {
    std::vector<Stretch> all;      // parents first
    std::vector<int32_t> of_node;  // by node id; -1 for the root
    double mean_logit = 0.0;       // of all points
    double density = 0.0;          // of points that lie on wood, by the metre
};

Stretches find_stretches(const Tree& tree, const std::vector<NodeId>& order, const std::vector<NodeId>& on,
                         const std::vector<float>& leafiness) {
    Stretches found;
    found.of_node.assign(static_cast<size_t>(tree.id_end()), -1);
    for (const NodeId id : order) {
        if (id == tree.root()) continue;
        const NodeId parent = tree.node(id).parent;
        const NodeId sibling = tree.node(parent).first_child;
        const bool alone = sibling == id && tree.node(id).next_sibling == kNoNode;
        if (parent == tree.root() || !alone) {
            found.of_node[id] = static_cast<int32_t>(found.all.size());
            found.all.push_back({id, id, found.of_node[parent]});
        } else {
            found.of_node[id] = found.of_node[parent];
        }
        Stretch& stretch = found.all[found.of_node[id]];
        stretch.last = id;
        stretch.length += glm::distance(tree.node(id).position, tree.node(parent).position);
    }
    for (size_t s = found.all.size(); s-- > 0;) {
        Stretch& stretch = found.all[s];
        stretch.carried += stretch.length;
        stretch.reach += stretch.length;
        if (stretch.below < 0) continue;
        Stretch& below = found.all[stretch.below];
        below.carried += stretch.carried;
        below.reach = std::max(below.reach, stretch.reach);
    }
    int64_t sum = 0, voices = 0, on_wood = 0;
    for (size_t i = 0; i < on.size(); i++) {
        if (std::isnan(leafiness[i])) continue;
        const auto logit = static_cast<int64_t>(std::lround(kSteps * leafiness[i]));
        sum += logit;
        voices++;
        if (on[i] == kNoNode) continue;
        on_wood++;
        found.all[found.of_node[on[i]]].sum += logit;
        found.all[found.of_node[on[i]]].voices++;
    }
    found.mean_logit =
        static_cast<double>(sum) / (kSteps * static_cast<double>(std::max<int64_t>(1, voices)));
    double length = 0.0;
    for (const Stretch& stretch : found.all)
        length += stretch.length;
    found.density = static_cast<double>(on_wood) / std::max(length, kLeastLength);
    return found;
}

// The mean logit of a stretch's points, and of some that are as leafy as all.
double leafiness_of(const Stretch& stretch, double mean_logit) {
    return (static_cast<double>(stretch.sum) / kSteps + kAllPoints * mean_logit) /
           (static_cast<double>(stretch.voices) + kAllPoints);
}

// Of the points that lie on it, by the metre, against all wood's.
double log_density(const Stretch& stretch, const Stretches& all) {
    const double own = static_cast<double>(stretch.voices) / std::max(stretch.length, kLeastLength);
    return portable::log(own / std::max(all.density, 1.0) + kLeastDensity);
}

// What tells whether a stretch is wood: how much it carries, how leafy its points and all points are, how
// straight it is and how straight on it grows, how long it reaches by its radius, and in metres (twigs as
// short as leaves, where there are leaves, are their stalks and edges); how leafy what it grows from is, how
// many points lie on both by the metre, its length and radius.
TwigLooks looks_of(const Stretch& stretch, const Stretches& all, const Tree& tree, double extent) {
    const Node& start = tree.node(tree.node(stretch.first).parent);
    const DVec3 chord = tree.node(stretch.last).position - start.position;
    DVec3 before = chord;
    if (start.parent != kNoNode) before = start.position - tree.node(start.parent).position;
    const double reach = std::max(stretch.reach, kLeastRadius);
    const double radius = tree.node(stretch.first).radius;
    const Stretch* const below = stretch.below >= 0 ? &all.all[stretch.below] : nullptr;
    return {portable::log(stretch.carried / extent + kLeastCarried),
            leafiness_of(stretch, all.mean_logit),
            all.mean_logit,
            glm::length(chord) / std::max(stretch.length, kLeastRadius),
            glm::dot(normalized_or(chord, DVec3(0.0)), normalized_or(before, DVec3(0.0))),
            portable::log(reach / (radius + kLeastRadius)),
            portable::log(reach) * all.mean_logit,
            below ? leafiness_of(*below, all.mean_logit) : kRootLeafiness,
            below ? log_density(*below, all) : 0.0,
            log_density(stretch, all),
            portable::log(stretch.length + kLeastLength),
            portable::log(radius + kLeastRadius)};
}

std::vector<TwigLooks> looks_of_all(const Stretches& stretches, const Tree& tree) {
    const DVec3 size = tree.bounds().size();
    const double extent = std::max({size.x, size.y, size.z});
    std::vector<TwigLooks> looks;
    for (const Stretch& stretch : stretches.all)
        looks.push_back(looks_of(stretch, stretches, tree, extent));
    return looks;
}

double chance_of(const TwigLooks& looks) {
    double logit = kWeights.back();
    for (size_t i = 0; i < looks.size(); i++)
        logit += kWeights[i] * looks[i];
    return 1.0 / (1.0 + portable::exp(-logit));
}

double least_chance(const LeavesTold& told) {
    const double many =
        std::clamp((kNearlyAllLeaves - told.share) / (kNearlyAllLeaves - kManyLeaves), 0.0, 1.0);
    return many * (told.by_colour ? kLeastByColour : kLeastChance) * (told.grown_anew ? kLeastAnew : 1.0);
}

// Which stretches go, where keeping one costs `least` of its length and gains as much of it as is likely
// wood: those that with all that they carry are not worth it at best, unless they have to stay.
std::vector<uint8_t> fall(const std::vector<Stretch>& all, const std::vector<double>& chances,
                          const std::vector<uint8_t>& stays, double least) {
    std::vector<double> worth(all.size(), 0.0);
    for (size_t s = all.size(); s-- > 0;) {
        worth[s] += all[s].length * (chances[s] - least);
        if (all[s].below >= 0) worth[all[s].below] += std::max(0.0, worth[s]);
    }
    std::vector<uint8_t> falls(all.size(), 0);
    for (size_t s = 0; s < all.size(); s++)
        falls[s] = (all[s].below >= 0 && falls[all[s].below]) || (!stays[s] && !(worth[s] > 0.0));
    return falls;
}

}  // namespace

std::vector<TwigSample> look_at_twigs(const Tree& tree, const std::vector<Vec3>& points,
                                      const std::vector<float>& leafiness, const Progress& progress) {
    LiesOn places(points, tree);
    places.find([&](size_t i) { return !std::isnan(leafiness[i]); }, progress);
    const std::vector<NodeId> order = tree.depth_first();
    const Stretches stretches = find_stretches(tree, order, places.on(), leafiness);
    const std::vector<TwigLooks> looks = looks_of_all(stretches, tree);
    std::vector<TwigSample> samples(looks.size());
    for (size_t s = 0; s < samples.size(); s++) {
        samples[s].looks = looks[s];
        samples[s].line.push_back(tree.node(tree.node(stretches.all[s].first).parent).position);
    }
    for (const NodeId id : order)
        if (id != tree.root()) samples[stretches.of_node[id]].line.push_back(tree.node(id).position);
    return samples;
}

DroppedTwigs drop_leaf_twigs(Tree& tree, const std::vector<Vec3>& points, const std::vector<float>& leafiness,
                             const LeavesTold& told, const Progress& progress) {
    if (const double factor = enlargement_to_usual(points); factor != 1.0) {
        Tree grown = tree;
        grown.scale(factor);
        DroppedTwigs dropped = drop_leaf_twigs(grown, enlarged(points, factor), leafiness, told, progress);
        if (dropped.leaf.empty()) return dropped;
        dropped.length /= factor;
        grown.scale(1.0 / factor);
        grown.set_frame(tree.frame());
        tree = std::move(grown);
        return dropped;
    }
    const double least = least_chance(told);
    if (tree.size() < 2 || points.empty() || !(least > 0.0)) return {};
    LiesOn places(points, tree);
    places.find([&](size_t i) { return !std::isnan(leafiness[i]); }, progress);
    const std::vector<NodeId>& on = places.on();
    const std::vector<NodeId> order = tree.depth_first();
    const Stretches stretches = find_stretches(tree, order, on, leafiness);
    const std::vector<Stretch>& all = stretches.all;
    progress.check();

    // A tree is no lower for want of wood that is seen: the way to its top stays. So does the trunk.
    NodeId top = tree.root();
    for (const NodeId id : order)
        if (tree.node(id).position.y > tree.node(top).position.y) top = id;
    std::vector<uint8_t> stays(all.size(), 0);
    for (NodeId id = top; id != tree.root(); id = tree.node(id).parent)
        stays[stretches.of_node[id]] = 1;
    for (const NodeId id : order)
        if (id != tree.root() && tree.node(id).is_trunk()) stays[stretches.of_node[id]] = 1;

    std::vector<double> chances;
    for (const TwigLooks& looks : looks_of_all(stretches, tree))
        chances.push_back(chance_of(looks));
    const std::vector<uint8_t> dropped = fall(all, chances, stays, least);
    std::vector<NodeId> tops;
    DroppedTwigs result;
    for (size_t s = 0; s < all.size(); s++) {
        if (!dropped[s]) continue;
        result.length += all[s].length;
        if (all[s].below < 0 || !dropped[all[s].below]) tops.push_back(all[s].first);
    }
    if (tops.empty()) return {};
    places.find([&](size_t i) { return std::isnan(leafiness[i]); }, progress);
    result.leaf.resize(points.size());
    for (size_t i = 0; i < points.size(); i++)
        result.leaf[i] = on[i] != kNoNode && dropped[stretches.of_node[on[i]]] != 0;
    for (const NodeId id : tops)
        tree.remove_subtree(id);
    tree = tree.compacted();
    return result;
}

}  // namespace treerec
