#include "foliage/leaves.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "error.h"
#include "foliage/branch_axis.h"
#include "foliage/foliage_twigs.h"
#include "foliage/leaf_area_grid.h"
#include "foliage/leaf_placer.h"
#include "foliage/near_wood.h"
#include "foliage/snags.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr size_t kBranchesPerChunk = 256;
constexpr size_t kLeavesPerChunk = 512;
constexpr double kStoutShare = 2.0;  // of the rules' maximum_radius: wood that a snag can stand on

// Following a scan's foliage.
constexpr size_t kCellsPerChunk = 512;
constexpr double kHostReach = 2.0;        // of the spacing of foliage_twigs.h: from a leaf to its wood
constexpr double kSpraysPerVolume = 0.7;  // times internode x leaf size squared: a full crown
constexpr double kLeastDensity = 0.4, kMostDensity = 2.5;  // of the usual one
// A whole wood that was taken for one tree would have tens of millions; few of them become leaves.
constexpr double kMostSprays = 1e6;

// The wood that bears one kind of leaves.
class Bearing {
  public:
    // kind: place in leaf_kinds(), or -1: all wood does.
    Bearing(const Tree& tree, const BranchList& list, int kind) : tree_(tree), list_(list), kind_(kind) {
        if (all()) return;
        ways_.resize(list.nodes.size());
        for (const Branch& branch : list.branches) {
            NodeId before = branch.attach != kNoNode ? branch.attach : list.nodes[branch.begin];
            double way = 0.0;
            for (int32_t i = branch.begin; i < branch.end; before = list.nodes[i++]) {
                way += glm::distance(tree.node(list.nodes[i]).position, tree.node(before).position);
                ways_[i] = way;
            }
        }
    }

    // Whether any of the branch does.
    bool any(const Branch& branch) const {
        if (all()) return true;
        const std::span<const NodeId> nodes = list_.nodes_of(branch);
        return std::any_of(nodes.begin(), nodes.end(), [&](NodeId id) { return is(id); });
    }
    // Takes out the spots from `first` on that stand on other wood; all are of the branch.
    void keep(const Branch& branch, std::vector<LeafSpot>& spots, size_t first) const {
        if (all()) return;
        const auto begin = spots.begin() + static_cast<std::ptrdiff_t>(first);
        spots.erase(std::remove_if(begin, spots.end(),
                                   [&](const LeafSpot& spot) { return !at(branch, spot.at.way); }),
                    spots.end());
    }
    // way: metres along the chords of the branch (AxisPoint::way).
    bool at(const Branch& branch, double way) const {
        if (all()) return true;
        const auto first = ways_.begin(),
                   above = std::lower_bound(first + branch.begin, first + branch.end - 1, way);
        return is(list_.nodes[static_cast<size_t>(above - first)]);
    }

  private:
    bool all() const { return kind_ < 0 || tree_.leaf_rules().empty(); }
    bool is(NodeId id) const { return tree_.node(id).leaf_rule == kind_; }

    const Tree& tree_;
    const BranchList& list_;
    const int kind_;
    std::vector<double> ways_;  // by list.nodes: metres along its branch's chords
};

// Leaves where a scan saw them.
class Follower {
  public:
    Follower(const LeafPlacer& placer, const Foliage& foliage)
        : placer_(placer),
          foliage_(foliage),
          wood_(placer.tree, placer.list, kHostReach * foliage_twig_spacing(foliage),
                placer.size.maximum_radius, 2e-5 * placer.crown.coordinate),
          usual_(usual_points(foliage)) {
        const ScaledLeaf& size = placer.size;
        per_cell_ = kSpraysPerVolume * foliage.edge * foliage.edge * foliage.edge /
                    (size.internode * size.leaf_size * size.leaf_size) * placer.rules.follow_density;
        double all = 0.0;
        for (const FoliageCell& cell : foliage.cells)
            all += per_cell_ * density(cell);
        share_ = std::min(1.0, kMostSprays / all);
        if (!foliage.colored) return;
        std::vector<double> shares;
        for (const FoliageCell& cell : foliage.cells)
            shares.push_back(red_share(cell));
        std::sort(shares.begin(), shares.end());
        greenest_ = shares[shares.size() / 20];
        reddest_ = shares[shares.size() - 1 - shares.size() / 20];
    }

