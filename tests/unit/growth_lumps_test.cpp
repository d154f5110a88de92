// Lumps and dents that a scan shows become lines of a recipe (src/growth/lumps.h), and bark grown by them
// comes nearer to the scan.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "geometry/random.h"
#include "growth/bark_fit.h"
#include "growth/grow_bark.h"
#include "growth/lumps.h"
#include "growth_trees.h"
#include "synth/scan.h"
#include "tree/branches.h"

using namespace treerec;

namespace {

constexpr int kSectors = 12;
constexpr size_t kPieces = 2 * kSectors;

// A Gaussian bump, or a dent, on a trunk.
struct Bump {
    double height = 0.0;   // metres up
    double angle = 0.0;    // radians about the axis, from +X by way of -Z
    double sigma = 0.0;    // metres
    double rise = 0.0;     // metres, outwards
    double wood = 0.0;     // metres: the trunk's radius there
    std::set<int> seen{};  // pieces of a disc of 1.5 sigma that have points, of kPieces

    bool visible() const { return seen.size() >= 3 * kPieces / 4; }
    // R, of which its centre must be within a quarter.
    double radius() const { return 2.0 * sigma; }
};

// Of the trunk, by linear interpolation between its nodes.
struct TrunkAxis {
    std::vector<DVec3> positions;
    std::vector<double> radii;

    explicit TrunkAxis(const Tree& tree) {
        const BranchList list = list_branches(tree);
        for (const NodeId node : list.nodes_of(list.branches.front())) {
            positions.push_back(tree.node(node).position);
            radii.push_back(tree.node(node).radius);
        }
    }
    // The nearest place of the axis: `radius` gets the wood's.
    DVec3 nearest(const DVec3& p, double& radius, double& along) const {
        DVec3 best(0.0);
        double least = 1e300, gone = 0.0;
        for (size_t i = 1; i < positions.size(); i++) {
            const DVec3 way = positions[i] - positions[i - 1];
            const double length = glm::length(way);
            const double t = std::clamp(glm::dot(p - positions[i - 1], way) / (length * length), 0.0, 1.0);
            const DVec3 at = positions[i - 1] + t * way;
            if (glm::distance(p, at) < least) {
                least = glm::distance(p, at);
                best = at;
                radius = glm::mix(radii[i - 1], radii[i], t);
                along = gone + t * length;
            }
            gone += length;
        }
        return best;
    }
};

// Pushes the trunk's points outwards.
void push(PointCloud& cloud, const std::vector<uint8_t>& of_trunk, const TrunkAxis& axis,
          std::vector<Bump>& bumps) {
    for (size_t i = 0; i < cloud.size(); i++) {
        if (!of_trunk[i]) continue;
        const DVec3 p(cloud.positions[i]);
        double radius = 0.0, along = 0.0;
        const DVec3 off = p - axis.nearest(p, radius, along);
        const double angle = std::atan2(-off.z, off.x);
        double rise = 0.0;
        for (Bump& bump : bumps) {
            const double across = bump.wood * std::remainder(angle - bump.angle, 2.0 * kPi);
            const double square = (along - bump.height) * (along - bump.height) + across * across;
            rise += bump.rise * std::exp(-0.5 * square / (bump.sigma * bump.sigma));
            const double far = std::sqrt(square) / (0.75 * bump.sigma);
            if (far < 2.0) {
                const double turn = std::atan2(across, along - bump.height) / (2.0 * kPi) + 0.5;
                bump.seen.insert(std::min(static_cast<int>(turn * kSectors), kSectors - 1) +
                                 kSectors * static_cast<int>(far));
            }
        }
        cloud.positions[i] += Vec3(normalized_or(off, DVec3(0.0)) * rise);
    }
}

// Points on an upright cylinder of test::cylinder(), seen from `seen` of a round (1: all) about +X.
PointCloud cylinder_scan(double radius, double height, double noise, double seen, size_t count,
                         uint64_t seed) {
    Random random(seed);
    PointCloud cloud;
    for (size_t i = 0; i < count; i++) {
        const double angle = kPi * seen * random.uniform(-1.0, 1.0);
        const double r = radius + noise * random.normal();
        cloud.positions.push_back(Vec3(r * std::cos(angle), height * random.uniform(), -r * std::sin(angle)));
    }
    return cloud;
}

// Apart from one another by more than their widths.
std::vector<Bump> bumps_at_random(Random& random, size_t count, double low, double high, double wood) {
    std::vector<Bump> bumps;
    for (int tries = 0; tries < 1000 && bumps.size() < count; tries++) {
        Bump bump;
        bump.wood = wood;
        bump.height = random.uniform(low, high);
        bump.angle = random.uniform(-kPi, kPi);
        bump.sigma = wood * random.uniform(0.3, 0.6);
        bump.rise = wood * random.uniform(0.16, 0.4);
        const bool free = std::none_of(bumps.begin(), bumps.end(), [&](const Bump& other) {
            const double across = wood * std::remainder(bump.angle - other.angle, 2.0 * kPi);
            return std::hypot(bump.height - other.height, across) < 2.0 * (bump.sigma + other.sigma);
        });
        if (free) bumps.push_back(bump);
    }
    return bumps;
}

struct Found {
    size_t bumps = 0, found = 0;     // recall
    size_t proposed = 0, right = 0;  // precision
};

// The height of a burl, over the radius of its wood.
double share_of(const GrowthFeature& burl) {
    return burl.growth * (1.0 - burl.from);
}

void compare(const std::vector<Bump>& bumps, const GrowthRecipe& recipe, const Tree& tree, Found& found) {
    std::set<size_t> matched;
    for (const GrowthFeature& burl : recipe.features) {
        if (burl.kind != GrowthFeature::Kind::kBurl || share_of(burl) < 0.15) continue;
        bool right = false;
        for (size_t i = 0; i < bumps.size() && burl.node == tree.root(); i++) {
            const double across =
                bumps[i].wood * std::remainder(burl.around / 180.0 * kPi - bumps[i].angle, 2.0 * kPi);
            if (std::hypot(burl.along - bumps[i].height, across) > 0.25 * bumps[i].radius()) continue;
            matched.insert(i);
            right = true;
        }
        found.proposed++;
        found.right += right ? 1 : 0;
    }
    for (size_t i = 0; i < bumps.size(); i++) {
        if (!bumps[i].visible()) continue;
        found.bumps++;
        found.found += matched.count(i);
    }
}

void expect_most(const Found& found) {
    ASSERT_GT(found.bumps, 0U);
    ASSERT_GT(found.proposed, 0U);
    EXPECT_GE(static_cast<double>(found.found), 0.8 * static_cast<double>(found.bumps));
    EXPECT_GE(static_cast<double>(found.right), 0.8 * static_cast<double>(found.proposed));
}

const char* kEdges = "edges longest=0.035";
const char* kCoarse = "edges longest=0.05";  // where bark is grown, to be quick

std::vector<uint8_t> all_of(const PointCloud& cloud) {
    return std::vector<uint8_t>(cloud.size(), 1);
}

}  // namespace

