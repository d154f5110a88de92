// The program itself, run as a user runs it (cli_runner.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "cli_runner.h"
#include "error.h"
#include "exchange/tree_files.h"
#include "geometry/random.h"
#include "scan/formats/read_cloud.h"
#include "synth/grow.h"
#include "synth/scan.h"
#include "tree/measure.h"

namespace treerec {
namespace {

using test::Cli;
using test::Outcome;
namespace fs = std::filesystem;

std::string xyz(const std::vector<DVec3>& points) {
    std::string text;
    char line[128];
    for (const DVec3& p : points) {
        std::snprintf(line, sizeof line, "%.6f %.6f %.6f\n", p.x, p.y, p.z);
        text += line;
    }
    return text;
}

constexpr double kSmallTree = 5.0;

// A small scanned tree in scan coordinates, Z up.
std::vector<DVec3> small_scan() {
    const Tree tree = grow_tree({Habit::kBroadleaf, kSmallTree, 3});
    VirtualScanOptions options;
    options.points = 5000;
    const PointCloud cloud = scan_tree(tree, options).cloud;
    std::vector<DVec3> points;
    for (const Vec3& p : cloud.positions)
        points.push_back(cloud.frame.to_scan(DVec3(p)));
    return points;
}

void expect_one_sentence(const Outcome& outcome) {
    EXPECT_GT(outcome.error.size(), 15u);
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1) << outcome.error;
    EXPECT_TRUE(outcome.error.ends_with(".\n")) << outcome.error;
    EXPECT_EQ(outcome.error.find("terminate"), std::string::npos) << outcome.error;
}

TEST_F(Cli, SynthReconstructInfoScoreWorkTogether) {
    ASSERT_EQ(run("synth -o s --seed 3 --height 5 --points 8000").code, 0);
    const Outcome made =
        run("reconstruct s/scan.ply -o out/a.glb -o out/a.obj -o out/a.txt -o out/a.csv "
            "-o out/a.ply --report out/a.json --leaves maple --seed 9");
    ASSERT_EQ(made.code, 0) << made.error;
    EXPECT_NE(made.out.find("wrote out/a.glb"), std::string::npos);
    for (const char* name : {"out/a.glb", "out/a.obj", "out/a.txt", "out/a.csv", "out/a.ply", "out/a.json"})
        EXPECT_GT(fs::file_size(path(name)), 500u) << name;
    const auto report = nlohmann::json::parse(get("out/a.json"));
    EXPECT_EQ(report["seed"], 9);
    EXPECT_EQ(report["options"]["leaves"], "maple");

    const Outcome info = run("info out/a.txt --json");
    ASSERT_EQ(info.code, 0) << info.error;
    EXPECT_EQ(nlohmann::json::parse(info.out)["nodes"], report["nodes"]);
    const Outcome cloud = run("info s/scan.ply --json");
    ASSERT_EQ(cloud.code, 0) << cloud.error;
    EXPECT_EQ(nlohmann::json::parse(cloud.out)["points"], 8000);
    EXPECT_EQ(run("info s/scan.ply").code, 0);
    EXPECT_EQ(run("info s/truth.txt").code, 0);

    const Outcome perfect = run("score s/truth.txt s/truth.txt --json");
    ASSERT_EQ(perfect.code, 0) << perfect.error;
    EXPECT_EQ(nlohmann::json::parse(perfect.out)["by_radius"][0]["f"], 1.0);
    const Outcome skeleton = run("score out/a.txt s/truth.txt --json");
    ASSERT_EQ(skeleton.code, 0) << skeleton.error;
    EXPECT_LT(nlohmann::json::parse(skeleton.out)["chamfer_mm"], 300.0);
    const Outcome scan = run("score out/a.ply s/scan.ply --json --noise 0.003");
    ASSERT_EQ(scan.code, 0) << scan.error;
    EXPECT_EQ(nlohmann::json::parse(scan.out)["points"], 8000);
    EXPECT_LT(nlohmann::json::parse(scan.out)["median_mm"], 30.0);
}

TEST_F(Cli, TheSameCommandGivesTheSameBytes) {
    ASSERT_EQ(run("synth -o a --seed 5 --height 4 --points 3000 --leaves 0.2 --occlusion 0.2 --quiet").code,
              0);
    ASSERT_EQ(run("synth -o b --seed 5 --height 4 --points 3000 --leaves 0.2 --occlusion 0.2 --quiet").code,
              0);
    EXPECT_EQ(get("a/scan.ply"), get("b/scan.ply"));
    EXPECT_EQ(get("a/truth.txt"), get("b/truth.txt"));
    ASSERT_EQ(run("reconstruct a/scan.ply -o out/1.glb --threads 1 --quiet").code, 0);
    ASSERT_EQ(run("reconstruct a/scan.ply -o out/2.glb --threads 3 --quiet").code, 0);
    EXPECT_TRUE(get("out/1.glb") == get("out/2.glb"));
}

TEST_F(Cli, HelpAndVersionExitWithZero) {
    for (const char* words : {"--help", "-h", "help", "--version", "reconstruct --help", "info --help",
                              "score -h", "synth --help", "textures --help"}) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 0) << words;
        EXPECT_GT(outcome.out.size(), 10u) << words;
        EXPECT_TRUE(outcome.error.empty()) << words;
    }
}

