// Plots of grown trees, scanned together, of which the tree of each point is known.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/quantile.h"
#include "geometry/random.h"
#include "scan/cleaning/clean_cloud.h"
#include "scan/point_cloud.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec::grown_plots {

struct PlotOptions {
    size_t trees = 5;
    bool row = true;        // a street; else scattered
    double overlap = 0.0;   // of neighbours' crowns: what they share, of their mean diameter
    bool ground = false;    // gently sloped, a little rough
    double leaves = 0.0;    // as VirtualScanOptions::leaves
    double noise = 0.003;   // metres
    size_t points = 16000;  // per tree
    uint64_t seed = 1;
};

struct GrownPlot {
    PointCloud cloud;             // metres, Y up
    std::vector<DVec3> feet;      // by tree
    std::vector<uint32_t> owner;  // by point: its tree; kNoTree: ground, and beams that met no wood or leaf
};

// A crown from above.
struct Disc {
    DVec2 centre{0.0};  // from the foot
    double radius = 0.0;
};

inline Disc crown_of(const Tree& tree) {
    const double top = tree.bounds().max.y;
    Disc disc;
    std::vector<DVec2> places;
    for (const NodeId id : tree.depth_first()) {
        const DVec3& p = tree.node(id).position;
        if (p.y > 0.3 * top) places.emplace_back(p.x, p.z);
    }
    for (const DVec2& p : places)
        disc.centre += p / static_cast<double>(places.size());
    std::vector<double> away;
    for (const DVec2& p : places)
        away.push_back(glm::distance(p, disc.centre));
    disc.radius = quantile(away, 0.9);
    return disc;
}

inline double ground_at(const DVec2& p) {
    return 0.05 * p.x - 0.03 * p.y + 0.12 * std::sin(0.4 * p.x) * std::cos(0.35 * p.y);
}

// Where the trees stand: each crown overlaps its neighbour's as asked and none more; feet are 1.2 m apart.
inline std::vector<DVec2> places_for(const std::vector<Disc>& crowns, const PlotOptions& options,
                                     Random& random) {
    constexpr double kFeetApart = 1.2;
    std::vector<DVec2> feet{DVec2(0.0)};
    const auto apart = [&](size_t a, size_t b) {
        return (1.0 - options.overlap) * (crowns[a].radius + crowns[b].radius);
    };
    for (size_t t = 1; t < crowns.size(); t++) {
        DVec2 best(0.0);
        double crowding = std::numeric_limits<double>::max();
        for (int trial = 0; trial < 200 && crowding > 0.0; trial++) {
            const size_t beside = options.row ? t - 1 : random.below(static_cast<uint32_t>(t));
            const double turn = options.row ? random.uniform(-0.1, 0.1) : random.uniform(0.0, 2.0 * kPi);
            const DVec2 way(std::cos(turn), std::sin(turn));
            DVec2 foot = feet[beside] + crowns[beside].centre + apart(beside, t) * way - crowns[t].centre;
            if (options.row) foot.y = random.uniform(-0.3, 0.3);
            if (const DVec2 d = foot - feet[beside]; glm::length(d) < kFeetApart)
                foot = feet[beside] + kFeetApart * way;
            double worst = 0.0;
            for (size_t o = 0; o < t; o++) {
                worst = std::max(worst, kFeetApart - glm::distance(foot, feet[o]));
                if (o != beside && !options.row)
                    worst = std::max(worst, apart(o, t) - glm::distance(foot + crowns[t].centre,
                                                                        feet[o] + crowns[o].centre));
            }
            if (worst >= crowding) continue;
            crowding = worst;
            best = foot;
        }
        feet.push_back(best);
    }
    return feet;
}