TEST(GrowthLumps, AreFoundOnCylinders) {
    Found whole, half;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        Random random(seed, 5);
        const double wood = random.uniform(0.12, 0.25);
        const Tree tree = test::cylinder(wood, 3.0);
        const TrunkAxis axis(tree);
        for (const double seen : {1.0, 0.6}) {
            PointCloud cloud = cylinder_scan(wood, 3.0, 0.004, seen, 40000, seed);
            std::vector<Bump> bumps = bumps_at_random(random, 5, 0.4, 2.6, wood);
            push(cloud, all_of(cloud), axis, bumps);
            const GrowthProposal proposal = propose_growth(tree, cloud, read_growth_recipe(tree, kEdges));
            EXPECT_TRUE(proposal.remarks.empty());
            const GrowthRecipe recipe = read_growth_recipe(tree, kEdges + ("\n" + proposal.recipe));
            compare(bumps, recipe, tree, seen < 1.0 ? half : whole);
            for (const GrowthFeature& feature : recipe.features)  // nothing where nothing is seen
                EXPECT_LT(std::abs(std::remainder(feature.around, 360.0)), 180.0 * seen + 25.0)
                    << proposal.recipe;
        }
    }
    expect_most(whole);
    expect_most(half);
}

TEST(GrowthLumps, NoneOnPlainTrunks) {
    for (uint64_t seed = 1; seed <= 3; seed++) {
        const Tree tree = test::cylinder(0.2, 3.0);
        const PointCloud cloud = cylinder_scan(0.2, 3.0, 0.008, 0.7, 5000, seed);
        const GrowthProposal proposal = propose_growth(tree, cloud, read_growth_recipe(tree, kEdges));
        EXPECT_EQ(proposal.recipe, "");
        EXPECT_EQ(proposal.burls + proposal.hollows, 0U);
    }
}