    // Of the sprays that fill the crown: those that are placed.
    double share() const { return share_; }

    // The sprays in one cell.
    void fill(const FoliageCell& cell, const Bearing& bearing, std::vector<LeafSpot>& spots) const {
        const uint64_t key = hash_seed(placer_.seed, key_of(cell));
        Random random(key, 3);
        const auto count = static_cast<uint64_t>(share_ * per_cell_ * density(cell) + random.uniform());
        for (uint64_t k = 0; k < count; k++) {
            const DVec3 p = foliage_.centre(cell) + foliage_.edge * DVec3(random.uniform(-0.5, 0.5),
                                                                          random.uniform(-0.5, 0.5),
                                                                          random.uniform(-0.5, 0.5));
            const WoodSample* host = wood_.nearest(p);
            if (!host || !bearing.at(placer_.list.branches[host->branch], host->at.way)) continue;
            const AxisPoint& axis = host->at;
            const DVec3 off = p - axis.position;
            const DVec3 radial = normalized_or(off - axis.direction * glm::dot(off, axis.direction),
                                               any_perpendicular(axis.direction));
            AxisPoint at = axis;
            at.direction = normalized_or(0.6 * axis.direction + normalized_or(off, radial), axis.direction);
            const NodeId tip = placer_.list.nodes[placer_.list.branches[host->branch].end - 1];
            // Never 0, which is the tip's own leaf.
            const uint64_t number = hash_seed(key, k) | 1;
            spots.push_back({at, radial, placer_.rules.angle, tip, number, redness(cell)});
        }
    }

    // A spray at the end of a twig that the scan shows among leaves.
    void finish(const Branch& branch, std::vector<AxisPoint>& axis, std::vector<LeafSpot>& spots) const {
        sample_axis(placer_.tree, placer_.list, branch, 2e-5 * placer_.crown.coordinate, axis);
        if (axis.size() < 2) return;
        const FoliageCell* cell = cell_near(axis.back().position);
        if (!cell) return;
        spots.push_back(placer_.tip_spot(branch, axis.back()));
        spots.back().red = redness(*cell);
    }

  private:
    static uint64_t key_of(const FoliageCell& cell) {
        return (static_cast<uint64_t>(cell.x) << 32) | (static_cast<uint64_t>(cell.y) << 16) | cell.z;
    }
    double density(const FoliageCell& cell) const {
        return std::clamp(cell.points / usual_, kLeastDensity, kMostDensity);
    }
    static double red_share(const FoliageCell& cell) {
        return (static_cast<double>(cell.color[0]) - cell.color[1]) /
               std::max(1, cell.color[0] + cell.color[1] + cell.color[2]);
    }

    // LeafSpot::red
    double redness(const FoliageCell& cell) const {
        if (!foliage_.colored) return -1.0;
        const double range = std::max(reddest_ - greenest_, 0.02);
        return std::clamp((red_share(cell) - greenest_) / range, 0.0, 1.0);
    }

