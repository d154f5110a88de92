#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "completion/complete.h"
#include "completion/complete_all.h"
#include "edit/commands/script.h"
#include "skeleton_shapes.h"

namespace treerec {
namespace {

// A stem with a branch that the tree lacks, and one beside it that it has.
struct Missing {
    Tree tree;
    PointCloud cloud;
    NodeId joint = kNoNode;
    DVec3 from{0.0};
    DVec3 to{0.0};
    double radius = 0.0;

    DVec3 direction() const { return glm::normalize(to - from); }
};

Missing missing_branch(uint64_t seed, double gap = 0.0) {
    Random random(seed, 31);
    Missing made;
    const DVec3 top(0.0, 3.0, 0.0);
    NodeId id = made.tree.add_root({0, 0, 0}, 0.1, kTrunkFlag);
    for (int i = 1; i <= 10; i++)
        id = made.tree.add_child(id, 0.1 * i * top, 0.1, kTrunkFlag);
    test::add_cone(made.cloud, random, {0, 0, 0}, top, 0.1, 0.1, 0.02, 0.0);
    const std::vector<NodeId> line = made.tree.depth_first();
    made.joint = line[5];
    const NodeId other = line[7];
    made.radius = random.uniform(0.015, 0.04);
    const double turn = random.uniform(0.0, 2.0 * kPi);
    const double rise = random.uniform(0.2, 1.2);
    const auto out = [&](double angle) {
        return glm::normalize(DVec3(std::cos(angle), rise, std::sin(angle)));
    };
    made.from = made.tree.node(made.joint).position;
    made.to = made.from + random.uniform(0.8, 1.4) * out(turn);
    // Where the branch comes out of the bark, and what of it the scan did not see.
    const DVec3 begin = made.from + (0.11 + gap) * out(turn) * std::sqrt(1.0 + rise * rise);
    test::add_cone(made.cloud, random, begin, made.to, made.radius, 0.5 * made.radius, 0.008, 0.0);
    const DVec3 at = made.tree.node(other).position;
    const DVec3 end = at + 1.0 * out(turn + 2.5);
    made.tree.add_child(made.tree.add_child(other, at + 0.15 * out(turn + 2.5), 0.02), end, 0.02);
    test::add_cone(made.cloud, random, at + 0.2 * out(turn + 2.5), end, 0.02, 0.02, 0.008, 0.0);
    return made;
}

double farthest_off(const Missing& made, const Completion& done) {
    double most = 0.0;
    for (const NodeId id : done.added) {
        const DVec3 p = made.tree.node(id).position;
        const double t =
            std::clamp(glm::dot(p - made.from, made.direction()), 0.0, glm::distance(made.from, made.to));
        most = std::max(most, glm::distance(p, made.from + t * made.direction()));
    }
    return most;
}

TEST(CompletionTest, FindsTheBranchThatWasPointedAt) {
    for (uint64_t seed = 0; seed < 20; seed++) {
        Missing made = missing_branch(seed);
        Random random(seed, 2);
        const size_t before = made.tree.size();
        const Tree old = made.tree;
        const DVec3 roughly =
            made.direction() +
            0.25 * DVec3(random.normal(), random.normal(), random.normal()) / std::sqrt(3.0);
        const Completion done = complete_branch(made.tree, made.cloud, made.joint, roughly);
        ASSERT_EQ(made.tree.check(), std::nullopt);
        ASSERT_FALSE(done.added.empty());
        EXPECT_EQ(made.tree.size(), before + done.added.size());
        EXPECT_EQ(made.tree.node(done.added.front()).parent, made.joint);
        EXPECT_LT(farthest_off(made, done), made.radius + 0.01) << seed;
        const double length = glm::distance(made.from, made.to);
        EXPECT_NEAR(done.length, length, 0.08 * length) << seed;
        double thickest = 0.0;
        for (const NodeId id : done.added)
            thickest = std::max(thickest, made.tree.node(id).radius);
        EXPECT_LT(thickest, 0.1 + 1e-12);
        for (const NodeId id : old.depth_first()) {
            EXPECT_EQ(old.node(id).position, made.tree.node(id).position);
            EXPECT_EQ(old.node(id).radius, made.tree.node(id).radius);
        }
        // What is explained now is not found again.
        try {
            EXPECT_LT(complete_branch(made.tree, made.cloud, made.joint, roughly).length, 0.25 * length)
                << seed;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("No points"), std::string::npos);
        }
    }
}

TEST(CompletionTest, AFirstStepOverNothingIsAGuess) {
    Missing made = missing_branch(3, 0.25);
    CompleteOptions options;
    options.reach = 0.6;
    const Completion done = complete_branch(made.tree, made.cloud, made.joint, made.direction(), options);
    EXPECT_TRUE(made.tree.node(done.added.front()).is_guess());
    Missing near = missing_branch(3);
    const Completion touching = complete_branch(near.tree, near.cloud, near.joint, near.direction());
    EXPECT_FALSE(near.tree.node(touching.added.front()).is_guess());
}

TEST(CompletionTest, OrderOfThePointsChangesNothing) {
    Missing first = missing_branch(5);
    Missing second = missing_branch(5);
    std::reverse(second.cloud.positions.begin(), second.cloud.positions.end());
    const Completion a = complete_branch(first.tree, first.cloud, first.joint, first.direction());
    const Completion b = complete_branch(second.tree, second.cloud, second.joint, second.direction());
    ASSERT_EQ(a.added, b.added);
    for (const NodeId id : a.added)
        EXPECT_EQ(first.tree.node(id).position, second.tree.node(id).position);
}

TEST(CompletionTest, WalksOverTheClusters) {
    for (uint64_t seed = 0; seed < 10; seed++) {
        Missing made = missing_branch(seed);
        const CompletedTree walked = complete_all(made.tree, made.cloud);
        ASSERT_EQ(made.tree.check(), std::nullopt);
        ASSERT_GE(walked.branches.size(), 1u) << seed;
        EXPECT_GT(walked.explained_after, walked.explained_before);
        EXPECT_GT(walked.explained_after, 0.97) << seed;
        double length = 0.0;
        for (const Completion& branch : walked.branches)
            length += branch.length;
        EXPECT_NEAR(length, glm::distance(made.from, made.to), 0.25 * length) << seed;
    }
}

// What is logged can be replayed without the cloud, and undone.
TEST(CompletionTest, IsAScriptOfCommands) {
    for (uint64_t seed = 0; seed < 10; seed++) {
        Missing made = missing_branch(seed);
        Tree replayed = made.tree;
        const Tree before = made.tree;
        const Completion done = complete_branch(made.tree, made.cloud, made.joint, made.direction());
        const ScriptResult result = run_script(replayed, completion_script(made.tree, done));
        EXPECT_EQ(result.done, done.added.size());
        ASSERT_EQ(replayed.size(), made.tree.size());
        for (const NodeId id : done.added) {
            ASSERT_TRUE(replayed.contains(id));
            EXPECT_LT(glm::distance(replayed.node(id).position, made.tree.node(id).position), 1e-6);
            EXPECT_NEAR(replayed.node(id).radius, made.tree.node(id).radius, 1e-6);
        }
        result.delta.revert(replayed);
        EXPECT_EQ(replayed.size(), before.size());
    }
}

TEST(CompletionTest, SaysWhatIsWrong) {
    Missing made = missing_branch(1);
    const Tree before = made.tree;
    const auto sentence = [&](NodeId node, const DVec3& direction,
                              CompleteOptions options = {}) -> std::string {
        try {
            complete_branch(made.tree, made.cloud, node, direction, options);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(sentence(99999, {1, 0, 0}).find("no node 99999"), std::string::npos);
    EXPECT_NE(sentence(made.joint, {0, 0, 0}).find("no length"), std::string::npos);
    EXPECT_NE(sentence(made.joint, -made.direction()).find("No points that the tree does not explain"),
              std::string::npos);
    CompleteOptions negative;
    negative.voxel = -1.0;
    EXPECT_NE(sentence(made.joint, made.direction(), negative).find("not negative"), std::string::npos);
    EXPECT_THROW(complete_branch(made.tree, made.cloud, made.joint, made.direction(), {}, {1, 0, 1}), Error);
    EXPECT_EQ(made.tree.size(), before.size());
    class Impatient : public Progress {
        bool cancelled() const override { return true; }
    } impatient;
    EXPECT_THROW(complete_branch(made.tree, made.cloud, made.joint, made.direction(), {}, {}, &impatient),
                 Cancelled);
    EXPECT_EQ(made.tree.size(), before.size());
}

}  // namespace
}  // namespace treerec
