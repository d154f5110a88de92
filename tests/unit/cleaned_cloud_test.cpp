// The cleaned cloud as a file: it lies where the scan lies, and holds what was kept of it.
#include "pipeline/cleaned_cloud.h"

#include <cmath>

#include "cli_runner.h"
#include "scan_samples.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec {
namespace {

using namespace scan_test;

// With whatever a cloud may have, anywhere, in any frame.
PointCloud any_cloud(Random& random) {
    constexpr double kOffsets[] = {0.0, 1.0, -431.5, 455123.4, 5812345.67, -2e7};
    const auto offset = [&] { return kOffsets[random.below(6)]; };
    const DVec3 centre(offset(), offset(), offset());
    const double size = std::pow(10.0, random.uniform(-1.0, 2.0));
    PointCloud cloud = random_cloud(random.below(1000000), 1 + random.below(300), centre, size,
                                    random.below(2) == 0, random.below(2) == 0);
    cloud.frame.metres_per_unit = random.below(2) == 0 ? 1.0 : 0.3048;
    cloud.frame.up = static_cast<UpAxis>(random.below(6));
    if (random.below(2) == 0) cloud.frame.set_sky(random.direction());
    if (random.below(2) == 0) cloud.spacing = random.uniform(1e-4, 0.1);
    if (random.below(3) == 0) return cloud;
    cloud.labels.column = random.below(2) == 0 ? "classification" : "Pred. label";
    cloud.labels.leaf_is_one = random.below(2) == 0;
    for (size_t i = 0; i < cloud.size(); i++)
        cloud.labels.values.push_back(static_cast<uint8_t>(random.below(cloud.labels.leaf_is_one ? 2 : 256)));
    return cloud;
}

TEST(CleanedCloud, IsReadAsItWasWritten) {
    const Folder folder;
    Random random(11);
    for (int round = 0; round < test::cases(600); round++) {
        SCOPED_TRACE(round);
        const PointCloud cloud = any_cloud(random);
        const std::string name = round % 4 == 3 ? "a.xyz" : "a.ply";
        const bool ply = name == "a.ply";
        write_cleaned_cloud(folder.file(name), cloud);
        EXPECT_EQ(bytes_of(folder.file(name)).substr(0, 4096).find(kCleanedMark) != std::string::npos, ply);
        ReadCloudReport report;
        const PointCloud back = read_cloud(folder.file(name), {}, &report);
        EXPECT_TRUE(report.warnings.empty()) << report.warnings.front();
        ASSERT_EQ(back.size(), cloud.size());
        EXPECT_EQ(back.colors, cloud.colors);
        EXPECT_EQ(back.spacing, ply ? cloud.spacing : 0.0);
        EXPECT_EQ(back.labels.values, cloud.labels.values);
        EXPECT_EQ(back.labels.leaf_is_one, cloud.labels.leaf_is_one);
        ASSERT_EQ(back.has_normals(), cloud.has_normals());
        double extent = 1e-3;
        for (size_t i = 0; i < cloud.size(); i++)
            extent = std::max(extent, glm::length(scan_point(cloud, i) - scan_point(cloud, 0)));
        // What floats resolve of the extent, and doubles of the place.
        const double tolerance = 4e-7 * extent + 4e-16 * glm::length(cloud.frame.origin);
        for (size_t i = 0; i < cloud.size(); i++) {
            ASSERT_TRUE(is_finite(scan_point(back, i)));
            expect_point(back, i, scan_point(cloud, i), tolerance);
            if (!cloud.has_normals()) continue;
            const DVec3 turned = cloud.frame.turn_to_scan(DVec3(cloud.normals[i]));
            EXPECT_LE(glm::length(DVec3(back.normals[i]) - turned), 1e-6);
        }
    }
}

class OfATree : public test::Cli {
  protected:
    static constexpr double kBase = 0.3048;  // the scan's unit

    // A leafy birch on a map, in feet, Z up, with normals, dust, and ground beside it.
    void SetUp() override {
        Cli::SetUp();
        if (IsSkipped()) return;
        VirtualScanOptions options;
        options.points = 40000;
        options.leaves = 0.8;
        options.stray = 0.002;
        PointCloud scan = scan_tree(grow_tree({Habit::kBirch, 8.0, 4}), options).cloud;
        Random random(3);
        for (int i = 0; i < 8000; i++) {
            scan.positions.emplace_back(random.uniform(-4, 4), random.uniform(-0.02, 0.02),
                                        random.uniform(-4, 4));
            scan.colors.push_back({90, 80, 60});
        }
        for (size_t i = 0; i < scan.size(); i++)
            scan.normals.emplace_back(random.direction());
        scan.frame.up = UpAxis::kZ;
        scan.frame.metres_per_unit = kBase;
        scan.frame.origin = DVec3(1455123.4, 5812345.67, 312.3);
        write_cloud(path("scan.ply"), scan);
        scan_ = read_cloud(path("scan.ply"));
    }