// A plausible tree, scanned from all sides or from two, with things in between.
TEST(GrowthLumps, AreFoundOnGrownTrees) {
    Found found;
    for (uint64_t seed = 1; seed <= 6; seed++) {
        GrowOptions grow;
        grow.seed = seed;
        const Tree tree = grow_tree(grow);
        VirtualScanOptions scanning;
        scanning.seed = seed;
        scanning.points = 250000;
        scanning.stations = seed % 2 == 0 ? 2 : 5;
        scanning.occlusion = 0.2;
        VirtualScan scan = scan_tree(tree, scanning);
        const TrunkAxis axis(tree);
        std::vector<uint8_t> of_trunk(scan.cloud.size());
        for (size_t i = 0; i < scan.cloud.size(); i++)
            of_trunk[i] = scan.origin[i] == kFromWood && tree.node(scan.node[i]).is_trunk();
        Random random(seed, 6);
        double wood = 0.0, along = 0.0;
        axis.nearest(axis.positions.front() + DVec3(0.0, 1.3, 0.0), wood, along);
        std::vector<Bump> bumps = bumps_at_random(random, 4, 0.5, 2.5, wood);
        push(scan.cloud, of_trunk, axis, bumps);
        const GrowthProposal proposal = propose_growth(tree, scan.cloud, read_growth_recipe(tree, kEdges));
        compare(bumps, read_growth_recipe(tree, kEdges + ("\n" + proposal.recipe)), tree, found);
    }
    expect_most(found);
}

TEST(GrowthLumps, GrownByThemBarkIsNearerToTheScan) {
    const double wood = 0.15;
    const Tree tree = test::cylinder(wood, 2.0);
    const TrunkAxis axis(tree);
    PointCloud cloud = cylinder_scan(wood, 2.0, 0.003, 1.0, 40000, 3);
    std::vector<Bump> bumps{
        {0.5, 0.5, 0.06, 0.05, wood}, {1.0, 2.5, 0.09, 0.04, wood}, {1.4, -1.2, 0.05, 0.03, wood}};
    push(cloud, all_of(cloud), axis, bumps);
    const GrowthRecipe plain = read_growth_recipe(tree, kCoarse);
    const GrowthProposal proposal = propose_growth(tree, cloud, plain);
    const GrowthRecipe recipe = read_growth_recipe(tree, plain.text + proposal.recipe);
    GrowBarkOptions options;
    options.check_every = 20;
    const GrownTree grown = grow_bark(tree, recipe, options);
    for (const GrowthStep& step : grown.checks)
        test::expect_sound(step);
    EXPECT_TRUE(grown.remarks.empty());
    const BarkFit fit = measure_bark_fit(tree, recipe, grown.bark, cloud);
    ASSERT_GT(fit.lumpy.points, 0U);
    EXPECT_LT(fit.lumpy.grown.mean, 0.75 * fit.lumpy.tubes.mean);
    EXPECT_EQ(fit.worse, 0U);
    EXPECT_LT(fit.radius_median, 0.02);
    EXPECT_LT(fit.radius_p95, 0.05);
    EXPECT_NEAR(fit.dbh_grown, fit.dbh_scan, 0.01 * fit.dbh_scan);
    // It is what they do.
    const BarkFit without = measure_bark_fit(tree, plain, grow_bark(tree, plain).bark, cloud);
    EXPECT_LT(fit.lumpy.grown.mean, 0.75 * without.lumpy.grown.mean);
}

TEST(GrowthLumps, HalfOfTheRoundTellsTheDiameter) {
    const Tree tree = test::cylinder(0.15, 2.0);
    const GrowthRecipe recipe = read_growth_recipe(tree, kCoarse);
    const GrownBark bark = grow_bark(tree, recipe).bark;
    for (const double wood : {0.14, 0.15, 0.16}) {
        const BarkFit half =
            measure_bark_fit(tree, recipe, bark, cylinder_scan(wood, 2.0, 0.003, 0.6, 40000, 4));
        EXPECT_NEAR(half.dbh_scan, 2.0 * wood, 0.01 * 2.0 * wood);
        EXPECT_NEAR(half.dbh_grown, 0.3, 0.01 * 0.3);
        const BarkFit third =
            measure_bark_fit(tree, recipe, bark, cylinder_scan(wood, 2.0, 0.003, 0.3, 40000, 4));
        EXPECT_EQ(third.dbh_scan, 0.0);
    }
}

TEST(GrowthLumps, DeepDentsBecomeHollows) {
    const double wood = 0.2;
    const Tree tree = test::cylinder(wood, 2.0);
    const TrunkAxis axis(tree);
    PointCloud cloud = cylinder_scan(wood, 2.0, 0.003, 1.0, 40000, 4);
    std::vector<Bump> bumps{{1.0, 1.0, 0.07, -0.1, wood}};
    push(cloud, all_of(cloud), axis, bumps);
    const GrowthProposal proposal = propose_growth(tree, cloud, read_growth_recipe(tree, kCoarse));
    const GrowthRecipe recipe = read_growth_recipe(tree, kCoarse + ("\n" + proposal.recipe));
    ASSERT_EQ(proposal.hollows, 1U);
    const auto hollow = std::find_if(recipe.features.begin(), recipe.features.end(), [](const auto& feature) {
        return feature.kind == GrowthFeature::Kind::kHollow;
    });
    EXPECT_NEAR(hollow->along, 1.0, 0.03);
    EXPECT_NEAR(wood * (hollow->around / 180.0 * kPi - 1.0), 0.0, 0.03);
    EXPECT_NEAR(hollow->depth, 0.1, 0.03);
    const GrownTree grown = grow_bark(tree, recipe);
    const BarkFit fit = measure_bark_fit(tree, recipe, grown.bark, cloud);
    EXPECT_LT(fit.all.grown.mean, 0.75 * fit.all.tubes.mean);
    EXPECT_EQ(fit.worse, 0U);
}

