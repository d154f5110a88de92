#include "foliage/leaves.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

#include "error.h"
#include "foliage/branch_axis.h"
#include "foliage/foliage_twigs.h"
#include "foliage/leaf_area.h"
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
constexpr double kLeastInside = 0.3;                       // of the leaves: those beside the twigs' ends
constexpr double kFull = 1.15;  // of the index: above one place, since there is less at a crown's rim
constexpr double kUneven = kMostDensity;  // where a scan saw more
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

    bool bears(const LeafSpot& spot) const {
        if (all()) return true;
        return at(list_.branches[static_cast<size_t>(list_.branch_of[static_cast<size_t>(spot.tip)])],
                  spot.at.way);
    }

  private:
    bool all() const { return kind_ < 0 || tree_.leaf_rules().empty(); }
    bool is(NodeId id) const { return tree_.node(id).leaf_rule == kind_; }
    // way: metres along the chords of the branch (AxisPoint::way).
    bool at(const Branch& branch, double way) const {
        const auto first = ways_.begin(),
                   above = std::lower_bound(first + branch.begin, first + branch.end - 1, way);
        return is(list_.nodes[static_cast<size_t>(above - first)]);
    }

    const Tree& tree_;
    const BranchList& list_;
    const int kind_;
    std::vector<double> ways_;  // by list.nodes: metres along its branch's chords
};

// What the rules' index is for this crown.
double index_of(const LeafPlacer& placer) {
    return placer.rules.leaf_area_index * light_on(placer.crown);
}

// Leaves where a scan saw them.
class Follower {
  public:
    Follower(const LeafPlacer& placer, const Foliage& foliage)
        : placer_(placer),
          foliage_(foliage),
          wood_(placer.tree, placer.list, kHostReach * foliage_twig_spacing(foliage),
                placer.size.maximum_radius, 2e-5 * placer.crown.coordinate),
          usual_(usual_points(foliage)) {
        if (!foliage.colored) return;
        std::vector<double> shares;
        for (const FoliageCell& cell : foliage.cells)
            shares.push_back(red_share(cell));
        std::sort(shares.begin(), shares.end());
        greenest_ = shares[shares.size() / 20];
        reddest_ = shares[shares.size() - 1 - shares.size() / 20];
    }

    // Parts the sprays among the cells. ends: square metres of blades at the twigs' ends, which stand
    // besides.
    void part(double ends) {
        double all = 0.0;
        for (const FoliageCell& cell : foliage_.cells)
            all += density(cell);
        per_cell_ = sprays(ends, all) * placer_.rules.follow_density;
        share_ = std::min(1.0, kMostSprays / (per_cell_ * all));
    }

    // Of the sprays that fill the crown: those that are placed.
    double share() const { return share_; }

