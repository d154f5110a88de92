#include <gtest/gtest.h>
#ifndef _WIN32
#include <unistd.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "error.h"
#include "exchange/tree_files.h"
#include "fidelity/score.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "pipeline/export.h"
#include "pipeline/reconstruct.h"
#include "pipeline/report.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// A small tree, scanned, in a folder of its own.
class Pipeline : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  ("treerec_pipeline_" + std::to_string(::getpid()) + "_" +
                   std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        truth_ = grow_tree({Habit::kBroadleaf, 5.0, 3});
        VirtualScanOptions options;
        options.points = 8000;
        cloud_ = scan_tree(truth_, options).cloud;
        write_cloud(path("scan.ply"), cloud_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    fs::path folder_;
    Tree truth_;
    PointCloud cloud_;
};

class Recorder : public Progress {
  public:
    explicit Recorder(double cancel_at = 2.0) : cancel_at_(cancel_at) {}
    void update(double fraction, const char* stage) override {
        if (fraction < last_ - 1e-9) fell_ = true;
        last_ = fraction;
        stages_.insert(stage);
    }
    bool cancelled() const override { return last_ >= cancel_at_; }

    double last_ = 0.0;
    bool fell_ = false;
    std::set<std::string> stages_;

  private:
    double cancel_at_;
};

TEST_F(Pipeline, FindsTheTreeThatWasScanned) {
    Recorder progress;
    const Reconstruction result = reconstruct_file(path("scan.ply"), {}, &progress);
    EXPECT_FALSE(progress.fell_);
    EXPECT_GE(progress.last_, 0.99);
    EXPECT_GE(progress.stages_.size(), 4u);
    EXPECT_EQ(result.points_read, 8000u);
    EXPECT_EQ(result.tree.check().value_or("sound"), "sound");
    EXPECT_EQ(result.raw.check().value_or("sound"), "sound");
    EXPECT_LT(glm::length(result.tree.node(result.tree.root()).position), 1e-9);
    const Measurements found = measure(result.tree), wanted = measure(truth_);
    EXPECT_NEAR(found.height, wanted.height, 0.1 * wanted.height);
    EXPECT_NEAR(found.dbh, wanted.dbh, 0.15 * wanted.dbh);
    const SkeletonScore score = score_skeleton(result.tree, truth_);
    EXPECT_GT(score.by_distance[5].precision, 0.7);
    EXPECT_GT(score.by_distance[5].recall, 0.4);
}

TEST_F(Pipeline, ItsHalvesAndPartsMadeAheadMakeTheSame) {
    const Reconstruction whole = reconstruct_file(path("scan.ply"), {});
    Reconstruction halves = reconstruct_tree(path("scan.ply"), {});
    EXPECT_EQ(halves.measured.nodes, 0u);
    TreeExporter exporter(halves.tree, {});
    exporter.prepare({path("halves.txt"), path("halves.glb")});
    score_reconstruction(halves, {});
    EXPECT_EQ(halves.warnings, whole.warnings);
    EXPECT_EQ(halves.fit.mean_mm, whole.fit.mean_mm);
    EXPECT_EQ(halves.measured.crown_radius, whole.measured.crown_radius);
    EXPECT_EQ(halves.stages.size(), whole.stages.size());
    TreeExporter at_once(whole.tree, {});
    for (const char* name : {".txt", ".glb"}) {
        exporter.write(path("halves") + name);
        at_once.write(path("whole") + name);
        EXPECT_EQ(bytes_of(path("halves") + name), bytes_of(path("whole") + name)) << name;
    }
}

TEST_F(Pipeline, ASpacingThatTheScanTellsIsTaken) {
    cloud_.frame.metres_per_unit = 0.5;
    cloud_.spacing = 0.1;  // of the file's units: 5 cm
    write_cloud(path("told.ply"), cloud_);
    ReconstructOptions options;
    options.orient.metres_per_unit = 0.5;
    const Reconstruction told = reconstruct_file(path("told.ply"), options);
    EXPECT_NEAR(told.spacing, 0.05, 1e-9);
    options.skeleton.spacing = 0.03;  // the user knows better
    EXPECT_NEAR(reconstruct_file(path("told.ply"), options).spacing, 0.03, 1e-9);
    // Nonsense is not believed.
    const Reconstruction plain = reconstruct_file(path("scan.ply"), {});
    cloud_.frame.metres_per_unit = 1.0;
    cloud_.spacing = 3.0;
    write_cloud(path("nonsense.ply"), cloud_);
    EXPECT_EQ(reconstruct_file(path("nonsense.ply"), {}).spacing, plain.spacing);
}

TEST_F(Pipeline, TheCloudLiesOnTheTreeInTheTreesFrame) {
    const Reconstruction result = reconstruct_file(path("scan.ply"), {});
    EXPECT_EQ(result.cloud.frame, result.tree.frame());
    EXPECT_EQ(result.raw.frame(), result.tree.frame());
    EXPECT_LT(score_scan(result.tree, result.cloud).median_mm, 15.0);
    // In scan coordinates it is still the cloud that was written.
    Bounds before, after;
    for (const Vec3& p : cloud_.positions)
        before.add(cloud_.frame.to_scan(DVec3(p)));
    for (const Vec3& p : result.cloud.positions)
        after.add(result.cloud.frame.to_scan(DVec3(p)));
    for (int axis = 0; axis < 3; axis++) {
        EXPECT_GE(after.min[axis], before.min[axis] - 1e-4);
        EXPECT_LE(after.max[axis], before.max[axis] + 1e-4);
    }
}

TEST_F(Pipeline, SameBytesWhateverTheThreadsAndTheOrderOfThePoints) {
    std::vector<std::string> files;
    Random random(3);
    for (int threads : {1, 2, 5}) {
        set_thread_count(threads);
        const Reconstruction result = reconstruct_file(path("scan.ply"), {});
        TreeExporter exporter(result.tree, {});
        for (const char* name : {"t.txt", "t.glb", "t.obj"}) {
            exporter.write(path(name));
            files.push_back(bytes_of(path(name)));
        }
        // The same points in another order for the next round.
        for (size_t i = cloud_.size(); i > 1; i--) {
            const size_t j = random.below(static_cast<uint32_t>(i));
            std::swap(cloud_.positions[i - 1], cloud_.positions[j]);
            std::swap(cloud_.colors[i - 1], cloud_.colors[j]);
        }
        write_cloud(path("scan.ply"), cloud_);
    }
    set_thread_count(0);
    for (size_t i = 3; i < files.size(); i++)
        EXPECT_TRUE(files[i] == files[i % 3]) << "file " << i;
}

// What `prune` does to the tree that comes without.
TEST_F(Pipeline, LongTwigsAreCutAtLast) {
    const Reconstruction plain = reconstruct_tree(path("scan.ply"), {});
    for (const bool spared : {false, true}) {
        ReconstructOptions options;
        options.prune.emplace();
        options.prune->spare_leader = spared;
        const Reconstruction pruned = reconstruct_tree(path("scan.ply"), options);
        Tree expected = plain.tree;
        EXPECT_EQ(prune_twigs(expected, *options.prune).nodes.size(), pruned.pruned);
        EXPECT_GT(pruned.pruned, 0u);
        ASSERT_EQ(pruned.tree.size(), expected.size());
        ASSERT_EQ(pruned.tree.check(), std::nullopt);
        const std::vector<NodeId> there = expected.depth_first(), here = pruned.tree.depth_first();
        for (size_t i = 0; i < here.size(); i++)
            ASSERT_EQ(pruned.tree.node(here[i]).position, expected.node(there[i]).position);
    }
}

// A rule gives radii to the wood that is left, none of which counts as measured; what was cut has no say.
TEST_F(Pipeline, ARuleOfRadiiIsForThePrunedTree) {
    const Reconstruction plain = reconstruct_tree(path("scan.ply"), {});
    for (const RadiusRule rule : {RadiusRule::kLinear, RadiusRule::kDaVinci}) {
        ReconstructOptions options;
        options.prune.emplace();
        options.prune->spare_leader = false;
        options.radii = rule;
        const Reconstruction both = reconstruct_tree(path("scan.ply"), options);
        Tree expected = plain.tree;
        prune_twigs(expected, *options.prune);
        expected = expected.compacted();
        apply_radius_rule(expected, rule);
        EXPECT_EQ(both.tree.check(), std::nullopt);
        ASSERT_EQ(both.tree.size(), expected.size());
        EXPECT_LT(both.tree.size(), plain.tree.size());
        for (const NodeId id : expected.depth_first()) {
            ASSERT_EQ(both.tree.node(id).position, expected.node(id).position);
            ASSERT_EQ(both.tree.node(id).radius, expected.node(id).radius);
            ASSERT_FALSE(both.tree.node(id).is_measured());
        }
        // Pruning goes by nodes, so that the rule has no say in it either.
        Tree ruled = plain.tree;
        apply_radius_rule(ruled, rule);
        EXPECT_EQ(prune_twigs(ruled, *options.prune).nodes.size(), both.pruned);
    }
}

TEST_F(Pipeline, ASkeletonIsNoCloud) {
    for (const char* name : {"truth.ply", "truth.txt", "truth.csv"}) {
        export_tree(path(name), truth_, leaf_preset("none"), 1);
        try {
            reconstruct_file(path(name), {});
            ADD_FAILURE() << name;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("is a skeleton"), std::string::npos) << error.what();
        }
    }
    EXPECT_THROW(reconstruct_file(path("missing.ply"), {}), Error);
}

