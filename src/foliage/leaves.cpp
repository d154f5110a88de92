#include "foliage/leaves.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "foliage/branch_axis.h"
#include "foliage/foliage_twigs.h"
#include "foliage/leaf_placer.h"
#include "foliage/near_wood.h"
#include "foliage/snags.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr size_t kBranchesPerChunk = 256;
constexpr double kStoutShare = 2.0;  // of the rules' maximum_radius: wood that a snag can stand on

// Following a scan's foliage.
constexpr size_t kCellsPerChunk = 512;
constexpr double kHostReach = 2.0;        // of the spacing of foliage_twigs.h: from a leaf to its wood
constexpr double kSpraysPerVolume = 0.7;  // times internode x leaf size squared: a full crown
constexpr double kLeastDensity = 0.4, kMostDensity = 2.5;  // of the usual one
constexpr double kColorHue = 0.7;                          // of a leaf's hue, where the scan has colours

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
                    (size.internode * size.leaf_size * size.leaf_size);
        if (!foliage.colored) return;
        std::vector<double> shares;
        for (const FoliageCell& cell : foliage.cells)
            shares.push_back(red_share(cell));
        std::sort(shares.begin(), shares.end());
        greenest_ = shares[shares.size() / 20];
        reddest_ = shares[shares.size() - 1 - shares.size() / 20];
    }

    // The sprays in one cell.
    void fill(const FoliageCell& cell, std::vector<LeafPlacement>& leaves) const {
        const uint64_t key = hash_seed(placer_.seed, key_of(cell));
        Random random(key, 3);
        const double density = std::clamp(cell.points / usual_, kLeastDensity, kMostDensity);
        const double wanted = per_cell_ * density * placer_.rules.follow_density;
        const auto count = static_cast<uint64_t>(wanted + random.uniform());
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
            leaves.push_back(placer_.leaf_at(at, radial, placer_.rules.angle, tip, number));
            tint(cell, leaves.back());
        }
    }

    // A spray at the end of a twig that the scan shows among leaves.
    void finish(const Branch& branch, std::vector<AxisPoint>& axis,
                std::vector<LeafPlacement>& leaves) const {
        sample_axis(placer_.tree, placer_.list, branch, 2e-5 * placer_.crown.coordinate, axis);
        if (axis.size() < 2) return;
        const FoliageCell* cell = cell_near(axis.back().position);
        if (!cell) return;
        leaves.push_back(placer_.tip_leaf(branch, axis.back()));
        tint(*cell, leaves.back());
    }

  private:
    static uint64_t key_of(const FoliageCell& cell) {
        return (static_cast<uint64_t>(cell.x) << 32) | (static_cast<uint64_t>(cell.y) << 16) | cell.z;
    }
    static double red_share(const FoliageCell& cell) {
        return (static_cast<double>(cell.color[0]) - cell.color[1]) /
               std::max(1, cell.color[0] + cell.color[1] + cell.color[2]);
    }

    void tint(const FoliageCell& cell, LeafPlacement& leaf) const {
        if (!foliage_.colored) return;
        const double range = std::max(reddest_ - greenest_, 0.02);
        const double hue = std::clamp((red_share(cell) - greenest_) / range, 0.0, 1.0);
        const double follow = kColorHue * placer_.rules.follow_color;
        leaf.hue = static_cast<float>(follow * hue + (1.0 - follow) * leaf.hue);
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
    double greenest_ = 0.0, reddest_ = 0.0;
};