    // The cell at p, or one of those that touch it; nullptr where there is none.
    const FoliageCell* cell_near(const DVec3& p) const {
        const DVec3 at = glm::floor((p - foliage_.origin) / foliage_.edge);
        const FoliageCell* found = nullptr;
        for (double x = at.x - 1.0; x <= at.x + 1.0; x += 1.0)
            for (double y = at.y - 1.0; y <= at.y + 1.0; y += 1.0) {
                if (!(x >= 0.0 && x <= UINT16_MAX && y >= 0.0 && y <= UINT16_MAX)) continue;
                if (!(at.z >= -1.0 && at.z <= UINT16_MAX)) continue;
                FoliageCell first;
                first.x = static_cast<uint16_t>(x);
                first.y = static_cast<uint16_t>(y);
                first.z = static_cast<uint16_t>(std::max(at.z - 1.0, 0.0));
                const uint64_t low = key_of(first);
                const auto cell =
                    std::lower_bound(foliage_.cells.begin(), foliage_.cells.end(), low,
                                     [](const FoliageCell& c, uint64_t key) { return key_of(c) < key; });
                if (cell == foliage_.cells.end() || cell->x != first.x || cell->y != first.y) continue;
                if (cell->z > at.z + 1.0) continue;
                if (x == at.x && y == at.y) return &*cell;
                found = &*cell;
            }
        return found;
    }

    const LeafPlacer& placer_;
    const Foliage& foliage_;
    const NearWood wood_;
    const double usual_;
    double per_cell_ = 0.0;
    double share_ = 1.0;
    double greenest_ = 0.0, reddest_ = 0.0;
};

using Spots = std::vector<std::vector<LeafSpot>>;

// Those of the spots that become leaves.
struct Chosen {
    std::vector<const LeafSpot*> spots;
    float growth = 1.0f;  // of their leaves, which stand for all
};

// Fewer, larger leaves that cover the same area. Those at the twigs' ends stay as long as there is room.
Chosen limit_count(const LeafPlacer& placer, const Spots& parts, size_t most) {
    Chosen all;
    size_t ends = 0;
    for (const auto& part : parts)
        for (const LeafSpot& spot : part) {
            all.spots.push_back(&spot);
            ends += spot.number == 0;
        }
    const size_t count = all.spots.size();
    if (count <= most) return all;
    std::vector<float> sizes(count);
    parallel_for(count, kLeavesPerChunk, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++)
            sizes[i] = placer.size_of(*all.spots[i]);
    });
    const size_t others = count - ends;
    const double end_share =
        std::min(1.0, static_cast<double>(most) / static_cast<double>(std::max<size_t>(ends, 1)));
    const double share = ends < most ? static_cast<double>(most - ends) / static_cast<double>(others) : 0.0;
    Chosen kept;
    kept.spots.reserve(most);
    double passed = 0.0, ends_passed = 0.0, area = 0.0, kept_area = 0.0;
    for (size_t i = 0; i < count; i++) {
        const bool terminal = all.spots[i]->number == 0;
        const double own_area = static_cast<double>(sizes[i]) * sizes[i];
        area += own_area;
        // A leaf stays where the running total passes the next whole number: evenly along every twig.
        double& total = terminal ? ends_passed : passed;
        const double before = total;
        total += terminal ? end_share : share;
        if (std::floor(total) == std::floor(before) || kept.spots.size() == most) continue;
        kept.spots.push_back(all.spots[i]);
        kept_area += own_area;
    }
    kept.growth = static_cast<float>(std::sqrt(area / std::max(kept_area, 1e-300)));
    return kept;
}

// Calls body(i, axis, spots) for all i, on several threads, and adds the spots in the order of i.
template <typename Body>
void gather(size_t count, size_t grain, Spots& parts, const Body& body) {
    const size_t first = parts.size();
    parts.resize(first + (count + grain - 1) / grain);
    parallel_for(count, grain, [&](size_t begin, size_t end) {
        std::vector<AxisPoint> axis;
        for (size_t i = begin; i < end; i++)
            body(i, axis, parts[first + begin / grain]);
    });
}