// The middle of its walls' base is empty, so no point is near it.
TEST_F(Pipeline, AHouseStillHasARoot) {
    Random random(6);
    PointCloud house;
    for (int i = 0; i < 3000; i++) {
        const double u = random.uniform(), v = random.uniform();
        for (const DVec3& p :
             {DVec3(10 * u, 0, 5 * v), DVec3(10 * u, 8, 5 * v), DVec3(0, 8 * u, 5 * v),
              DVec3(10, 8 * u, 5 * v), DVec3(10 * u, 4 * v, 5 + 3 * v), DVec3(10 * u, 8 - 4 * v, 5 + 3 * v),
              DVec3(20 * u - 5, 18 * v - 5, 0), DVec3(20 * v - 5, 18 * u - 5, 0)})
            house.positions.emplace_back(p);
    }
    write_cloud(path("house.ply"), house);
    const Reconstruction result = reconstruct_file(path("house.ply"), {});
    EXPECT_EQ(result.tree.check().value_or("sound"), "sound");
    EXPECT_LT(measure(result.tree).height, 9.0);
}

TEST_F(Pipeline, ABallIsDoubted) {
    const auto doubts = [](const Reconstruction& result) {
        return std::ranges::count_if(result.warnings, [](const std::string& warning) {
            return warning.find("Is it a tree?") != std::string::npos;
        });
    };
    EXPECT_EQ(doubts(reconstruct_file(path("scan.ply"), {})), 0);
    Random random(5);
    PointCloud ball;
    for (int i = 0; i < 8000; i++)
        ball.positions.emplace_back(3.0 * random.direction());
    write_cloud(path("ball.ply"), ball);
    EXPECT_EQ(doubts(reconstruct_file(path("ball.ply"), {})), 1);
}