TEST_F(Cli, AKnownLengthSetsTheScale) {
    put("s.xyz", xyz(small_scan()));
    ASSERT_EQ(run("reconstruct s.xyz -o out/a.txt --report out/plain.json --quiet").code, 0);
    ASSERT_EQ(run("reconstruct s.xyz -o out/b.txt --report out/b.json --height 12.5 --quiet").code, 0);
    ASSERT_EQ(run("reconstruct s.xyz -o out/c.txt --report out/c.json --length 0,0,0,0,3,4,15 --quiet").code,
              0);
    const auto plain = nlohmann::json::parse(get("out/plain.json"));
    const auto height = nlohmann::json::parse(get("out/b.json"));
    const auto length = nlohmann::json::parse(get("out/c.json"));
    EXPECT_TRUE(plain["scale_guessed"].get<bool>());
    EXPECT_FALSE(height["scale_guessed"].get<bool>());
    EXPECT_NEAR(height["height_m"].get<double>(), 12.5, 0.5);
    EXPECT_EQ(height["options"]["known_height_m"], 12.5);
    EXPECT_NEAR(length["metres_per_unit"].get<double>(), 3.0, 1e-9);
    EXPECT_EQ(length["options"]["known_length_m"], 15.0);
}

TEST_F(Cli, TakesTheTreeThatIsAskedFor) {
    // The same tree twice, and once more a third smaller.
    std::string text;
    for (const DVec3& p : small_scan()) {
        for (const auto& [x, size] : {std::pair(0.0, 1.0), std::pair(12.0, 1.3), std::pair(24.0, 0.9)}) {
            char line[100];
            std::snprintf(line, sizeof line, "%.4f %.4f %.4f\n", size * p.x + x, size * p.y, size * p.z);
            text += line;
        }
    }
    put("s.xyz", text);
    const auto base_of = [&](const std::string& options) {
        const Outcome outcome =
            run("reconstruct s.xyz -o out/a.txt --report out/a.json --scale 1 --up z --quiet " + options);
        EXPECT_EQ(outcome.code, 0) << outcome.error;
        return nlohmann::json::parse(get("out/a.json"));
    };
    const auto largest = base_of("");
    ASSERT_EQ(largest["trees"].size(), 3u);
    EXPECT_EQ(largest["tree_taken"], 1);
    EXPECT_NEAR(largest["origin"][0].get<double>(), 12.0, 0.5);
    EXPECT_NEAR(base_of("--tree 3")["origin"][0].get<double>(), 24.0, 0.5);
    const auto nearest = base_of("--tree-at 1,-0.5,0");
    EXPECT_NEAR(nearest["origin"][0].get<double>(), 0.0, 0.5);
    EXPECT_EQ(nearest["options"]["tree_at"][1], -0.5);
    EXPECT_EQ(run("reconstruct s.xyz -o out/b.txt --tree 9").code, 1);
    const auto one = base_of("--one-tree");
    EXPECT_TRUE(one["trees"].empty());
    EXPECT_TRUE(one["tree_taken"].is_null());
}

