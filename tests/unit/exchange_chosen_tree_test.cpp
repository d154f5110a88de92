// Files of several trees, of none, and skeletons in sections and as MTG.
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "error.h"
#include "exchange/skeleton_parsers.h"
#include "exchange/text_scan.h"
#include "exchange/tree_files.h"
#include "random_tree.h"
#include "scan_samples.h"
#include "tree/branches.h"

namespace treerec {
namespace {

using scan_test::Folder;

std::string text_of(double value) {
    std::string text;
    append_number(text, value);
    return text;
}

// What a tree is made of, whatever its ids: places and radii with those of the parents, sorted.
std::vector<std::array<double, 8>> segments_of(const Tree& tree) {
    std::vector<std::array<double, 8>> rows;
    for (const NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode) continue;
        const Node& below = tree.node(node.parent);
        const DVec3 p = tree.frame().to_scan(node.position), q = tree.frame().to_scan(below.position);
        rows.push_back({p.x, p.y, p.z, node.radius, q.x, q.y, q.z, 0.0});
    }
    std::sort(rows.begin(), rows.end());
    return rows;
}

void expect_same(const Tree& tree, const Tree& read, const std::string& what, double tolerance = 1e-6) {
    const auto wanted = segments_of(tree), got = segments_of(read);
    ASSERT_EQ(wanted.size(), got.size()) << what;
    for (size_t i = 0; i < wanted.size(); i++)
        for (size_t k = 0; k < 8; k++)
            ASSERT_NEAR(wanted[i][k], got[i][k], tolerance) << what << " " << i;
}

// Three trees, the second the largest, each at its own place. Z up.
std::vector<Tree> three_trees() {
    std::vector<Tree> trees;
    const int nodes[] = {30, 90, 60};
    for (int i = 0; i < 3; i++) {
        Tree tree = test::random_tree(static_cast<uint64_t>(7 + i), nodes[i], 6.0);
        ScanFrame frame;
        frame.up = UpAxis::kZ;
        frame.origin = DVec3(20.0 * i, 5.0, 100.0);
        tree.set_frame(frame);
        trees.push_back(std::move(tree));
    }
    return trees;
}

// Calls node(number, parent's or -1, place, radius) for all nodes of all trees, parents first.
void for_all_nodes(const std::vector<Tree>& trees,
                   const std::function<void(size_t, int, int, const DVec3&, double)>& node) {
    int count = 0;
    for (size_t t = 0; t < trees.size(); t++) {
        std::vector<int> number(static_cast<size_t>(trees[t].id_end()), -1);
        for (const NodeId id : trees[t].depth_first()) {
            const Node& one = trees[t].node(id);
            number[static_cast<size_t>(id)] = count;
            node(t, count++, one.parent == kNoNode ? -1 : number[static_cast<size_t>(one.parent)],
                 trees[t].frame().to_scan(one.position), one.radius);
        }
    }
}

std::string place_of(const DVec3& p, const char* between) {
    return text_of(p.x) + between + text_of(p.y) + between + text_of(p.z);
}

TEST(ChosenTree, IsReadOfEveryFormThatHoldsSeveral) {
    const std::vector<Tree> trees = three_trees();
    std::string treefile = "x,y,z,radius,parent_id", table = "id,parent,x,y,z,radius\n", swc, vertices, edges;
    size_t line = 9, first = 0, count = 0, joined = 0;
    for_all_nodes(trees, [&](size_t tree, int number, int parent, const DVec3& p, double radius) {
        if (tree != line) {
            treefile += '\n';
            first = static_cast<size_t>(number);
        } else {
            treefile += ", ";
        }
        line = tree;
        const std::string r = text_of(radius);
        treefile += place_of(p, ",") + "," + r + "," +
                    std::to_string(parent < 0 ? -1 : parent - static_cast<int>(first));
        table +=
            std::to_string(number) + "," + std::to_string(parent) + "," + place_of(p, ",") + "," + r + "\n";
        swc += std::to_string(number + 1) + " 0 " + place_of(p, " ") + " " + r + " " +
               std::to_string(parent < 0 ? -1 : parent + 1) + "\n";
        vertices += place_of(p, " ") + " " + r + "\n";
        count++;
        if (parent < 0) return;
        edges += "2 " + std::to_string(parent) + " " + std::to_string(number) + "\n";
        joined++;
    });
    const std::string ply = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
                            "\nproperty double x\nproperty double y\nproperty double z\nproperty double "
                            "radius\nelement edge " +
                            std::to_string(joined) +
                            "\nproperty list uchar int vertex_indices\nend_header\n" + vertices + edges;
    const Folder folder;
    for (const auto& [name, bytes] : std::vector<std::pair<std::string, std::string>>{
             {"a.txt", treefile + "\n"}, {"b.csv", table}, {"c.swc", swc}, {"d.ply", ply}}) {
        const std::string path = folder.write(name, bytes);
        ASSERT_TRUE(is_skeleton_file(path)) << name;
        SkeletonReport report;
        expect_same(trees[1], read_skeleton(path, {}, &report), name + ", the largest");
        EXPECT_EQ(report.trees, 3u) << name;
        EXPECT_EQ(report.taken, 2u) << name;
        ASSERT_EQ(report.warnings.size(), 1u) << name;
        EXPECT_NE(report.warnings[0].find("3 trees"), std::string::npos) << report.warnings[0];
        EXPECT_NE(report.warnings[0].find("--tree"), std::string::npos) << report.warnings[0];
        for (size_t number = 1; number <= 3; number++) {
            SkeletonReport asked;
            expect_same(trees[number - 1], read_skeleton(path, {UpAxis::kZ, number}, &asked),
                        name + " " + std::to_string(number));
            EXPECT_EQ(asked.taken, number);
            EXPECT_TRUE(asked.warnings.empty()) << name << ": who asks knows";
        }
        EXPECT_THROW(read_skeleton(path, {UpAxis::kZ, 4}), Error) << name;
    }
}

TEST(ChosenTree, OfOneTreeIsTheFirst) {
    const Tree tree = three_trees()[0];
    const Folder folder;
    write_treefile(folder.file("a.txt"), tree);
    write_skeleton_ply(folder.file("a.ply"), tree);
    write_qsm_csv(folder.file("a.csv"), tree);
    for (const char* name : {"a.txt", "a.ply", "a.csv"}) {
        SkeletonReport report;
        expect_same(tree, read_skeleton(folder.file(name), {UpAxis::kZ, 1}, &report), name);
        EXPECT_EQ(report.trees, 1u);
        EXPECT_TRUE(report.warnings.empty());
        EXPECT_THROW(read_skeleton(folder.file(name), {UpAxis::kZ, 2}), Error) << name;
    }
}

// A single node was once a tree, and its model empty.
TEST(ChosenTree, WithoutWoodIsRefused) {
    const Folder folder;
    for (const auto& [name, bytes] : std::vector<std::pair<std::string, std::string>>{
             {"a.txt", "x,y,z,radius,parent_id\n1,2,3,0.1,-1\n"},
             {"b.txt", "x,y,z,radius,parent_id\n1,2,3,0.1,-1, 1,2,3,0.1,0, 1,2,3,0.2,1\n"},
             {"c.csv", "id,parent,x,y,z,radius\n1,-1,0,0,0,0.1\n"},
             {"d.swc", "1 0 1 2 3 0.5 -1\n"},
             {"e.txt", "x,y,z,radius,parent_id\n0,0,0,0.1,-1, 0,0,1e300,0.1,0\n"},
             {"f.txt", "x,y,z,radius,parent_id\n1e300,0,0,0.1,-1, 1e300,0,1,0.1,0\n"},
             {"g.txt", "x,y,z,radius,parent_id\n0,0,0,1e300,-1, 0,0,1,0.1,0\n"},
             {"h.txt", "x,y,z,radius,parent_id\n0,0,0,inf,-1, 0,0,1,0.1,0\n"},
             {"i.ply",
              "ply\nformat ascii 1.0\ncomment treerec 1 up z metres_per_unit 1\nelement vertex 1\nproperty "
              "double x\nproperty double y\nproperty double z\nproperty double radius\nelement edge "
              "0\nproperty int vertex1\nproperty int vertex2\nend_header\n0 0 0 1\n"}}) {
        const std::string path = folder.write(name, bytes);
        EXPECT_TRUE(is_skeleton_file(path)) << name;
        EXPECT_THROW(read_skeleton(path), Error) << name;
    }
}

// Rows as TreeQSM exports them for modelling programs: without names, below "# Cylinder data".
TEST(QsmSections, AreReadAsTheCylindersThatTheyAre) {
    const Tree tree = three_trees()[1];
    const BranchList list = list_branches(tree);
    std::string text = "# Cylinder data\r\n";
    std::vector<int> row(static_cast<size_t>(tree.id_end()), 0);
    int count = 0;
    for (size_t b = 0; b < list.branches.size(); b++)
        for (const NodeId id : list.nodes_of(list.branches[b])) {
            const Node& node = tree.node(id);
            if (node.parent == kNoNode) continue;
            const DVec3 start = tree.frame().to_scan(tree.node(node.parent).position);
            const DVec3 along = tree.frame().to_scan(node.position) - start;
            row[static_cast<size_t>(id)] = ++count;
            text += text_of(node.radius) + " " + text_of(glm::length(along)) + " " + place_of(start, "\t") +
                    "  " + place_of(glm::normalize(along), " ") + " " +
                    std::to_string(row[static_cast<size_t>(node.parent)]) + " 0 " + std::to_string(b + 1) +
                    " " + std::to_string(list.branches[b].order) + " 1 0\r\n";
        }
    text +=
        "# Branch data\n0 0 491.8 3.414 0 1.333\n1 1 209.1 2.414 45.01 1.75\n# Tree data\n0.7 # Total "
        "volume\n";
    const Folder folder;
    const std::string path = folder.write("qsm.txt", text);
    ASSERT_TRUE(is_skeleton_file(path));
    const Tree read = read_skeleton(path);
    expect_same(tree, read, "sections");
    size_t trunk = 0, wanted = 0;
    for (const NodeId id : read.depth_first())
        trunk += read.node(id).is_trunk();
    for (const Branch& branch : list.branches)
        if (branch.order == 0) wanted += list.nodes_of(branch).size();
    EXPECT_EQ(trunk, wanted) << "the order tells the trunk";

    EXPECT_FALSE(is_skeleton_file(folder.write("points.txt", "# points of a cylinder\n1 2 3\n4 5 6\n")));
    EXPECT_FALSE(is_skeleton_file(folder.write("cloud.txt", "# Cylinder data\n1 2 3 4 5 6\n4 5 6 7 8 9\n")));
    for (const char* damaged :
         {"# Cylinder data\n", "# Cylinder data\n0.3 1 0 0 0 0 0 1 0\n0.3 1 0 0\n",
          "# Cylinder data\n0.3 1 0 0 0 0 0 1 0\n0.3 1 0 0 x 0 0 1 1\n",
          "# Cylinder data\n0.3 1 0 0 0 0 0 1 0\n# Cylinder data\n0.3 1 0 0 0 0 0 1 0\n"})
        EXPECT_THROW(parse_qsm_sections(damaged, "q.txt", {}, nullptr), Error) << damaged;
}

// As plantscan3d writes it: the tabs before a code tell what it grows on.
std::string mtg_of(const std::vector<Tree>& trees, const std::string& features, double factor) {
    int deepest = 0;
    std::string rows;
    for (const Tree& tree : trees) {
        rows += "/P\n";
        const std::function<void(NodeId, int, const char*)> write = [&](NodeId id, int column,
                                                                        const char* code) {
            deepest = std::max(deepest, column);
            const Node& node = tree.node(id);
            rows += std::string(static_cast<size_t>(column), '\t') + code + "\x01" + std::to_string(column) +
                    "\x02" + place_of(tree.frame().to_scan(node.position), "\t") + "\t" +
                    text_of(factor * node.radius) + "\n";
            // All but the first stand on lines of their own column, before the axis goes on.
            std::vector<NodeId> children;
            for (const NodeId child : tree.children(id))
                children.push_back(child);
            for (size_t i = 1; i < children.size(); i++)
                write(children[i], column + 1, "+N");
            if (!children.empty()) write(children[0], column, "^<N");
        };
        write(tree.root(), 0, "^/N");
    }
    std::string aligned;
    for (size_t at = 0; at < rows.size();) {
        const size_t mark = rows.find('\x01', at);
        if (mark == rows.npos) {
            aligned += rows.substr(at);
            break;
        }
        const size_t end = rows.find('\x02', mark);
        const int column = std::stoi(rows.substr(mark + 1, end - mark - 1));
        aligned += rows.substr(at, mark - at) + std::string(static_cast<size_t>(deepest + 1 - column), '\t');
        at = end + 1;
    }
    return "CODE :\tFORM-A\n\nCLASSES "
           ":\nSYMBOL\tSCALE\tDECOMPOSITION\tINDEXATION\tDEFINITION\n$\t0\tFREE\tFREE\t"
           "IMPLICIT\nP\t1\tFREE\tFREE\tEXPLICIT\nN\t2\tFREE\tFREE\tEXPLICIT\n\nDESCRIPTION "
           ":\nLEFT\tRIGHT\tRELTYPE\t"
           "MAX\nN\tN\t<\t?\nN\tN\t+\t?\n\nFEATURES :\nNAME\tTYPE\nXX\tREAL\n\nMTG :\nENTITY-CODE" +
           std::string(static_cast<size_t>(deepest + 1), '\t') + features + "\n" + aligned;
}

TEST(Mtg, IsReadAsTheTreeThatItsTabsDraw) {
    const std::vector<Tree> trees = three_trees();
    const Folder folder;
    for (const auto& [features, factor] :
         {std::pair{"XX\tYY\tZZ\tradius", 1.0}, std::pair{"XX\tYY\tZZ\tdiameter", 2.0}}) {
        const std::string path = folder.write("a.mtg", mtg_of({trees[1]}, features, factor));
        ASSERT_TRUE(is_skeleton_file(path));
        expect_same(trees[1], read_skeleton(path), features);
    }
    const std::string many = folder.write("b.mtg", mtg_of(trees, "XX\tYY\tZZ\tradius", 1.0));
    SkeletonReport report;
    expect_same(trees[1], read_skeleton(many, {}, &report), "the largest");
    EXPECT_EQ(report.trees, 3u);
    expect_same(trees[2], read_skeleton(many, {UpAxis::kZ, 3}), "the third");

    const std::string no_places =
        folder.write("c.mtg", mtg_of({trees[0]}, "length\twidth\tage\tradius", 1.0));
    try {
        read_skeleton(no_places);
        ADD_FAILURE() << "an MTG without places was read";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("MTG"), std::string::npos) << error.what();
    }
    const std::string whole = mtg_of({trees[0]}, "XX\tYY\tZZ\tradius", 1.0);
    for (size_t length = 12; length < whole.size(); length += 97)
        try {
            EXPECT_EQ(parse_mtg(whole.substr(0, length), "m", {}, nullptr).check().value_or("sound"),
                      "sound");
        } catch (const Error&) {
        }
}