TEST_F(Pipeline, TheReportIsCompleteAndFinite) {
    const Reconstruction result = reconstruct_file(path("scan.ply"), {});
    TreeExporter exporter(result.tree, {});
    ReportDetails details;
    details.scan_path = "odd \xff name";
    details.triangles = exporter.triangles();
    details.leaf_count = exporter.leaves();
    const nlohmann::json report = nlohmann::json::parse(report_json(result, details));
    for (const char* key :
         {"format_version",  "version",        "scan",           "scan_format",  "seed",
          "options",         "points_read",    "points",         "removed",      "up",
          "metres_per_unit", "origin",         "spacing_m",      "stages",       "total_ms",
          "peak_mb",         "nodes",          "tips",           "branches",     "height_m",
          "dbh_m",           "stems",          "crown_radius_m", "crown_base_m", "length_m",
          "volume_m3",       "measured_share", "triangles",      "leaves",       "warnings"})
        EXPECT_TRUE(report.contains(key)) << key;
    EXPECT_EQ(report["nodes"], result.tree.size());
    EXPECT_GT(report["triangles"], 100);
    EXPECT_GT(report["leaves"], 10);
    EXPECT_GT(report["height_m"], 3.0);
    EXPECT_GE(report["stages"].size(), 4u);
    double total = 0.0;
    for (const auto& stage : report["stages"])
        total += stage["ms"].get<double>();
    EXPECT_NEAR(report["total_ms"].get<double>(), total, 1e-6);
}

