// Skeletons of clouds whose maker knows how thick the wood is (skeleton/cylinders/known_radii.h).
#include "skeleton/cylinders/known_radii.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/parallel.h"
#include "geometry/quantile.h"
#include "skeleton/skeleton.h"
#include "skeleton_test_clouds.h"

namespace treerec {
namespace {

using test::add_cone;

// The points that were added last are on wood of this radius.
void know(PointCloud& cloud, double radius) {
    cloud.radii.resize(cloud.size(), static_cast<float>(radius));
}

void add_stem(PointCloud& cloud, Random& random, double radius, double height, double spacing) {
    add_cone(cloud, random, {0, 0, 0}, {0, height, 0}, radius, 0.6 * radius, spacing, 0.002);
}

DVec3 in_cloud(const Tree& tree, const PointCloud& cloud, NodeId id) {
    return cloud.frame.to_tree(tree.frame().to_scan(tree.node(id).position));
}

// The median radius of the nodes whose place in the cloud is asked for.
template <typename Where>
double radius_where(const Tree& tree, const PointCloud& cloud, const Where& where) {
    std::vector<float> radii;
    for (const NodeId id : tree.depth_first())
        if (where(in_cloud(tree, cloud, id))) radii.push_back(static_cast<float>(tree.node(id).radius));
    EXPECT_GE(radii.size(), 2U);
    return radii.empty() ? 0.0 : static_cast<double>(quantile(radii, 0.5));
}

// As clouds of photos are thinned, which say how fine they are.
SkeletonOptions thinned_to(double spacing) {
    SkeletonOptions options;
    options.spacing = spacing;
    return options;
}

constexpr double kSpacing = 0.015;

std::vector<SkeletonOptions> both_methods() {
    SkeletonOptions flood = thinned_to(kSpacing);
    flood.method = SkeletonMethod::kFlood;
    return {thinned_to(kSpacing), flood};
}

constexpr double kTwig = 0.004;

// Points here and there along the way from a to b, off it by `spread` (standard deviation, metres).
void scatter_along(PointCloud& cloud, Random& random, const DVec3& a, const DVec3& b, int count,
                   double spread) {
    for (int i = 0; i < count; i++) {
        const double along = random.uniform();
        cloud.positions.emplace_back(glm::mix(a, b, along) + spread * random.normal() * random.direction());
    }
}

// A stem with a twig whose points scatter by three times its radius.
PointCloud scattered_twig(uint64_t seed) {
    Random random(seed);
    PointCloud cloud;
    add_stem(cloud, random, 0.1, 3.0, 0.012);
    know(cloud, 0.0);
    scatter_along(cloud, random, {0.08, 1.5, 0.0}, {1.28, 1.9, 0.0}, 1500, 3.0 * kTwig);
    know(cloud, kTwig);
    return cloud;
}

TEST(KnownRadii, AScatteredTwigIsAsThinAsItIsKnownToBe) {
    for (const SkeletonOptions& options : both_methods())
        for (const uint64_t seed : {1, 2, 3}) {
            PointCloud cloud = scattered_twig(seed);
            const auto on_twig = [](const DVec3& p) { return p.x > 0.3 && p.x < 1.1; };
            const Tree told = skeletonize(cloud, options).tree;
            EXPECT_NEAR(radius_where(told, cloud, on_twig), kTwig, 0.1 * kTwig) << seed;
            cloud.radii.clear();
            const Tree untold = skeletonize(cloud, options).tree;
            EXPECT_GT(radius_where(untold, cloud, on_twig), 1.5 * kTwig) << "there was nothing to tell";
        }
}

// Most points of a furrowed trunk are of lines that a photo shows as thin wood.
TEST(KnownRadii, ATrunkWithFurrowsKeepsItsOwn) {
    for (const SkeletonOptions& options : both_methods()) {
        Random random(5);
        PointCloud cloud;
        add_cone(cloud, random, {0, 0, 0}, {0, 3, 0}, 0.15, 0.14, 0.02, 0.002);
        know(cloud, 0.0);
        for (int furrow = 0; furrow < 24; furrow++)
            for (int i = 0; i < 1200; i++) {
                const double angle = 2.0 * kPi * furrow / 24.0, up = 3.0 * i / 1200.0;
                // A furrow is deeper than the bark beside it.
                const double radius = 0.145 - 0.01 * up / 3.0 + 0.001 * random.normal();
                cloud.positions.emplace_back(radius * std::cos(angle), up, radius * std::sin(angle));
            }
        know(cloud, 0.005);
        const Tree tree = skeletonize(cloud, options).tree;
        EXPECT_NEAR(radius_where(tree, cloud, [](const DVec3& p) { return p.y > 0.5 && p.y < 2.5; }), 0.145,
                    0.012);
    }
}

// A few points in the fork of two limbs, which a photo shows as one, are as wide as both.
TEST(KnownRadii, StrayPointsBesideAStemMakeNoStump) {
    for (const SkeletonOptions& options : both_methods())
        for (const uint64_t seed : {1, 2, 3}) {
            Random random(seed);
            PointCloud cloud;
            add_stem(cloud, random, 0.1, 3.0, 0.012);
            know(cloud, 0.1);
            scatter_along(cloud, random, {0.1, 1.5, 0.0}, {0.45, 1.8, 0.0}, 60, 0.006);
            know(cloud, 0.1);
            const Tree tree = skeletonize(cloud, options).tree;
            double thickest = 0.0;
            for (const NodeId id : tree.depth_first())
                if (in_cloud(tree, cloud, id).x > 0.25) thickest = std::max(thickest, tree.node(id).radius);
            EXPECT_LT(thickest, 0.015) << seed;
        }
}

constexpr double kBranch = 0.04;

// A stem; a branch that is seen from three of its radii beside the stem's bark on; and a twig of the stem
// that comes down on the branch farther out.
PointCloud branch_without_base(uint64_t seed) {
    Random random(seed);
    PointCloud cloud;
    add_cone(cloud, random, {0, 0, 0}, {0, 3.4, 0}, 0.12, 0.1, 0.012, 0.001);
    know(cloud, 0.11);
    const DVec3 base(0.12 + 3.0 * kBranch, 1.5, 0.0), end(1.8, 1.9, 0.0);
    add_cone(cloud, random, base, end, kBranch, kBranch, 0.01, 0.001);
    know(cloud, kBranch);
    add_cone(cloud, random, {0.1, 2.3, 0.0}, glm::mix(base, end, 0.55) + DVec3(0.0, kBranch, 0.0), 0.005,
             0.005, 0.004, 0.0005);
    know(cloud, 0.005);
    return cloud;
}

// The ways from the branch's middle to the stem, and whether they pass by the twig.
TEST(KnownRadii, ABranchHangsOnTheStemAndNotOnATwigThatTouchesIt) {
    for (const uint64_t seed : {1, 2, 3, 4}) {
        const PointCloud cloud = branch_without_base(seed);
        const Tree tree = skeletonize(cloud, thinned_to(kSpacing)).tree;
        const DVec3 begin(0.32, 1.53, 0.0);
        NodeId at = tree.root();
        for (const NodeId id : tree.depth_first())
            if (glm::distance(in_cloud(tree, cloud, id), begin) <
                glm::distance(in_cloud(tree, cloud, at), begin))
                at = id;
        ASSERT_LT(glm::distance(in_cloud(tree, cloud, at), begin), 0.15) << seed;
        // Down the branch's own way into the stem, without a climb to the twig.
        double highest = 0.0, farthest = 0.0;
        for (NodeId id = at; id != kNoNode; id = tree.node(id).parent) {
            const DVec3 p = in_cloud(tree, cloud, id);
            highest = std::max(highest, p.y);
            farthest = std::max(farthest, std::hypot(p.x, p.z));
        }
        EXPECT_LT(highest, 1.75) << seed;
        EXPECT_LT(farthest, 0.5) << seed;
        const auto on_branch = [](const DVec3& p) {
            return p.x > 0.4 && p.x < 1.7 && p.y < 2.0 - 0.02 && p.y < 1.5 + 0.3 * p.x;
        };
        EXPECT_NEAR(radius_where(tree, cloud, on_branch), kBranch, 0.1 * kBranch) << seed;
    }
}

bool same_tree(const Tree& a, const Tree& b) {
    const std::vector<NodeId> ids = a.depth_first();
    if (ids != b.depth_first() || !(a.frame() == b.frame())) return false;
    return std::all_of(ids.begin(), ids.end(), [&](NodeId id) {
        const Node &m = a.node(id), &n = b.node(id);
        return m.position == n.position && m.radius == n.radius && m.parent == n.parent && m.flags == n.flags;
    });
}

TEST(KnownRadii, WhereNoneIsKnownNothingChanges) {
    for (const SkeletonOptions& options : both_methods()) {
        PointCloud cloud = scattered_twig(7);
        cloud.radii.clear();
        const Tree without = skeletonize(cloud, options).tree;
        for (const float none :
             {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
            cloud.radii.assign(cloud.size(), none);
            EXPECT_TRUE(same_tree(skeletonize(cloud, options).tree, without)) << none;
        }
    }
}

TEST(KnownRadii, OrderRepetitionThreadsAndPlacesThatAreNoneDoNotMatter) {
    PointCloud cloud = branch_without_base(9);
    set_thread_count(1);
    const Tree first = skeletonize(cloud, thinned_to(kSpacing)).tree;
    Random random(99);
    for (size_t i = cloud.size() - 1; i > 0; i--) {
        const size_t other = random.below(static_cast<uint32_t>(i + 1));
        std::swap(cloud.positions[i], cloud.positions[other]);
        std::swap(cloud.radii[i], cloud.radii[other]);
    }
    // Copies of which nothing is known, and points without a place.
    for (int i = 0; i < 500; i++) {
        cloud.positions.push_back(cloud.positions[random.below(static_cast<uint32_t>(cloud.size()))]);
        cloud.radii.push_back(0.0F);
    }
    cloud.positions.emplace_back(std::nanf(""), 1.0F, 0.0F);
    cloud.radii.push_back(0.05F);
    // The copies come first.
    std::reverse(cloud.positions.begin(), cloud.positions.end());
    std::reverse(cloud.radii.begin(), cloud.radii.end());
    for (const int threads : {1, 4}) {
        set_thread_count(threads);
        EXPECT_TRUE(same_tree(skeletonize(cloud, thinned_to(kSpacing)).tree, first)) << threads;
    }
    set_thread_count(0);
}

// Small trees are enlarged for the skeleton, and what they know with them.
TEST(KnownRadii, AreThoseOfASmallTreeToo) {
    PointCloud cloud = scattered_twig(4);
    for (Vec3& p : cloud.positions)
        p *= 0.1F;
    for (float& radius : cloud.radii)
        radius *= 0.1F;
    const Tree tree = skeletonize(cloud, thinned_to(0.1 * kSpacing)).tree;
    EXPECT_NEAR(radius_where(tree, cloud, [](const DVec3& p) { return p.x > 0.03 && p.x < 0.11; }),
                0.1 * kTwig, 0.01 * kTwig);
}

}  // namespace
}  // namespace treerec
