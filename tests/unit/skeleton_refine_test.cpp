#include <gtest/gtest.h>

#include <algorithm>

#include "skeleton/cylinders/radii.h"
#include "skeleton/cylinders/refine.h"
#include "skeleton_test_clouds.h"

namespace treerec {
namespace {

using test::add_cone;

// A branch along the y axis, with `count` stations `step` metres apart.
std::vector<Station> upright(int count, double step, double radius, const DVec3& base = DVec3(0.0)) {
    std::vector<Station> line(static_cast<size_t>(count));
    for (int i = 0; i < count; i++) {
        line[i].position = base + DVec3(0.0, i * step, 0.0);
        line[i].radius = radius;
        line[i].measured = true;
    }
    return line;
}

// Every point at the station of the branch that is nearest to it.
PointPlaces nearest_places(const std::vector<Vec3>& points, const std::vector<std::vector<Station>>& axes) {
    PointPlaces places;
    for (const Vec3& p : points) {
        double best = 1e30;
        places.branch.push_back(-1);
        places.station.push_back(0);
        for (size_t l = 0; l < axes.size(); l++)
            for (size_t i = 0; i < axes[l].size(); i++) {
                const double off = std::abs(glm::distance(DVec3(p), axes[l][i].position) - axes[l][i].radius);
                if (off >= best) continue;
                best = off;
                places.branch.back() = static_cast<int32_t>(l);
                places.station.back() = static_cast<int32_t>(i);
            }
    }
    return places;
}

struct Scene {
    std::vector<Vec3> points;
    std::vector<SkeletonBranch> branches;
    std::vector<std::vector<Station>> axes;