TEST_F(Pipeline, WritesEveryFormat) {
    const Reconstruction result = reconstruct_file(path("scan.ply"), {});
    TreeExporter exporter(result.tree, {});
    for (const char* name : {"t.glb", "t.gltf", "t.obj", "t.ply", "t.txt", "t.csv", "UPPER.GLB"}) {
        EXPECT_NO_THROW(require_writable_format(path(name)));
        exporter.write(path(name));
        EXPECT_GT(fs::file_size(path(name)), 1000u) << name;
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
        EXPECT_NE(entry.path().extension(), ".part");
    EXPECT_THROW(exporter.write(path("t.fbx")), Error);
    EXPECT_THROW(require_writable_format(path("t")), Error);
    EXPECT_THROW(require_writable_format(path("none/t.glb")), Error);
    EXPECT_THROW(exporter.write(path("none/t.glb")), Error);
    EXPECT_THROW(TreeExporter(Tree(), {}).write(path("e.glb")), Error);
    // The skeleton is where the scan is, and the same in both files.
    EXPECT_EQ(score_skeleton(read_skeleton(path("t.ply")), read_skeleton(path("t.txt"))).by_radius[0].f, 1.0);
    EXPECT_GT(score_skeleton(read_skeleton(path("t.txt")), truth_).by_distance[5].f, 0.4);
}

TEST_F(Pipeline, CanBeCancelledAtAnyTime) {
    for (double at : {0.0, 0.05, 0.12, 0.2, 0.4, 0.7}) {
        Recorder progress(at);
        EXPECT_THROW(reconstruct_file(path("scan.ply"), {}, &progress), Cancelled) << at;
    }
}

// Slow: only on request, with the scans at hand. Every scan finishes in a sound tree.
TEST(PipelineOnScans, ABirchOf46kPointsHasItsTapedHeightAndDbh) {
    const char* scans = std::getenv("TREEREC_SCANS");
    if (!scans) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of scans";
    const fs::path file = fs::path(scans) / "clouds" / "wytham_Tf18_birch.txt";
    if (!fs::exists(file)) GTEST_SKIP() << "there is no " << file;
    const Reconstruction result = reconstruct_file(file.string(), {});
    EXPECT_EQ(result.tree.check().value_or("sound"), "sound");
    const Measurements m = measure(result.tree);
    EXPECT_GT(m.height, 10.0);
    EXPECT_GT(m.dbh, 0.08);
    EXPECT_LT(m.dbh, 0.35);
    EXPECT_LT(score_scan(result.tree, result.cloud).median_mm, 15.0);
}

// Fronds that hang around the stem hid it once, and every rib became a branch.
TEST_F(Pipeline, APalmIsOneStem) {
    for (const uint64_t seed : {1, 2, 3, 4}) {
        SCOPED_TRACE(seed);
        const Tree palm = grow_tree({Habit::kPalm, 0.0, seed});
        VirtualScanOptions options = scan_options_for(Habit::kPalm);
        options.seed = seed;
        write_cloud(path("palm.ply"), scan_tree(palm, options).cloud);
        const Measurements measured = measure(palm);
        for (const SkeletonMethod method : {SkeletonMethod::kGeodesic, SkeletonMethod::kFlood}) {
            ReconstructOptions how;
            how.skeleton.method = method;
            const Reconstruction made = reconstruct_file(path("palm.ply"), how, nullptr);
            EXPECT_EQ(made.tree.nodes_of_kind(NodeKind::kLeaf).size(), 1u);
            EXPECT_NEAR(made.measured.total_length, measured.total_length, 0.05 * measured.total_length);
            EXPECT_NEAR(made.measured.dbh, measured.dbh, 0.03 * measured.dbh);
            EXPECT_GT(made.fit.explained_2cm, 0.95);
            EXPECT_GT(made.foliage.reach, 1.0);
            EXPECT_EQ(chosen_leaves("auto", made), "palm");
            EXPECT_EQ(chosen_leaves("oak", made), "oak");
            EXPECT_LT(suited_leaves("palm", made).leaf_size, made.foliage.reach);
        }
    }
}

// Voxels much finer than the points lie apart cut wood to pieces.
TEST_F(Pipeline, VoxelsThatAreTooFineAreToldOf) {
    ReconstructOptions how;
    how.skeleton.method = SkeletonMethod::kFlood;
    const auto told = [&](double voxel) {
        how.skeleton.voxel = voxel;
        const std::vector<std::string> warnings = reconstruct_file(path("scan.ply"), how, nullptr).warnings;
        return std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
            return warning.starts_with("The voxels are finer");
        });
    };
    EXPECT_TRUE(told(0.002));
    EXPECT_FALSE(told(0.0));
}

