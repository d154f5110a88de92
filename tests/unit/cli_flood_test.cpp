// `treerec reconstruct --skeleton flood`, as a user runs it.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli_runner.h"

namespace treerec {
namespace {

using test::Cli;

class CliFlood : public Cli {};

TEST_F(CliFlood, FloodsAndReportsItsVoxels) {
    ASSERT_EQ(run("synth -o s --seed 3 --height 5 --points 8000").code, 0);
    ASSERT_EQ(run("reconstruct s/scan.ply -o out/a.txt --report out/a.json --skeleton flood --quiet").code,
              0);
    const auto found = nlohmann::json::parse(get("out/a.json"));
    EXPECT_EQ(found["options"]["skeleton"], "flood");
    EXPECT_EQ(found["options"]["voxel_m"], "auto");
    EXPECT_GT(found["voxel_m"], 0.0);
    EXPECT_GT(found["nodes"], 20);
    ASSERT_EQ(run("reconstruct s/scan.ply -o out/b.txt --report out/b.json --skeleton flood --voxel 0.03 "
                  "--quiet --threads 1")
                  .code,
              0);
    EXPECT_EQ(nlohmann::json::parse(get("out/b.json"))["voxel_m"], 0.03);
    ASSERT_EQ(
        run("reconstruct s/scan.ply -o out/c.txt --skeleton flood --voxel 0.03 --quiet --threads 3").code, 0);
    EXPECT_EQ(get("out/b.txt"), get("out/c.txt"));
    ASSERT_EQ(run("reconstruct s/scan.ply -o out/d.txt --report out/d.json --quiet").code, 0);
    const auto other = nlohmann::json::parse(get("out/d.json"));
    EXPECT_EQ(other["options"]["skeleton"], "geodesic");
    EXPECT_FALSE(other.contains("voxel_m"));
}

TEST_F(CliFlood, CompletesWhatIsLeftOver) {
    ASSERT_EQ(run("synth -o s --seed 3 --height 5 --points 8000").code, 0);
    // Voxels as wide as twigs are apart leave much over.
    const std::string words = "reconstruct s/scan.ply --all-wood --skeleton flood --voxel 0.12 --quiet ";
    ASSERT_EQ(run(words + "-o out/a.txt --report out/a.json").code, 0);
    ASSERT_EQ(run(words + "-o out/b.txt --report out/b.json --complete").code, 0);
    const auto before = nlohmann::json::parse(get("out/a.json"));
    const auto after = nlohmann::json::parse(get("out/b.json"));
    EXPECT_EQ(before["completed_branches"], 0);
    EXPECT_GT(after["completed_branches"], 0);
    EXPECT_GT(after["fit"]["explained_2cm"], before["fit"]["explained_2cm"]);
    EXPECT_NEAR(after["length_m"].get<double>(),
                before["length_m"].get<double>() + after["completed_length_m"].get<double>(),
                0.01 * after["length_m"].get<double>());
}

TEST_F(CliFlood, FloodsAsPrintedAndTakesRadiiByRule) {
    ASSERT_EQ(run("synth -o s --seed 3 --height 5 --points 8000").code, 0);
    const std::string words = "reconstruct s/scan.ply --quiet ";
    ASSERT_EQ(run(words + "--skeleton flood --flood paper -o out/p.txt --report out/p.json").code, 0);
    ASSERT_EQ(run(words + "--skeleton flood -o out/o.txt --report out/o.json").code, 0);
    const auto paper = nlohmann::json::parse(get("out/p.json"));
    const auto ours = nlohmann::json::parse(get("out/o.json"));
    EXPECT_EQ(paper["options"]["flood"], "paper");
    EXPECT_EQ(ours["options"]["flood"], "ours");
    EXPECT_NE(get("out/p.txt"), get("out/o.txt"));
    ASSERT_EQ(run(words + "--skeleton flood --flood paper --threads 3 -o out/q.txt").code, 0);
    EXPECT_EQ(get("out/p.txt"), get("out/q.txt"));
    ASSERT_EQ(run(words + "--radii measured -o out/a.txt --report out/a.json").code, 0);
    ASSERT_EQ(run(words + "--radii davinci -o out/b.txt --report out/b.json").code, 0);
    ASSERT_EQ(run(words + "--radii linear -o out/c.txt --report out/c.json").code, 0);
    const auto measured = nlohmann::json::parse(get("out/a.json"));
    for (const char* rule : {"out/b.json", "out/c.json"}) {
        const auto by_rule = nlohmann::json::parse(get(rule));
        EXPECT_EQ(by_rule["nodes"], measured["nodes"]);
        EXPECT_NE(by_rule["volume_m3"], measured["volume_m3"]);
        EXPECT_EQ(by_rule["measured_share"], 0.0);
    }
}

TEST_F(CliFlood, RefusesWhatMakesNoSense) {
    ASSERT_EQ(run("synth -o s --seed 3 --height 5 --points 8000").code, 0);
    EXPECT_EQ(run("reconstruct s/scan.ply -o out/a.txt --skeleton voxels").code, 2);
    EXPECT_EQ(run("reconstruct s/scan.ply -o out/a.txt --voxel 0.03").code, 2);
    EXPECT_EQ(run("reconstruct s/scan.ply -o out/a.txt --flood paper").code, 2);
    EXPECT_EQ(run("reconstruct s/scan.ply -o out/a.txt --skeleton flood --flood printed").code, 2);
    EXPECT_EQ(run("reconstruct s/scan.ply -o out/a.txt --radii leonardo").code, 2);
    EXPECT_EQ(run("reconstruct s/scan.ply -o out/a.txt --skeleton flood --voxel 0").code, 2);
    const auto large = run("reconstruct s/scan.ply -o out/a.txt --skeleton flood --voxel 40");
    EXPECT_EQ(large.code, 1);
    EXPECT_NE(large.error.find("too large for a tree of"), std::string::npos) << large.error;
    const auto small = run("reconstruct s/scan.ply -o out/a.txt --skeleton flood --voxel 0.00000001");
    EXPECT_NE(small.code, 0);
}

}  // namespace
}  // namespace treerec