    // The sprays in one cell.
    void fill(const FoliageCell& cell, std::vector<LeafSpot>& spots) const {
        const uint64_t key = hash_seed(placer_.seed, key_of(cell));
        Random random(key, 3);
        const auto count = static_cast<uint64_t>(share_ * per_cell_ * density(cell) + random.uniform());
        for (uint64_t k = 0; k < count; k++) {
            const DVec3 p = foliage_.centre(cell) + foliage_.edge * DVec3(random.uniform(-0.5, 0.5),
                                                                          random.uniform(-0.5, 0.5),
                                                                          random.uniform(-0.5, 0.5));
            const WoodSample* host = wood_.nearest(p);
            if (!host) continue;
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
    // For each cell of the usual density; `all`: of them.
    double sprays(double ends, double all) const {
        const ScaledLeaf& size = placer_.size;
        const double index = index_of(placer_);
        if (index <= 0.0)
            return kSpraysPerVolume * foliage_.edge * foliage_.edge * foliage_.edge /
                   (size.internode * size.leaf_size * size.leaf_size);
        const double variation = placer_.rules.size_variation;
        const double own =
            blade_area(placer_.rules) * size.leaf_size * size.leaf_size * (1.0 + variation * variation / 3.0);
        const double wanted = index * covered_ground(CrownGround(placer_.crown), foliage_);
        return std::max(wanted - ends, kLeastInside * wanted) / (own * all);
    }
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
Chosen limit_count(const LeafPlacer& placer, std::vector<const LeafSpot*> spots, size_t most) {
    Chosen all{std::move(spots)};
    const size_t count = all.spots.size();
    if (count <= most) return all;
    const auto ends = static_cast<size_t>(std::count_if(
        all.spots.begin(), all.spots.end(), [](const LeafSpot* spot) { return spot->number == 0; }));
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

std::vector<const LeafSpot*> all_of(const Spots& parts) {
    std::vector<const LeafSpot*> all;
    for (const auto& part : parts)
        for (const LeafSpot& spot : part)
            all.push_back(&spot);
    return all;
}

// By the rules alone.
Spots bear_all(const LeafPlacer& placer, double share, double crowding) {
    const std::vector<Branch>& branches = placer.list.branches;
    const std::vector<uint8_t> snag =
        find_snags(placer.tree, placer.list, kStoutShare * placer.size.maximum_radius);
    Spots spots;
    gather(branches.size(), kBranchesPerChunk, spots,
           [&](size_t i, std::vector<AxisPoint>& axis, std::vector<LeafSpot>& out) {
               if (!snag[i]) placer.bear(branches[i], share, crowding, axis, out);
           });
    return spots;
}

// As many as the rules' leaf area index asks for, if there is wood enough. In steps, so that what changes in
// one part of a crown does not move all leaves.
Spots bear_enough(const LeafPlacer& placer, double share) {
    constexpr double kStep = 1.25;
    constexpr double kSpare = 2.0;  // of what is wanted: where they stand too close some go again
    Spots spots = bear_all(placer, share, 1.0);
    const LeafBudget budget = measure_leaves(placer, all_of(spots));
    const double wanted = kSpare * share * index_of(placer) * budget.ground;
    double crowding = 1.0;
    while (crowding * budget.blades < wanted && crowding * kStep < kMostCrowding)
        crowding *= kStep;
    return crowding > 1.0 ? bear_all(placer, share, crowding) : spots;
}

// In a scan's foliage. Returns the share of them that is placed. ends: twigs end in leaves, too.
double follow_all(const LeafPlacer& placer, const Foliage& foliage, bool ends, Spots& spots) {
    const std::vector<Branch>& branches = placer.list.branches;
    Follower follower(placer, foliage);
    if (ends)
        gather(branches.size(), kBranchesPerChunk, spots,
               [&](size_t i, std::vector<AxisPoint>& axis, std::vector<LeafSpot>& out) {
                   follower.finish(branches[i], axis, out);
               });
    follower.part(ends ? measure_leaves(placer, all_of(spots)).blades : 0.0);
    gather(foliage.cells.size(), kCellsPerChunk, spots,
           [&](size_t i, std::vector<AxisPoint>&, std::vector<LeafSpot>& out) {
               follower.fill(foliage.cells[i], out);
           });
    return follower.share();
}

// wood: the tree, or what leafy_tree() makes of it where the rules follow the foliage.
std::vector<LeafPlacement> place_kind(const Tree& wood, const LeafRules& rules, int kind, uint64_t seed,
                                      const Foliage& foliage) {
    std::vector<LeafPlacement> leaves;
    if (!rules.enabled || wood.size() < 2 || rules.maximum_leaves <= 0) return leaves;
    const double follow = foliage.empty() ? 0.0 : rules.follow_density;
    const LeafPlacer placer(wood, rules, seed);
    const double index = index_of(placer);
    Spots parts;
    double share = 1.0;
    if (follow < 1.0)
        parts = index > 0.0 ? bear_enough(placer, 1.0 - follow) : bear_all(placer, 1.0 - follow, 1.0);
    if (follow > 0.0) share = follow_all(placer, foliage, follow >= 1.0, parts);
    std::vector<const LeafSpot*> spots = all_of(parts);
    // Among the leaves of all wood, so that those of one kind stand where they would if all were of it.
    if (index > 0.0) thin_to_index(placer, share * index * (follow > 0.0 ? kUneven : kFull), spots);
    const Bearing bearing(wood, placer.list, kind);
    std::erase_if(spots, [&](const LeafSpot* spot) { return spot->spare || !bearing.bears(*spot); });
    const Chosen chosen = limit_count(placer, std::move(spots), static_cast<size_t>(rules.maximum_leaves));
    const auto growth = static_cast<float>(chosen.growth * rules.unfolded / std::sqrt(share));
    leaves.resize(chosen.spots.size());
    parallel_for(leaves.size(), kLeavesPerChunk, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            leaves[i] = placer.leaf_at(*chosen.spots[i]);
            leaves[i].size *= growth;
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
    light_leaves({{&leaves, blade_area(rules)}});
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
        groups.push_back({&leaves[kind], blade_area(kinds[kind].rules)});
    light_leaves(groups);
    return leaves;
}

}  // namespace treerec