// Fewer, larger leaves that cover the same area. Those at the twigs' ends stay as long as there is room.
void limit_count(std::vector<LeafPlacement>& leaves, size_t most) {
    if (leaves.size() <= most) return;
    size_t ends = 0;
    for (const LeafPlacement& leaf : leaves)
        ends += leaf.terminal > 0.0f;
    const size_t others = leaves.size() - ends;
    const double end_share =
        std::min(1.0, static_cast<double>(most) / static_cast<double>(std::max<size_t>(ends, 1)));
    const double share = ends < most ? static_cast<double>(most - ends) / static_cast<double>(others) : 0.0;
    std::vector<LeafPlacement> kept;
    kept.reserve(most);
    double passed = 0.0, ends_passed = 0.0, area = 0.0, kept_area = 0.0;
    for (const LeafPlacement& leaf : leaves) {
        area += static_cast<double>(leaf.size) * leaf.size;
        // A leaf stays where the running total passes the next whole number: evenly along every twig.
        double& total = leaf.terminal > 0.0f ? ends_passed : passed;
        const double before = total;
        total += leaf.terminal > 0.0f ? end_share : share;
        if (std::floor(total) == std::floor(before) || kept.size() == most) continue;
        kept.push_back(leaf);
        kept_area += static_cast<double>(leaf.size) * leaf.size;
    }
    const auto growth = static_cast<float>(std::sqrt(area / std::max(kept_area, 1e-300)));
    for (LeafPlacement& leaf : kept)
        leaf.size *= growth;
    leaves = std::move(kept);
}

// Calls body(i, leaves) for all i, on several threads, and gathers the leaves in the order of i.
template <typename Body>
void gather(size_t count, size_t grain, std::vector<LeafPlacement>& leaves, const Body& body) {
    std::vector<std::vector<LeafPlacement>> parts((count + grain - 1) / grain);
    parallel_for(count, grain, [&](size_t begin, size_t end) {
        std::vector<AxisPoint> axis;
        for (size_t i = begin; i < end; i++)
            body(i, axis, parts[begin / grain]);
    });
    size_t total = leaves.size();
    for (const auto& part : parts)
        total += part.size();
    leaves.reserve(total);
    for (const auto& part : parts)
        leaves.insert(leaves.end(), part.begin(), part.end());
}

}  // namespace

std::vector<LeafPlacement> place_leaves(const Tree& tree, const LeafRules& rules, uint64_t seed,
                                        const Foliage& foliage) {
    check_leaf_rules(rules);
    std::vector<LeafPlacement> leaves;
    if (!rules.enabled || tree.size() < 2 || rules.maximum_leaves <= 0) return leaves;
    const double follow = foliage.empty() ? 0.0 : rules.follow_density;
    const Tree grown = follow > 0.0 ? leafy_tree(tree, rules, foliage) : Tree();
    const Tree& wood = follow > 0.0 ? grown : tree;
    const LeafPlacer placer(wood, rules, seed);
    const std::vector<Branch>& branches = placer.list.branches;
    using Leaves = std::vector<LeafPlacement>;
    if (follow < 1.0) {
        const std::vector<uint8_t> snag =
            find_snags(wood, placer.list, kStoutShare * placer.size.maximum_radius);
        gather(branches.size(), kBranchesPerChunk, leaves,
               [&](size_t i, std::vector<AxisPoint>& axis, Leaves& out) {
                   if (!snag[i]) placer.bear(branches[i], 1.0 - follow, axis, out);
               });
    }
    if (follow > 0.0) {
        const Follower follower(placer, foliage);
        if (follow >= 1.0)
            gather(branches.size(), kBranchesPerChunk, leaves,
                   [&](size_t i, std::vector<AxisPoint>& axis, Leaves& out) {
                       follower.finish(branches[i], axis, out);
                   });
        gather(foliage.cells.size(), kCellsPerChunk, leaves,
               [&](size_t i, std::vector<AxisPoint>&, Leaves& out) { follower.fill(foliage.cells[i], out); });
    }
    limit_count(leaves, static_cast<size_t>(rules.maximum_leaves));
    // Last, so that the same leaves fall first whatever the limit.
    std::erase_if(leaves, [&](const LeafPlacement& leaf) { return leaf.hold <= 1.0 - rules.standing; });
    return leaves;
}

}  // namespace treerec