TEST(Mtg, IsWrittenAsItIsRead) {
    const Folder folder;
    for (const Tree& tree : three_trees()) {
        const std::string path = folder.write("a.mtg", "");
        write_mtg(path, tree);
        ASSERT_TRUE(is_skeleton_file(path));
        expect_same(tree, read_skeleton(path), "written");
    }
    EXPECT_THROW(write_mtg(folder.write("b.mtg", ""), Tree()), Error);
}

// plantscan3d's own file of a real tree, and its nodes in another program's table.
TEST(Mtg, OfARealTreeAgreesWithItsTable) {
    const std::string clouds = scan_test::scans_folder();
    if (clouds.empty()) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of scans";
    for (const char* name : {"A1B2", "A3B4", "A5B7"}) {
        const std::string stem = clouds + "../groundtruth/vezy_" + name + "_skeleton_corrected.";
        const Tree mtg = read_skeleton(stem + "mtg"), table = read_skeleton(stem + "in_cloud_coords.csv");
        ASSERT_EQ(mtg.size(), table.size()) << name;
        const std::vector<NodeId> a = mtg.depth_first(), b = table.depth_first();
        // The table lies elsewhere.
        double length_a = 0.0, length_b = 0.0;
        for (size_t i = 1; i < a.size(); i++) {
            length_a += glm::distance(mtg.node(a[i]).position, mtg.node(mtg.node(a[i]).parent).position);
            length_b +=
                glm::distance(table.node(b[i]).position, table.node(table.node(b[i]).parent).position);
        }
        EXPECT_NEAR(length_a, length_b, 1e-3 * length_b) << name;
    }
}

}  // namespace
}  // namespace treerec
