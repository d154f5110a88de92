#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>

#include "geometry/parallel.h"
#include "skeleton/skeleton.h"
#include "skeleton_test_clouds.h"
#include "tree/branches.h"

namespace treerec {
namespace {

using test::add_bend;
using test::add_cone;

// The tree's nodes in the cloud's own coordinates.
std::vector<DVec3> nodes_in_cloud(const Tree& tree, const PointCloud& cloud) {
    std::vector<DVec3> positions;
    for (NodeId id : tree.depth_first())
        positions.push_back(cloud.frame.to_tree(tree.frame().to_scan(tree.node(id).position)));
    return positions;
}

double distance_to_segment(const DVec3& p, const DVec3& a, const DVec3& b) {
    const double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return glm::distance(p, a + t * (b - a));
}

double distance_to_line(const DVec3& p, const std::vector<DVec3>& line) {
    double best = 1e30;
    for (size_t i = 0; i + 1 < line.size(); i++)
        best = std::min(best, distance_to_segment(p, line[i], line[i + 1]));
    return best;
}

double distance_to_tree(const DVec3& p, const Tree& tree, const PointCloud& cloud) {
    double best = 1e30;
    for (NodeId id : tree.depth_first()) {
        if (id == tree.root()) continue;
        const DVec3 a = cloud.frame.to_tree(tree.frame().to_scan(tree.node(tree.node(id).parent).position));
        const DVec3 b = cloud.frame.to_tree(tree.frame().to_scan(tree.node(id).position));
        best = std::min(best, a == b ? glm::distance(p, a) : distance_to_segment(p, a, b));
    }
    return best;
}

size_t tips(const Tree& tree) {
    return tree.nodes_of_kind(NodeKind::kLeaf).size();
}

// Everything that holds for every tree.
void expect_sane(const SkeletonResult& result) {
    EXPECT_EQ(result.tree.check(), std::nullopt);
    EXPECT_EQ(result.raw.check(), std::nullopt);
    ASSERT_FALSE(result.tree.empty());
    EXPECT_LT(glm::length(result.tree.node(result.tree.root()).position), 1e-9);
    for (NodeId id : result.tree.depth_first()) {
        const Node& node = result.tree.node(id);
        if (id == result.tree.root()) continue;
        EXPECT_LE(node.radius, result.tree.node(node.parent).radius * (1.0 + 1e-9));
    }
}

bool same_bytes(const Tree& a, const Tree& b) {
    const std::vector<NodeId> ids = a.depth_first();
    if (ids != b.depth_first()) return false;
    for (NodeId id : ids) {
        const Node& m = a.node(id);
        const Node& n = b.node(id);
        if (std::memcmp(&m.position, &n.position, sizeof m.position) != 0 || m.radius != n.radius ||
            m.parent != n.parent || m.flags != n.flags)
            return false;
    }
    return a.frame() == b.frame();
}

PointCloud forked_cloud(uint64_t seed, double noise) {
    Random random(seed);
    PointCloud cloud;
    const DVec3 base = {random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
    const DVec3 fork = base + DVec3(0.1, 2.0, 0.05);
    add_cone(cloud, random, base, fork, 0.10, 0.09, 0.012, noise);
    add_cone(cloud, random, fork, fork + DVec3(0.7, 1.4, 0.0), 0.06, 0.02, 0.012, noise);
    add_cone(cloud, random, fork, fork + DVec3(-0.6, 1.5, 0.2), 0.06, 0.02, 0.012, noise);
    return cloud;
}

struct Pole {
    double radius;
    double noise;
    DVec3 top;
};

class PoleTest : public testing::TestWithParam<Pole> {};

TEST_P(PoleTest, HasItsAxisAndRadius) {
    const Pole& pole = GetParam();
    Random random(7);
    PointCloud cloud;
    const std::vector<DVec3> line = {DVec3(0.0), pole.top};
    add_cone(cloud, random, line[0], line[1], pole.radius, pole.radius, 0.25 * pole.radius, pole.noise);
    const SkeletonResult result = skeletonize(cloud, {});
    expect_sane(result);
    EXPECT_EQ(tips(result.tree), 1u);
    for (const DVec3& p : nodes_in_cloud(result.tree, cloud))
        EXPECT_LT(distance_to_line(p, line), 0.15 * pole.radius + pole.noise);
    EXPECT_NEAR(glm::distance(nodes_in_cloud(result.tree, cloud).front(), line[0]), 0.0, 0.5 * pole.radius);
    EXPECT_NEAR(glm::distance(nodes_in_cloud(result.tree, cloud).back(), line[1]), 0.0, pole.radius);
    size_t measured = 0;
    for (NodeId id : result.tree.depth_first()) {
        const Node& node = result.tree.node(id);
        measured += node.is_measured() ? 1 : 0;
        EXPECT_NEAR(node.radius, pole.radius, 0.05 * pole.radius);
    }
    EXPECT_GT(measured, result.tree.size() / 2);
}

INSTANTIATE_TEST_SUITE_P(All, PoleTest,
                         testing::Values(Pole{0.1, 0.0, {0, 3, 0}}, Pole{0.1, 0.004, {0, 3, 0}},
                                         Pole{0.3, 0.01, {0, 9, 0}}, Pole{0.03, 0.001, {0, 1.5, 0}},
                                         Pole{0.1, 0.003, {1.5, 3, 0.5}}));

TEST(Skeletonize, FindsTheForkOfAY) {
    for (uint64_t seed = 1; seed <= 4; seed++) {
        const PointCloud cloud = forked_cloud(seed, 0.002);
        const SkeletonResult result = skeletonize(cloud, {});
        expect_sane(result);
        EXPECT_EQ(tips(result.tree), 2u) << seed;
        EXPECT_EQ(result.tree.nodes_of_kind(NodeKind::kBranch).size(), 1u) << seed;
    }
}

TEST(Skeletonize, FollowsABentBranch) {
    Random random(3);
    PointCloud cloud;
    std::vector<DVec3> line;
    for (int i = 0; i <= 30; i++) {
        const double t = i / 30.0;
        line.emplace_back(std::sin(2.5 * t), 2.5 * t, 0.3 * std::cos(3.0 * t));
    }
    add_bend(cloud, random, line, 0.05, 0.02, 0.008, 0.001);
    const SkeletonResult result = skeletonize(cloud, {});
    expect_sane(result);
    EXPECT_EQ(tips(result.tree), 1u);
    for (const DVec3& p : nodes_in_cloud(result.tree, cloud))
        EXPECT_LT(distance_to_line(p, line), 0.015);
    for (const DVec3& p : line)
        EXPECT_LT(distance_to_tree(p, result.tree, cloud), 0.03);
}

TEST(Skeletonize, BridgesAGapAndSaysSo) {
    Random random(5);
    PointCloud cloud;
    add_cone(cloud, random, {0, 0, 0}, {0, 1.5, 0}, 0.1, 0.1, 0.015, 0.002);
    add_cone(cloud, random, {0, 2.3, 0}, {0, 4, 0}, 0.1, 0.1, 0.015, 0.002);
    const SkeletonResult result = skeletonize(cloud, {});
    expect_sane(result);
    EXPECT_EQ(tips(result.tree), 1u);
    size_t guesses = 0;
    for (NodeId id : result.tree.depth_first())
        if (result.tree.node(id).is_guess()) {
            guesses++;
            const double from = result.tree.node(result.tree.node(id).parent).position.y;
            const double to = result.tree.node(id).position.y;
            EXPECT_GT(to - from, 0.7);
        }
    EXPECT_EQ(guesses, 1u);
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_NE(result.warnings[0].find("a gap of up to 0."), std::string::npos) << result.warnings[0];
    EXPECT_LT(distance_to_tree({0, 1.9, 0}, result.tree, cloud), 0.03);
}

TEST(Skeletonize, TapersOverAGap) {
    Random random(5);
    PointCloud cloud;
    add_cone(cloud, random, {0, 0, 0}, {0, 1.5, 0}, 0.12, 0.11, 0.015, 0.002);
    add_cone(cloud, random, {0, 2.4, 0}, {0, 4, 0}, 0.07, 0.06, 0.015, 0.002);
    const SkeletonResult result = skeletonize(cloud, {});
    expect_sane(result);
    size_t looked = 0;
    for (NodeId id : result.tree.depth_first()) {
        const Node& node = result.tree.node(id);
        if (!node.is_guess() || node.position.y > 2.2) continue;
        looked++;
        EXPECT_NEAR(node.radius, 0.11 - 0.04 * (node.position.y - 1.5) / 0.9, 0.012);
    }
    EXPECT_GE(looked, 2u);
}

// A branch whose base the scan has missed, and above it a bough that is nearer than the stem it grew from.
TEST(Skeletonize, BridgesAGapInABranchsOwnDirection) {
    Random random(12);
    PointCloud cloud;
    const DVec3 along = glm::normalize(DVec3(1.0, 0.7, 0.0));
    const DVec3 fork(0.0, 1.5, 0.0);
    add_cone(cloud, random, {0, 0, 0}, {0, 4, 0}, 0.1, 0.05, 0.015, 0.002);
    add_cone(cloud, random, fork + 0.6 * along, fork + 2.2 * along, 0.03, 0.015, 0.008, 0.001);
    add_cone(cloud, random, {0, 2.9, 0}, {1.4, 2.83, 0}, 0.04, 0.03, 0.01, 0.001);
    const SkeletonResult result = skeletonize(cloud, {});
    expect_sane(result);
    EXPECT_EQ(tips(result.tree), 3u);
    // The gap is bridged, and known to be a guess.
    EXPECT_LT(distance_to_tree(fork + 0.35 * along, result.tree, cloud), 0.06);
    size_t guesses = 0;
    for (NodeId id : result.tree.depth_first())
        guesses += result.tree.node(id).is_guess() ? 1 : 0;
    EXPECT_EQ(guesses, 1u);
}

TEST(Skeletonize, GivesSeveralStemsOneRoot) {
    Random random(6);
    PointCloud cloud;
    add_cone(cloud, random, {0.15, 0, 0}, {0.6, 3, 0}, 0.06, 0.04, 0.012, 0.001);
    add_cone(cloud, random, {-0.15, 0, 0}, {-0.6, 3, 0.2}, 0.06, 0.04, 0.012, 0.001);
    const SkeletonResult result = skeletonize(cloud, {});
    expect_sane(result);
    // Both stems come from the root's neighbourhood and run to their own tops.
    size_t tops = 0;
    for (NodeId tip : result.tree.nodes_of_kind(NodeKind::kLeaf))
        tops += result.tree.node(tip).position.y > 2.9 ? 1 : 0;
    EXPECT_EQ(tops, 2u);
    EXPECT_EQ(tips(result.tree), 2u);
    EXPECT_GE(result.tree.node(result.tree.root()).child_count, 2);
}

TEST(Skeletonize, RootsALyingBranchAtItsThickEnd) {
    Random random(8);
    for (double side : {1.0, -1.0}) {
        PointCloud cloud;
        add_cone(cloud, random, {0, 0, 0}, {2 * side, 0.1, 0.3}, 0.05, 0.01, 0.008, 0.001);
        add_cone(cloud, random, {1 * side, 0.05, 0.15}, {1.5 * side, 0.3, 0.6}, 0.015, 0.008, 0.008, 0.001);
        const SkeletonResult result = skeletonize(cloud, {});
        expect_sane(result);
        EXPECT_LT(glm::length(nodes_in_cloud(result.tree, cloud).front()), 0.08);
        EXPECT_EQ(tips(result.tree), 2u);
    }
}

TEST(Skeletonize, IgnoresStrayPoints) {
    PointCloud cloud = forked_cloud(2, 0.002);
    const PointCloud clean = cloud;
    cloud.positions.emplace_back(8.0f, 2.0f, 5.0f);
    cloud.positions.emplace_back(-4.0f, 6.0f, -9.0f);
    cloud.positions.push_back(clean.positions.front() - Vec3(0.0f, 0.9f, 0.3f));
    const SkeletonResult result = skeletonize(cloud, {});
    expect_sane(result);
    EXPECT_EQ(tips(result.tree), 2u);
    EXPECT_LT(glm::distance(nodes_in_cloud(result.tree, cloud).front(),
                            nodes_in_cloud(skeletonize(clean, {}).tree, clean).front()),
              0.02);
}

TEST(Skeletonize, GivesTheSameBytesForAnyOrderRepetitionAndThreadCount) {
    PointCloud cloud = forked_cloud(11, 0.003);
    set_thread_count(1);
    const SkeletonResult first = skeletonize(cloud, {});
    Random random(99);
    for (size_t i = cloud.positions.size() - 1; i > 0; i--)
        std::swap(cloud.positions[i], cloud.positions[random.below(static_cast<uint32_t>(i + 1))]);
    for (size_t i = 0; i < 500; i++)
        cloud.positions.push_back(cloud.positions[random.below(static_cast<uint32_t>(cloud.size()))]);
    for (int threads : {1, 2, 5}) {
        set_thread_count(threads);
        const SkeletonResult again = skeletonize(cloud, {});
        EXPECT_TRUE(same_bytes(first.tree, again.tree)) << threads;
        EXPECT_TRUE(same_bytes(first.raw, again.raw)) << threads;
    }
    set_thread_count(0);
}

TEST(Skeletonize, MapsBackOntoTheScan) {
    PointCloud cloud = forked_cloud(4, 0.0);
    cloud.frame.origin = {431250.25, 5411900.5, 123.0};
    cloud.frame.up = UpAxis::kZ;
    cloud.frame.metres_per_unit = 0.001;
    const SkeletonResult result = skeletonize(cloud, {});
    EXPECT_EQ(result.tree.frame().up, UpAxis::kZ);
    for (NodeId tip : result.tree.nodes_of_kind(NodeKind::kLeaf)) {
        const DVec3 p = cloud.frame.to_tree(result.tree.frame().to_scan(result.tree.node(tip).position));
        double nearest = 1e30;
        for (const Vec3& q : cloud.positions)
            nearest = std::min(nearest, glm::distance(p, DVec3(q)));
        EXPECT_LT(nearest, 0.05);
    }
}

TEST(Skeletonize, RefusesWhatCannotBeATree) {
    Random random(1);
    PointCloud cloud;
    for (int count = 0; count < 10; count++) {
        EXPECT_THROW(skeletonize(cloud, {}), Error) << count;
        cloud.positions.emplace_back(random.uniform(), random.uniform(), random.uniform());
    }
    PointCloud repeated;
    repeated.positions.assign(1000, Vec3(1.0f, 2.0f, 3.0f));
    EXPECT_THROW(skeletonize(repeated, {}), Error);
    PointCloud line;
    PointCloud plane;
    for (int i = 0; i < 200; i++) {
        line.positions.emplace_back(0.0f, 0.01f * static_cast<float>(i), 0.0f);
        plane.positions.emplace_back(static_cast<float>(random.uniform()),
                                     static_cast<float>(random.uniform()), 0.0f);
    }
    EXPECT_THROW(skeletonize(line, {}), Error);
    EXPECT_THROW(skeletonize(plane, {}), Error);
    PointCloud nan;
    nan.positions.assign(100, Vec3(std::nanf(""), 0.0f, 0.0f));
    EXPECT_THROW(skeletonize(nan, {}), Error);
}

TEST(Skeletonize, SurvivesAnyCloud) {
    for (uint64_t seed = 1; seed <= 30; seed++) {
        Random random(seed);
        PointCloud cloud;
        const int count = 10 + static_cast<int>(random.below(400));
        const double size = std::pow(10.0, random.uniform(-3.0, 6.0));
        const DVec3 stretch = {random.uniform(0.01, 1.0), random.uniform(0.01, 1.0),
                               random.uniform(0.01, 1.0)};
        for (int i = 0; i < count; i++)
            cloud.positions.emplace_back(size * stretch *
                                         DVec3(random.uniform(), random.uniform(), random.uniform()));
        if (seed % 5 == 0) cloud.positions.emplace_back(1e6f, -1e6f, 1e6f);
        try {
            const SkeletonResult result = skeletonize(cloud, {});
            expect_sane(result);
        } catch (const Error& error) {
            EXPECT_GT(std::strlen(error.what()), 20u);
        }
    }
}

class Canceller final : public Progress {
  public:
    explicit Canceller(int after) : left_(after) {}
    void update(double fraction, const char*) override {
        EXPECT_GE(fraction, last_);
        last_ = fraction;
    }
    bool cancelled() const override { return --left_ < 0; }

  private:
    mutable std::atomic<int> left_;
    double last_ = 0.0;
};

TEST(Skeletonize, StopsWhenAsked) {
    const PointCloud cloud = forked_cloud(1, 0.002);
    Canceller patient(1 << 30);
    EXPECT_NO_THROW(skeletonize(cloud, {}, &patient));
    for (int after : {0, 3, 8, 15}) {
        Canceller canceller(after);
        EXPECT_THROW(skeletonize(cloud, {}, &canceller), Cancelled) << after;
    }
}

// Thinning to an even density leaves too large a part of the points that noise put beside the wood.
TEST(Skeletonize, NoiseInADenseScanDoesNotMakeWoodThicker) {
    Random random(7);
    PointCloud cloud;
    add_cone(cloud, random, DVec3(0.0), DVec3(0.0, 2.0, 0.0), 0.05, 0.05, 0.003, 0.01);
    SkeletonOptions options;
    options.spacing = 0.016;
    const SkeletonResult result = skeletonize(cloud, options);
    std::vector<double> radii;
    for (NodeId id : result.tree.depth_first()) {
        const Node& node = result.tree.node(id);
        if (node.is_trunk() && node.position.y > 0.3 && node.position.y < 1.7) radii.push_back(node.radius);
    }
    ASSERT_FALSE(radii.empty());
    std::sort(radii.begin(), radii.end());
    EXPECT_NEAR(radii[radii.size() / 2], 0.05, 0.0015);
}

}  // namespace
}  // namespace treerec