    void refine(int times = 1) {
        for (int i = 0; i < times; i++) {
            SubProgress progress(nullptr, 0.0, 1.0);
            refine_axes(axes, branches, nearest_places(points, axes), points, progress);
        }
    }
};

Scene noisy_pole(uint64_t seed, double radius, double noise, double from = 0.0, double to = 1.0) {
    Random random(seed);
    PointCloud cloud;
    add_cone(cloud, random, {0, 0, 0}, {0, 3, 0}, radius, radius, 0.02, noise, from, to);
    Scene scene;
    scene.points = cloud.positions;
    scene.branches.resize(1);
    scene.axes.push_back(upright(31, 0.1, radius));
    return scene;
}

double mean_radius(const std::vector<Station>& line) {
    double sum = 0.0;
    for (const Station& station : line)
        sum += station.radius;
    return sum / static_cast<double>(line.size());
}

TEST(RefineAxes, NoiseDoesNotThickenAStem) {
    // Points inside the surface were once given to whichever segment explained them best, and each round made
    // the stem two per cent thicker.
    for (uint64_t seed = 1; seed <= 5; seed++) {
        Scene scene = noisy_pole(seed, 0.1, 0.015);
        scene.refine(4);
        EXPECT_NEAR(mean_radius(scene.axes[0]), 0.1, 0.0012) << seed;
    }
}

TEST(RefineAxes, MovesADisplacedAxisIntoTheMiddle) {
    for (uint64_t seed = 1; seed <= 5; seed++) {
        Random random(seed);
        Scene scene = noisy_pole(seed, 0.1, 0.003, 0.0, seed % 2 == 1 ? 1.0 : 0.6);
        const double angle = random.uniform(0.0, 2.0 * kPi);
        for (Station& station : scene.axes[0]) {
            station.position += 0.03 * DVec3(std::cos(angle), 0.0, std::sin(angle));
            station.radius = 0.09;
        }
        scene.refine(3);
        for (size_t i = 2; i + 2 < scene.axes[0].size(); i++) {
            const DVec3& p = scene.axes[0][i].position;
            EXPECT_LT(std::hypot(p.x, p.z), 0.006) << seed << " " << i;
            EXPECT_NEAR(scene.axes[0][i].radius, 0.1, 0.003) << seed << " " << i;
        }
    }
}

TEST(RefineAxes, ABranchDoesNotThickenItsParent) {
    Random random(3);
    PointCloud cloud;
    add_cone(cloud, random, {0, 0, 0}, {0, 3, 0}, 0.1, 0.1, 0.02, 0.002);
    add_cone(cloud, random, {0.1, 1.5, 0}, {0.7, 2.1, 0}, 0.06, 0.05, 0.01, 0.002);
    Scene scene;
    scene.points = cloud.positions;
    scene.branches.resize(2);
    scene.branches[1].parent = 0;
    scene.branches[1].attach = 15;
    scene.axes.push_back(upright(31, 0.1, 0.1));
    std::vector<Station> side;
    for (int i = 0; i < 9; i++) {
        Station station;
        station.position = DVec3(0.1 + 0.075 * i, 1.5 + 0.075 * i, 0.0);
        station.radius = 0.055;
        station.measured = true;
        side.push_back(station);
    }
    scene.axes.push_back(side);
    // As the slices do it: the branch's lowest points hang on the parent.
    PointPlaces places = nearest_places(scene.points, scene.axes);
    for (size_t v = 0; v < scene.points.size(); v++)
        if (places.branch[v] == 1 && places.station[v] <= 1) {
            places.branch[v] = 0;
            places.station[v] = 16;
        }
    SubProgress progress(nullptr, 0.0, 1.0);
    refine_axes(scene.axes, scene.branches, places, scene.points, progress);
    for (const Station& station : scene.axes[0])
        EXPECT_NEAR(station.radius, 0.1, 0.006) << station.position.y;
}

TEST(RefineAxes, KeepsTheRootAndTheEndsOfBridges) {
    Scene scene = noisy_pole(1, 0.1, 0.003);
    for (Station& station : scene.axes[0])
        station.position.x += 0.02;
    scene.axes[0][20].bridged = true;
    const std::vector<Station> before = scene.axes[0];
    scene.refine();
    for (const size_t i : {size_t{0}, size_t{19}, size_t{20}})
        EXPECT_EQ(scene.axes[0][i].position, before[i].position) << i;
    EXPECT_LT(scene.axes[0][10].position.x, 0.012);
}

TEST(RefineAxes, BelievesWhatPointsAllAroundAgreeOn) {
    Scene scene = noisy_pole(1, 0.1, 0.002);
    for (size_t i = 10; i < 20; i++) {
        scene.axes[0][i].measured = false;
        scene.axes[0][i].radius = 0.03;
    }
    for (Station& station : scene.axes[0])
        station.scatter = 0.0015;
    scene.refine();
    for (const Station& station : scene.axes[0]) {
        EXPECT_TRUE(station.measured);
        EXPECT_NEAR(station.radius, 0.1, 0.004);
    }
    // A cloud of points without a surface is not believed.
    Random random(2);
    for (Vec3& p : scene.points)
        p = Vec3(DVec3(0.04 * random.normal(), p.y, 0.04 * random.normal()));
    for (Station& station : scene.axes[0]) {
        station.measured = station.position.y < 1.0;
        station.scatter = 0.0015;
    }
    scene.refine();
    size_t believed = 0;
    for (size_t i = 12; i < scene.axes[0].size(); i++)
        believed += scene.axes[0][i].measured ? 1 : 0;
    EXPECT_EQ(believed, 0u);
}

TEST(RefineAxes, LeavesBranchesWithoutPointsAlone) {
    Scene scene;
    scene.branches.resize(1);
    scene.axes.push_back(upright(5, 0.1, 0.05));
    scene.refine();
    for (int i = 0; i < 5; i++) {
        EXPECT_EQ(scene.axes[0][i].position, DVec3(0.0, 0.1 * i, 0.0));
        EXPECT_EQ(scene.axes[0][i].radius, 0.05);
    }
}

std::vector<std::vector<Station>> random_axes(Random& random, std::vector<SkeletonBranch>& branches) {
    std::vector<std::vector<Station>> axes;
    branches.clear();
    for (int l = 0; l < 12; l++) {
        SkeletonBranch branch;
        DVec3 p(0.0);
        if (l > 0) {
            branch.parent = static_cast<int32_t>(random.below(static_cast<uint32_t>(l)));
            branch.attach =
                static_cast<int32_t>(random.below(static_cast<uint32_t>(axes[branch.parent].size())));
            p = axes[branch.parent][branch.attach].position;
        }
        std::vector<Station> line(1 + random.below(30));
        for (Station& station : line) {
            p += 0.05 * random.direction();
            station.position = p;
            station.radius = random.below(4) == 0 ? 0.0 : random.uniform(0.0, 0.2);
            station.measured = station.radius > 0.0 && random.below(2) == 0;
            station.scatter = random.uniform(0.0, 0.02);
        }
        axes.push_back(line);
        branches.push_back(branch);
    }
    return axes;
}

TEST(InferRadii, NeverGrowOutward) {
    for (uint64_t seed = 1; seed <= 40; seed++) {
        Random random(seed);
        std::vector<SkeletonBranch> branches;
        std::vector<std::vector<Station>> axes = random_axes(random, branches);
        infer_radii(axes, branches);
        for (size_t l = 0; l < axes.size(); l++) {
            double limit = branches[l].parent < 0 ? 1e9 : axes[branches[l].parent][branches[l].attach].radius;
            for (const Station& station : axes[l]) {
                EXPECT_GT(station.radius, 0.0);
                EXPECT_LE(station.radius, limit);
                limit = station.radius;
            }
        }
    }
}

TEST(InferRadii, TakesTheNoiseOffThinTwigs) {
    std::vector<SkeletonBranch> branches(2);
    branches[1].parent = 0;
    branches[1].attach = 20;
    std::vector<std::vector<Station>> axes = {upright(31, 0.1, 0.1), upright(11, 0.1, 0.012, {0.1, 2, 0})};
    for (Station& station : axes[1])
        station.measured = false;
    std::vector<std::vector<Station>> clean = axes;
    for (size_t i = 0; i < axes[0].size(); i++) {
        axes[0][i].scatter = 0.0067;  // a standard deviation of 1 cm
        clean[0][i].scatter = 0.0005;
    }
    EXPECT_NEAR(noise_of(axes), 0.01, 1e-4);
    infer_radii(axes, branches);
    infer_radii(clean, branches);
    EXPECT_NEAR(clean[1][2].radius, 0.012, 0.0005);
    EXPECT_LT(axes[1][2].radius, 0.0105);
    EXPECT_GT(axes[1][2].radius, 0.004);
}

TEST(InferRadii, GuessesAsThickAsTheTreeWasMeasured) {
    std::vector<SkeletonBranch> branches(2);
    branches[1].parent = 0;
    branches[1].attach = 5;
    // A slender stem, about a hundredth of the way to its tip thick; thin wood tapers half as fast again.
    std::vector<std::vector<Station>> axes = {upright(101, 0.1, 0.1), upright(11, 0.1, 0.0, {0.1, 0.5, 0})};
    for (size_t i = 0; i < axes[0].size(); i++)
        axes[0][i].radius = 0.002 + 0.1 * (1.0 - static_cast<double>(i) / 100.0);
    for (Station& station : axes[1])
        station.measured = false;
    infer_radii(axes, branches);
    EXPECT_NEAR(axes[1][0].radius, 0.003 + 0.0155 * 1.0, 0.001);
    EXPECT_NEAR(axes[1][10].radius, 0.0028, 1e-9);
}

// The greatest fall of the radius, as a ratio, within three radii along a line.
double steepest(const std::vector<Station>& line) {
    double most = 1.0;
    for (size_t i = 0; i < line.size(); i++) {
        double way = 0.0;
        for (size_t j = i + 1; j < line.size(); j++) {
            way += glm::distance(line[j].position, line[j - 1].position);
            if (way > 3.0 * line[i].radius) break;
            most = std::max(most, line[i].radius / line[j].radius);
        }
    }
    return most;
}

TEST(InferRadii, AForkThatNoPointShowsIsNoThickerThanWhatGrowsFromIt) {
    std::vector<SkeletonBranch> branches(2);
    branches[1].parent = 0;
    branches[1].attach = 20;
    // Around the fork all points are the parent's; those further out show a twig of 3 mm.
    std::vector<std::vector<Station>> axes = {upright(151, 0.02, 0.03),
                                              upright(51, 0.02, 0.003, {0.1, 0.4, 0})};
    for (size_t i = 0; i < axes[1].size(); i++) {
        axes[1][i].measured = false;
        if (i < 10) axes[1][i].radius = 0.0;
    }
    infer_radii(axes, branches, true);
    EXPECT_LT(axes[1][0].radius, 0.005);
    EXPECT_GE(axes[1][0].radius, axes[1][10].radius);
    EXPECT_LT(steepest(axes[1]), 1.3);
    // And in a gap, it goes from the radius before to the one behind.
    for (size_t i = 0; i < 8; i++)
        axes[1][i].radius = 0.006;
    for (size_t i = 8; i < 40; i++)
        axes[1][i].radius = 0.0;
    for (size_t i = 40; i < axes[1].size(); i++)
        axes[1][i].radius = 0.003;
    infer_radii(axes, branches, true);
    EXPECT_NEAR(axes[1][24].radius, 0.0045, 0.0008);
}

TEST(InferRadii, MeasuredWoodNarrowsToItsTipEvenly) {
    std::vector<SkeletonBranch> branches(1);
    std::vector<std::vector<Station>> axes = {upright(61, 0.02, 0.02)};
    // At the end, too few points for a circle still lie as far from the axis.
    for (size_t i = 51; i < axes[0].size(); i++)
        axes[0][i].measured = false;
    infer_radii(axes, branches, true);
    EXPECT_NEAR(axes[0][50].radius, 0.02, 1e-9);
    EXPECT_NEAR(axes[0][55].radius, 0.01, 0.002);
    EXPECT_LT(axes[0][60].radius, 0.004);
    EXPECT_LT(steepest(std::vector<Station>(axes[0].begin(), axes[0].begin() + 54)), 1.5);
}

TEST(InferRadii, ThickWoodThatWasCutKeepsItsThickness) {
    std::vector<SkeletonBranch> branches(1);
    std::vector<std::vector<Station>> axes = {upright(61, 0.02, 0.08)};
    for (size_t i = 0; i < axes[0].size(); i++) {
        axes[0][i].scatter = 0.003;
        axes[0][i].measured = i <= 50;
    }
    infer_radii(axes, branches, true);
    EXPECT_NEAR(axes[0][60].radius, 0.08, 0.002);
}

TEST(InferRadii, ABaseKeepsItsFlare) {
    std::vector<SkeletonBranch> branches(1);
    std::vector<std::vector<Station>> axes = {upright(31, 0.1, 0.1)};
    axes[0][0].radius = 0.16;
    axes[0][1].radius = 0.13;
    axes[0][2].radius = 0.11;
    infer_radii(axes, branches);
    EXPECT_GT(axes[0][0].radius, 0.14);
    EXPECT_GT(axes[0][1].radius, 0.12);
    EXPECT_NEAR(axes[0][5].radius, 0.1, 1e-9);
}

}  // namespace
}  // namespace treerec
