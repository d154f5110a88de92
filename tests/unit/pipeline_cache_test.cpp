// Reconstructing a scan again with other options, and loading it beside its tree.
#include <gtest/gtest.h>
#ifndef _WIN32
#include <unistd.h>
#endif

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "edit/delta.h"
#include "error.h"
#include "exchange/tree_files.h"
#include "geometry/random.h"
#include "pipeline/reconstruct.h"
#include "pipeline/report.h"
#include "scan/cleaning/thin_cloud.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec {
namespace {

namespace fs = std::filesystem;

class PipelineCache : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  ("treerec_cache_" + std::to_string(::getpid()) + "_" +
                   std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        VirtualScanOptions options;
        options.points = 9000;
        cloud_ = scan_tree(grow_tree({Habit::kBroadleaf, 5.0, 3}), options).cloud;
        // Somewhere on a map, with colours.
        cloud_.frame.origin += DVec3(443210.25, 5431234.5, 312.0);
        Random random(1);
        cloud_.colors.clear();
        for (size_t i = 0; i < cloud_.size(); i++)
            cloud_.colors.push_back({uint8_t(random.below(200) + 20), uint8_t(random.below(200) + 20), 90});
        write_cloud(path("scan.ply"), cloud_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    fs::path folder_;
    PointCloud cloud_;
};

class CancelAt : public Progress {
  public:
    explicit CancelAt(double at) : at_(at) {}
    void update(double fraction, const char*) override { last_ = fraction; }
    bool cancelled() const override { return last_ >= at_; }

  private:
    double at_, last_ = 0.0;
};

// All that the report tells but the times.
std::string told(const Reconstruction& result, const ReconstructOptions& options) {
    ReportDetails details;
    details.options = options;
    nlohmann::json json = nlohmann::json::parse(report_json(result, details));
    json.erase("total_ms");
    json.erase("peak_mb");
    for (nlohmann::json& stage : json["stages"]) {
        stage.erase("ms");
        stage.erase("kept");
    }
    return json.dump(1);
}

void expect_same(const Reconstruction& a, const Reconstruction& b, const ReconstructOptions& options) {
    EXPECT_TRUE(identical(a.tree, b.tree));
    EXPECT_TRUE(identical(a.raw, b.raw));
    EXPECT_EQ(a.foliage, b.foliage);
    EXPECT_EQ(a.cloud.positions, b.cloud.positions);
    EXPECT_EQ(a.cloud.colors, b.cloud.colors);
    EXPECT_EQ(a.cloud.frame, b.cloud.frame);
    EXPECT_EQ(a.wood, b.wood);
    EXPECT_EQ(a.warnings, b.warnings);
    EXPECT_EQ(told(a, options), told(b, options));
}

std::string kept_stages(const Reconstruction& result) {
    std::string names;
    for (const StageTime& stage : result.stages)
        if (stage.kept) names += stage.name + " ";
    return names;
}

TEST_F(PipelineCache, ARunThatKeepsStagesGivesWhatAFreshOneGives) {
    using Change = std::function<void(ReconstructOptions&)>;
    const std::vector<std::pair<Change, std::string>> changes = {
        {[](ReconstructOptions&) {}, ""},
        {[](ReconstructOptions&) {}, "Read Orient Clean Leaves "},
        {[](ReconstructOptions& o) { o.skeleton.simplify_distance = 0.03; }, "Read Orient Clean Leaves "},
        {[](ReconstructOptions& o) { o.skeleton.seed = 7; }, "Read Orient Clean Leaves "},
        {[](ReconstructOptions& o) { o.tell_leaves = false; }, "Read Orient Clean "},
        {[](ReconstructOptions& o) { o.tell_leaves = true; }, "Read Orient Clean Leaves "},
        {[](ReconstructOptions& o) { o.clean.remove_fragments = false; }, "Read "},
        {[](ReconstructOptions& o) { o.clean.outlier_deviations = 2.0; }, "Read "},
        {[](ReconstructOptions& o) { o.skeleton.method = SkeletonMethod::kFlood; },
         "Read Orient Clean Leaves "},
        {[](ReconstructOptions& o) { o.orient.known_height = 7.5; }, "Read "},
        {[](ReconstructOptions& o) { o.complete = true; }, "Read Orient Clean Leaves "},
        {[](ReconstructOptions& o) {
             o.orient = {};
             o.orient.up = UpAxis::kZ;
         },
         "Read "},
        {[](ReconstructOptions& o) {
             o.read.columns = {"x", "y", "z"};
         },
         ""},
        {[](ReconstructOptions& o) { o.clean.pick.position = DVec3(443210, 5431234, 312); }, "Read "},
    };
    ReconstructCache cache;
    ReconstructOptions options;
    size_t step = 0;
    for (const auto& [change, kept] : changes) {
        SCOPED_TRACE(step++);
        change(options);
        const Reconstruction again = reconstruct_file(path("scan.ply"), options, nullptr, &cache);
        EXPECT_EQ(kept_stages(again), kept);
        expect_same(again, reconstruct_file(path("scan.ply"), options), options);
    }
    EXPECT_GT(cache.bytes(), 2 * 5000 * sizeof(Vec3));
}

TEST_F(PipelineCache, AnotherFileOrANewVersionOfItIsReadAgain) {
    ReconstructCache cache;
    reconstruct_file(path("scan.ply"), {}, nullptr, &cache);
    fs::copy_file(path("scan.ply"), path("other.ply"));
    EXPECT_EQ(kept_stages(reconstruct_file(path("other.ply"), {}, nullptr, &cache)), "");
    EXPECT_EQ(kept_stages(reconstruct_file(path("other.ply"), {}, nullptr, &cache)),
              "Read Orient Clean Leaves ");
    const auto before = fs::last_write_time(path("other.ply"));
    PointCloud half = cloud_;
    std::vector<uint8_t> keep(half.size());
    for (size_t i = 0; i < keep.size(); i++)
        keep[i] = i % 2;
    half.keep_only(keep);
    write_cloud(path("other.ply"), half);
    fs::last_write_time(path("other.ply"), before);
    Reconstruction result = reconstruct_file(path("other.ply"), {}, nullptr, &cache);
    EXPECT_EQ(kept_stages(result), "") << "another size";
    EXPECT_EQ(result.points_read, 4500u);
    fs::last_write_time(path("other.ply"), before + std::chrono::seconds(2));
    EXPECT_EQ(kept_stages(reconstruct_file(path("other.ply"), {}, nullptr, &cache)), "") << "another time";
    fs::remove(path("other.ply"));
    EXPECT_THROW(reconstruct_file(path("other.ply"), {}, nullptr, &cache), Error);
}

TEST_F(PipelineCache, AJobThatStopsHalfwayLeavesOnlyWholeStages) {
    const ReconstructOptions options;
    const Reconstruction fresh = reconstruct_file(path("scan.ply"), options);
    for (const double at : {0.0, 0.05, 0.12, 0.2, 0.35, 0.5, 0.9}) {
        SCOPED_TRACE(at);
        ReconstructCache cache;
        CancelAt stop(at);
        EXPECT_THROW(reconstruct_file(path("scan.ply"), options, &stop, &cache), Cancelled);
        expect_same(reconstruct_file(path("scan.ply"), options, nullptr, &cache), fresh, options);
        // And in the middle of a job with other options.
        ReconstructOptions other;
        other.clean.remove_outliers = false;
        CancelAt again(at);
        EXPECT_THROW(reconstruct_file(path("scan.ply"), other, &again, &cache), Cancelled);
        expect_same(reconstruct_file(path("scan.ply"), options, nullptr, &cache), fresh, options);
    }
}

TEST_F(PipelineCache, TheScanLiesOnItsTree) {
    ReconstructOptions options;
    options.orient.metres_per_unit = 0.5;
    const Reconstruction made = reconstruct_file(path("scan.ply"), options);
    ReconstructCache cache;
    // Options of the frame are no matter: the tree has one.
    ReconstructOptions other = options;
    other.orient = {};
    other.orient.known_height = 40.0;
    const PointCloud again = load_scan(path("scan.ply"), other, made.tree.frame(), 1000000, nullptr, &cache);
    EXPECT_EQ(again.frame, made.tree.frame());
    ASSERT_EQ(again.size(), made.cloud.size());
    EXPECT_EQ(again.colors, made.cloud.colors);
    for (size_t i = 0; i < again.size(); i++)
        ASSERT_LT(glm::distance(again.positions[i], made.cloud.positions[i]), 1e-4F);
    EXPECT_TRUE(cache.read.has_value());
    EXPECT_FALSE(cache.clean.has_value());
    // A tree that was moved and resized takes its scan along.
    Tree edited = made.tree;
    edited.rebase({0.5, 1.0, -2.0});
    edited.scale(3.0);
    const PointCloud moved = load_scan(path("scan.ply"), other, edited.frame(), 1000000, nullptr, &cache);
    const DVec3 tip(made.cloud.positions[10]);
    const DVec3 there = edited.frame().to_tree(made.cloud.frame.to_scan(tip));
    double nearest = 1e9;
    for (const Vec3& p : moved.positions)
        nearest = std::min(nearest, glm::distance(DVec3(p), there));
    EXPECT_LT(nearest, 1e-3);
    // What the cache then has serves a reconstruction.
    EXPECT_EQ(kept_stages(reconstruct_file(path("scan.ply"), options, nullptr, &cache)), "Read ");
    CancelAt stop(0.3);
    EXPECT_THROW(load_scan(path("scan.ply"), options, made.tree.frame(), 5000, &stop), Cancelled);
    EXPECT_THROW(load_scan(path("none.ply"), options, made.tree.frame(), 5000), Error);
    write_treefile(path("tree.txt"), made.tree);
    EXPECT_THROW(load_scan(path("tree.txt"), options, made.tree.frame(), 5000), Error);
}

TEST_F(PipelineCache, AThinnedCloudIsEvenAndKnowsNoOrder) {
    PointCloud cloud = cloud_;
    // Some twice, in another colour, and half of them in one place.
    for (size_t i = 0; i < 500; i++) {
        cloud.positions.push_back(cloud.positions[i]);
        cloud.colors.push_back({1, 2, 3});
    }
    for (size_t i = 0; i < 9000; i++) {
        cloud.positions.push_back(cloud.positions[i] * 0.05F);
        cloud.colors.push_back({9, 9, 9});
    }
    PointCloud all = cloud;
    thin_cloud(all, cloud.size());
    EXPECT_EQ(all.positions, cloud.positions);
    for (const size_t most : {size_t{1000}, size_t{3000}, size_t{9000}}) {
        PointCloud thin = cloud;
        thin_cloud(thin, most);
        EXPECT_LE(thin.size(), most);
        EXPECT_GT(thin.size(), most / 2);
        ASSERT_EQ(thin.colors.size(), thin.size());
        std::set<std::array<float, 3>> places;
        std::map<std::array<float, 3>, std::set<Color8>> known;
        for (size_t i = 0; i < cloud.size(); i++)
            known[{cloud.positions[i].x, cloud.positions[i].y, cloud.positions[i].z}].insert(cloud.colors[i]);
        size_t crowded = 0;
        for (size_t i = 0; i < thin.size(); i++) {
            const std::array<float, 3> place{thin.positions[i].x, thin.positions[i].y, thin.positions[i].z};
            EXPECT_TRUE(places.insert(place).second) << "two at one place";
            ASSERT_EQ(known.count(place), 1u);
            EXPECT_EQ(known[place].count(thin.colors[i]), 1u);
            crowded += thin.colors[i] == Color8{9, 9, 9};
        }
        EXPECT_LT(crowded, thin.size() / 3) << "the dense part gets no more than its share";
        Random random(most);
        PointCloud shuffled;
        std::vector<size_t> order(cloud.size());
        std::iota(order.begin(), order.end(), size_t{0});
        for (size_t i = order.size(); i-- > 1;)
            std::swap(order[i], order[random.below(static_cast<uint32_t>(i + 1))]);
        for (const size_t i : order) {
            shuffled.positions.push_back(cloud.positions[i]);
            shuffled.colors.push_back(cloud.colors[i]);
        }
        thin_cloud(shuffled, most);
        EXPECT_EQ(shuffled.positions, thin.positions);
        EXPECT_EQ(shuffled.colors, thin.colors);
    }
    EXPECT_THROW(thin_cloud(cloud, 999), Error);
}

}  // namespace
}  // namespace treerec
