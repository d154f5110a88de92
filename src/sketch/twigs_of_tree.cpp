// A tree's own twigs, and how they stand on it.
#include <algorithm>
#include <cmath>
#include <utility>

#include "edit/graft/scion.h"
#include "error.h"
#include "geometry/quantile.h"
#include "lsystem/lstring.h"
#include "sketch/twig_stock.h"

namespace treerec {

namespace {

// As the species' twigs are: of a 12 m tree the longest, and with the root of its height, but never most of a
// small tree; the shortest of the longest.
constexpr double kLongest = 3.6, kOfHeight = 12.0, kMostOfTree = 0.35, kShortest = 0.2;
constexpr size_t kOfEachSize = 4;
// What makes a good twig: radius over length, its wood over its length, its nodes.
constexpr double kSlender = 0.02, kRich = 3.0, kFewNodes = 200.0;
constexpr size_t kMostNodes = 1000;
constexpr double kLeastLength = 0.01, kStoutest = 0.2;  // metres; radius over length
constexpr double kLeastStraight = 0.6;  // from base to farthest tip, over the way along the wood

constexpr size_t kLeastSides = 20;  // whose angles are told apart
constexpr size_t kAngles = 11;
constexpr double kFrom = 0.05, kTo = 0.95;               // quantiles: those beyond are faults of the skeleton
constexpr double kLeastAngle = 8.0, kMostAngle = 130.0;  // degrees
constexpr double kTogether = 0.1;                        // of a usual internode: twigs at one place
constexpr double kMostlyClusters = 0.4, kMostlyPairs = 0.5;
constexpr double kThickest = 0.2;  // of the height: the trunk's radius

struct Candidate {
    NodeId node;  // the lowest of its own
    double length;
    double score;
};

// What is asked of each node's wood, by node id.
class Wood {
  public:
    explicit Wood(const Tree& tree)
        : tree_(tree),
          lengths_(subtree_lengths(tree)),
          paths_(longest_paths(tree)),
          nodes_(static_cast<size_t>(tree.id_end()), 1),
          guessed_(static_cast<size_t>(tree.id_end()), 0.0),
          tips_(static_cast<size_t>(tree.id_end()), kNoNode),
          moments_(static_cast<size_t>(tree.id_end()), DVec3(0.0)) {
        const std::vector<NodeId> order = tree.depth_first();
        for (size_t i = order.size(); i-- > 0;) {
            const NodeId id = order[i];
            const auto at = static_cast<size_t>(id);
            double farthest = -1.0;
            tips_[at] = id;
            for (const NodeId child : tree.children(id)) {
                const auto c = static_cast<size_t>(child);
                const double step = segment(child);
                nodes_[at] += nodes_[c];
                guessed_[at] += guessed_[c] + (tree.node(child).is_guess() ? step : 0.0);
                moments_[at] +=
                    moments_[c] + 0.5 * step * (tree.node(child).position + tree.node(id).position);
                if (step + paths_[c] <= farthest) continue;
                farthest = step + paths_[c];
                tips_[at] = tips_[c];
            }
        }
    }

    // Metres from the joint to the farthest tip.
    double length(NodeId id) const { return segment(id) + paths_[static_cast<size_t>(id)]; }

    // 0..1; 0: no twig.
    double score(NodeId id) const {
        const auto at = static_cast<size_t>(id);
        const Node& node = tree_.node(id);
        const DVec3 joint = tree_.node(node.parent).position;
        const double own = length(id), step = segment(id);
        if (!(own >= kLeastLength) || node.radius > kStoutest * own) return 0.0;
        const DVec3 chord = tree_.node(tips_[at]).position - joint;
        const double straight = glm::length(chord) / own;
        if (nodes_[at] > kMostNodes || straight < kLeastStraight) return 0.0;
        const double wood = step + lengths_[at];
        const double seen = 1.0 - (guessed_[at] + (node.is_guess() ? step : 0.0)) / wood;
        // How far its wood lies to one side of it.
        const DVec3 middle = (moments_[at] + 0.5 * step * (joint + node.position)) / wood - joint;
        const DVec3 way = glm::normalize(chord);
        const double aside = glm::length(middle - way * glm::dot(middle, way)) / own;
        return straight * (0.25 + 0.75 * seen) * std::min(1.0, kSlender * own / node.radius) *
               std::min(1.0, wood / own / kRich) * std::max(0.05, 1.0 - 3.0 * aside) *
               std::min(1.0, kFewNodes / nodes_[at]);
    }

  private:
    double segment(NodeId id) const {
        return glm::distance(tree_.node(id).position, tree_.node(tree_.node(id).parent).position);
    }