TEST_F(Cli, AWrongCommandLineExitsWithTwo) {
    put("c.xyz", "1 2 3\n");
    put("c.txt", "1 2 3\n");
    for (const char* words : {"",
                              "reconstrct",
                              "--nonsense",
                              "reconstruct",
                              "reconstruct c.xyz",
                              "reconstruct c.xyz -o",
                              "reconstruct c.xyz -o out/a.fbx",
                              "reconstruct c.xyz -o none/a.glb",
                              "reconstruct c.xyz -o c.xyz",
                              "reconstruct c.txt -o ./c.txt",
                              "reconstruct c.xyz -o out/a.txt --report c.xyz",
                              "reconstruct c.xyz -o out/a.txt --report none/a.json",
                              "reconstruct c.xyz -o out/a.glb --sed 3",
                              "reconstruct c.xyz -o out/a.glb --seed three",
                              "reconstruct c.xyz -o out/a.glb --seed -1",
                              "reconstruct c.xyz -o out/a.glb --up w",
                              "reconstruct c.xyz -o out/a.glb --scale 0",
                              "reconstruct c.xyz -o out/a.glb --scale nan",
                              "reconstruct c.xyz -o out/a.glb --tree 0",
                              "reconstruct c.xyz -o out/a.glb --tree-at 1,2",
                              "reconstruct c.xyz -o out/a.glb --tree-at 1,2,3 --tree 2",
                              "reconstruct c.xyz -o out/a.glb --height 0",
                              "reconstruct c.xyz -o out/a.glb --height 5 --scale 1",
                              "reconstruct c.xyz -o out/a.glb --length 1,2,3,4",
                              "reconstruct c.xyz -o out/a.glb --length 1,2,3,4,5,6,7,8",
                              "reconstruct c.xyz -o out/a.glb --length 1,2,3,1,2,3,7",
                              "reconstruct c.xyz -o out/a.glb --length 1,2,3,4,5,6,nan",
                              "reconstruct c.xyz -o out/a.glb --leaves cactus",
                              "reconstruct c.xyz -o out/a.glb --quiet=1",
                              "reconstruct c.xyz -o out/a.glb -o out/a.glb",
                              "reconstruct c.xyz -o out/a.glb --threads 0",
                              "info",
                              "info a b",
                              "score a",
                              "score a b c",
                              "synth",
                              "synth -o s --habit cactus",
                              "synth -o s --points 0",
                              "synth -o s --leaves 2",
                              "textures",
                              "textures -o t --preset cactus"}) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 2) << words;
        EXPECT_FALSE(outcome.error.empty()) << words;
        EXPECT_TRUE(out_is_empty()) << words;
        EXPECT_EQ(get("c.xyz") + get("c.txt"), "1 2 3\n1 2 3\n") << words;
    }
    EXPECT_NE(run("reconstruct c.xyz -o out/a.glb --sed 3").error.find("--seed"), std::string::npos);
    EXPECT_NE(run("reconstrct").error.find("'reconstruct'"), std::string::npos);
}

TEST_F(Cli, OutputThatCannotBeWrittenIsAnError) {
    if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    const int status = std::system(("'" + program_ + "' --version >/dev/full 2>/dev/null").c_str());
    EXPECT_EQ(WEXITSTATUS(status), 1);
    put("s.xyz", xyz(small_scan()));
    // Known before the long work, and so a matter of the command line.
    EXPECT_EQ(run("reconstruct s.xyz -o out/a.txt --report out --quiet").code, 2);
    EXPECT_EQ(run("reconstruct s.xyz -o out/a.txt --report nowhere/r.json --quiet").code, 2);
    EXPECT_TRUE(out_is_empty());
}