TEST_F(Pipeline, LeavesBecomeFoliageAndTheSkeletonFollowsWood) {
    const Tree grown = grow_tree({Habit::kBirch, 8.0, 4});
    VirtualScanOptions options;
    options.points = 60000;
    options.leaves = 0.8;
    write_cloud(path("leafy.ply"), scan_tree(grown, options).cloud);
    const Reconstruction leafy = reconstruct_file(path("leafy.ply"), {});
    EXPECT_FALSE(leafy.foliage.empty());
    EXPECT_TRUE(leafy.foliage.colored);
    EXPECT_GT(leafy.leaf_points, leafy.cloud.size() / 2);
    EXPECT_LT(leafy.leaf_points, leafy.cloud.size());
    // In the tree's own frame.
    const Bounds bounds = leafy.tree.bounds();
    for (const FoliageCell& cell : leafy.foliage.cells)
        for (int axis = 0; axis < 3; axis++) {
            EXPECT_GT(leafy.foliage.centre(cell)[axis], bounds.min[axis] - 1.0);
            EXPECT_LT(leafy.foliage.centre(cell)[axis], bounds.max[axis] + 1.0);
        }
    EXPECT_NEAR(measure(leafy.tree).height, measure(grown).height, 0.05 * measure(grown).height);

    ReconstructOptions all_wood;
    all_wood.tell_leaves = false;
    const Reconstruction plain = reconstruct_file(path("leafy.ply"), all_wood);
    EXPECT_TRUE(plain.foliage.empty());
    EXPECT_EQ(plain.leaf_points, 0u);
    EXPECT_LT(leafy.tree.size(), plain.tree.size());

    const Reconstruction bare = reconstruct_file(path("scan.ply"), {});
    EXPECT_TRUE(bare.foliage.empty());
    EXPECT_EQ(bare.leaf_points, 0u);
}

}  // namespace
}  // namespace treerec
