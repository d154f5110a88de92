#include "scan/cleaning/clean_cloud.h"

#include <algorithm>

#include "geometry/parallel.h"
#include "scan_samples.h"

namespace treerec {
namespace {

using namespace scan_test;

constexpr UpAxis kAllUps[] = {UpAxis::kX,    UpAxis::kY,    UpAxis::kZ,
                              UpAxis::kNegX, UpAxis::kNegY, UpAxis::kNegZ};

// A cloud as a file would give it: Y-up points in metres, in the axes and units of `frame`.
PointCloud as_scanned(const std::vector<Vec3>& points, UpAxis up, double metres_per_unit,
                      const DVec3& origin) {
    ScanFrame frame;
    frame.up = up;
    frame.metres_per_unit = metres_per_unit;
    PointCloud cloud;
    cloud.frame.origin = origin;
    for (const Vec3& p : points)
        cloud.positions.emplace_back(frame.to_scan(DVec3(p)));
    return cloud;
}

// The points, sorted.
struct PointSet {
    std::vector<std::array<float, 3>> points;

    bool contains(const std::array<float, 3>& p) const { return std::ranges::binary_search(points, p); }
    bool operator==(const PointSet&) const = default;
};

PointSet set_of(const PointCloud& cloud) {
    PointSet set;
    for (const Vec3& p : cloud.positions)
        set.points.push_back({p.x, p.y, p.z});
    std::ranges::sort(set.points);
    return set;
}

size_t removed_by(const CleanReport& report, const std::string& name) {
    for (const CleanStep& step : report.steps)
        if (step.name == name) return step.removed;
    ADD_FAILURE() << "no step " << name;
    return 0;
}

// --- orient_cloud ------------------------------------------------------------------------------------------

TEST(ScanOrient, FindsTheUpAxis) {
    for (uint64_t seed = 1; seed <= 5; seed++) {
        std::vector<Vec3> points = tree_points(seed);
        // With a bare tip above the crown, the tree would look like a stem from either end.
        std::erase_if(points, [](const Vec3& p) { return p.y > 8.0F; });
        for (const UpAxis up : {UpAxis::kY, UpAxis::kZ, UpAxis::kNegY}) {
            for (const double unit : {1.0, 0.01, 0.001}) {
                SCOPED_TRACE(std::string(up_axis_name(up)) + " " + std::to_string(unit));
                PointCloud cloud = as_scanned(points, up, unit, {4550.0, 8120.0, 300.0});
                shuffle(cloud, seed);
                const PointCloud before = cloud;
                const OrientReport report = orient_cloud(cloud, {});
                EXPECT_EQ(report.up, up);
                EXPECT_TRUE(report.up_detected);
                EXPECT_DOUBLE_EQ(report.metres_per_unit, unit);
                // Whatever has Y up comes from photos, without a scale.
                EXPECT_EQ(report.warnings.size(), unit == 1.0 && up == UpAxis::kZ ? 0U : 1U);
                EXPECT_EQ(report.scale_unknown, unit == 1.0 && up != UpAxis::kZ);
                for (size_t i = 0; i < cloud.size(); i += 97)
                    expect_point(cloud, i, DVec3(before.positions[i]) + before.frame.origin, 1e-5 / unit);
            }
        }
    }
}

// A branch that lies along Y looks like a tree that is Y up.
TEST(ScanOrient, MapCoordinatesAreZUp) {
    PointCloud cloud = as_scanned(tree_points(1), UpAxis::kY, 1.0, {455000.0, 5812000.0, 300.0});
    const OrientReport report = orient_cloud(cloud, {});
    EXPECT_EQ(report.up, UpAxis::kZ);
    EXPECT_TRUE(report.warnings.empty());
}

TEST(ScanOrient, ObeysTheUser) {
    const std::vector<Vec3> points = tree_points(1);
    for (const UpAxis up : kAllUps) {
        PointCloud cloud = as_scanned(points, up, 0.3048, {10.0, 20.0, 30.0});
        cloud.normals.assign(cloud.size(), Vec3(0, 0, 1));
        OrientOptions options;
        options.up = up;
        options.metres_per_unit = 0.3048;
        const OrientReport report = orient_cloud(cloud, options);
        EXPECT_FALSE(report.up_detected);
        EXPECT_FALSE(report.scale_guessed);
        EXPECT_TRUE(report.warnings.empty());
        for (size_t i = 0; i < points.size(); i += 101)
            EXPECT_LE(glm::length(cloud.positions[i] - points[i]), 1e-4F);
        EXPECT_LE(glm::length(cloud.frame.turn_to_scan(DVec3(cloud.normals[0])) - DVec3(0, 0, 1)), 1e-9);
    }
    PointCloud cloud = as_scanned(points, UpAxis::kZ, 1.0, DVec3(0.0));
    OrientOptions options;
    options.metres_per_unit = 0.0;
    EXPECT_THROW(orient_cloud(cloud, options), Error);
    PointCloud empty;
    EXPECT_THROW(orient_cloud(empty, {}), Error);
}

TEST(ScanOrient, StraysAndGroundDoNotConfuseIt) {
    Random random(9);
    std::vector<Vec3> points = tree_points(2);
    for (int i = 0; i < 3000; i++)
        points.emplace_back(random.uniform(-5, 5), random.uniform(0, 0.04), random.uniform(-5, 5));
    points.emplace_back(100.0F, 3.0F, 0.0F);
    points.emplace_back(0.0F, 100.0F, 0.0F);
    points.emplace_back(0.1F, -0.6F, 0.0F);
    for (const UpAxis up : {UpAxis::kY, UpAxis::kZ}) {
        PointCloud cloud = as_scanned(points, up, 1.0, DVec3(0.0));
        const OrientReport report = orient_cloud(cloud, {});
        EXPECT_EQ(report.up, up);
        EXPECT_DOUBLE_EQ(report.metres_per_unit, 1.0);
    }
}

TEST(ScanOrient, AScanWithoutAScaleBecomesAsHighAsATree) {
    for (const double unit : {1e-7, 100.0, 1e5}) {
        SCOPED_TRACE(unit);
        PointCloud cloud = as_scanned(tree_points(4), UpAxis::kZ, unit, DVec3(0.0));
        const OrientReport report = orient_cloud(cloud, {});
        EXPECT_NEAR(report.metres_per_unit / unit, 1.0, 1e-9);
        ASSERT_EQ(report.warnings.size(), 1U);
        EXPECT_NE(report.warnings[0].find(" m each"), std::string::npos) << report.warnings[0];
    }
}

TEST(ScanOrient, SurvivesWhatIsNoTree) {
    Random random(4);
    for (const size_t count : {1U, 2U, 5U, 100U}) {
        for (int kind = 0; kind < 3; kind++) {
            PointCloud cloud;
            for (size_t i = 0; i < count; i++) {
                Vec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
                if (kind == 1) p = Vec3(p.x);               // a line
                if (kind == 2) p = Vec3(1.0F, 2.0F, 3.0F);  // a place
                cloud.positions.push_back(p);
            }
            const OrientReport report = orient_cloud(cloud, {});
            EXPECT_EQ(report.up, UpAxis::kZ);
            for (const Vec3& p : cloud.positions)
                EXPECT_TRUE(is_finite(DVec3(p)));
            EXPECT_LE(clean_cloud(cloud, {}).steps.size(), 4U);
            EXPECT_FALSE(cloud.empty());
        }
    }
}

// --- clean_cloud -------------------------------------------------------------------------------------------

PointCloud upright(const std::vector<Vec3>& points) {
    PointCloud cloud;
    cloud.positions = points;
    return cloud;
}

TEST(ScanClean, LeavesACleanTreeAlone) {
    for (uint64_t seed = 1; seed <= 5; seed++) {
        PointCloud cloud = upright(tree_points(seed));
        const size_t before = cloud.size();
        const CleanReport report = clean_cloud(cloud, {});
        EXPECT_TRUE(report.warnings.empty());
        EXPECT_EQ(removed_by(report, "Ground"), 0U);
        EXPECT_EQ(removed_by(report, "Fragments"), 0U);
        EXPECT_LE(removed_by(report, "Outliers"), before / 500);
        EXPECT_EQ(cloud.size(), before - removed_by(report, "Outliers"));
    }
}

TEST(ScanClean, TakesStrayPoints) {
    const std::vector<Vec3> tree = tree_points(3);
    std::vector<Vec3> points = tree;
    const std::vector<Vec3> strays = {{100, 5, 0}, {0, 5, -60}, {0.1F, -0.6F, 0},
                                      {4, 9, 4},   {-4, 1, 2},  {0, 60, 0}};
    points.insert(points.end(), strays.begin(), strays.end());
    PointCloud cloud = upright(points);
    clean_cloud(cloud, {});
    const PointSet left = set_of(cloud);
    for (const Vec3& s : strays)
        EXPECT_FALSE(left.contains({s.x, s.y, s.z})) << s.x << " " << s.y << " " << s.z;
    EXPECT_GE(cloud.size(), tree.size() - tree.size() / 500);
}

TEST(ScanClean, SaysThatItLeftOutASecondTree) {
    std::vector<Vec3> points = tree_points(3);
    for (const Vec3& p : tree_points(4))
        points.push_back(p + Vec3(15.0F, 0.0F, 0.0F));
    PointCloud cloud = as_scanned(points, UpAxis::kY, 1.0, DVec3(0.0));
    orient_cloud(cloud, {UpAxis::kY, 1.0});
    CleanOptions options;
    options.pick.enabled = false;
    const CleanReport report = clean_cloud(cloud, options);
    EXPECT_GT(removed_by(report, "Fragments"), points.size() / 3);
    ASSERT_EQ(report.warnings.size(), 1U);
    EXPECT_NE(report.warnings[0].find("apart"), std::string::npos) << report.warnings[0];
}

TEST(ScanClean, TakesFarFragmentsAndKeepsNearParts) {
    Random random(6);
    std::vector<Vec3> points = tree_points(4);
    // A gap in the stem, 0.8 m high.
    std::erase_if(points, [](const Vec3& p) { return p.y > 0.9F && p.y < 1.7F; });
    const size_t tree = points.size();
    for (int i = 0; i < 60; i++)  // a bird
        points.emplace_back(9.0 + random.uniform(-0.2, 0.2), 6.0 + random.uniform(-0.2, 0.2),
                            random.uniform(0, 0.3));
    for (int i = 0; i < 900; i++)  // a bush
        points.emplace_back(-9.0 + random.uniform(-0.5, 0.5), random.uniform(0, 1),
                            7.0 + random.uniform(-0.5, 0.5));
    PointCloud cloud = upright(points);
    const CleanReport report = clean_cloud(cloud, {});
    EXPECT_GE(removed_by(report, "Fragments"), 930U);
    EXPECT_GE(cloud.size(), tree - tree / 500);
    size_t foot = 0;
    for (const Vec3& p : cloud.positions) {
        EXPECT_LT(std::abs(p.x), 6.0F);
        foot += p.y < 0.9F;
    }
    EXPECT_GT(foot, 300U);
}

TEST(ScanClean, TakesTheGroundAndKeepsTheFoot) {
    for (const double slope : {0.0, 0.1, 0.35}) {
        for (const double roughness : {0.0, 0.03}) {
            for (const double radius : {1.5, 4.0, 9.0}) {
                SCOPED_TRACE(std::to_string(slope) + " " + std::to_string(roughness) + " " +
                             std::to_string(radius));
                Random random(11);
                const std::vector<Vec3> tree = tree_points(5);
                std::vector<Vec3> points = tree;
                for (int i = 0; i < 2000;) {
                    const double x = random.uniform(-radius, radius);
                    const double z = random.uniform(-radius, radius);
                    if (x * x + z * z > radius * radius || x * x + z * z < 0.0625) continue;
                    points.emplace_back(x, slope * x + roughness * random.normal(), z);
                    i++;
                }
                PointCloud cloud = upright(points);
                const CleanReport report = clean_cloud(cloud, {});
                const PointSet left = set_of(cloud);
                size_t tree_kept = 0;
                size_t foot = 0;
                size_t foot_kept = 0;
                for (const Vec3& p : tree) {
                    const bool kept = left.contains({p.x, p.y, p.z});
                    tree_kept += kept;
                    if (p.y > 0.3F) continue;
                    foot++;
                    foot_kept += kept;
                }
                const size_t ground_kept = cloud.size() - tree_kept;
                EXPECT_LE(ground_kept, 2000U / 8) << "ground left";
                EXPECT_GE(tree_kept, tree.size() - tree.size() / 200) << "tree lost";
                EXPECT_GE(foot_kept * 10, foot * 8) << "foot lost";
            }
        }
    }
}

TEST(ScanClean, TakesLowPlantsAndKeepsBranchesThatTouchTheGround) {
    Random random(13);
    std::vector<Vec3> branch;
    add_cylinder(branch, random, {0.1, 3.5, 0.0}, {2.2, 0.1, 0.5}, 0.03, 0.01, 800);
    std::vector<Vec3> points = tree_points(9);
    const size_t tree = points.size();
    points.insert(points.end(), branch.begin(), branch.end());
    for (int i = 0; i < 4000; i++)
        points.emplace_back(random.uniform(-3, 3), 0.02 * random.normal(), random.uniform(-3, 3));
    size_t plants = 0;
    for (int plant = 0; plant < 6; plant++) {
        const DVec3 foot(2.0 * std::cos(plant), 0.0, -1.0 - 1.5 * std::abs(std::sin(plant)));
        for (int i = 0; i < 150; i++, plants++)
            points.emplace_back(foot + DVec3(random.uniform(-0.15, 0.15), random.uniform(0, 0.6),
                                             random.uniform(-0.15, 0.15)));
    }
    PointCloud cloud = upright(points);
    const CleanReport report = clean_cloud(cloud, {});
    EXPECT_GE(removed_by(report, "Ground"), (4000 + plants) * 9 / 10);
    EXPECT_LE(removed_by(report, "Ground"), (4000 + plants) * 103 / 100);
    const PointSet left = set_of(cloud);
    size_t kept = 0;
    for (const Vec3& p : branch)
        kept += left.contains({p.x, p.y, p.z});
    EXPECT_GE(kept, branch.size() * 9 / 10);
    EXPECT_GE(cloud.size(), tree);
}

// As scans of single trees are often cut out.
TEST(ScanClean, TakesANarrowDiscOfGround) {
    Random random(14);
    std::vector<Vec3> points;
    add_cylinder(points, random, {0, 0, 0}, {0, 20, 0}, 0.12, 0.02, 20000);
    for (int i = 0; i < 25; i++) {
        const DVec3 foot(0.0, 10.0 + 0.4 * i, 0.0);
        add_cylinder(points, random, foot, foot + DVec3(std::cos(2.4 * i), 0.1, std::sin(2.4 * i)), 0.02,
                     0.01, 300);
    }
    for (int i = 0; i < 3000;) {
        const double x = random.uniform(-1.2, 1.2);
        const double z = random.uniform(-1.2, 1.2);
        if (x * x + z * z > 1.44) continue;
        points.emplace_back(x, random.uniform(-0.1, 0.1), z);
        i++;
    }
    PointCloud cloud = upright(points);
    const CleanReport report = clean_cloud(cloud, {});
    EXPECT_GE(removed_by(report, "Ground"), 2500U);
    EXPECT_LE(removed_by(report, "Ground"), 3100U);
}

TEST(ScanClean, TakesExtremeColorsOnlyWhereColorsAreReal) {
    PointCloud cloud = upright(tree_points(6));
    const size_t all = cloud.size();
    for (size_t i = 0; i < all; i++) {
        const uint8_t shade = static_cast<uint8_t>(60 + i % 100);
        cloud.colors.push_back(i % 10 == 0   ? Color8{255, 252, 250}
                               : i % 10 == 1 ? Color8{0, 5, 3}
                                             : Color8{shade, 50, 40});
    }
    PointCloud white = cloud;
    white.colors.assign(all, Color8{255, 255, 255});
    EXPECT_EQ(removed_by(clean_cloud(cloud, {}), "Extreme colours"), (all + 9) / 10 + (all + 8) / 10);
    for (const Color8& c : cloud.colors)
        EXPECT_EQ(c[1], 50);
    EXPECT_EQ(removed_by(clean_cloud(white, {}), "Extreme colours"), 0U);
    EXPECT_GT(white.size(), all * 9 / 10);
}

TEST(ScanClean, StepsCanBeSwitchedOff) {
    PointCloud cloud = upright(tree_points(7));
    cloud.positions.emplace_back(50.0F, 0.0F, 0.0F);
    const size_t all = cloud.size();
    CleanOptions options;
    options.remove_extreme_colors = options.remove_outliers = options.remove_fragments =
        options.remove_ground = options.pick.enabled = false;
    EXPECT_TRUE(clean_cloud(cloud, options).steps.empty());
    EXPECT_EQ(cloud.size(), all);
    options.remove_fragments = true;
    EXPECT_EQ(removed_by(clean_cloud(cloud, options), "Fragments"), 1U);
}

TEST(ScanClean, SameResultInAnyOrderAndOnAnyThreads) {
    Random random(8);
    std::vector<Vec3> points = tree_points(8);
    for (int i = 0; i < 2000; i++)
        points.emplace_back(random.uniform(-5, 5), random.uniform(0, 0.04), random.uniform(-5, 5));
    for (int i = 0; i < 300; i++)
        points.emplace_back(random.uniform(-9, 9), random.uniform(0, 12), random.uniform(-9, 9));
    const std::vector<Vec3> copies(points.begin(), points.begin() + 500);
    points.insert(points.end(), copies.begin(), copies.end());
    PointCloud first = upright(points);
    const size_t all = first.size();
    set_thread_count(1);
    clean_cloud(first, {});
    ASSERT_LT(first.size(), all);
    const PointSet expected = set_of(first);
    for (uint64_t round = 1; round <= 4; round++) {
        PointCloud cloud = upright(points);
        shuffle(cloud, round);
        set_thread_count(static_cast<int>(round));
        clean_cloud(cloud, {});
        EXPECT_TRUE(set_of(cloud) == expected);
    }
    set_thread_count(0);
}

// More points than are looked at one by one.
TEST(ScanClean, ThinsADenseCloudAndCleansItTheSame) {
    Random random(12);
    std::vector<Vec3> points;
    for (int copy = 0; copy < 22; copy++)
        for (const Vec3& p : tree_points(static_cast<uint64_t>(copy)))
            points.push_back(p);
    points.emplace_back(80.0F, 5.0F, 0.0F);
    points.emplace_back(0.3F, -0.9F, 0.0F);
    PointCloud cloud = upright(points);
    const size_t all = cloud.size();
    ASSERT_GT(all, 400000U);
    clean_cloud(cloud, {});
    const PointSet left = set_of(cloud);
    EXPECT_FALSE(left.contains({80.0F, 5.0F, 0.0F}));
    EXPECT_FALSE(left.contains({0.3F, -0.9F, 0.0F}));
    EXPECT_GT(cloud.size(), all - all / 500);
    PointCloud shuffled = upright(points);
    shuffle(shuffled, 1);
    clean_cloud(shuffled, {});
    EXPECT_TRUE(set_of(shuffled) == left);
}

class Cancelling final : public Progress {
  public:
    void update(double fraction, const char*) override {
        EXPECT_GE(fraction, last_);
        last_ = fraction;
    }
    bool cancelled() const override { return last_ >= 0.3; }

