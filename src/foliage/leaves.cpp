#include "foliage/leaves.h"

#include <algorithm>
#include <cstdint>

#include "foliage/branch_axis.h"
#include "foliage/crown.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr double kGoldenAngle = 2.39996322972865332;  // radians: leaves above one another shade least
constexpr double kFullHeight = 6.0;                   // metres; smaller trees bear smaller sprays
constexpr size_t kBranchesPerChunk = 256;
constexpr double kStoutShare = 2.0;  // of the rules' maximum_radius: wood that a snag can stand on
constexpr double kSnagRadii = 6.0;   // a branch shorter than this many radii of its host is a snag

// The rules of one tree, in its own measure.
struct Scaled {
    double internode, twig_length, maximum_radius, leaf_size;
};

Scaled scaled(const LeafRules& rules, double height) {
    const double s = std::min(1.0, std::sqrt(height / kFullHeight));
    return {std::max(rules.internode * s, 1e-4 * height), rules.twig_length * s, rules.maximum_radius * s,
            rules.leaf_size * s};
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

void Placer::bear(const Branch& branch, std::vector<AxisPoint>& axis,
                  std::vector<LeafPlacement>& leaves) const {
    sample_axis(tree, list, branch, 2e-5 * crown.coordinate, axis);
    if (axis.size() < 2) return;
    const NodeId tip = list.nodes[branch.end - 1];
    const AxisPoint end = axis.back();
    uint64_t number = 0;
    leaves.push_back(leaf_at(end, end.direction, true, tip, number++));
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

// By branch: whether it is a snag on stout wood, or grows on one. A scan of an old trunk is full of them -
// dead twigs, bark strips, burls - and leaves on them make its foot a bush.
std::vector<uint8_t> find_snags(const Tree& tree, const BranchList& list, double stout_radius) {
    std::vector<uint8_t> snag(list.branches.size(), 0);
    for (size_t i = 0; i < snag.size(); i++) {
        const Branch& branch = list.branches[i];
        if (branch.attach == kNoNode) continue;
        const double host = tree.node(branch.attach).radius;
        snag[i] = snag[branch.parent] || (host > stout_radius && branch.length < kSnagRadii * host);
    }
    return snag;
}

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

}  // namespace

std::vector<LeafPlacement> place_leaves(const Tree& tree, const LeafRules& rules, uint64_t seed) {
    std::vector<LeafPlacement> leaves;
    if (!rules.enabled || tree.size() < 2 || rules.maximum_leaves <= 0) return leaves;
    const Placer placer(tree, rules, seed, measure_crown(tree));
    const std::vector<Branch>& branches = placer.list.branches;
    std::vector<std::vector<LeafPlacement>> parts((branches.size() + kBranchesPerChunk - 1) /
                                                  kBranchesPerChunk);
    const std::vector<uint8_t> snag = find_snags(tree, placer.list, kStoutShare * placer.size.maximum_radius);
    parallel_for(branches.size(), kBranchesPerChunk, [&](size_t begin, size_t end) {
        std::vector<AxisPoint> axis;
        for (size_t i = begin; i < end; i++)
            if (!snag[i]) placer.bear(branches[i], axis, parts[begin / kBranchesPerChunk]);
    });
    size_t count = 0;
    for (const auto& part : parts)
        count += part.size();
    leaves.reserve(count);
    for (const auto& part : parts)
        leaves.insert(leaves.end(), part.begin(), part.end());
    limit_count(leaves, static_cast<size_t>(rules.maximum_leaves));
    return leaves;
}

}  // namespace treerec
