// What a user is asked to look at: wood that is missing, and branches that are doubtful.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "completion/unexplained.h"
#include "error.h"
#include "fidelity/doubtful.h"
#include "geometry/random.h"
#include "random_tree.h"
#include "tree/branches.h"

namespace treerec {
namespace {

// Points on the cylinder from a to b, about 5 mm apart.
void add_tube(const DVec3& a, const DVec3& b, double radius, PointCloud& cloud) {
    const DVec3 axis = glm::normalize(b - a), side = any_perpendicular(axis);
    const double length = glm::distance(a, b), step = 0.005;
    const int around = std::max(6, static_cast<int>(2.0 * kPi * radius / step));
    for (double x = 0.0; x <= length; x += step)
        for (int k = 0; k < around; k++) {
            const double angle = 2.0 * kPi * k / around;
            cloud.positions.emplace_back(
                a + x * axis + radius * (std::cos(angle) * side + std::sin(angle) * glm::cross(axis, side)));
        }
}

// A stem of 2 m with a branch to +x; `missing` branches to -x and +z are in the cloud alone.
struct Scene {
    Tree tree;
    PointCloud cloud;
    NodeId middle = kNoNode, branch = kNoNode, top = kNoNode;
};

Scene scene() {
    Scene s;
    const NodeId root = s.tree.add_root(DVec3(0.0), 0.1);
    NodeId at = root;
    for (int i = 1; i <= 20; i++) {
        at = s.tree.add_child(at, DVec3(0.0, 0.1 * i, 0.0), 0.1);
        if (i == 10) s.middle = at;
    }
    s.top = at;
    s.branch = s.tree.add_child(s.middle, DVec3(0.8, 1.3, 0.0), 0.03);
    add_tube(DVec3(0.0), DVec3(0.0, 2.0, 0.0), 0.1, s.cloud);
    add_tube(DVec3(0.1, 1.0375, 0.0), DVec3(0.8, 1.3, 0.0), 0.03, s.cloud);
    return s;
}

TEST(Unexplained, FindsEachMissingBranchItsJointAndItsDirection) {
    Scene s = scene();
    const size_t explained = s.cloud.size();
    add_tube(DVec3(-0.1, 0.5, 0.0), DVec3(-1.1, 0.9, 0.0), 0.03, s.cloud);
    const size_t first = s.cloud.size() - explained;
    add_tube(DVec3(0.0, 1.5, 0.1), DVec3(0.0, 1.5, 0.6), 0.02, s.cloud);
    const Fidelity fidelity = measure_fidelity(s.tree, s.cloud);
    const std::vector<UnexplainedCluster> found = find_unexplained(s.tree, s.cloud, fidelity);
    ASSERT_EQ(found.size(), 2u);
    // The larger one comes first; near the stem its points count as the stem's.
    EXPECT_GT(found[0].points.size(), first * 8 / 10);
    EXPECT_LE(found[0].points.size(), first);
    for (uint32_t i : found[0].points) {
        EXPECT_GE(i, explained);
        EXPECT_LT(i, explained + first);
    }
    EXPECT_NEAR(s.tree.node(found[0].joint).position.y, 0.5, 0.11);
    EXPECT_GT(glm::dot(found[0].direction, glm::normalize(DVec3(-1.0, 0.4, 0.0))), 0.98);
    EXPECT_NEAR(found[0].size, 1.05, 0.1);
    EXPECT_NEAR(s.tree.node(found[1].joint).position.y, 1.5, 0.11);
    EXPECT_GT(found[1].direction.z, 0.98);
    EXPECT_NEAR(found[1].centre.z, 0.37, 0.05);

    // Leaves are no wood.
    std::vector<uint8_t> wood(s.cloud.size(), 1);
    std::fill(wood.begin(), wood.begin() + static_cast<ptrdiff_t>(explained + first), uint8_t{0});
    EXPECT_EQ(find_unexplained(s.tree, s.cloud, fidelity, wood).size(), 1u);
}

TEST(Unexplained, NothingIsMissingFromAWholeTree) {
    const Scene s = scene();
    EXPECT_TRUE(find_unexplained(s.tree, s.cloud, measure_fidelity(s.tree, s.cloud)).empty());
}

TEST(Unexplained, TheOrderOfThePointsChangesNothing) {
    const Tree tree = test::random_tree(3, 200, 5.0);
    Random random(3);
    PointCloud cloud;
    for (int i = 0; i < 60; i++) {
        const DVec3 centre(random.uniform(-3, 3), random.uniform(0, 5), random.uniform(-3, 3));
        for (int k = 0; k < 80; k++)
            cloud.positions.emplace_back(centre + random.uniform(0.0, 0.2) * random.direction());
    }
    const auto clusters_of = [&] { return find_unexplained(tree, cloud, measure_fidelity(tree, cloud)); };
    const std::vector<UnexplainedCluster> one = clusters_of();
    std::reverse(cloud.positions.begin(), cloud.positions.end());
    const std::vector<UnexplainedCluster> other = clusters_of();
    ASSERT_GT(one.size(), 5u);
    ASSERT_EQ(one.size(), other.size());
    std::set<uint32_t> seen;
    for (size_t c = 0; c < one.size(); c++) {
        EXPECT_EQ(one[c].centre, other[c].centre);
        EXPECT_EQ(one[c].joint, other[c].joint);
        EXPECT_EQ(one[c].direction, other[c].direction);
        EXPECT_LE(one[c].points.size(), one[c > 0 ? c - 1 : 0].points.size());
        for (uint32_t i : one[c].points)
            EXPECT_TRUE(seen.insert(i).second);
    }
}

// Against joining every pair that is near enough.
TEST(Unexplained, ClustersAreWhatTheGapJoins) {
    Tree tree;
    tree.add_child(tree.add_root(DVec3(0.0, -50.0, 0.0), 0.1), DVec3(0.0, -49.0, 0.0), 0.1);
    for (uint64_t seed = 1; seed < 8; seed++) {
        Random random(seed);
        PointCloud cloud;
        for (int i = 0; i < 400; i++)
            cloud.positions.emplace_back(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const double gap = 0.12;
        std::vector<size_t> label(cloud.size());
        for (size_t i = 0; i < label.size(); i++)
            label[i] = i;
        for (size_t i = 0; i < label.size(); i++)
            for (size_t k = 0; k < i; k++)
                if (glm::distance(DVec3(cloud.positions[i]), DVec3(cloud.positions[k])) <= gap &&
                    label[i] != label[k]) {
                    const size_t from = label[i], to = label[k];
                    std::replace(label.begin(), label.end(), from, to);
                }
        std::set<std::set<uint32_t>> wanted, given;
        for (size_t i = 0; i < label.size(); i++) {
            std::set<uint32_t> cluster;
            for (uint32_t k = 0; k < label.size(); k++)
                if (label[k] == label[i]) cluster.insert(k);
            wanted.insert(cluster);
        }
        for (const UnexplainedCluster& c :
             find_unexplained(tree, cloud, measure_fidelity(tree, cloud), {}, {gap, 1}))
            given.insert({c.points.begin(), c.points.end()});
        EXPECT_EQ(given, wanted);
    }
}

TEST(Unexplained, BadInputIsASentence) {
    const Scene s = scene();
    const Fidelity fidelity = measure_fidelity(s.tree, s.cloud);
    EXPECT_THROW(find_unexplained(s.tree, PointCloud(), fidelity), Error);
    EXPECT_THROW(find_unexplained(s.tree, s.cloud, fidelity, {1, 0}), Error);
    EXPECT_THROW(find_unexplained(s.tree, s.cloud, fidelity, {}, {NAN, 12}), Error);
    EXPECT_THROW(find_doubtful(test::random_tree(1, 300, 5.0), fidelity), Error);
}

const DoubtfulBranch* find(const std::vector<DoubtfulBranch>& all, NodeId node) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const DoubtfulBranch& d) { return d.node == node; });
    return found == all.end() ? nullptr : &*found;
}