// Files that hold no tree at all: a sentence, exit code 1, nothing written.
TEST_F(Cli, WhatIsNoTreeGetsASentence) {
    std::string garbage;
    Random random(1);
    for (int i = 0; i < 20000; i++)
        garbage += static_cast<char>(random.below(256));
    std::vector<DVec3> few, line, same(100, DVec3(1, 2, 3));
    for (int i = 0; i < 5; i++)
        few.emplace_back(random.uniform(), random.uniform(), random.uniform());
    for (int i = 0; i < 1000; i++)
        line.emplace_back(0.0, 0.0, 0.01 * i);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<std::pair<std::string, std::string>> cases = {
        {"empty.xyz", ""},
        {"empty.ply", ""},
        {"empty.las", ""},
        {"garbage.ply", garbage},
        {"garbage.xyz", garbage},
        {"garbage.las", garbage},
        {"headed.ply", "ply\n" + garbage},
        {"headed.las", "LASF" + garbage},
        {"cut.ply",
         "ply\nformat binary_little_endian 1.0\nelement vertex 1000\nproperty float x\n"
         "property float y\nproperty float z\nend_header\n12345678"},
        {"huge.ply",
         "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
         "property float y\nproperty float z\nend_header\n12345678"},
        {"nan.xyz", xyz(std::vector<DVec3>(50, DVec3(nan)))},
        {"line.xyz", xyz(line)},
        {"same.xyz", xyz(same)},
    };
    for (size_t count = 1; count <= 5; count++)
        cases.push_back(
            {std::to_string(count) + ".xyz", xyz({few.begin(), few.begin() + static_cast<long>(count)})});
    for (const auto& [name, bytes] : cases) {
        put(name, bytes);
        const Outcome outcome =
            run("reconstruct " + name + " -o out/a.glb -o out/a.txt --report out/a.json --quiet");
        EXPECT_EQ(outcome.code, 1) << name << ": " << outcome.error;
        expect_one_sentence(outcome);
        EXPECT_TRUE(out_is_empty()) << name;
        if (name == "line.xyz" || name == "same.xyz" || name.size() == 5) continue;
        EXPECT_EQ(run("info " + name).code, 1) << name;
        EXPECT_EQ(run("score " + name + " " + name).code, 1) << name;
    }
    const Outcome missing = run("reconstruct nowhere.xyz -o out/a.glb --quiet");
    EXPECT_EQ(missing.code, 1);
    expect_one_sentence(missing);
    EXPECT_EQ(run("reconstruct out -o out/a.glb --quiet").code, 1);
}

// Clouds that are odd: a sentence, or a sane tree.
TEST_F(Cli, OddCloudsEndInASentenceOrASaneTree) {
    Random random(2);
    std::vector<DVec3> plane, house, ball;
    for (int i = 0; i < 4000; i++) {
        plane.emplace_back(random.uniform(0, 5), random.uniform(0, 5), 0.0);
        ball.push_back(3.0 * random.direction());
        // Four walls and a saddle roof.
        const double u = random.uniform(), v = random.uniform();
        switch (i % 6) {
            case 0:
                house.emplace_back(10 * u, 0, 5 * v);
                break;
            case 1:
                house.emplace_back(10 * u, 8, 5 * v);
                break;
            case 2:
                house.emplace_back(0, 8 * u, 5 * v);
                break;
            case 3:
                house.emplace_back(10, 8 * u, 5 * v);
                break;
            case 4:
                house.emplace_back(10 * u, 4 * v, 5 + 3 * v);
                break;
            default:
                house.emplace_back(10 * u, 8 - 4 * v, 5 + 3 * v);
        }
    }
    const std::vector<std::pair<std::string, std::vector<DVec3>>> cases = {
        {"plane", plane}, {"house", house}, {"ball", ball}};
    for (const auto& [name, points] : cases) {
        put(name + ".xyz", xyz(points));
        const Outcome outcome = run("reconstruct " + name + ".xyz -o out/a.txt -o out/a.glb --quiet");
        ASSERT_TRUE(outcome.code == 0 || outcome.code == 1) << name << " " << outcome.code << outcome.error;
        if (outcome.code == 1) {
            expect_one_sentence(outcome);
            EXPECT_TRUE(out_is_empty()) << name;
            continue;
        }
        const Tree tree = read_treefile(path("out/a.txt"));
        EXPECT_EQ(tree.check().value_or("sound"), "sound") << name;
        EXPECT_LT(measure(tree).height, 15.0) << name;
        fs::remove_all(folder_ / "out");
        fs::create_directories(folder_ / "out");
    }
}

