#include "foliage/leaf_rules.h"

#include <gtest/gtest.h>

#include <set>

#include "bark_surface.h"
#include "error.h"
#include "foliage/branch_axis.h"
#include "foliage/leaf_rule_text.h"
#include "foliage/leaves.h"
#include "random_tree.h"

namespace treerec {
namespace {

constexpr LeafArrangement kArrangements[] = {LeafArrangement::kAlternate, LeafArrangement::kOpposite,
                                             LeafArrangement::kDecussate, LeafArrangement::kWhorled,
                                             LeafArrangement::kSpiral,    LeafArrangement::kFascicled};

// A slender twig of 2 m along `direction`, on a stem of 12 m, so that no length is scaled.
Tree twig_along(const DVec3& direction, NodeId& tip) {
    Tree tree;
    tree.add_root({0, 0, 0}, 0.2);
    NodeId at = tree.add_child(0, {0, 6, 0}, 0.15);
    tree.add_child(at, {0, 12, 0}, 0.1);
    tip = at;
    for (int i = 1; i <= 8; i++)
        tip = tree.add_child(tip, DVec3(0, 6, 0) + direction * (0.25 * i), 0.004);
    return tree;
}

struct OnTwig {
    double along;    // metres from the tip
    double azimuth;  // degrees around the twig, from the side that is level
};

// Where a rule's leaves stand on a straight twig, without its randomness, from the tip down.
std::vector<OnTwig> on_twig(LeafRules rules, const DVec3& direction) {
    rules.angle_variation = 0.0;
    rules.twig_length = 1.5;
    rules.leaf_area_index = 0.0;
    NodeId tip = kNoNode;
    const Tree tree = twig_along(direction, tip);
    const DVec3 end = tree.node(tip).position;
    const DVec3 level = normalized_or(glm::cross(direction, DVec3(0, 1, 0)), any_perpendicular(direction));
    const DVec3 other = glm::cross(direction, level);
    std::vector<OnTwig> found;
    for (const LeafPlacement& leaf : place_leaves(tree, rules, 3)) {
        const DVec3 from = DVec3(leaf.position) - end;
        const double along = -glm::dot(from, direction);
        if (leaf.terminal > 0.0f || glm::length(from + direction * along) > 0.01) continue;
        const DVec3 radial = from + direction * along;
        found.push_back({along, glm::degrees(std::atan2(glm::dot(radial, other), glm::dot(radial, level)))});
    }
    return found;
}

double turn_between_degrees(double a, double b) {
    const double turn = std::fmod(std::abs(a - b), 360.0);
    return std::min(turn, 360.0 - turn);
}

TEST(LeafRules, PhyllotaxisIsWhatItsNameSays) {
    const DVec3 direction = glm::normalize(DVec3(1.0, 0.3, 0.2));
    for (const LeafArrangement arrangement : kArrangements) {
        LeafRules rules;
        rules.arrangement = arrangement;
        rules.whorl = 4;
        rules.divergence = 144.0;
        rules.internode = 0.04;
        const std::vector<OnTwig> leaves = on_twig(rules, direction);
        const auto count = static_cast<size_t>(leaves_per_node(rules));
        ASSERT_GE(leaves.size(), 4 * count);
        ASSERT_EQ(leaves.size() % count, 0u);
        for (size_t node = 0; node + 1 < leaves.size() / count; node++) {
            const OnTwig& first = leaves[node * count];
            const OnTwig& next = leaves[(node + 1) * count];
            // Whole nodes stand `count` internodes apart, give or take a fifth.
            EXPECT_GT(next.along - first.along, 0.79 * 0.04 * static_cast<double>(count));
            EXPECT_LT(next.along - first.along, 1.21 * 0.04 * static_cast<double>(count));
            for (size_t k = 1; k < count; k++) {
                EXPECT_NEAR(leaves[node * count + k].along, first.along, 1e-3);
                const double apart = turn_between_degrees(leaves[node * count + k].azimuth, first.azimuth);
                const double wanted = arrangement == LeafArrangement::kFascicled ? 30.0 : 360.0 / count * k;
                EXPECT_NEAR(apart, std::min(wanted, 360.0 - wanted),
                            arrangement == LeafArrangement::kFascicled ? 30.0 : 2.0);
            }
            const double turn = turn_between_degrees(next.azimuth, first.azimuth);
            switch (arrangement) {
                case LeafArrangement::kAlternate:
                    EXPECT_NEAR(turn, 180.0, 2.0);
                    // To the left and the right, level.
                    EXPECT_LT(std::min(turn_between_degrees(first.azimuth, 0.0),
                                       turn_between_degrees(first.azimuth, 180.0)),
                              2.0);
                    break;
                case LeafArrangement::kOpposite:
                    EXPECT_NEAR(turn, 0.0, 2.0);
                    break;
                case LeafArrangement::kDecussate:
                    EXPECT_NEAR(turn, 90.0, 2.0);
                    break;
                case LeafArrangement::kWhorled:
                    EXPECT_NEAR(turn, 45.0, 2.0);
                    break;
                case LeafArrangement::kSpiral:
                case LeafArrangement::kFascicled:
                    EXPECT_NEAR(turn, 144.0, 2.0);
                    break;
            }
        }
    }
}

TEST(LeafRules, EveryPetioleStandsOnTheBarkAndEveryTipBearsALeaf) {
    const std::vector<std::string> names = leaf_preset_names();
    for (uint64_t seed = 0; seed < 60; seed++) {
        Tree tree = test::random_tree(seed, 60 + static_cast<int>(seed) * 3);
        for (const NodeId id : tree.depth_first())
            tree.set_radius(id, std::min(tree.node(id).radius, 0.02));
        LeafRules rules = leaf_preset(names[seed % (names.size() - 1)]);
        rules.arrangement = kArrangements[seed % 6];
        rules.by_order.clear();  // a palm's
        rules.leaf_area_index = 0.0;
        rules.form = static_cast<LeafForm>(seed % 5);
        const std::vector<LeafPlacement> leaves = place_leaves(tree, rules, seed);
        const test::BarkSurface bark(tree);
        std::set<std::array<float, 3>> ends;
        for (const LeafPlacement& leaf : leaves) {
            // A tenth of the radius (2 cm at most) under the surface, and the thinnest tubes have three
            // sides, the middles of which lie at half the radius; bends are cut short a little.
            ASSERT_LT(bark.distance(DVec3(leaf.position)), 0.015) << "seed " << seed;
            if (leaf.terminal > 0.0f) ends.insert({leaf.position.x, leaf.position.y, leaf.position.z});
        }
        const std::vector<NodeId> tips = tree.nodes_of_kind(NodeKind::kLeaf);
        for (const NodeId tip : tips) {
            const Vec3 p(tree.node(tip).position);
            bool borne = false;
            for (const std::array<float, 3>& end : ends)
                borne = borne || glm::distance(p, Vec3(end[0], end[1], end[2])) < 1e-4f;
            EXPECT_TRUE(borne) << "seed " << seed << ", tip " << tip;
        }
    }
}

TEST(LeafRules, TheLimitTakesTheTipsLast) {
    Tree tree = test::random_tree(4, 500);
    for (const NodeId id : tree.depth_first())
        tree.set_radius(id, std::min(tree.node(id).radius, 0.02));
    const size_t tips = tree.nodes_of_kind(NodeKind::kLeaf).size();
    LeafRules rules;
    rules.leaf_area_index = 0.0;
    for (const size_t most : {2 * tips, tips, tips / 2}) {
        rules.maximum_leaves = static_cast<int>(most);
        size_t ends = 0, all = 0;
        for (const LeafPlacement& leaf : place_leaves(tree, rules, 1)) {
            all++;
            ends += leaf.terminal > 0.0f;
        }
        EXPECT_LE(all, most);
        EXPECT_GE(all + 2, most);
        EXPECT_GE(ends + 2, std::min(most, tips));
    }
}

std::set<std::array<float, 3>> places(const std::vector<LeafPlacement>& leaves) {
    std::set<std::array<float, 3>> found;
    for (const LeafPlacement& leaf : leaves)
        found.insert({leaf.position.x, leaf.position.y, leaf.position.z});
    return found;
}

TEST(LeafRules, LeavesFallOneByOneAndTheSameFirst) {
    const Tree tree = test::random_tree(7, 400);
    LeafRules rules;
    std::set<std::array<float, 3>> before = places(place_leaves(tree, rules, 2));
    const size_t full = before.size();
    for (const double standing : {0.8, 0.5, 0.2, 0.0}) {
        rules.standing = standing;
        const std::set<std::array<float, 3>> now = places(place_leaves(tree, rules, 2));
        EXPECT_LT(now.size(), before.size());
        for (const auto& place : now)
            ASSERT_TRUE(before.contains(place));
        // Those at the tips hold longer.
        EXPECT_GE(static_cast<double>(now.size()), 0.8 * standing * static_cast<double>(full));
        before = now;
    }
    EXPECT_TRUE(before.empty());
}

// Wood that is to be fuller than the tree's own leaves make it, whatever these are.
TEST(LeafRules, CrowdedLeavesStandCloserThanTheKindsInternodeSays) {
    const Tree tree = test::random_tree(7, 400);
    for (const char* preset : {"maple", "oak", "spruce"}) {
        LeafRules own = leaf_preset(preset);
        own.leaf_area_index = 0.0;
        const LeafKind crowded = make_leaf_kind("crowding=1.5", own);
        EXPECT_EQ(crowded.rules.internode, own.internode);
        const auto few = static_cast<double>(place_leaves(tree, own, 2).size());
        const auto more = static_cast<double>(place_leaves(tree, crowded.rules, 2).size());
        own.internode /= 1.5;
        EXPECT_EQ(more, static_cast<double>(place_leaves(tree, own, 2).size())) << preset;
        EXPECT_GT(more, 1.2 * few) << preset;
    }
}

TEST(LeafRules, UnfoldingLeavesStandWhereFullOnesDo) {
    const Tree tree = test::random_tree(7, 400);
    LeafRules rules;
    rules.leaf_area_index = 3.0;
    const std::vector<LeafPlacement> full = place_leaves(tree, rules, 2);
    rules.unfolded = 0.3;
    const std::vector<LeafPlacement> buds = place_leaves(tree, rules, 2);
    ASSERT_EQ(buds.size(), full.size());
    for (size_t i = 0; i < full.size(); i++) {
        ASSERT_EQ(buds[i].position, full[i].position);
        ASSERT_NEAR(buds[i].size, 0.3f * full[i].size, 1e-5f);
    }
}

TEST(LeafRules, DensityFollowsHeightRadiusAndOrder) {
    const Tree tree = test::random_tree(9, 900, 12.0);
    LeafRules rules;
    const std::vector<LeafPlacement> all = place_leaves(tree, rules, 5);
    double low = 1e9, high = -1e9;
    for (const NodeId id : tree.depth_first()) {
        low = std::min(low, tree.node(id).position.y);
        high = std::max(high, tree.node(id).position.y);
    }
    low = tree.node(tree.root()).position.y;
    const double middle = low + 0.5 * (high - low);
    // None in the lower half, all at the top.
    rules.by_height = {0.0f, 0.0f, 1.0f};
    const std::vector<LeafPlacement> upper = place_leaves(tree, rules, 5);
    EXPECT_LT(upper.size(), all.size());
    ASSERT_GT(upper.size(), 20u);
    for (const LeafPlacement& leaf : upper)
        EXPECT_GT(leaf.position.y, middle - 0.1);
    rules.by_height = {0.5f};
    EXPECT_LT(place_leaves(tree, rules, 5).size(), all.size());
    rules.by_height.clear();
    // By order: none on the trunk and the branches.
    rules.by_order = {0.0f, 0.0f, 1.0f};
    const BranchList list = list_branches(tree);
    std::set<std::array<float, 3>> ends;
    for (const Branch& branch : list.branches)
        if (branch.order < 2) {
            const Vec3 p(tree.node(list.nodes[branch.end - 1]).position);
            ends.insert({p.x, p.y, p.z});
        }
    const std::set<std::array<float, 3>> by_order = places(place_leaves(tree, rules, 5));
    EXPECT_LT(by_order.size(), all.size());
    for (const auto& end : ends)
        EXPECT_FALSE(by_order.contains(end));
    rules.by_order.clear();
    rules.by_radius = {1.0f, 0.0f};
    const size_t thin = place_leaves(tree, rules, 5).size();
    rules.by_radius = {0.0f, 1.0f};
    EXPECT_GT(thin, place_leaves(tree, rules, 5).size());
    for (const std::vector<float>& table : {std::vector<float>{1.5f}, std::vector<float>{NAN}}) {
        LeafRules bad;
        bad.by_order = table;
        EXPECT_THROW(place_leaves(tree, bad, 1), Error);
    }
}

TEST(LeafRules, ClusteredLeavesStandNearTheTips) {
    const DVec3 direction = glm::normalize(DVec3(1.0, 0.5, 0.0));
    const auto mean = [&](double clustering) {
        LeafRules rules;
        rules.internode = 0.01;
        rules.clustering = clustering;
        double sum = 0.0, count = 0.0;
        for (const OnTwig& leaf : on_twig(rules, direction)) {
            sum += leaf.along;
            count++;
        }
        EXPECT_GT(count, 5.0);
        return sum / count;
    };
    EXPECT_NEAR(mean(0.0), 0.75, 0.08);
    EXPECT_LT(mean(0.5), 0.6);
    EXPECT_LT(mean(1.0), 0.4);
}

TEST(LeafRules, PoseFollowsTheRule) {
    const DVec3 direction(1.0, 0.0, 0.0);
    NodeId tip = kNoNode;
    const Tree tree = twig_along(direction, tip);
    LeafRules rules;
    rules.angle_variation = 0.0;
    rules.droop = 0.0;
    rules.twig_length = 1.5;
    const auto each = [&](auto&& check) {
        int seen = 0;
        for (const LeafPlacement& leaf : place_leaves(tree, rules, 4)) {
            if (leaf.terminal > 0.0f || leaf.position.x < 0.4f || leaf.position.y > 6.5f) continue;
            check(leaf);
            seen++;
        }
        EXPECT_GT(seen, 5);
    };
    const auto lean = [&](const LeafPlacement& leaf) {
        return glm::degrees(std::acos(glm::clamp(glm::dot(DVec3(leaf.y), direction), -1.0, 1.0)));
    };
    rules.angle = 70.0;
    each([&](const LeafPlacement& leaf) { EXPECT_NEAR(lean(leaf), 70.0, 0.5); });
    // Near the tip (x = 2) the leaves close in on it.
    rules.closing = 1.0;
    each([&](const LeafPlacement& leaf) {
        EXPECT_NEAR(lean(leaf), 70.0 * std::min((2.0 - leaf.position.x) / 1.5, 1.0), 1.0);
    });
    rules.closing = 0.0;
    double level = 0.0, drooping = 0.0, rising = 0.0;
    each([&](const LeafPlacement& leaf) { level += leaf.y.y; });
    rules.droop = 40.0;
    each([&](const LeafPlacement& leaf) { drooping += leaf.y.y; });
    rules.droop = 0.0;
    rules.phototropism = 1.0;
    each([&](const LeafPlacement& leaf) { rising += leaf.y.y; });
    EXPECT_LT(drooping, level - 1.0);
    EXPECT_GT(rising, level + 1.0);
    // Without phototropism faces look to the twig's tip, with it to the sky.
    double sky = 0.0, along = 0.0;
    rules.phototropism = 0.5;
    each([&](const LeafPlacement& leaf) { sky += leaf.z.y; });
    rules.phototropism = 0.0;
    each([&](const LeafPlacement& leaf) { along += leaf.z.x; });
    EXPECT_GT(sky, 5.0);
    EXPECT_GT(along, 5.0);
}

TEST(LeafRules, BadOnesAreRefusedWithTheirName) {
    const Tree tree = test::random_tree(1, 20);
    const auto refused = [&](auto&& spoil, const char* word) {
        LeafRules rules;
        spoil(rules);
        try {
            place_leaves(tree, rules, 1);
            ADD_FAILURE() << word;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
        }
    };
    refused([](LeafRules& r) { r.internode = 0.0; }, "internode");
    refused([](LeafRules& r) { r.internode = NAN; }, "internode");
    refused([](LeafRules& r) { r.leaf_size = -1.0; }, "leaf size");
    refused([](LeafRules& r) { r.whorl = 0; }, "whorl");
    refused([](LeafRules& r) { r.leaflets = 100000; }, "leaflets");
    refused([](LeafRules& r) { r.angle = INFINITY; }, "angle");
    refused([](LeafRules& r) { r.standing = 1.5; }, "standing");
    refused([](LeafRules& r) { r.unfolded = 0.0; }, "size");
    refused([](LeafRules& r) { r.crowding = 0.0; }, "crowding");
    refused([](LeafRules& r) { r.follow_density = -0.1; }, "density");
    refused([](LeafRules& r) { r.sprig = std::make_shared<LeafSprig>(); }, "sprig");
}

}  // namespace
}  // namespace treerec