  private:
    double last_ = 0.0;
};

TEST(ScanClean, CanBeCancelled) {
    PointCloud cloud = upright(tree_points(1));
    Cancelling progress;
    EXPECT_THROW(clean_cloud(cloud, {}, &progress), Cancelled);
}

TEST(ScanClean, SurvivesAHouseAWallAndAFloor) {
    Random random(15);
    for (int kind = 0; kind < 3; kind++) {
        PointCloud cloud;
        for (int i = 0; i < 6000; i++) {
            DVec3 p(random.uniform(0, 8), random.uniform(0, 6), random.uniform(0, 10));
            const int side = kind == 0 ? i % 5 : kind == 1 ? 0 : 4;
            if (side < 2) p.x = 8.0 * side;
            if (side == 2 || side == 3) p.z = 10.0 * (side - 2);
            if (side == 4) p.y = kind == 0 ? 6.0 : 0.0;
            cloud.positions.emplace_back(p);
        }
        clean_cloud(cloud, {});
        EXPECT_GE(cloud.size(), 600U);
    }
}

// --- Real scans --------------------------------------------------------------------------------------------

TEST(ScanReal, EveryCloudIsReadUprightAndClean) {
    const std::string folder = scans_folder();
    if (folder.empty()) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    for (const std::string& name : names) {
        SCOPED_TRACE(name);
        if (name.ends_with(".laz")) continue;  // needs a library, and most are plots: scan_pick_tree_test
        ReadCloudReport read;
        PointCloud cloud = read_cloud(folder + name, {}, &read);
        EXPECT_TRUE(read.warnings.empty());
        const bool photos = name.starts_with("sfm_") || name.find("_rgb") != name.npos;
        EXPECT_EQ(cloud.has_colors(), photos);
        EXPECT_EQ(cloud.has_normals(),
                  name.find("normals") != name.npos || name.find("orchard") != name.npos);

        if (name.find("treehill") != name.npos) continue;  // a whole scene in the cameras' axes
        const OrientReport oriented = orient_cloud(cloud, {});
        EXPECT_EQ(oriented.up, name.find("Yup") != name.npos ? UpAxis::kY : UpAxis::kZ);
        EXPECT_EQ(oriented.metres_per_unit, 1.0);

        const size_t all = cloud.size();
        const CleanReport cleaned = clean_cloud(cloud, {});
        // Two were taken against a white sky.
        const bool sky = name.starts_with("sfm_pear_take");
        ASSERT_EQ(cleaned.warnings.size(), sky ? 1U : 0U);
        if (sky) {
            EXPECT_NE(cleaned.warnings[0].find("% of the points are near white"), std::string::npos);
            EXPECT_GT(removed_by(cleaned, "Extreme colours"), all / 3);
        }
        EXPECT_EQ(removed_by(cleaned, "Ground"), 0U);
        EXPECT_LE(removed_by(cleaned, "Fragments"), all / 200);
        EXPECT_LE(removed_by(cleaned, "Outliers"), all / 50);
    }
}

TEST(ScanReal, TheSameTreeFromLasAndText) {
    const std::string folder = scans_folder();
    if (folder.empty()) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    const PointCloud las = read_cloud(folder + "itsme_tropical_tree_1.las");
    const PointCloud text = read_cloud(folder + "itsme_tropical_tree_1.txt");
    ASSERT_EQ(las.size(), text.size());
    EXPECT_EQ(las.frame, text.frame);
    for (size_t i = 0; i < las.size(); i++)
        ASSERT_LE(glm::length(las.positions[i] - text.positions[i]),
                  1e-3F);  // the LAS file is in millimetres
}

}  // namespace
}  // namespace treerec