TEST(Doubtful, ASupportedTreeHasNone) {
    const Scene s = scene();
    EXPECT_TRUE(find_doubtful(s.tree, measure_fidelity(s.tree, s.cloud)).empty());
}

TEST(Doubtful, TellsWhatSpeaksAgainstEachBranch) {
    Scene s = scene();
    // No points at all; across a gap; back down along the stem; thicker than the branch it grows from.
    const NodeId bare = s.tree.add_child(s.middle, DVec3(-0.9, 1.4, 0.0), 0.02);
    const NodeId far = s.tree.add_child(s.middle, DVec3(0.0, 1.2, 0.6), 0.03, kGuessFlag);
    s.tree.add_child(far, DVec3(0.0, 1.3, 0.9), 0.03);
    add_tube(DVec3(0.0, 1.2, 0.6), DVec3(0.0, 1.3, 0.9), 0.03, s.cloud);
    const NodeId back = s.tree.add_child(s.tree.node(s.top).parent, DVec3(0.0, 0.7, 0.35), 0.02);
    add_tube(DVec3(0.0, 1.9, 0.0), DVec3(0.0, 0.7, 0.35), 0.02, s.cloud);
    const NodeId on = s.tree.add_child(s.branch, DVec3(1.0, 1.375, 0.0), 0.03);
    s.tree.add_child(on, DVec3(1.8, 1.675, 0.0), 0.03);
    const NodeId thick = s.tree.add_child(s.branch, DVec3(0.8, 2.0, 0.0), 0.09);
    add_tube(DVec3(0.8, 1.3, 0.0), DVec3(0.8, 2.0, 0.0), 0.09, s.cloud);
    const std::vector<DoubtfulBranch> found = find_doubtful(s.tree, measure_fidelity(s.tree, s.cloud));
    ASSERT_TRUE(find(found, bare));
    EXPECT_EQ(find(found, bare)->reasons, kFewPoints);
    EXPECT_EQ(find(found, bare)->points, 0u);
    EXPECT_EQ(find(found, bare)->doubt, 1.0);
    ASSERT_TRUE(find(found, far));
    EXPECT_TRUE(find(found, far)->reasons & kLongBridge);
    EXPECT_NEAR(find(found, far)->bridged, std::hypot(0.2, 0.6), 1e-9);
    ASSERT_TRUE(find(found, back));
    EXPECT_EQ(find(found, back)->reasons, kImprobableAngle);
    EXPECT_NEAR(find(found, back)->angle, 163.7, 0.2);
    // The thick one goes on as the branch, so the thin one is judged instead: it has no points.
    EXPECT_FALSE(find(found, thick));
    ASSERT_TRUE(find(found, on));
    EXPECT_EQ(find(found, on)->reasons, kFewPoints);
    EXPECT_FALSE(find(found, s.branch));
    for (size_t i = 1; i < found.size(); i++)
        EXPECT_GE(found[i - 1].doubt * found[i - 1].length, found[i].doubt * found[i].length);
    EXPECT_EQ(doubt_text(kFewPoints | kLongBridge), "few points, a long bridge");
}

}  // namespace
}  // namespace treerec
