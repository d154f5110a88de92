#include "foliage/leaves.h"

#include <algorithm>
#include <cstdint>

#include "foliage/branch_axis.h"
#include "foliage/crown.h"
#include "foliage/near_wood.h"
#include "foliage/snags.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr double kGoldenAngle = 2.39996322972865332;  // radians: leaves above one another shade least
constexpr double kFullHeight = 6.0;                   // metres; smaller trees have shorter, thinner twigs
constexpr double kFullSprayHeight = 12.0;             // metres; smaller trees bear smaller sprays
constexpr size_t kBranchesPerChunk = 256;
constexpr double kStoutShare = 2.0;  // of the rules' maximum_radius: wood that a snag can stand on

// Following a scan's foliage.
constexpr size_t kCellsPerChunk = 512;
constexpr double kReach = 1.2;            // metres between a leaf and its branch, on a tree of full height
constexpr double kLeastReachCells = 4.0;  // or that many cells, if that is more
constexpr double kSpraysPerVolume = 0.7;  // times internode x leaf size squared: a full crown
constexpr double kLeastDensity = 0.4, kMostDensity = 2.5;  // of the usual one
constexpr double kColorHue = 0.7;                          // of a leaf's hue, where the scan has colours

// The rules of one tree, in its own measure.
struct Scaled {
    double internode, twig_length, maximum_radius, leaf_size;
};

Scaled scaled(const LeafRules& rules, double height) {
    const double s = std::min(1.0, std::sqrt(height / kFullHeight));
    const double spray = std::min(1.0, std::sqrt(height / kFullSprayHeight));
    return {std::max(rules.internode * spray, 1e-4 * height), rules.twig_length * s, rules.maximum_radius * s,
            rules.leaf_size * spray};
}

struct Placer {
    const Tree& tree;
    const LeafRules& rules;
    const Scaled size;
    const BranchList list;
    const Crown crown;
    const uint64_t seed;

    Placer(const Tree& t, const LeafRules& r, uint64_t s, const Crown& c)
        : tree(t), rules(r), size(scaled(r, c.height)), list(list_branches(t)), crown(c), seed(s) {}

    LeafPlacement tip_leaf(const Branch& branch, const AxisPoint& end) const;
    void bear(const Branch& branch, std::vector<AxisPoint>& axis, std::vector<LeafPlacement>& leaves) const;
    LeafPlacement leaf_at(const AxisPoint& at, const DVec3& radial, bool terminal, NodeId tip,
                          uint64_t number) const;
};

// radial: unit, out of the bark at `at`. number: counts from the tip, so that the leaf keeps its random
// numbers whatever happens below it.
LeafPlacement Placer::leaf_at(const AxisPoint& at, const DVec3& radial, bool terminal, NodeId tip,
                              uint64_t number) const {
    const uint64_t branch_key = hash_seed(seed, static_cast<uint64_t>(tip));
    Random random(hash_seed(branch_key, number));
    const DVec3 up(0.0, 1.0, 0.0);
    const double angle =
        terminal ? 0.0 : glm::radians(rules.angle + rules.angle_variation * random.uniform(-1.0, 1.0));
    DVec3 y = at.direction * std::cos(angle) + radial * std::sin(angle);
    // Droop turns the leaf towards the ground, most where it lies level.
    const double droop = glm::radians(rules.droop + 0.5 * rules.angle_variation * random.uniform(-1.0, 1.0)) *
                         (terminal ? 0.4 : 1.0);
    y = normalized_or(y - up * std::tan(std::clamp(droop, -1.2, 1.2)) * (1.0 - 0.6 * std::abs(y.y)),
                      at.direction);
    // The upper face looks to the light: the sky and out of the crown.
    const DVec3 position = at.position + radial * (terminal ? 0.0 : 0.9 * at.radius);
    const DVec3 outward = crown.outward(position);
    const double lean = glm::radians(rules.angle_variation) * random.uniform(-1.0, 1.0);
    DVec3 z = up * 0.8 + outward * 0.5 + random.direction() * 0.35;
    z = normalized_or(z - y * glm::dot(z, y), any_perpendicular(y));
    DVec3 x = glm::cross(y, z);
    z = glm::normalize(z * std::cos(lean) + x * std::sin(lean));
    x = glm::cross(y, z);

    LeafPlacement leaf;
    leaf.position = Vec3(position);
    leaf.x = Vec3(x);
    leaf.y = Vec3(y);
    leaf.z = Vec3(z);
    leaf.outward = Vec3(outward);
    leaf.size = static_cast<float>(size.leaf_size * (1.0 + rules.size_variation * random.uniform(-1.0, 1.0)));
    const double phase = branch_phase(tip) + 0.25 * random.uniform();
    leaf.phase = static_cast<float>(phase - std::floor(phase));
    Random branch_random(branch_key, 1);
    leaf.hue = static_cast<float>(0.55 * branch_random.uniform() + 0.45 * random.uniform());
    const double stout = size.maximum_radius > 0.0 ? at.radius / size.maximum_radius : 1.0;
    leaf.stiffness = static_cast<float>(std::clamp(stout, 0.0, 1.0));
    leaf.sway = static_cast<float>(crown.sway(at.position));
    leaf.occlusion = static_cast<float>(0.35 + 0.65 * crown.openness(position));
    return leaf;
}

LeafPlacement Placer::tip_leaf(const Branch& branch, const AxisPoint& end) const {
    return leaf_at(end, end.direction, true, list.nodes[branch.end - 1], 0);
}

