// Picking nodes on the screen, and previews of edits.
#include "edit/pick.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "edit/commands/commands.h"
#include "edit/preview.h"
#include "random_edit.h"
#include "random_tree.h"

namespace treerec {
namespace {

// A stem of 4 m with a fork at 2 m, seen from 10 m in front: at (0, 0, 10), looking along -z.
Tree fork() {
    Tree tree;
    const NodeId root = tree.add_root({0, 0, 0}, 0.2);
    const NodeId middle = tree.add_child(root, {0, 2, 0}, 0.2);
    tree.add_child(middle, {0, 4, 0}, 0.05);
    tree.add_child(middle, {2, 3, 0}, 0.05);
    return tree;
}

ScreenView front(double z = 10.0) {
    ScreenView view;
    view.width = 800;
    view.height = 600;
    view.to_clip = glm::perspective(1.0, 800.0 / 600.0, 0.1, 100.0) *
                   glm::lookAt(glm::dvec3(0, 2, z), glm::dvec3(0, 2, z - 1.0), glm::dvec3(0, 1, 0));
    return view;
}

DVec2 seen(const ScreenView& view, const DVec3& place) {
    DVec3 at;
    EXPECT_TRUE(project(view, place, at));
    return DVec2(at);
}

TEST(Pick, TheNodeUnderThePointer) {
    const Tree tree = fork();
    const ScreenView view = front();
    for (NodeId id = 0; id < 4; id++) {
        const DVec2 at = seen(view, tree.node(id).position);
        EXPECT_EQ(pick_node(tree, view, at, 8.0), id);
        EXPECT_EQ(pick_node(tree, view, at + DVec2(5, 5), 8.0), id);
    }
    EXPECT_EQ(pick_node(tree, view, {700, 100}, 8.0), kNoNode);
    EXPECT_EQ(pick_node(tree, view, {NAN, 100}, 8.0), kNoNode);
    EXPECT_EQ(pick_node(tree, view, seen(view, {0, 2, 0}), -1.0), kNoNode);
    EXPECT_EQ(pick_node(Tree(), view, {400, 300}, 8.0), kNoNode);
    // x goes to the right and y down.
    EXPECT_GT(seen(view, {2, 3, 0}).x, 400.0);
    EXPECT_LT(seen(view, {2, 3, 0}).y, 300.0);
}

TEST(Pick, WoodBetweenNodesBelongsToItsUpperNode) {
    const Tree tree = fork();
    const ScreenView view = front();
    EXPECT_EQ(pick_node(tree, view, seen(view, {0, 1, 0}), 8.0), 1);
    EXPECT_EQ(pick_node(tree, view, seen(view, {1, 2.5, 0}), 8.0), 3);
    // The stem is as thick as it is seen: some 11 pixels to each side.
    const DVec2 bark = seen(view, {0.19, 1, 0});
    ASSERT_GT(bark.x - 400.0, 8.0);
    EXPECT_EQ(pick_node(tree, view, bark, 0.5), 1);
    EXPECT_EQ(pick_node(tree, view, seen(view, {0.5, 1, 0}), 8.0), kNoNode);
}

TEST(Pick, TheOneInFrontOfSeveral) {
    Tree tree = fork();
    const NodeId behind = tree.add_child(2, {0, 4.02, -1.0}, 0.05);
    const NodeId before = tree.add_child(2, {0.005, 4.0, 1.0}, 0.05);
    const ScreenView view = front();
    tree.set_position(before, {0.003, 2.0 + 2.0 * 0.9, 1.0});
    const DVec2 at = seen(view, {0, 4, 0});
    ASSERT_LT(glm::distance(seen(view, tree.node(before).position), at), 2.0);
    EXPECT_EQ(pick_node(tree, view, at, 8.0), before);
    EXPECT_NE(pick_node(tree, view, at, 8.0), behind);
}

TEST(Pick, NothingBehindTheCamera) {
    const Tree tree = fork();
    // Within the tree's plane's back, and turned away.
    ScreenView view = front(-10.0);
    for (NodeId id = 0; id < 4; id++) {
        DVec3 at;
        EXPECT_FALSE(project(view, tree.node(id).position, at));
    }
    EXPECT_EQ(pick_node(tree, view, {400, 300}, 1e6), kNoNode);
    EXPECT_TRUE(pick_nodes(tree, view, {-1e6, -1e6}, {1e6, 1e6}).empty());
    // A segment from behind the camera to its front is picked where it is seen.
    Tree through;
    through.add_root({0, 2, 20}, 0.01);
    through.add_child(0, {0, 2, -5}, 0.01);
    through.set_position(1, {1, 2, -5});
    const DVec3 between = through.node(0).position * 0.3 + through.node(1).position * 0.7;
    EXPECT_EQ(pick_node(through, front(), seen(front(), between), 4.0), 1);
}

TEST(Pick, AlsoWithoutPerspective) {
    const Tree tree = fork();
    ScreenView view = front();
    view.to_clip = glm::ortho(-4.0, 4.0, -3.0, 3.0, 0.1, 100.0) *
                   glm::lookAt(glm::dvec3(0, 2, 10), glm::dvec3(0, 2, 9), glm::dvec3(0, 1, 0));
    EXPECT_EQ(pick_node(tree, view, {600, 200}, 1.0), 3);
    EXPECT_EQ(pick_node(tree, view, {400 + 19, 400}, 0.5), 1);  // 100 pixels for a metre
    EXPECT_EQ(pick_node(tree, view, {400 + 22, 400}, 0.5), kNoNode);
}

TEST(Pick, AgreesWithLookingAtEveryNode) {
    for (uint64_t seed = 1; seed <= 30; seed++) {
        const Tree tree = test::random_tree(seed, 800);
        Random random(seed);
        ScreenView view = front();
        const DVec3 eye = 15.0 * random.direction() + DVec3(0, 6, 0);
        view.to_clip = glm::perspective(1.0, 800.0 / 600.0, 0.1, 100.0) *
                       glm::lookAt(eye, DVec3(0, 6, 0), DVec3(0.1, 0.98, 0.1));
        for (int i = 0; i < 40; i++) {
            const DVec2 at(random.uniform(200, 600), random.uniform(100, 500));
            double least = 1e9;
            for (NodeId id = 0; id < tree.id_end(); id++)
                least = std::min(least, glm::distance(seen(view, tree.node(id).position), at));
            const NodeId got = pick_node(tree, view, at, 8.0);
            if (least > 8.0) continue;
            ASSERT_NE(got, kNoNode);
            EXPECT_LE(glm::distance(seen(view, tree.node(got).position), at), least + 2.0);
        }
        const DVec2 a(random.uniform(0, 800), random.uniform(0, 600));
        const DVec2 b(random.uniform(0, 800), random.uniform(0, 600));
        std::vector<NodeId> wanted;
        for (NodeId id = 0; id < tree.id_end(); id++) {
            const DVec2 at = seen(view, tree.node(id).position);
            if ((at.x - a.x) * (at.x - b.x) <= 0.0 && (at.y - a.y) * (at.y - b.y) <= 0.0)
                wanted.push_back(id);
        }
        EXPECT_EQ(pick_nodes(tree, view, a, b), wanted);
    }
}

// A view of no size or without an end sees nothing, whichever of its numbers is none.
TEST(Pick, NothingIsSeenThroughWhatIsNoView) {
    const Tree tree = test::random_tree(3, 60);
    const double odd[] = {NAN, INFINITY, -INFINITY, 1e308, -1e308, 0.0};
    const ScreenView good{glm::dmat4(1.0), 1280.0, 720.0};
    for (const double value : odd) {
        for (int entry = 0; entry < 18; entry++) {
            ScreenView view = good;
            if (entry < 16)
                view.to_clip[entry / 4][entry % 4] = value;
            else
                (entry == 16 ? view.width : view.height) = value;
            const NodeId one = pick_node(tree, view, {640.0, 360.0}, 8.0);
            const std::vector<NodeId> all = pick_nodes(tree, view, {0.0, 0.0}, {1280.0, 720.0});
            if (std::isfinite(value)) {
                EXPECT_TRUE(one == kNoNode || tree.contains(one)) << value << ", " << entry;
            } else {
                EXPECT_EQ(one, kNoNode) << value << ", " << entry;
                EXPECT_TRUE(all.empty()) << value << ", " << entry;
            }
        }
        if (std::isfinite(value)) continue;
        EXPECT_EQ(pick_node(tree, good, {value, 360.0}, 8.0), kNoNode);
        EXPECT_EQ(pick_node(tree, good, {640.0, value}, 8.0), kNoNode);
    }
    EXPECT_EQ(pick_node(tree, good, {640.0, 360.0}, NAN), kNoNode);
    EXPECT_EQ(pick_node(tree, good, {640.0, 360.0}, -1.0), kNoNode);
    EXPECT_TRUE(pick_nodes(tree, good, {NAN, 0.0}, {1280.0, 720.0}).empty());
}

// The wood that a preview leaves is the wood that the edit leaves.
TEST(Preview, ShowsWhatTheEditDoes) {
    using Line = std::array<double, 6>;
    const auto lines = [](const std::vector<DVec3>& ends) {
        std::multiset<Line> all;
        for (size_t i = 0; i + 1 < ends.size(); i += 2)
            all.insert({ends[i].x, ends[i].y, ends[i].z, ends[i + 1].x, ends[i + 1].y, ends[i + 1].z});
        return all;
    };
    const auto wood = [&](const Tree& tree) {
        std::vector<DVec3> ends;
        for (NodeId id = 0; id < tree.id_end(); id++) {
            if (!tree.contains(id) || tree.node(id).parent == kNoNode) continue;
            ends.push_back(tree.node(tree.node(id).parent).position);
            ends.push_back(tree.node(id).position);
        }
        return lines(ends);
    };
    int changed = 0;
    for (uint64_t seed = 1; seed <= 400; seed++) {
        const Tree tree = test::random_tree(seed % 20 + 1, 200);
        Random random(seed);
        const EditCommand& command =
            edit_commands()[random.below(static_cast<uint32_t>(edit_commands().size()))];
        const std::string line = test::random_command(command, tree, random);
        const Tree before = tree;
        const EditPreview preview = preview_edit(tree, line);
        ASSERT_TRUE(identical(tree, before));
        Tree after = tree;
        try {
            EXPECT_EQ(preview.message, perform(after, line).outcome.said);
        } catch (const Error& error) {
            EXPECT_EQ(preview.error, error.what());
            EXPECT_TRUE(preview.added.empty() && preview.removed.empty());
            continue;
        }
        EXPECT_EQ(preview.error, "");
        EXPECT_EQ(preview.added.size(), 2 * preview.added_radii.size());
        std::multiset<Line> expected = wood(tree);
        for (const Line& one : lines(preview.removed)) {
            const auto found = expected.find(one);
            ASSERT_NE(found, expected.end()) << line;
            expected.erase(found);
        }
        for (const Line& one : lines(preview.added))
            expected.insert(one);
        EXPECT_EQ(expected, wood(after)) << line;
        changed += !preview.added.empty() || !preview.removed.empty();
    }
    EXPECT_GT(changed, 100);
    EXPECT_EQ(preview_edit(test::random_tree(1, 50), "nonsense").error.substr(0, 25),
              "There is no command 'nons");
}

}  // namespace
}  // namespace treerec