// The same tree in other units, places and company is still that tree.
TEST_F(Cli, AGoodTreeInAnOddFileIsStillFound) {
    const std::vector<DVec3> points = small_scan();
    const auto changed = [&](const std::function<DVec3(const DVec3&)>& change) {
        std::vector<DVec3> result;
        for (const DVec3& p : points)
            result.push_back(change(p));
        return result;
    };
    const DVec3 utm(500123.4, 5432109.8, 231.5);
    std::vector<DVec3> with_far = points, with_nan = points;
    with_far.emplace_back(100.0, 0.0, 2.0);
    for (size_t i = 0; i < with_nan.size(); i += 50)
        with_nan[i] = DVec3(std::numeric_limits<double>::quiet_NaN());
    struct Case {
        const char* name;
        std::vector<DVec3> points;
        const char* options;
    };
    const std::vector<Case> cases = {
        {"plain", points, ""},
        {"millimetres", changed([](const DVec3& p) { return 1000.0 * p; }), ""},
        {"centimetres_named", changed([](const DVec3& p) { return 100.0 * p; }), "--scale 0.01"},
        {"utm", changed([&](const DVec3& p) { return p + utm; }), ""},
        {"y_up", changed([](const DVec3& p) { return DVec3(p.x, p.z, -p.y); }), ""},
        {"x_down_named", changed([](const DVec3& p) { return DVec3(-p.z, p.y, p.x); }), "--up -x"},
        {"far_point", with_far, ""},
        {"some_nan", with_nan, ""},
    };
    for (const Case& c : cases) {
        put(std::string(c.name) + ".xyz", xyz(c.points));
        const Outcome outcome = run("reconstruct " + std::string(c.name) +
                                    ".xyz -o out/a.txt --report out/a.json --quiet " + c.options);
        ASSERT_EQ(outcome.code, 0) << c.name << ": " << outcome.error;
        const auto report = nlohmann::json::parse(get("out/a.json"));
        EXPECT_NEAR(report["height_m"].get<double>(), kSmallTree, 0.15 * kSmallTree) << c.name;
        const Tree tree = read_treefile(path("out/a.txt"));
        EXPECT_EQ(tree.check().value_or("sound"), "sound") << c.name;
        // The tree file lies where the cloud lies.
        Bounds cloud;
        for (size_t i = 0; i < points.size(); i++)
            if (is_finite(c.points[i])) cloud.add(c.points[i]);
        for (NodeId id : tree.depth_first()) {
            const DVec3 p = tree.frame().to_scan(tree.node(id).position);
            for (int axis = 0; axis < 3; axis++) {
                const double margin = 0.1 * cloud.diagonal();
                ASSERT_GE(p[axis], cloud.min[axis] - margin) << c.name;
                ASSERT_LE(p[axis], cloud.max[axis] + margin) << c.name;
            }
        }
    }
}

TEST_F(Cli, AnInterruptLeavesNothingHalfWritten) {
    ASSERT_EQ(run("synth -o s --seed 3 --points 60000 --quiet").code, 0);
    const std::string command =
        "cd '" + folder_.string() + "' && timeout -s INT 0.4 '" + program_ +
        "' reconstruct s/scan.ply -o out/a.glb -o out/a.txt --report out/a.json --quiet "
        ">stdout.log 2>stderr.log";
    ASSERT_NE(std::system(command.c_str()), -1);
    const std::string error = get("stderr.log");
    EXPECT_TRUE(error.empty() || error == "Cancelled.\n") << error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "out"))
        EXPECT_NE(entry.path().extension(), ".part");
}

}  // namespace
}  // namespace treerec
