// The commands that graft, and the library of twigs.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "edit/commands/commands.h"
#include "edit/graft/scion.h"
#include "edit/graft/twig_library.h"
#include "edit/graft/twig_picture.h"
#include "error.h"
#include "lsystem/lstring.h"
#include "random_tree.h"
#include "tree/branches.h"

namespace treerec {
namespace {

TEST(EditGraftLibrary, HoldsTwigsThatAreScions) {
    std::set<std::string_view> names;
    size_t crown = 0;
    for (const LibraryTwig& twig : twig_library()) {
        const std::string name(twig.name);
        EXPECT_TRUE(names.insert(twig.name).second) << name;
        EXPECT_GT(twig.title.size(), 10u) << name;
        const Tree scion = read_lstring(twig.string);
        ASSERT_EQ(scion.check(), std::nullopt) << name;
        EXPECT_EQ(&find_library_twig(twig.name), &twig);
        if (name.find('_') !=
            std::string::npos) {  // of those that fill a sketch's crown: sketch_species_test
            crown++;
            continue;
        }
        EXPECT_GT(scion.size(), 80u) << name;
        EXPECT_LT(scion.size(), 500u) << name;
        EXPECT_GT(scion_length(scion), 0.5) << name;
        EXPECT_LT(scion_length(scion), 2.0) << name;
        // Grown along +Y, as thick as such a branch, and ever thinner.
        EXPECT_GT(scion_direction(scion).y, 0.9) << name;
        EXPECT_GT(scion.node(scion.root()).radius, 0.004) << name;
        EXPECT_LT(scion.node(scion.root()).radius, 0.02) << name;
        for (NodeId id : scion.depth_first()) {
            const Node& node = scion.node(id);
            if (node.parent == kNoNode) continue;
            EXPECT_LE(node.radius, scion.node(node.parent).radius) << name << " " << id;
            EXPECT_GT(glm::distance(node.position, scion.node(node.parent).position), 0.002) << name;
        }
        EXPECT_GE(list_branches(scion).branches.size(), 8u) << name;
    }
    EXPECT_EQ(names.size(), 22u);
    EXPECT_EQ(crown, 12u);
    try {
        find_library_twig("palm");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("generic"), std::string::npos);
    }
}

// Which way most of the wood hangs or rises, 0..1 each, grown at 35 degrees above the level.
double share_that_hangs(const Tree& scion) {
    const DVec3 up(0.0, std::sin(35.0 * kPi / 180.0), std::cos(35.0 * kPi / 180.0));
    double hangs = 0.0;
    double all = 0.0;
    for (NodeId id : scion.depth_first()) {
        if (scion.node(id).parent == kNoNode) continue;
        const DVec3 way = scion.node(id).position - scion.node(scion.node(id).parent).position;
        all += glm::length(way);
        if (glm::dot(way, up) < -0.3 * glm::length(way)) hangs += glm::length(way);
    }
    return hangs / all;
}

TEST(EditGraftLibrary, EachGrowsInItsOwnWay) {
    const auto scion = [](std::string_view name) { return read_lstring(find_library_twig(name).string); };
    EXPECT_GT(share_that_hangs(scion("willow")), 0.5);
    EXPECT_GT(share_that_hangs(scion("birch")), 0.3);
    EXPECT_LT(share_that_hangs(scion("cherry")), 0.1);
    EXPECT_LT(share_that_hangs(scion("maple")), 0.1);
    // A maple's buds stand in pairs, a pine's shoots in whorls.
    const auto most_at_a_node = [](const Tree& tree) {
        int most = 0;
        for (NodeId id : tree.depth_first())
            most = std::max(most, tree.node(id).child_count);
        return most;
    };
    EXPECT_EQ(most_at_a_node(scion("maple")), 3);
    EXPECT_GE(most_at_a_node(scion("pine")), 4);
    EXPECT_EQ(most_at_a_node(scion("cherry")), 2);
    // A spruce's spray is flat.
    const DVec3 spray = scion("spruce").bounds().size();
    EXPECT_LT(spray.z, 0.5 * spray.x);
}

TEST(EditGraftLibrary, DrawsWhatItHolds) {
    for (const LibraryTwig& twig : twig_library()) {
        const Image image = draw_twig(read_lstring(twig.string), 96);
        int there = 0;
        int left = 95, right = 0, top = 95, bottom = 0;
        for (int y = 0; y < 96; y++) {
            for (int x = 0; x < 96; x++) {
                const uint8_t* pixel = image.at(x, y);
                if (pixel[3] == 0) continue;
                there++;
                EXPECT_GT(pixel[0], 60) << twig.name;
                left = std::min(left, x), right = std::max(right, x);
                top = std::min(top, y), bottom = std::max(bottom, y);
            }
        }
        // Fills the picture one way, without touching its edge.
        EXPECT_GE(std::max(right - left, bottom - top), 85) << twig.name;
        EXPECT_GT(std::min({left, top, 95 - right, 95 - bottom}), 0) << twig.name;
        EXPECT_GT(there, 300) << twig.name;
        EXPECT_LT(there, 96 * 96 / 2) << twig.name;
        // It comes in from the left.
        EXPECT_LT(left, 30) << twig.name;
    }
    Tree wild = test::wild_tree(3, 40);
    EXPECT_EQ(draw_twig(wild, 16).pixels.size(), 16u * 16u * 4u);
    EXPECT_THROW(draw_twig(Tree(), 64), Error);
    EXPECT_THROW(draw_twig(wild, 8), Error);
    EXPECT_THROW(draw_twig(wild, 513), Error);
}

TEST(EditGraftCommands, ATwigAndAGraftOnIt) {
    Tree tree = test::random_tree(3, 200);
    const NodeId host = tree.nodes_of_kind(NodeKind::kCommon)[20];
    const Edit twig = perform(tree, "twig node=" + std::to_string(host) + " side=left view=0,0,-1");
    ASSERT_EQ(twig.outcome.nodes.size(), 1u);
    const NodeId tip = twig.outcome.nodes[0];
    EXPECT_EQ(tree.node(tip).parent, host);
    EXPECT_LT(tree.node(tip).position.x, tree.node(host).position.x + 0.2);
    const size_t before = tree.size();
    const std::string line = "graft node=" + std::to_string(tip) + " twig=oak seed=4 tries=10";
    const Edit graft = perform(tree, line);
    EXPECT_EQ(graft.outcome.nodes.size(), read_lstring(find_library_twig("oak").string).size() - 1);
    EXPECT_EQ(tree.size(), before + graft.outcome.nodes.size());
    EXPECT_NE(graft.outcome.said.find("Grafted 1 branch of"), std::string::npos);
    graft.delta.revert(tree);
    EXPECT_EQ(tree.size(), before);
    // As a string, or as a copy of another branch.
    const Edit string = perform(
        tree, "graft node=" + std::to_string(tip) + " string=\"!(0.01)F(0.3)[+(50)!(0.004)F(0.2)]F(0.3)\"");
    EXPECT_EQ(string.outcome.nodes.size(), 3u);
    string.delta.revert(tree);
    const NodeId other = tree.nodes_of_kind(NodeKind::kBranch)[2];
    const size_t branch = tree.depth_first(other).size();
    const Edit copy = perform(
        tree, "graft node=" + std::to_string(tip) + " from=" + std::to_string(other) + " angle=0 stretch=0");
    EXPECT_EQ(copy.outcome.nodes.size(), branch);
}

TEST(EditGraftCommands, ATwigTellsWhatItHits) {
    Tree tree;
    tree.add_root({0, 0, 0}, 0.05);
    tree.add_child(0, {0, 1, 0}, 0.05);
    tree.add_child(1, {0, 2, 0}, 0.05);
    const NodeId arm = tree.add_child(0, {1, 0.2, 0}, 0.02);
    tree.add_child(arm, {1, 2, 0}, 0.02);
    EXPECT_EQ(perform(tree, "twig node=1 direction=1,0.1,0 length=1.2").outcome.said,
              "The twig runs into 1 segment of another branch.");
    EXPECT_EQ(perform(tree, "twig node=1 direction=-1,0.1,0 length=1.2").outcome.said, "");
}

TEST(EditGraftCommands, ManyAtOnce) {
    Tree tree = test::random_tree(5, 300);
    const size_t tips = tree.nodes_of_kind(NodeKind::kLeaf).size();
    const Edit edit = perform(tree, "graft_many nodes=leaves twigs=maple,dead seed=2");
    EXPECT_NE(edit.outcome.said.find("Grafted " + std::to_string(tips) + " branches"), std::string::npos);
    EXPECT_GT(tree.size(), 300 + 100 * tips);
    EXPECT_EQ(perform(tree, "graft_many nodes=height:500..").outcome.said,
              "Nothing was grafted: no node was chosen.");
    EXPECT_EQ(tree.check(), std::nullopt);
}

TEST(EditGraftCommands, SayWhatIsWrong) {
    Tree tree = test::random_tree(5, 100);
    const auto error_of = [&](const char* line) -> std::string {
        try {
            perform(tree, line);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_NE(error_of("graft node=3 twig=palm").find("oak"), std::string::npos);
    EXPECT_NE(error_of("graft_many nodes=leaves twigs=maple,palm").find("'palm'"), std::string::npos);
    EXPECT_NE(error_of("graft node=3 string=\"F(0.1)[\"").find("line 1"), std::string::npos);
    EXPECT_NE(error_of("graft node=3 string=\"+(3)\"").find("single node"), std::string::npos);
    EXPECT_NE(error_of("graft node=3 aim=direction").find("direction=x,y,z"), std::string::npos);
    EXPECT_NE(error_of("graft_many nodes=all most=100").find("100 that are allowed"), std::string::npos);
    EXPECT_EQ(tree.size(), test::random_tree(5, 100).size());
}

}  // namespace
}  // namespace treerec