namespace {

// Uneven flutes that wind about a trunk.
PointCloud fluted_scan(double wood, double height, double twist, double depth, double seen, uint64_t seed) {
    PointCloud cloud = cylinder_scan(wood, height, 0.004, seen, 60000, seed);
    for (Vec3& p : cloud.positions) {
        const double angle = std::atan2(-p.z, p.x) - twist * p.y;
        const double r = 1.0 + depth * (std::cos(5.0 * angle) + 0.6 * std::cos(3.0 * angle + 1.0));
        p.x *= static_cast<float>(r);
        p.z *= static_cast<float>(r);
    }
    return cloud;
}

}  // namespace

TEST(GrowthLumps, WhatWindsAboutTheTrunkIsTheGrain) {
    const Tree tree = test::cylinder(0.2, 4.0);
    const GrowthRecipe recipe = read_growth_recipe(tree, kEdges);
    for (const double twist : {-2.5, -0.8, 0.5, 1.5, 3.0})
        for (const double seen : {1.0, 0.75}) {
            const GrowthProposal proposal =
                propose_growth(tree, fluted_scan(0.2, 4.0, twist, 0.06, seen, 7), recipe);
            EXPECT_NEAR(proposal.twist, twist, 0.05 + 0.03 * std::abs(twist)) << "seen " << seen;
            EXPECT_NEAR(read_growth_recipe(tree, kEdges + ("\n" + proposal.recipe)).twist, proposal.twist,
                        1e-9);
            EXPECT_EQ(proposal.remarks.size(), 1U);
        }
    // Straight flutes, lumps and plain bark have none.
    EXPECT_EQ(propose_growth(tree, fluted_scan(0.2, 4.0, 0.0, 0.06, 1.0, 7), recipe).twist, 0.0);
    for (uint64_t seed = 1; seed <= 4; seed++) {
        PointCloud cloud = cylinder_scan(0.2, 4.0, 0.006, seed % 2 == 0 ? 0.7 : 1.0, 40000, seed);
        EXPECT_EQ(propose_growth(tree, cloud, recipe).twist, 0.0) << "seed " << seed;
        Random random(seed);
        std::vector<Bump> bumps = bumps_at_random(random, 6, 0.4, 3.6, 0.2);
        push(cloud, all_of(cloud), TrunkAxis(tree), bumps);
        EXPECT_EQ(propose_growth(tree, cloud, recipe).twist, 0.0) << "seed " << seed;
    }
}

TEST(GrowthLumps, AreTheSameEachTimeWhateverTheOrder) {
    const Tree tree = test::cylinder(0.15, 2.0);
    PointCloud cloud = cylinder_scan(0.15, 2.0, 0.003, 1.0, 20000, 5);
    Random random(9);
    std::vector<Bump> bumps = bumps_at_random(random, 3, 0.4, 1.6, 0.15);
    push(cloud, all_of(cloud), TrunkAxis(tree), bumps);
    const GrowthRecipe recipe = read_growth_recipe(tree, kEdges);
    const std::string first = propose_growth(tree, cloud, recipe).recipe;
    EXPECT_NE(first, "");
    std::reverse(cloud.positions.begin(), cloud.positions.end());
    EXPECT_EQ(propose_growth(tree, cloud, recipe).recipe, first);
}

TEST(GrowthLumps, TellWhatTheyCannotDo) {
    const Tree tree = test::cylinder(0.15, 2.0);
    const GrowthRecipe recipe = read_growth_recipe(tree, "edges longest=0.08");
    EXPECT_THROW(propose_growth(tree, PointCloud(), recipe), Error);
    EXPECT_THROW(propose_growth(Tree(), cylinder_scan(0.15, 2.0, 0.0, 1.0, 100, 1), recipe), Error);
    PointCloud far = cylinder_scan(0.15, 2.0, 0.0, 1.0, 1000, 1);
    for (Vec3& p : far.positions)
        p.x += 50.0f;
    const GrowthProposal proposal = propose_growth(tree, far, recipe);
    EXPECT_EQ(proposal.recipe, "");
    EXPECT_EQ(proposal.remarks.size(), 1U);
    EXPECT_THROW(measure_bark_fit(tree, recipe, grow_bark(tree, recipe).bark, far), Error);
}