// wood: the tree, or what leafy_tree() makes of it where the rules follow the foliage.
std::vector<LeafPlacement> place_kind(const Tree& wood, const LeafRules& rules, int kind, uint64_t seed,
                                      const Foliage& foliage) {
    std::vector<LeafPlacement> leaves;
    if (!rules.enabled || wood.size() < 2 || rules.maximum_leaves <= 0) return leaves;
    const double follow = foliage.empty() ? 0.0 : rules.follow_density;
    const LeafPlacer placer(wood, rules, seed);
    const Bearing bearing(wood, placer.list, kind);
    const std::vector<Branch>& branches = placer.list.branches;
    Spots spots;
    double share = 1.0;
    if (follow < 1.0) {
        const std::vector<uint8_t> snag =
            find_snags(wood, placer.list, kStoutShare * placer.size.maximum_radius);
        gather(branches.size(), kBranchesPerChunk, spots,
               [&](size_t i, std::vector<AxisPoint>& axis, std::vector<LeafSpot>& out) {
                   if (snag[i] || !bearing.any(branches[i])) return;
                   const size_t first = out.size();
                   placer.bear(branches[i], 1.0 - follow, axis, out);
                   bearing.keep(branches[i], out, first);
               });
    }
    if (follow > 0.0) {
        const Follower follower(placer, foliage);
        share = follower.share();
        if (follow >= 1.0)
            gather(branches.size(), kBranchesPerChunk, spots,
                   [&](size_t i, std::vector<AxisPoint>& axis, std::vector<LeafSpot>& out) {
                       if (!bearing.any(branches[i])) return;
                       const size_t first = out.size();
                       follower.finish(branches[i], axis, out);
                       bearing.keep(branches[i], out, first);
                   });
        gather(foliage.cells.size(), kCellsPerChunk, spots,
               [&](size_t i, std::vector<AxisPoint>&, std::vector<LeafSpot>& out) {
                   follower.fill(foliage.cells[i], bearing, out);
               });
    }
    Chosen chosen = limit_count(placer, spots, static_cast<size_t>(rules.maximum_leaves));
    chosen.growth /= static_cast<float>(std::sqrt(share));
    leaves.resize(chosen.spots.size());
    parallel_for(leaves.size(), kLeavesPerChunk, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            leaves[i] = placer.leaf_at(*chosen.spots[i]);
            leaves[i].size *= chosen.growth;
        }
    });
    // Last, so that the same leaves fall first whatever the limit.
    std::erase_if(leaves, [&](const LeafPlacement& leaf) { return leaf.hold <= 1.0 - rules.standing; });
    return leaves;
}

}  // namespace

std::vector<LeafPlacement> place_leaves(const Tree& tree, const LeafRules& rules, uint64_t seed,
                                        const Foliage& foliage) {
    check_leaf_rules(rules);
    std::vector<LeafPlacement> leaves =
        follows(rules, foliage) ? place_kind(leafy_tree(tree, rules, foliage), rules, -1, seed, foliage)
                                : place_kind(tree, rules, -1, seed, foliage);
    light_leaves({{&leaves, card_area(rules)}});
    return leaves;
}

std::vector<std::vector<LeafPlacement>> place_foliage(const Tree& tree, const std::vector<LeafKind>& kinds,
                                                      uint64_t seed, const Foliage& foliage) {
    if (kinds.size() != tree.leaf_rules().size() + 1)
        throw Error("The tree has other leaf rules than it is to bear leaves by.");
    const bool followed = std::any_of(kinds.begin(), kinds.end(),
                                      [&](const LeafKind& kind) { return follows(kind.rules, foliage); });
    const Tree leafy = followed ? leafy_tree(tree, kinds, foliage) : Tree();
    std::vector<std::vector<LeafPlacement>> leaves;
    for (size_t kind = 0; kind < kinds.size(); kind++) {
        const LeafRules& rules = kinds[kind].rules;
        check_leaf_rules(rules);
        leaves.push_back(
            place_kind(follows(rules, foliage) ? leafy : tree, rules, static_cast<int>(kind), seed, foliage));
    }
    std::vector<LeafGroup> groups;
    for (size_t kind = 0; kind < kinds.size(); kind++)
        groups.push_back({&leaves[kind], card_area(kinds[kind].rules)});
    light_leaves(groups);
    return leaves;
}

}  // namespace treerec