    // Whether each point is one of the scan's, in its order, with its colour and normal.
    void expect_part_of_scan(const PointCloud& cloud, size_t count) const {
        ASSERT_EQ(cloud.size(), count);
        ASSERT_TRUE(cloud.has_colors() && cloud.has_normals());
        size_t at = 0;
        for (size_t i = 0; i < cloud.size(); i++) {
            const DVec3 p = scan_point(cloud, i);
            while (at < scan_.size() && glm::length(scan_point(scan_, at) - p) > 2e-5)
                at++;
            ASSERT_LT(at, scan_.size()) << i << " is no point of the scan";
            ASSERT_EQ(cloud.colors[i], scan_.colors[at]);
            ASSERT_LE(glm::length(DVec3(cloud.normals[i] - scan_.normals[at])), 1e-5);
            at++;
        }
    }

    PointCloud scan_;
};

TEST_F(OfATree, TheProgramWritesWhatItKept) {
    const std::string how = "reconstruct scan.ply --unit ft --cloud ";
    const test::Outcome made = run(how + "out/clean.ply");
    ASSERT_EQ(made.code, 0) << made.error;
    EXPECT_NE(made.out.find("wrote out/clean.ply"), std::string::npos) << made.out;
    ReconstructOptions options;
    options.orient.metres_per_unit = kBase;
    Reconstruction result = reconstruct_tree(path("scan.ply"), options);
    ASSERT_LT(result.cloud.size() + 6000, scan_.size()) << "the ground is still there";
    const PointCloud cloud = read_cloud(path("out/clean.ply"));
    expect_part_of_scan(cloud, result.cloud.size());
    // Leaves are those of the reconstruction.
    ASSERT_FALSE(result.wood.empty());
    label_found_leaves(result);
    EXPECT_EQ(cloud.labels.column, "leaf");
    EXPECT_EQ(cloud.labels.values, result.cloud.labels.values);
    // Alone, and as text.
    ASSERT_EQ(run(how + "out/clean.xyz --quiet").code, 0);
    const PointCloud text = read_cloud(path("out/clean.xyz"));
    expect_part_of_scan(text, result.cloud.size());
    EXPECT_EQ(text.labels.values, cloud.labels.values);
    // And from the tree, when it was made before.
    save_cleaned_scan(path("out/again.ply"), path("scan.ply"), options, result.tree.frame(), result.foliage);
    const PointCloud again = read_cloud(path("out/again.ply"));
    expect_part_of_scan(again, again.size());
    EXPECT_NEAR(static_cast<double>(again.size()), static_cast<double>(cloud.size()), 100.0);
    size_t leaves = 0;
    for (const uint8_t label : again.labels.values)
        leaves += label;
    EXPECT_NEAR(static_cast<double>(leaves), static_cast<double>(result.leaf_points),
                0.1 * static_cast<double>(again.size()));
}

TEST_F(OfATree, NothingElseIsWrittenOver) {
    const std::string scan = get("scan.ply");
    const auto refused = [&](const std::string& words, const std::string& part) {
        const test::Outcome outcome = run("reconstruct " + words + " --quiet");
        EXPECT_EQ(outcome.code, 2) << words;
        EXPECT_NE(outcome.error.find(part), std::string::npos) << words << ": " << outcome.error;
        EXPECT_TRUE(out_is_empty()) << words;
    };
    refused("scan.ply --cloud scan.ply", "the scan itself");
    refused("scan.ply --cloud ./scan.ply", "the scan itself");
    refused("scan.ply --cloud out/a.ply -o out/a.ply", "twice");
    refused("scan.ply --cloud out/clean.glb", "no name for a point cloud");
    refused("scan.ply --cloud out", "no name for a point cloud");
    refused("scan.ply --cloud none/clean.ply", "no folder");
    put("other.ply", scan);
    refused("scan.ply --cloud other.ply", "no cloud that treerec has cleaned");
    EXPECT_EQ(get("other.ply"), scan);
    put("notes.txt", "1 2 3");
    refused("scan.ply --cloud notes.txt", "does not tell");
    EXPECT_EQ(get("notes.txt"), "1 2 3");
    EXPECT_EQ(get("scan.ply"), scan);
    EXPECT_THROW(save_cleaned_scan(path("scan.ply"), path("scan.ply"), {}, {}, {}), Error);
    EXPECT_EQ(get("scan.ply"), scan);
    // Ours is.
    for (int time = 0; time < 2; time++)
        EXPECT_EQ(run("reconstruct scan.ply --unit ft --cloud out/clean.ply --quiet").code, 0);
}

// A cancel leaves what was there.
TEST_F(OfATree, CanBeCancelled) {
    class Stop final : public Progress {
      public:
        void update(double fraction, const char*) override { at_ = fraction; }
        bool cancelled() const override { return at_ >= 0.9; }

      private:
        double at_ = 0.0;
    };
    put("out/clean.ply", "mine");
    Stop stop;
    ScanFrame frame;
    frame.up = UpAxis::kZ;
    frame.metres_per_unit = kBase;
    frame.origin = DVec3(1455123.4, 5812345.67, 312.3);
    EXPECT_THROW(save_cleaned_scan(path("out/clean.ply"), path("scan.ply"), {}, frame, {}, &stop), Cancelled);
    EXPECT_EQ(get("out/clean.ply"), "mine");
}

}  // namespace
}  // namespace treerec
