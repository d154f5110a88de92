// What becomes of measured sections when a tree is changed, saved and put back.
#include <gtest/gtest.h>
#ifndef _WIN32
#include <unistd.h>
#endif

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "edit/commands/commands.h"
#include "edit/delta.h"
#include "edit/graft/scion.h"
#include "edit/move.h"
#include "edit/prune/removed.h"
#include "edit/smooth.h"
#include "edit/vary/vary.h"
#include "error.h"
#include "exchange/tree_files.h"
#include "section_outlines.h"
#include "tree/tree.h"

namespace treerec {
namespace {

SectionShape shape_of(int number) {
    SectionShape shape;
    shape.cosine = {0.01f * static_cast<float>(number), 0.1f, -0.05f, 1.0f / 3.0f};
    shape.sine = {-0.02f, 0.0f, 1e-7f, 0.25f};
    return shape;
}

// A trunk of ten nodes, all measured but the last; a branch of three on node 4, of which the first is.
Tree measured_tree() {
    Tree tree;
    NodeId at = tree.add_root({0, 0, 0}, 0.2, kTrunkFlag);
    for (int i = 1; i < 10; i++)
        at = tree.add_child(at, {0.01 * i, 0.5 * i, 0}, 0.2 - 0.01 * i, kTrunkFlag);
    at = 4;
    for (int i = 1; i <= 3; i++)
        at = tree.add_child(at, {0.5 * i, 2.0 + 0.3 * i, 0.1}, 0.07 - 0.01 * i);
    std::vector<SectionShape> shapes;
    for (int i = 0; i < 10; i++)
        shapes.push_back(shape_of(i));
    const size_t before = tree.add_sections(shapes);
    for (NodeId id = 0; id < 9; id++)
        tree.set_section(id, before + static_cast<size_t>(id) + 1);
    tree.set_section(10, before + 10);
    return tree;
}

void expect_section(const Tree& tree, NodeId id, int number) {
    const SectionShape* const section = tree.section_of(id);
    ASSERT_NE(section, nullptr) << "node " << id;
    EXPECT_EQ(*section, shape_of(number)) << "node " << id;
}

TEST(TreeSections, AreNamedByNodes) {
    Tree tree = measured_tree();
    expect_section(tree, 3, 3);
    expect_section(tree, 10, 9);
    EXPECT_EQ(tree.section_of(9), nullptr);
    EXPECT_EQ(tree.check(), std::nullopt);
    EXPECT_THROW(tree.set_section(1, 11), Error);
    EXPECT_THROW(tree.set_section(99, 1), Error);
    EXPECT_THROW(tree.set_section_table(nullptr), Error);
    tree.set_section(3, 0);
    tree.drop_unused_sections();
    EXPECT_EQ(tree.sections().size(), 9u);
    expect_section(tree, 4, 4);
    expect_section(tree, 10, 9);
    // Room is made of what no node names.
    tree.add_sections(std::vector<SectionShape>(kMostSections - 9));
    EXPECT_EQ(tree.add_sections({shape_of(7)}), 9u);
    expect_section(tree, 10, 9);
}

TEST(TreeSections, StayWithTheWoodThatIsReshaped) {
    Tree tree = measured_tree();
    tree.set_radius(2, 0.3);
    tree.set_position(2, {0.3, 1.0, 0.2});
    tree.scale(1.7);
    tree.rebase({1, 2, 3});
    expect_section(tree, 2, 2);
    const NodeId between = tree.insert_before(3, {0.02, 1.2, 0}, 0.18);
    expect_section(tree, between, 3);
    const NodeId grown = tree.add_child(5, {1, 3, 0}, 0.05);
    EXPECT_EQ(tree.section_of(grown), nullptr) << "nobody measured new wood";
    tree.dissolve(6);
    expect_section(tree, 7, 7);
    const Tree compact = tree.compacted();
    const std::vector<NodeId> ids = tree.depth_first();
    for (size_t i = 0; i < ids.size(); i++) {
        const SectionShape* const was = tree.section_of(ids[i]);
        const SectionShape* const is = compact.section_of(static_cast<NodeId>(i));
        ASSERT_EQ(was == nullptr, is == nullptr);
        if (was) {
            EXPECT_EQ(*was, *is);
        }
    }
    EXPECT_EQ(tree.check(), std::nullopt);
}

TEST(TreeSections, FinerWoodKeepsThem) {
    Tree tree = measured_tree();
    const std::vector<NodeId> added = subdivide(tree, tree.depth_first(), 0.2, true);
    ASSERT_FALSE(added.empty());
    expect_section(tree, 3, 3);
    for (const NodeId id : added) {
        NodeId above = id;
        while (above > 12)
            above = tree.node(above).first_child;
        EXPECT_EQ(tree.node(id).section, tree.node(above).section);
    }
}

TEST(TreeSections, GoAlongWithScionsAndCuts) {
    Tree tree = measured_tree();
    const Tree scion = take_scion(tree, 10);
    EXPECT_EQ(scion.sections().size(), 1u) << "only its own";
    ASSERT_NE(scion.section_of(1), nullptr);
    const std::vector<NodeId> added = place_scion(tree, 7, scion, {});
    // In the scion's own axes, the section is told by others.
    EXPECT_EQ(*tree.section_of(added[0]), *scion.section_of(1));
    EXPECT_EQ(tree.section_of(added[1]), nullptr);
    expect_section(tree, 7, 7);

    const Removed removed = remove_wood(tree, {10});
    const Tree piece = removed.piece(0, tree.frame());
    expect_section(piece, 1, 9);
    EXPECT_EQ(piece.section_of(2), nullptr);
    EXPECT_EQ(piece.sections().size(), 1u);
}

// Where the outline of a node is in space, in units of its radius, seen from its axis; and the other way
// about.
DVec3 outline_at(const Tree& tree, NodeId id, double angle) {
    const DVec3 way = glm::normalize(tree.node(id).position - tree.node(tree.node(id).parent).position);
    const DVec3 zero = section_zero(way);
    return (zero * std::cos(angle) + glm::cross(way, zero) * std::sin(angle)) *
           test::outline_radius(*tree.section_of(id), angle);
}

double off_outline(const Tree& tree, NodeId id, const DVec3& place) {
    const DVec3 way = glm::normalize(tree.node(id).position - tree.node(tree.node(id).parent).position);
    const DVec3 zero = section_zero(way);
    const double angle = std::atan2(glm::dot(place, glm::cross(way, zero)), glm::dot(place, zero));
    return std::abs(glm::length(place) - test::outline_radius(*tree.section_of(id), angle));
}

// What the scan showed on one side of a branch stays on that side of its wood.
TEST(TreeSections, TurnWithTheWood) {
    const Tree start = measured_tree();
    const DVec3 axis = glm::normalize(DVec3(0.3, 1.0, 0.4));
    const DMat3 turn = turn_about(axis, 2.0);
    const DVec3 normal = glm::normalize(DVec3(1.0, 0.2, -0.3));
    const DMat3 mirror = DMat3(1.0) - 2.0 * glm::outerProduct(normal, normal);
    for (const bool mirrored : {false, true}) {
        Tree tree = start;
        if (mirrored)
            mirror_branch(tree, 5, normal);
        else
            turn_branch(tree, 5, axis, glm::degrees(2.0));
        EXPECT_EQ(tree.check(), std::nullopt);
        for (const NodeId id : {5, 6, 7, 8})
            for (double angle = 0.0; angle < 6.3; angle += 0.7)
                EXPECT_LT(off_outline(tree, id, (mirrored ? mirror : turn) * outline_at(start, id, angle)),
                          1e-5)
                    << mirrored << " " << id;
        expect_section(tree, 4, 4);
    }
    // A scion that is put back where it was is as it was.
    Tree tree = start;
    const DMat3 frame = frame_about(direction_at(tree, 4));
    const std::vector<NodeId> added = place_scion(tree, 4, take_scion(tree, 10), {frame, 1.0});
    for (double angle = 0.0; angle < 6.3; angle += 0.7)
        EXPECT_LT(off_outline(tree, added[0], outline_at(start, 10, angle)), 1e-5);
}

TEST(TreeSections, VariantsShowThem) {
    const Tree tree = measured_tree();
    const Tree variant = VariantMaker(tree).make(3, 0.3).tree;
    EXPECT_EQ(variant.check(), std::nullopt);
    size_t shown = 0;
    for (const NodeId id : variant.depth_first())
        shown += variant.section_of(id) != nullptr;
    EXPECT_GE(shown, 8u);
}

TEST(TreeSections, EditsAreUndoneAndDoneAgain) {
    const Tree start = measured_tree();
    Tree tree = start;
    std::vector<Tree> states{tree};
    std::vector<TreeDelta> deltas;
    for (const char* const command :
         {"set_radius nodes=2 radius=0.3", "turn node=5 axis=0,1,0.2 angle=40", "mirror node=10 normal=1,0,0",
          "graft from=10 node=7", "subdivide nodes=all length=0.2", "cut node=10",
          "lstring node=8 string=F(0.3)[+(50)F(0.2)]F(0.3)", "smooth_paths nodes=all"}) {
        Tree next = tree;
        perform(next, command);
        EXPECT_EQ(next.check(), std::nullopt) << command;
        deltas.push_back(TreeDelta::between(tree, next));
        EXPECT_FALSE(deltas.back().empty());
        tree = next;
        states.push_back(tree);
    }
    for (size_t i = deltas.size(); i-- > 0;) {
        deltas[i].revert(tree);
        EXPECT_TRUE(identical(tree, states[i])) << i;
        EXPECT_EQ(tree.sections(), states[i].sections());
    }
    for (size_t i = 0; i < deltas.size(); i++) {
        deltas[i].apply(tree);
        EXPECT_TRUE(identical(tree, states[i + 1])) << i;
    }
    // A section alone is a change, too.
    Tree other = start;
    other.set_section(5, 0);
    EXPECT_FALSE(identical(start, other));
}

class SectionFiles : public ::testing::Test {
  protected:
    void SetUp() override {
        path_ = (std::filesystem::temp_directory_path() /
                 ("treerec_sections_" + std::to_string(::getpid()) + "_" +
                  ::testing::UnitTest::GetInstance()->current_test_info()->name()))
                    .string();
    }
    void TearDown() override { std::filesystem::remove(path_); }
    std::string get() const {
        std::ifstream in(path_, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void put(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }
    std::string path_;
};

TEST_F(SectionFiles, KeepThemToTheBit) {
    const Tree tree = measured_tree();
    write_treefile(path_, tree);
    const Tree read = read_treefile(path_);
    const std::vector<NodeId> ids = tree.depth_first();
    ASSERT_EQ(read.size(), tree.size());
    for (size_t i = 0; i < ids.size(); i++) {
        const SectionShape* const was = tree.section_of(ids[i]);
        const SectionShape* const is = read.section_of(static_cast<NodeId>(i));
        ASSERT_EQ(was == nullptr, is == nullptr) << i;
        if (was) {
            EXPECT_EQ(*was, *is);
        }
    }
}

TEST_F(SectionFiles, OlderOnesAreRead) {
    Tree plain = measured_tree();
    for (const NodeId id : plain.depth_first())
        plain.set_section(id, 0);
    write_treefile(path_, plain);
    EXPECT_EQ(get().find("section"), std::string::npos) << "as files were before";
    EXPECT_TRUE(read_treefile(path_).sections().empty());
}

TEST_F(SectionFiles, DamageIsSaid) {
    write_treefile(path_, measured_tree());
    const std::string whole = get();
    const size_t line = whole.find("# treerec section 3 ");
    ASSERT_NE(line, std::string::npos);
    const size_t end = whole.find('\n', line);
    for (const char* const bad :
         {"# treerec section 99 0 0 0 0 0 0 0 0", "# treerec section -1 0 0 0 0 0 0 0 0",
          "# treerec section 1.5 0 0 0 0 0 0 0 0", "# treerec section 3 0 0 0", "# treerec section ",
          "# treerec section 3 0 0 0 0 nan 0 0 0", "# treerec section 3 0 0 0 0 1e9 0 0 0",
          "# treerec section x 0 0 0 0 0 0 0 0"}) {
        put(whole.substr(0, line) + bad + whole.substr(end));
        EXPECT_THROW(read_treefile(path_), Error) << bad;
    }
    put(whole.substr(0, line) + "# of section 3 somebody wrote" + whole.substr(end));
    EXPECT_EQ(read_treefile(path_).sections().size(), 9u);
}

}  // namespace
}  // namespace treerec