// Several habits, 7 to 14 m high, scanned as one scene from stations around it, so that trees hide each
// other.
inline GrownPlot make_plot(const PlotOptions& options) {
    constexpr std::array kHabits{Habit::kBroadleaf, Habit::kConifer, Habit::kBirch, Habit::kForked,
                                 Habit::kLeaning};
    Random random(options.seed, 31);
    std::vector<Tree> trees;
    std::vector<Disc> crowns;
    for (size_t t = 0; t < options.trees; t++) {
        GrowOptions grow;
        grow.habit = kHabits[random.below(static_cast<uint32_t>(kHabits.size()))];
        grow.height = random.uniform(7.0, 14.0);
        grow.seed = 100 * options.seed + t;
        trees.push_back(grow_tree(grow));
        crowns.push_back(crown_of(trees.back()));
    }
    const std::vector<DVec2> places = places_for(crowns, options, random);
    GrownPlot plot;
    DVec3 middle(0.0);
    for (const DVec2& p : places) {
        plot.feet.emplace_back(p.x, options.ground ? ground_at(p) : 0.0, p.y);
        middle += plot.feet.back() / static_cast<double>(places.size());
    }
    // One tree whose root lies between theirs; what joins them is thicker than wood that bears leaves, and
    // is left out of the scan.
    constexpr double kLink = 0.009;
    Tree all;
    const NodeId root = all.add_root(middle, kLink);
    std::vector<uint32_t> tree_of{kNoTree};
    for (uint32_t t = 0; t < trees.size(); t++) {
        std::vector<NodeId> made(static_cast<size_t>(trees[t].id_end()), kNoNode);
        const NodeId foot = all.add_child(root, plot.feet[t], kLink);
        tree_of.push_back(kNoTree);
        for (const NodeId id : trees[t].depth_first()) {
            const Node& node = trees[t].node(id);
            const NodeId parent = node.parent == kNoNode ? foot : made[static_cast<size_t>(node.parent)];
            made[static_cast<size_t>(id)] =
                all.add_child(parent, node.position + plot.feet[t], node.radius, node.flags);
            tree_of.push_back(t);
        }
    }
    VirtualScanOptions scan;
    scan.points = options.points * options.trees;
    scan.stations = 5 + static_cast<int>(options.trees) / 2;
    scan.leaves = options.leaves;
    scan.noise = options.noise;
    scan.seed = options.seed;
    const VirtualScan seen = scan_tree(all, scan);
    for (size_t i = 0; i < seen.cloud.size(); i++) {
        const bool wood_or_leaf = seen.origin[i] == kFromWood || seen.origin[i] == kFromLeaf;
        const NodeId node = seen.node[i];
        const uint32_t owner = node == kNoNode ? kNoTree : tree_of[static_cast<size_t>(node)];
        if (node != kNoNode && owner == kNoTree) continue;
        plot.cloud.positions.push_back(seen.cloud.positions[i]);
        plot.owner.push_back(wood_or_leaf ? owner : kNoTree);
    }
    if (!options.ground) return plot;
    Bounds bounds;
    for (const DVec3& foot : plot.feet)
        bounds.add(foot);
    const size_t count = options.points * options.trees / 3;
    for (size_t i = 0; i < count; i++) {
        const DVec2 p(random.uniform(bounds.min.x - 4.0, bounds.max.x + 4.0),
                      random.uniform(bounds.min.z - 4.0, bounds.max.z + 4.0));
        const DVec3 at(p.x, ground_at(p) + (0.01 + options.noise) * random.normal(), p.y);
        plot.cloud.positions.emplace_back(at);
        plot.owner.push_back(kNoTree);
    }
    return plot;
}

struct PlotScore {
    size_t trees = 0;
    size_t found = 0;       // trees that have a stem of their own
    size_t false_ones = 0;  // stems that stand for no tree
    double right = 0.0;     // share of the trees' points that were given to the stem of their tree
};

// labels: by point, from label_trees().
inline PlotScore judge(const GrownPlot& plot, const std::vector<uint32_t>& labels, const PickReport& pick) {
    constexpr double kNear = 0.8;  // metres, and half the way to the next tree
    PlotScore score;
    score.trees = plot.feet.size();
    const size_t count = std::max<size_t>(1, pick.trees.size());
    std::vector<uint32_t> stem_of(plot.feet.size(), kNoTree);
    if (pick.trees.empty()) {
        // Taken for one tree: it is the one with the most points.
        std::vector<size_t> points(plot.feet.size());
        for (const uint32_t owner : plot.owner)
            if (owner != kNoTree) points[owner]++;
        stem_of[static_cast<size_t>(std::max_element(points.begin(), points.end()) - points.begin())] = 0;
        score.found = 1;
    } else {
        struct Pair {
            double away;
            uint32_t tree, stem;
        };
        std::vector<Pair> pairs;
        for (uint32_t t = 0; t < plot.feet.size(); t++) {
            double near = kNear;
            for (uint32_t o = 0; o < plot.feet.size(); o++)
                if (o != t)
                    near = std::min(near, 0.5 * glm::length(DVec2(plot.feet[o].x - plot.feet[t].x,
                                                                  plot.feet[o].z - plot.feet[t].z)));
            for (uint32_t s = 0; s < count; s++) {
                const DVec3 foot = plot.cloud.frame.to_tree(pick.trees[s].foot);
                const double away = glm::length(DVec2(foot.x - plot.feet[t].x, foot.z - plot.feet[t].z));
                if (away <= near) pairs.push_back({away, t, s});
            }
        }
        std::stable_sort(pairs.begin(), pairs.end(),
                         [](const Pair& a, const Pair& b) { return a.away < b.away; });
        std::vector<uint8_t> taken(count);
        for (const Pair& pair : pairs) {
            if (stem_of[pair.tree] != kNoTree || taken[pair.stem]) continue;
            stem_of[pair.tree] = pair.stem;
            taken[pair.stem] = 1;
            score.found++;
        }
    }
    score.false_ones = count - score.found;
    size_t all = 0, right = 0;
    for (size_t i = 0; i < labels.size(); i++) {
        if (plot.owner[i] == kNoTree) continue;
        all++;
        right += labels[i] != kNoTree && labels[i] == stem_of[plot.owner[i]];
    }
    score.right = static_cast<double>(right) / static_cast<double>(std::max<size_t>(1, all));
    return score;
}

}  // namespace treerec::grown_plots
