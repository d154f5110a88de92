#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "branch_trials.h"
#include "cli_runner.h"
#include "edit/commands/script.h"
#include "exchange/tree_files.h"
#include "scan/formats/read_cloud.h"
#include "skeleton_shapes.h"
#include "sketch/branch_stroke.h"
#include "sketch/flat_line.h"
#include "sketch/read_branch.h"

namespace treerec {
namespace {

using branch_trials::Figures;
using branch_trials::make_trial;
using branch_trials::Trial;

constexpr double kDegree = kPi / 180.0;

// A stem with three branches of its own, seen from the front, and a fourth that only the cloud has: it leaves
// at 2 m to the right and away from the camera.
struct Stem {
    Tree tree;
    PointCloud cloud;
    BranchStroke stroke;
    DVec3 from{0.0, 2.0, 0.0};
    DVec3 to{1.0, 2.8, -0.9};
    NodeId joint = kNoNode;

    explicit Stem(double shown = 1.0, uint64_t seed = 4, double radius = 0.03) {
        Random random(seed, 3);
        NodeId id = tree.add_root({0, 0, 0}, 0.08, kTrunkFlag);
        const DVec3 top(0.0, 4.0, 0.0);
        std::vector<NodeId> stem{id};
        for (int i = 1; i <= 40; i++)
            stem.push_back(id = tree.add_child(id, top * (i / 40.0), 0.08 - 0.001 * i, kTrunkFlag));
        test::add_cone(cloud, random, {0, 0, 0}, top, 0.08, 0.04, 0.02, 0.0);
        joint = stem[20];
        for (const auto& [at, end] :
             {std::pair<int, DVec3>{12, {-1.2, 2.0, 0.2}}, {16, {0.2, 2.5, 1.2}}, {26, {-0.9, 3.4, -0.4}}}) {
            NodeId side_branch = stem[static_cast<size_t>(at)];
            const DVec3 base = tree.node(side_branch).position;
            for (int k = 1; k <= 8; k++) {
                side_branch = tree.add_child(side_branch, base + (end - base) * (k / 8.0), 0.03 - 0.0025 * k);
                if (k % 2 == 0 && k < 8) {
                    const DVec3 side = base + (end - base) * (k / 8.0);
                    tree.add_child(side_branch, side + DVec3(0.05, 0.2, k % 4 == 0 ? 0.15 : -0.15), 0.005);
                }
            }
            test::add_cone(cloud, random, base, end, 0.03, 0.01, 0.008, 0.0);
        }
        const DVec3 reach = from + (to - from) * shown;
        test::add_cone(cloud, random, from, reach, radius, radius * (1.0 - 0.67 * shown), 0.008, 0.0);
        stroke.view = branch_trials::camera_at(tree, 0.0, 0.0, 1.5);
        draw(from, to);
    }