    const Tree& tree_;
    std::vector<double> lengths_, paths_;
    std::vector<size_t> nodes_;
    std::vector<double> guessed_;  // metres
    std::vector<NodeId> tips_;     // the farthest
    std::vector<DVec3> moments_;   // metres times places
};

// Side branches of such a length, and the ends of longer ones.
std::vector<Candidate> candidates_of(const BranchList& list, const Wood& wood, double shortest,
                                     double longest) {
    std::vector<Candidate> found;
    const auto add = [&](NodeId id, double length) {
        const double score = wood.score(id);
        if (score > 0.0) found.push_back({id, length, score});
    };
    for (const Branch& branch : list.branches) {
        if (branch.order == 0) continue;
        double before = 1e300;
        // Of a longer one two ends, the longer of which is as long as may be.
        for (const NodeId id : list.nodes_of(branch)) {
            const double length = wood.length(id);
            const bool begins = before >= 1e300;
            for (const double most : {longest, 0.4 * longest})
                if (length <= most && length >= shortest && (begins ? most == longest : before > most)) {
                    add(id, length);
                    break;
                }
            before = length;
        }
    }
    return found;
}

bool grows_on(const Tree& tree, NodeId id, NodeId below) {
    for (; id != kNoNode; id = tree.node(id).parent)
        if (id == below) return true;
    return false;
}

// The best of each size, none on another of its size.
std::vector<NodeId> choose(const Tree& tree, std::vector<Candidate> candidates, double shortest,
                           double longest) {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    const double step = std::cbrt(longest / shortest);
    std::vector<NodeId> chosen;
    for (int size = 0; size < 3; size++) {
        const double from = shortest * (size == 0 ? 0.0 : size == 1 ? step : step * step);
        const double to = size == 2 ? 1e300 : shortest * (size == 0 ? step : step * step);
        std::vector<NodeId> own;
        for (const Candidate& one : candidates) {
            if (own.size() >= kOfEachSize) break;
            if (one.length < from || one.length >= to) continue;
            const bool apart = std::none_of(own.begin(), own.end(), [&](NodeId other) {
                return grows_on(tree, one.node, other) || grows_on(tree, other, one.node);
            });
            if (apart) own.push_back(one.node);
        }
        chosen.insert(chosen.end(), own.begin(), own.end());
    }
    return chosen;
}

struct Standing {
    std::vector<double> angles;  // degrees
    std::vector<double> internodes;
    size_t paired = 0, clustered = 0;
};

// How the side branches that are no shorter than a twig stand; on the trunk, too, where `trunk` is set.
Standing standing_of(const BranchStatistics& statistics, double shortest, bool trunk) {
    Standing standing;
    std::vector<std::vector<double>> places;
    const std::vector<Branch>& branches = statistics.list().branches;
    for (size_t i = 0; i < branches.size(); i++) {
        if (branches[i].order == 0 && !trunk) continue;
        std::vector<double> own;
        for (const SideBranch& side : statistics.sides(static_cast<int32_t>(i))) {
            if (branches[static_cast<size_t>(side.branch)].length < shortest) continue;
            standing.angles.push_back(std::clamp(side.angle * 180.0 / kPi, kLeastAngle, kMostAngle));
            if (!own.empty()) standing.internodes.push_back(side.along - own.back());
            own.push_back(side.along);
        }
        places.push_back(std::move(own));
    }
    if (standing.internodes.empty()) return standing;
    const double together = kTogether * quantile(standing.internodes, 0.75);
    for (const std::vector<double>& own : places)
        for (size_t from = 0, to = 0; from < own.size(); from = to) {
            while (to < own.size() && own[to] - own[from] <= together)
                to++;
            if (to - from == 2) standing.paired += 2;
            if (to - from > 2) standing.clustered += to - from;
        }
    return standing;
}

}  // namespace

TwigStock stock_of_tree(const Tree& tree, const std::string& title) {
    if (tree.empty()) throw Error("There is no tree to take twigs of.");
    const double height = tree.bounds().max.y - tree.node(tree.root()).position.y;
    const BranchStatistics statistics(tree);
    const BranchList& list = statistics.list();
    if (list.branches.size() < 2 || !(height > 0.0))
        throw Error("The tree has no side branches to take twigs of.");
    const double longest = std::min(kLongest * std::sqrt(height / kOfHeight), kMostOfTree * height);
    double shortest = kShortest * longest;
    const Wood wood(tree);
    std::vector<Candidate> candidates = candidates_of(list, wood, shortest, longest);
    if (candidates.empty()) {
        // A tree with short ones alone still has those.
        candidates = candidates_of(list, wood, 0.0, longest);
        for (const Candidate& one : candidates)
            shortest = std::min(shortest, one.length);
    }
    std::vector<std::string> strings;
    LStringOptions options;
    options.accuracy = 1e-4;
    options.radius_accuracy = 1e-3;
    options.flags = false;
    for (const NodeId id : choose(tree, std::move(candidates), shortest, longest)) {
        const Tree scion = take_scion(tree, id);
        strings.push_back(write_lstring(scion, scion.root(), options));
    }
    if (strings.empty())
        throw Error(
            "None of the tree's side branches is a twig for a sketch: they are too crooked or too large.");
    TwigStock stock = stock_of_twigs(strings, title);
    stock.height = height;

    Standing standing = standing_of(statistics, shortest, false);
    if (standing.angles.size() < kLeastSides) standing = standing_of(statistics, shortest, true);
    if (standing.angles.size() < kLeastSides) standing = standing_of(statistics, 0.0, true);
    if (!standing.angles.empty())
        for (size_t i = 0; i < kAngles; i++)
            stock.angles.push_back(
                quantile(standing.angles, kFrom + (kTo - kFrom) * static_cast<double>(i) / (kAngles - 1)));
    if (!standing.internodes.empty()) stock.internode = quantile(standing.internodes, 0.5);
    const auto most = static_cast<double>(standing.angles.size());
    if (static_cast<double>(standing.clustered) > kMostlyClusters * most)
        stock.arrangement = TwigArrangement::kClustered;
    else if (static_cast<double>(standing.paired) > kMostlyPairs * most)
        stock.arrangement = TwigArrangement::kOpposite;

    WoodTaper taper;
    taper.height = height;
    taper.stem_base = std::min(tree.node(tree.root()).radius, kThickest * height);
    taper.trunk = statistics.profile(0);
    for (size_t i = 1; i < taper.trunk.size(); i++)
        taper.trunk[i] = std::min(taper.trunk[i], taper.trunk[i - 1]);
    taper.branches = statistics.radius_law(1);
    if (taper.branches.known) stock.taper = taper;
    return stock;
}

}  // namespace treerec
