// Clouds as users have them: everything that is wrong with them must leave the same tree, or be said.
#include <gtest/gtest.h>

#include <limits>

#include "scan/check_shape.h"
#include "scan/cleaning/clean_cloud.h"
#include "scan_samples.h"

namespace treerec {
namespace {

using namespace scan_test;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

PointCloud z_up(const std::vector<Vec3>& points, const DVec3& origin = DVec3(0.0)) {
    ScanFrame frame;
    frame.up = UpAxis::kZ;
    PointCloud cloud;
    cloud.frame.origin = origin;
    for (const Vec3& p : points)
        cloud.positions.emplace_back(frame.to_scan(DVec3(p)));
    return cloud;
}

struct Cleaned {
    PointCloud cloud;
    std::vector<std::string> warnings;
};

// Oriented, cleaned and looked at, as the pipeline does it.
Cleaned prepare(PointCloud cloud) {
    Cleaned result;
    result.warnings = orient_cloud(cloud, {}).warnings;
    const CleanReport report = clean_cloud(cloud, {});
    result.warnings.insert(result.warnings.end(), report.warnings.begin(), report.warnings.end());
    for (const std::string& warning : check_shape(cloud))
        result.warnings.push_back(warning);
    result.cloud = std::move(cloud);
    return result;
}

std::vector<std::array<float, 3>> sorted(const PointCloud& cloud) {
    std::vector<std::array<float, 3>> points;
    for (const Vec3& p : cloud.positions)
        points.push_back({p.x, p.y, p.z});
    std::ranges::sort(points);
    return points;
}

// How much of `tree` (tree space) is left, and how much else.
struct Left {
    double of_tree = 0.0;
    size_t others = 0;
};

Left compare(const Cleaned& cleaned, const std::vector<Vec3>& tree) {
    std::vector<std::array<float, 3>> own;
    for (const Vec3& p : tree)
        own.push_back({p.x, p.y, p.z});
    std::ranges::sort(own);
    Left left;
    size_t kept = 0;
    for (const Vec3& p : cleaned.cloud.positions) {
        // The way through the scan's axes costs nothing but signs of zero.
        if (std::ranges::binary_search(own, std::array<float, 3>{p.x, p.y, p.z}))
            kept++;
        else
            left.others++;
    }
    left.of_tree = static_cast<double>(kept) / static_cast<double>(tree.size());
    return left;
}

bool says(const std::vector<std::string>& warnings, const std::string& words) {
    return std::ranges::any_of(warnings, [&](const std::string& w) { return w.find(words) != w.npos; });
}

// --- Still the same tree -----------------------------------------------------------------------------------

TEST(ScanTough, OneOutlierBelowTheStemAndOneFarAway) {
    for (uint64_t seed = 1; seed <= 3; seed++) {
        const std::vector<Vec3> tree = tree_points(seed);
        std::vector<Vec3> points = tree;
        points.emplace_back(0.05F, -0.7F, 0.02F);
        points.emplace_back(100.0F, 4.0F, 3.0F);
        points.emplace_back(0.0F, 110.0F, 3.0F);
        const Cleaned cleaned = prepare(z_up(points));
        const Left left = compare(cleaned, tree);
        EXPECT_GE(left.of_tree, 0.997);
        EXPECT_EQ(left.others, 0U);
        EXPECT_EQ(cleaned.cloud.frame.metres_per_unit, 1.0);
        EXPECT_TRUE(cleaned.warnings.empty());
    }
}

TEST(ScanTough, TwoThousandPointsOfGround) {
    Random random(21);
    for (uint64_t seed = 1; seed <= 3; seed++) {
        const std::vector<Vec3> tree = tree_points(seed);
        std::vector<Vec3> points = tree;
        for (int i = 0; i < 2000; i++) {
            const double x = random.uniform(-5, 5);
            const double z = random.uniform(-5, 5);
            // Hills of half a metre.
            points.emplace_back(x, 0.5 * std::sin(0.5 * x) * std::sin(0.4 * z) + 0.02 * random.normal(), z);
        }
        const Left left = compare(prepare(z_up(points)), tree);
        EXPECT_GE(left.of_tree, 0.99);
        EXPECT_LE(left.others, 100U);
    }
}

TEST(ScanTough, TheOrderOfThePointsAndTheirCopiesDoNotMatter) {
    const std::vector<Vec3> tree = tree_points(4);
    const Cleaned first = prepare(z_up(tree));
    PointCloud shuffled = z_up(tree);
    shuffle(shuffled, 5);
    EXPECT_EQ(sorted(prepare(shuffled).cloud), sorted(first.cloud));
    std::vector<Vec3> twice = tree;
    twice.insert(twice.end(), tree.begin(), tree.end());
    std::vector<std::array<float, 3>> once = sorted(prepare(z_up(twice)).cloud);
    EXPECT_EQ(once.size(), 2 * first.cloud.size());
    once.erase(std::unique(once.begin(), once.end()), once.end());
    EXPECT_EQ(once, sorted(first.cloud));
}

// A leaf of which the stalk was not seen stays; the same further away goes.
TEST(ScanTough, ASmallPartNearATwigStays) {
    Random random(16);
    const std::vector<Vec3> tree = tree_points(4);
    for (const double gap : {0.6, 2.0}) {
        std::vector<Vec3> points = tree;
        for (int i = 0; i < 40; i++)
            points.emplace_back(DVec3(0.2, 10.0 + gap, 0.1) + 0.05 * random.direction());
        CleanOptions options;
        options.remove_outliers = false;
        PointCloud cloud;
        cloud.positions = points;
        clean_cloud(cloud, options);
        EXPECT_EQ(cloud.size(), gap < 1.0 ? points.size() : tree.size());
    }
}

TEST(ScanTough, MapCoordinatesChangeNothing) {
    const std::vector<Vec3> tree = tree_points(4);
    const Cleaned first = prepare(z_up(tree));
    const Cleaned mapped = prepare(z_up(tree, {455123.0, 5812345.0, 212.0}));
    EXPECT_EQ(sorted(mapped.cloud), sorted(first.cloud));
    EXPECT_EQ(mapped.cloud.frame.origin.y, 5812345.0);
}

TEST(ScanTough, PointsThatAreNoPlacesAreLeftOutAndCounted) {
    const std::vector<Vec3> tree = tree_points(4);
    std::vector<Vec3> points = tree;
    points[0] = Vec3(kNaN, 0.0F, 0.0F);
    points.emplace_back(kInf, 1.0F, 1.0F);
    points.emplace_back(0.0F, 1.0F, -kInf);
    points.emplace_back(1e30F, 1e30F, 1e30F);
    points.emplace_back(0.0F, -3e38F, 0.0F);
    points.emplace_back(1e6F, 0.0F, 0.0F);
    PointCloud cloud;
    cloud.positions = points;
    cloud.normals.assign(points.size(), Vec3(kNaN, 1e30F, kInf));
    cloud.colors.assign(points.size(), Color8{90, 80, 70});
    const OrientOptions upright{UpAxis::kY, 1.0};
    const OrientReport report = orient_cloud(cloud, upright);
    EXPECT_TRUE(says(report.warnings, "6 points have no possible place")) << report.warnings.size();
    EXPECT_EQ(cloud.size(), tree.size() - 1);
    EXPECT_EQ(cloud.colors.size(), cloud.size());
    for (const Vec3& n : cloud.normals)
        ASSERT_TRUE(is_finite(DVec3(n)));
    clean_cloud(cloud, {});
    EXPECT_GE(cloud.size(), tree.size() * 997 / 1000);

    PointCloud nothing;
    nothing.positions.assign(50, Vec3(kNaN));
    EXPECT_THROW(orient_cloud(nothing, {}), Error);
}

TEST(ScanTough, OddColorsBreakNothing) {
    for (int kind = 0; kind < 3; kind++) {
        PointCloud cloud = z_up(tree_points(5));
        Random random(1);
        for (size_t i = 0; i < cloud.size(); i++)
            cloud.colors.push_back(kind == 0   ? Color8{0, 0, 0}
                                   : kind == 1 ? Color8{255, 255, 255}
                                               : Color8{static_cast<uint8_t>(255 * random.below(2)), 0, 0});
        const size_t all = cloud.size();
        EXPECT_GE(prepare(std::move(cloud)).cloud.size(), kind == 2 ? all * 45 / 100 : all * 99 / 100);
    }
}

// --- No room for a tree ------------------------------------------------------------------------------------

// The sentence that check_shape() throws, or nothing.
std::string refusal(const std::vector<Vec3>& points) {
    PointCloud cloud;
    cloud.positions = points;
    try {
        check_shape(cloud);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

TEST(ScanTough, ThreeToTenPoints) {
    Random random(2);
    std::vector<Vec3> points;
    for (size_t count = 1; count <= 10; count++) {
        points.emplace_back(random.uniform(-1, 1), random.uniform(0, 5), random.uniform(-1, 1));
        PointCloud cloud;
        cloud.positions = points;
        orient_cloud(cloud, {});
        clean_cloud(cloud, {});
        EXPECT_EQ(cloud.size(), count);
        EXPECT_EQ(refusal(points).find("needs at least 10") != std::string::npos, count < 10) << count;
    }
    const std::vector<Vec3> copies(5000, Vec3(1.0F, 2.0F, 3.0F));
    EXPECT_NE(refusal(copies).find("only 1 place,"), std::string::npos) << refusal(copies);
    PointCloud cloud;
    cloud.positions = copies;
    orient_cloud(cloud, {});
    clean_cloud(cloud, {});
    EXPECT_EQ(cloud.size(), copies.size());
}

TEST(ScanTough, LinesAndPlanesHoweverTilted) {
    Random random(3);
    for (int round = 0; round < 20; round++) {
        const DVec3 u = random.direction();
        const DVec3 v = any_perpendicular(u);
        const DVec3 w = glm::cross(u, v);
        const double size = std::pow(10.0, random.uniform(-2, 3));
        for (const double thickness : {0.0, 2e-5, 0.01}) {
            SCOPED_TRACE(std::to_string(size) + " " + std::to_string(thickness));
            std::vector<Vec3> line;
            std::vector<Vec3> plane;
            const DVec3 at = random.uniform(0.0, 3.0) * size * random.direction();
            for (int i = 0; i < 3000; i++) {
                const double a = random.uniform(-1, 1);
                const double b = random.uniform(-1, 1);
                const double c = thickness * random.uniform(-1, 1);
                line.emplace_back(at + size * (a * u + c * v + c * w));
                plane.emplace_back(at + size * (a * u + b * v + c * w));
            }
            const bool flat = thickness < 1e-4;
            EXPECT_EQ(refusal(line).find("straight line") != std::string::npos, flat) << refusal(line);
            EXPECT_EQ(refusal(plane).find("one plane") != std::string::npos, flat) << refusal(plane);
            for (const std::vector<Vec3>& points : {line, plane}) {
                PointCloud cloud;
                cloud.positions = points;
                orient_cloud(cloud, {});
                clean_cloud(cloud, {});
                EXPECT_FALSE(cloud.empty());
            }
        }
    }
}

// --- Something else than a tree ----------------------------------------------------------------------------

TEST(ScanTough, SaysThatAWallARoomABallAndNoiseAreNoTree) {
    for (int kind = 0; kind < 6; kind++) {
        SCOPED_TRACE(kind);
        Random random(static_cast<uint64_t>(kind) + 1);
        PointCloud cloud;
        for (int i = 0; i < 12000; i++) {
            DVec3 p(random.uniform(-3, 3), random.uniform(0, 5), random.uniform(-4, 4));
            const DVec3 noise = 0.01 * random.normal() * random.direction();
            if (kind == 0) p.x = 0.0;                   // a wall
            if (kind == 1) p.y = 0.05 * std::sin(p.x);  // the ground
            if (kind == 2 || kind == 3) {               // a room, and one with things in it
                const int side = i % 6;
                if (side < 2) p.x = side == 0 ? -3.0 : 3.0;
                if (side == 2 || side == 3) p.y = side == 2 ? 0.0 : 5.0;
                if (side > 3) p.z = side == 4 ? -4.0 : 4.0;
                if (kind == 3 && i % 5 == 0) p = DVec3(0.7, 0.8, 1.0) + 0.5 * random.direction();
            }
            if (kind == 4) p = DVec3(0, 3, 0) + 2.0 * random.direction();  // a ball; 5: noise
            cloud.positions.emplace_back(p + noise);
        }
        const std::vector<std::string> warnings = check_shape(cloud);
        ASSERT_EQ(warnings.size(), 1U);
        const char* words = kind < 4 ? "flat surfaces" : kind == 4 ? "a ball" : "spread evenly";
        EXPECT_TRUE(says(warnings, words)) << warnings[0];
        EXPECT_TRUE(says(warnings, "hardly a tree")) << warnings[0];
        // And nothing breaks.
        const Cleaned cleaned = prepare(cloud);
        EXPECT_GE(cleaned.cloud.size(), 1000U);
        EXPECT_TRUE(kind == 1 || says(cleaned.warnings, "hardly a tree"));
    }
}

TEST(ScanTough, DoubtsNoRealTree) {
    const std::string folder = scans_folder();
    if (folder.empty()) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    size_t looked_at = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name.ends_with(".laz") || name.find("treehill") != name.npos) continue;
        SCOPED_TRACE(name);
        const Cleaned cleaned = prepare(read_cloud(folder + name));
        EXPECT_FALSE(says(cleaned.warnings, "hardly a tree"));
        EXPECT_FALSE(says(cleaned.warnings, "no possible place"));
        looked_at++;
    }
    EXPECT_GT(looked_at, 20U);
}

// --- Which way is up ---------------------------------------------------------------------------------------

// Never wrong with certainty: turned onto its head or its side, a tree is doubted.
TEST(ScanTough, ATreeOnItsHeadOrItsSideIsDoubted) {
    for (uint64_t seed = 1; seed <= 5; seed++) {
        std::vector<Vec3> points = tree_points(seed);
        std::erase_if(points, [](const Vec3& p) { return p.y > 8.0F; });
        for (const UpAxis up : {UpAxis::kNegZ, UpAxis::kX, UpAxis::kNegX}) {
            for (const bool colors : {false, true}) {
                SCOPED_TRACE(std::string(up_axis_name(up)) + (colors ? " coloured" : ""));
                ScanFrame frame;
                frame.up = up;
                PointCloud cloud;
                for (const Vec3& p : points)
                    cloud.positions.emplace_back(frame.to_scan(DVec3(p)));
                if (colors) cloud.colors.assign(cloud.size(), Color8{90, 80, 70});
                const OrientReport report = orient_cloud(cloud, {});
                if (report.up == up) {
                    EXPECT_TRUE(colors && says(report.warnings, "an unusual axis"));
                } else {
                    EXPECT_TRUE(says(report.warnings, std::string(up_axis_name(up)) + " looks more like"));
                }
            }
        }
    }
}

// A stem with stubs and a long bare top: either end looks like a stem.
std::vector<Vec3> pruned_tree(uint64_t seed) {
    Random random(seed);
    std::vector<Vec3> points;
    add_cylinder(points, random, {0, 0, 0}, {0.1, 4, 0}, 0.09, 0.03, 6000);
    for (int i = 0; i < 7; i++) {
        const double h = 0.85 + 0.22 * i;
        const double angle = 2.4 * i + random.uniform();
        const DVec3 foot(0.025 * h, h, 0.0);
        const double length = i % 3 == 0 ? 1.3 : 0.4;
        add_cylinder(points, random, foot,
                     foot + length * glm::normalize(DVec3(std::cos(angle), 0.3, std::sin(angle))), 0.03, 0.02,
                     static_cast<size_t>(900.0 * length));
    }
    return points;
}

TEST(ScanTough, APrunedTreeIsNotSaidToStandOnItsHead) {
    for (uint64_t seed = 1; seed <= 8; seed++) {
        for (const UpAxis up : {UpAxis::kY, UpAxis::kZ}) {
            SCOPED_TRACE(std::to_string(seed) + " " + up_axis_name(up));
            ScanFrame frame;
            frame.up = up;
            PointCloud cloud;
            for (const Vec3& p : pruned_tree(seed))
                cloud.positions.emplace_back(frame.to_scan(DVec3(p)));
            if (up == UpAxis::kY) cloud.colors.assign(cloud.size(), Color8{90, 80, 70});
            const OrientReport report = orient_cloud(cloud, {});
            EXPECT_EQ(report.up, up);
            EXPECT_FALSE(says(report.warnings, "up axis by hand"));
        }
    }
}

TEST(ScanTough, PrunedTreesFromPhotosAreNotDoubted) {
    const std::string folder = scans_folder();
    if (folder.empty()) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    for (const char* name : {"take6_Yup", "take_outside_Yup", "tree_badheader_Yup"}) {
        SCOPED_TRACE(name);
        PointCloud cloud = read_cloud(folder + "sfm_pear_" + name + ".ply");
        const OrientReport report = orient_cloud(cloud, {});
        EXPECT_EQ(report.up, UpAxis::kY);
        EXPECT_FALSE(says(report.warnings, "up axis by hand"));
    }
}

TEST(ScanTough, RealTreesAreNotDoubtedUprightButOnTheirHeads) {
    const std::string folder = scans_folder();
    if (folder.empty()) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    size_t trees = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        // Branches and pruned trees look alike from both ends, and maps are Z up.
        const bool tree = name.starts_with("wytham") || name.starts_with("adtree_tree") ||
                          name.starts_with("adtree_Lille") || name.starts_with("voxr") ||
                          name.starts_with("ryu") || name.starts_with("rtls") || name.starts_with("archi");
        if (!tree) continue;
        SCOPED_TRACE(name);
        PointCloud upright = read_cloud(folder + name);
        PointCloud on_its_head = upright;
        for (Vec3& p : on_its_head.positions)
            p = Vec3(p.x, -p.y, -p.z);
        EXPECT_FALSE(says(orient_cloud(upright, {}).warnings, "up axis by hand"));
        EXPECT_TRUE(says(orient_cloud(on_its_head, {}).warnings, "up axis by hand"));
        trees++;
    }
    EXPECT_GE(trees, 12U);
}

}  // namespace
}  // namespace treerec