void Placer::bear(const Branch& branch, std::vector<AxisPoint>& axis,
                  std::vector<LeafPlacement>& leaves) const {
    sample_axis(tree, list, branch, 2e-5 * crown.coordinate, axis);
    if (axis.size() < 2) return;
    const NodeId tip = list.nodes[branch.end - 1];
    const AxisPoint end = axis.back();
    leaves.push_back(tip_leaf(branch, end));
    uint64_t number = 1;
    // The tip bears leaves however thick a scan made it.
    const double stoutest = std::max(size.maximum_radius, 1.5 * end.radius);
    const double buried = branch.attach == kNoNode ? 0.0 : tree.node(branch.attach).radius;
    Random random(hash_seed(seed, static_cast<uint64_t>(tip)), 2);
    double azimuth = random.uniform(0.0, 2.0 * kPi);
    double along = end.along - size.internode * random.uniform(0.5, 1.0);
    const double lowest = std::max(end.along - size.twig_length, buried);
    size_t hint = axis.size() - 2;
    const bool opposite = rules.arrangement == LeafArrangement::kOpposite;
    // A frame carried down from the tip; over a twig's length its twist is no matter.
    DVec3 side = any_perpendicular(end.direction);
    while (along > lowest) {
        const AxisPoint at = axis_at(axis, along, hint);
        if (at.radius > stoutest) break;
        side = normalized_or(side - at.direction * glm::dot(side, at.direction),
                             any_perpendicular(at.direction));
        const DVec3 other = glm::cross(at.direction, side);
        const double turned = azimuth + 0.35 * random.uniform(-1.0, 1.0);
        const DVec3 radial = side * std::cos(turned) + other * std::sin(turned);
        leaves.push_back(leaf_at(at, radial, false, tip, number++));
        if (opposite) leaves.push_back(leaf_at(at, -radial, false, tip, number++));
        azimuth += opposite ? 0.5 * kPi : kGoldenAngle;
        along -= size.internode * random.uniform(0.8, 1.2) * (opposite ? 2.0 : 1.0);
    }
}

// Leaves where a scan saw them.
class Follower {
  public:
    Follower(const Placer& placer, const Foliage& foliage)
        : placer_(placer),
          foliage_(foliage),
          wood_(placer.tree, placer.list, reach(placer, foliage), placer.size.maximum_radius,
                2e-5 * placer.crown.coordinate),
          usual_(usual_points(foliage)) {
        const Scaled& size = placer.size;
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
        const double wanted = per_cell_ * density;
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
            // leaf_at() puts the petiole onto the bark: out to p, unless p lies in the wood.
            if (glm::length(off) > axis.radius) at.position = p - radial * 0.9 * axis.radius;
            at.direction = normalized_or(0.6 * axis.direction + normalized_or(off, radial), axis.direction);
            const Branch& branch = placer_.list.branches[host->branch];
            leaves.push_back(
                placer_.leaf_at(at, radial, false, placer_.list.nodes[branch.end - 1], hash_seed(key, k)));
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
    static double reach(const Placer& placer, const Foliage& foliage) {
        const double scale = std::min(1.0, std::sqrt(placer.crown.height / kFullHeight));
        return std::max({kReach * scale, kLeastReachCells * foliage.edge, foliage.reach});
    }
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
        leaf.hue = static_cast<float>(kColorHue * hue + (1.0 - kColorHue) * leaf.hue);
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

    const Placer& placer_;
    const Foliage& foliage_;
    const NearWood wood_;
    const double usual_;
    double per_cell_ = 0.0;
    double greenest_ = 0.0, reddest_ = 0.0;
};

// Fewer, larger leaves that cover the same area.
void limit_count(std::vector<LeafPlacement>& leaves, size_t most) {
    if (leaves.size() <= most) return;
    const double share = static_cast<double>(most) / static_cast<double>(leaves.size());
    const float growth = static_cast<float>(1.0 / std::sqrt(share));
    std::vector<LeafPlacement> kept;
    kept.reserve(most);
    for (size_t i = 0; i < leaves.size(); i++) {
        // Leaf i stays where the running total passes the next whole number: evenly along every twig.
        const auto before = static_cast<uint64_t>(static_cast<double>(i) * share);
        const auto after = static_cast<uint64_t>(static_cast<double>(i + 1) * share);
        if (after == before || kept.size() == most) continue;
        kept.push_back(leaves[i]);
        kept.back().size *= growth;
    }
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
    std::vector<LeafPlacement> leaves;
    if (!rules.enabled || tree.size() < 2 || rules.maximum_leaves <= 0) return leaves;
    const Placer placer(tree, rules, seed, measure_crown(tree));
    const std::vector<Branch>& branches = placer.list.branches;
    using Leaves = std::vector<LeafPlacement>;
    if (rules.follow_foliage && !foliage.empty()) {
        const Follower follower(placer, foliage);
        gather(branches.size(), kBranchesPerChunk, leaves,
               [&](size_t i, std::vector<AxisPoint>& axis, Leaves& out) {
                   follower.finish(branches[i], axis, out);
               });
        gather(foliage.cells.size(), kCellsPerChunk, leaves,
               [&](size_t i, std::vector<AxisPoint>&, Leaves& out) { follower.fill(foliage.cells[i], out); });
    } else {
        const std::vector<uint8_t> snag =
            find_snags(tree, placer.list, kStoutShare * placer.size.maximum_radius);
        gather(branches.size(), kBranchesPerChunk, leaves,
               [&](size_t i, std::vector<AxisPoint>& axis, Leaves& out) {
                   if (!snag[i]) placer.bear(branches[i], axis, out);
               });
    }
    limit_count(leaves, static_cast<size_t>(rules.maximum_leaves));
    return leaves;
}

}  // namespace treerec