    void draw(const DVec3& a, const DVec3& b) {
        stroke.points.clear();
        for (int i = 0; i <= 40; i++)
            stroke.points.push_back(*stroke.view.project(a + (b - a) * (i / 40.0)));
    }
};

std::string sentence_of(const Tree& tree, const PointCloud* cloud, const BranchStroke& stroke,
                        const SketchedBranchOptions& options = {}) {
    try {
        sketch_branch(tree, cloud, stroke, options);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(SketchBranch, BranchesRemovedFromScansComeBack) {
    double within = 0.0, told = 0.0;
    std::vector<double> unseen;
    int count = 0;
    for (const Habit habit : {Habit::kBroadleaf, Habit::kBirch, Habit::kConifer})
        // With sanitizers, too: a mean of fewer says little.
        for (uint64_t seed = 21; seed < 24; seed++) {
            SCOPED_TRACE(habit_name(habit) + " " + std::to_string(seed));
            const auto trial = make_trial(habit, seed);
            ASSERT_TRUE(trial);
            const SketchedBranch side_branch = sketch_branch(trial->tree, &trial->cloud, trial->stroke);
            const Figures figures = branch_trials::judge(*trial, side_branch);
            EXPECT_TRUE(figures.host);
            EXPECT_GT(figures.within, 0.6);
            EXPECT_NEAR(figures.radius_ratio, 1.0, 0.5);
            EXPECT_LT(branch_trials::off(figures.angles.mean, figures.angles_own.mean), 0.1);
            EXPECT_LT(branch_trials::off(figures.angles.median, figures.angles_own.median), 0.1);
            EXPECT_LT(branch_trials::off(figures.internodes.mean, figures.internodes_own.mean), 0.1);
            within += figures.within;
            told += figures.measured_right;
            const SketchedBranch guessed = sketch_branch(trial->tree, &trial->cloud_cut, trial->stroke);
            EXPECT_EQ(guessed.measured, 0.0);
            unseen.push_back(branch_trials::judge(*trial, guessed).angle);
            count++;
        }
    EXPECT_GT(within / count, 0.93);
    EXPECT_GT(told / count, 0.95);
    EXPECT_LT(branch_trials::spread_of(unseen).median, 20.0);
}

TEST(SketchBranch, TheCommandGivesExactlyThatWood) {
    const Stem stem;
    const SketchedBranch side_branch = sketch_branch(stem.tree, &stem.cloud, stem.stroke);
    EXPECT_EQ(side_branch.host, stem.joint);
    EXPECT_GT(side_branch.twigs, 1u);
    Tree grown = stem.tree;
    const Edit edit = perform(grown, side_branch.command);
    EXPECT_FALSE(grown.check());
    ASSERT_EQ(edit.outcome.nodes.size(), side_branch.scion.size() - 1);
    std::vector<DVec3> axis;
    for (const BranchPlace& place : side_branch.axis)
        axis.push_back(place.position);
    // The axis is the branch that list_branches() sees, and no thicker than .8 of its host.
    const BranchList list = list_branches(grown);
    const Branch& branch =
        list.branches[static_cast<size_t>(list.branch_of[static_cast<size_t>(edit.outcome.nodes[0])])];
    EXPECT_EQ(branch.attach, stem.joint);
    EXPECT_NEAR(branch.length, side_branch.length, 0.03);
    for (const NodeId id : list.nodes_of(branch)) {
        EXPECT_LT(branch_trials::distance_to_line(grown.node(id).position, axis), 1e-3);
        EXPECT_LE(grown.node(id).radius, 0.8 * grown.node(stem.joint).radius + 1e-9);
        EXPECT_FALSE(grown.node(id).is_guess());
    }
    // A log replays it on the tree it was made for, and taking it back leaves that tree.
    EditLog log;
    log.add(edit);
    Tree again = stem.tree;
    run_script(again, log.text());
    ASSERT_EQ(again.size(), grown.size());
    for (const NodeId id : grown.depth_first())
        EXPECT_EQ(again.node(id).position, grown.node(id).position);
    edit.delta.revert(grown);
    EXPECT_EQ(grown.size(), stem.tree.size());
}

TEST(SketchBranch, DepthComesFromThePointsAndNotFromWhatLiesBehind) {
    Stem stem;
    // A stout branch of another tree, a metre and a half behind the branch's outer half, in the same line of
    // sight.
    Random random(9, 1);
    const DVec3 eye = stem.stroke.view.centre;
    const auto behind = [&](double share) {
        const DVec3 p = stem.from + (stem.to - stem.from) * share;
        return p + glm::normalize(p - eye) * 1.5;
    };
    test::add_cone(stem.cloud, random, behind(0.3), behind(1.0), 0.05, 0.05, 0.006, 0.0);
    const SketchedBranch side_branch = sketch_branch(stem.tree, &stem.cloud, stem.stroke);
    EXPECT_GT(side_branch.measured, 0.85);
    const std::vector<DVec3> truth{stem.from, stem.to};
    for (const BranchPlace& place : side_branch.axis)
        EXPECT_LT(branch_trials::distance_to_line(place.position, truth), 0.05);
}

// Its own points tell its thickness; without them its siblings do.
TEST(SketchBranch, AStoutBranchIsAsStoutAsItsPoints) {
    const Stem stem(1.0, 4, 0.046);
    const SketchedBranch side_branch = sketch_branch(stem.tree, &stem.cloud, stem.stroke);
    EXPECT_GT(side_branch.axis.front().radius, 0.039);
    const std::vector<DVec3> truth{stem.from, stem.to};
    for (const BranchPlace& place : side_branch.axis)
        EXPECT_LT(branch_trials::distance_to_line(place.position, truth), 0.03);
    const double usual = sketch_branch(stem.tree, nullptr, stem.stroke).axis.front().radius;
    EXPECT_LT(usual, 0.036);
    const Stem slender;
    EXPECT_NEAR(sketch_branch(slender.tree, &slender.cloud, slender.stroke).axis.front().radius, 0.03, 0.006);
}

TEST(SketchBranch, WhereThePointsEndItGoesOnInItsPlane) {
    const Stem stem(0.5);
    const SketchedBranch side_branch = sketch_branch(stem.tree, &stem.cloud, stem.stroke);
    EXPECT_GT(side_branch.measured, 0.3);
    EXPECT_LT(side_branch.measured, 0.7);
    EXPECT_FALSE(side_branch.axis.back().measured);
    EXPECT_LT(glm::distance(side_branch.axis.back().position, stem.to), 0.2);
    Tree grown = stem.tree;
    const Edit edit = perform(grown, side_branch.command);
    // What was guessed is flagged in the tree.
    size_t guesses = 0;
    for (const NodeId id : edit.outcome.nodes)
        guesses += grown.node(id).is_guess() ? 1 : 0;
    EXPECT_GT(guesses, 2u);
    EXPECT_LT(guesses, edit.outcome.nodes.size());
}

TEST(SketchBranch, WithoutPointsItBranchesAsItsSiblings) {
    const Stem stem;
    const SketchedBranch side_branch = sketch_branch(stem.tree, nullptr, stem.stroke);
    EXPECT_EQ(side_branch.measured, 0.0);
    ASSERT_FALSE(side_branch.remarks.empty());
    EXPECT_NE(side_branch.remarks.back().find("guessed"), std::string::npos);
    // In the picture it is what was drawn, whatever its depth.
    for (const BranchPlace& place : side_branch.axis) {
        const auto pixel = stem.stroke.view.project(place.position);
        ASSERT_TRUE(pixel);
        double least = 1e9;
        for (const DVec2& p : stem.stroke.points)
            least = std::min(least, glm::length(p - *pixel));
        EXPECT_LT(least, 6.0);
    }
}

TEST(SketchBranch, EitherEndFirstThroughTheStemOrShortOfItIsTheSameBranch) {
    Stem stem;
    const NodeId host = sketch_branch(stem.tree, &stem.cloud, stem.stroke).host;
    EXPECT_EQ(host, stem.joint);
    BranchStroke stroke = stem.stroke;
    std::reverse(stroke.points.begin(), stroke.points.end());
    EXPECT_EQ(sketch_branch(stem.tree, &stem.cloud, stroke).host, host);
    const DVec3 way = stem.to - stem.from;
    stem.draw(stem.from - way * 0.3, stem.to);
    SketchedBranch side_branch = sketch_branch(stem.tree, &stem.cloud, stem.stroke);
    EXPECT_EQ(side_branch.host, host);
    ASSERT_EQ(side_branch.remarks.size(), 1u);
    EXPECT_NE(side_branch.remarks[0].find("runs through"), std::string::npos);
    EXPECT_NEAR(side_branch.length, glm::length(way), 0.1);
    stem.draw(stem.from + way * 0.15, stem.to);
    side_branch = sketch_branch(stem.tree, &stem.cloud, stem.stroke);
    EXPECT_LT(glm::distance(stem.tree.node(side_branch.host).position, stem.from), 0.25);
    stem.draw(stem.from + way * 0.6, stem.to);
    EXPECT_NE(sentence_of(stem.tree, &stem.cloud, stem.stroke).find("near no wood"), std::string::npos);
}

TEST(SketchBranch, TheSameInputGivesTheSameBytesInAnyOrderOfPoints) {
    Stem stem;
    const std::string command = sketch_branch(stem.tree, &stem.cloud, stem.stroke).command;
    EXPECT_EQ(sketch_branch(stem.tree, &stem.cloud, stem.stroke).command, command);
    std::reverse(stem.cloud.positions.begin(), stem.cloud.positions.end());
    EXPECT_EQ(sketch_branch(stem.tree, &stem.cloud, stem.stroke).command, command);
    SketchedBranchOptions other;
    other.seed = 2;
    EXPECT_NE(sketch_branch(stem.tree, &stem.cloud, stem.stroke, other).command, command);
}

TEST(SketchBranch, ACloudInAnotherFrameIsTheSameCloud) {
    Stem stem;
    const std::string command = sketch_branch(stem.tree, &stem.cloud, stem.stroke).command;
    ScanFrame frame;
    frame.up = UpAxis::kZ;
    frame.metres_per_unit = 0.5;
    frame.origin = {1000.0, -200.0, 30.0};
    stem.tree.set_frame(frame);
    PointCloud raw;
    raw.frame.origin = {990.0, -190.0, 20.0};
    for (const Vec3& p : stem.cloud.positions)
        raw.positions.emplace_back(frame.to_scan(DVec3(p)) - raw.frame.origin);
    const SketchedBranch side_branch = sketch_branch(stem.tree, &raw, stem.stroke);
    EXPECT_GT(side_branch.measured, 0.9);
    EXPECT_EQ(side_branch.host, stem.joint);
}

TEST(SketchBranch, LeavesCanBeLeftOut) {
    Stem stem;
    std::vector<uint8_t> wood(stem.cloud.size(), 0);
    EXPECT_EQ(sketch_branch(stem.tree, &stem.cloud, stem.stroke, {}, wood).measured, 0.0);
    wood.pop_back();
    EXPECT_THROW(sketch_branch(stem.tree, &stem.cloud, stem.stroke, {}, wood), Error);
}

TEST(SketchBranch, BadInputGetsASentence) {
    const Stem stem;
    const PointCloud* cloud = &stem.cloud;
    const auto with = [&](const auto& change) {
        BranchStroke stroke = stem.stroke;
        change(stroke);
        return sentence_of(stem.tree, cloud, stroke);
    };
    EXPECT_NE(with([](BranchStroke& s) { s.view.centre.x = NAN; }).find("no camera"), std::string::npos);
    EXPECT_NE(with([](BranchStroke& s) { s.view.turn[0] *= 2.0; }).find("no camera"), std::string::npos);
    EXPECT_NE(with([](BranchStroke& s) { s.view.focal = 0.0; }).find("no camera"), std::string::npos);
    EXPECT_NE(with([](BranchStroke& s) { s.points.clear(); }).find("no points"), std::string::npos);
    EXPECT_NE(with([](BranchStroke& s) { s.points.resize(1); }).find("too short"), std::string::npos);
    EXPECT_NE(with([](BranchStroke& s) { s.points[3].y = INFINITY; }).find("no place"), std::string::npos);
    EXPECT_NE(with([](BranchStroke& s) {
                  for (DVec2& p : s.points)
                      p.x -= 5000.0;
              }).find("outside"),
              std::string::npos);
    EXPECT_NE(with([](BranchStroke& s) {
                  s.view.turn[0] = -s.view.turn[0];
                  s.view.turn[2] = -s.view.turn[2];
              }).find("behind the camera"),
              std::string::npos);
    EXPECT_NE(sentence_of(Tree(), cloud, stem.stroke).find("no tree"), std::string::npos);
    Tree lone;
    lone.add_root({0, 0, 0}, 0.1);
    EXPECT_NE(sentence_of(lone, cloud, stem.stroke).find("no tree"), std::string::npos);
    SketchedBranchOptions options;
    options.jitter = 0.0;
    EXPECT_NE(sentence_of(stem.tree, cloud, stem.stroke, options).find("jitter"), std::string::npos);
    options = {};
    options.tolerance = -1.0;
    EXPECT_NE(sentence_of(stem.tree, cloud, stem.stroke, options).find("tolerance"), std::string::npos);
    const PointCloud empty;
    EXPECT_EQ(sketch_branch(stem.tree, &empty, stem.stroke).measured, 0.0);
}

// Any scribble over any tree: a branch that keeps the tree right, or a sentence.
TEST(SketchBranch, ScribblesNeverBreakATree) {
    for (uint64_t seed = 1; seed <= static_cast<uint64_t>(test::cases(150)); seed++) {
        Random random(seed, 12);
        const Stem stem(random.uniform(0.0, 1.0), seed);
        BranchStroke stroke;
        stroke.view = branch_trials::camera_at(stem.tree, random.uniform(0.0, 6.28),
                                               random.uniform(-1.5, 1.5), random.uniform(0.05, 3.0));
        DVec2 at(random.uniform(0.0, 1000.0), random.uniform(0.0, 1000.0));
        if (random.below(2) == 0)
            if (const auto p = stroke.view.project(stem.tree.node(stem.joint).position)) at = *p;
        const uint32_t count = 1 + random.below(60);
        for (uint32_t i = 0; i < count; i++) {
            stroke.points.push_back(at);
            at += DVec2(random.normal(), random.normal()) * random.uniform(0.0, 30.0);
        }
        try {
            const SketchedBranch side_branch = sketch_branch(stem.tree, &stem.cloud, stroke);
            Tree grown = stem.tree;
            perform(grown, side_branch.command);
            const auto wrong = grown.check();
            EXPECT_FALSE(wrong) << seed << ": " << *wrong;
            EXPECT_GT(grown.size(), stem.tree.size());
        } catch (const Error& error) {
            EXPECT_GT(std::string(error.what()).size(), 20u);
        }
    }
}

TEST(SketchBranchStroke, SlowStrokesDoNotVanish) {
    std::vector<DVec2> slow;
    for (int i = 0; i <= 1000; i++)
        slow.emplace_back(0.1 * i, 0.0);
    const std::vector<DVec2> cleaned = clean_stroke(slow);
    EXPECT_GT(cleaned.size(), 30u);
    EXPECT_EQ(cleaned.front(), slow.front());
    EXPECT_EQ(cleaned.back(), slow.back());
    EXPECT_NEAR(line_length(cleaned), 100.0, 1e-9);
    // Equation 1.
    const std::vector<DVec2> bump =
        clean_stroke({{0, 0}, {10, 0}, {20, 0}, {30, 10}, {40, 0}, {50, 0}, {60, 0}});
    EXPECT_NEAR(bump[3].y, 6.0, 1e-12);
    EXPECT_NEAR(bump[2].y, 1.3, 1e-12);
}

TEST(SketchBranchFile, ReadsWhatItWritesInBothSpaces) {
    Stem stem;
    ScanFrame frame;
    frame.up = UpAxis::kZ;
    frame.metres_per_unit = 0.01;
    frame.origin = {4e5, 5e6, 100.0};
    const std::string text = branch_json({stem.stroke, stem.stroke});
    const std::vector<BranchStroke> read = parse_branch_json(text, frame);
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[1].points, stem.stroke.points);
    std::string old = text;
    old.replace(old.find("treerec branch"), 14, "treerec limb");
    EXPECT_EQ(parse_branch_json(old, frame).size(), 2u);
    EXPECT_LT(glm::distance(read[0].view.centre, stem.stroke.view.centre), 1e-9);
    const DVec3 place = frame.to_scan(stem.stroke.view.centre);
    const DVec3 right = frame.turn_to_scan(stem.stroke.view.turn[0]);
    const DVec3 up = frame.turn_to_scan(stem.stroke.view.turn[1]);
    const auto list = [](const DVec3& v) {
        return "[" + number_text(v.x) + "," + number_text(v.y) + "," + number_text(v.z) + "]";
    };
    const std::string of_scan =
        "{\"format\":\"treerec branch\",\"version\":1,\"camera\":{\"position\":" + list(place) +
        ",\"right\":" + list(right) + ",\"up\":" + list(up) +
        ",\"focal\":1000,\"size\":[1000,1000]},\"strokes\":[{\"points\":[[1,2],[3,4]]}]}";
    const PinholeView view = parse_branch_json(of_scan, frame)[0].view;
    EXPECT_LT(glm::distance(view.centre, stem.stroke.view.centre), 1e-6);
    for (int i = 0; i < 3; i++)
        EXPECT_LT(glm::distance(view.turn[i], stem.stroke.view.turn[i]), 1e-9);
    EXPECT_EQ(view.principal, DVec2(500.0, 500.0));
}

TEST(SketchBranchFile, DamagedFilesGetASentence) {
    const Stem stem;
    const std::string good = branch_json({stem.stroke});
    for (const char* bad :
         {"", "{", "[]", "{\"format\":\"treerec sketch\",\"version\":1}", "{\"format\":\"treerec branch\"}",
          "{\"format\":\"treerec branch\",\"version\":2}", "{\"format\":\"treerec branch\",\"version\":1}"})
        EXPECT_THROW(parse_branch_json(bad, {}), Error) << bad;
    const auto replaced = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        const size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    };
    EXPECT_THROW(parse_branch_json(replaced("1000.0", "1e999"), {}), Error);
    EXPECT_THROW(parse_branch_json(replaced("\"up\":[0.0,1.0,0.0]", "\"up\":[1.0,0.0,0.0]"), {}), Error);
    EXPECT_THROW(parse_branch_json(replaced("\"points\":[[", "\"points\":[[\"a\","), {}), Error);
    EXPECT_THROW(parse_branch_json(replaced("\"space\":\"tree\"", "\"space\":\"moon\""), {}), Error);
    for (size_t cut = 0; cut < good.size(); cut += 7)
        EXPECT_THROW(parse_branch_json(good.substr(0, cut), {}), Error);
}

class SketchOntoCli : public test::Cli {};

TEST_F(SketchOntoCli, DrawsABranchOntoATreeAndTellsItsFidelity) {
    const auto trial = make_trial(Habit::kBroadleaf, 21);
    ASSERT_TRUE(trial);
    write_treefile(path("tree.txt"), trial->tree);
    write_cloud(path("scan.ply"), trial->cloud);
    put("branch.json", branch_json({trial->stroke}));
    const test::Outcome done =
        run("sketch branch.json --onto tree.txt --scan scan.ply -o out/tree.txt --log out/log.txt --report");
    ASSERT_EQ(done.code, 0) << done.error;
    EXPECT_NE(done.out.find("\"fidelity_after\""), std::string::npos);
    EXPECT_NE(done.out.find("\"measured\": true"), std::string::npos);
    const auto value = [&](const std::string& section) {
        const size_t at = done.out.find("\"explained\": ", done.out.find(section));
        return std::stod(done.out.substr(at + 13));
    };
    EXPECT_GT(value("\"fidelity_after\""), value("\"fidelity_before\"") + 0.005);
    EXPECT_GT(read_skeleton(path("out/tree.txt")).size(), trial->tree.size() + 20);
    // The log is an ordinary one.
    const test::Outcome replayed = run("edit tree.txt --script out/log.txt -o out/again.txt");
    ASSERT_EQ(replayed.code, 0) << replayed.error;
    EXPECT_EQ(get("out/again.txt"), get("out/tree.txt"));

    EXPECT_EQ(run("sketch branch.json -o out/x.glb").code, 1);
    EXPECT_NE(run("sketch branch.json -o out/x.glb").error.find("--onto"), std::string::npos);
    EXPECT_EQ(run("sketch branch.json --scan scan.ply -o out/x.glb").code, 2);
    EXPECT_EQ(run("sketch branch.json --onto tree.txt --height 3 -o out/x.glb").code, 2);
    put("bad.json", "{}");
    EXPECT_EQ(run("sketch bad.json --onto tree.txt -o out/x.glb").code, 1);
    EXPECT_FALSE(test::fs::exists(path("out/x.glb")));
}

}  // namespace
}  // namespace treerec
