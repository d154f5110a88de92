// Skeletons as other programs write them.
#include <gtest/gtest.h>
#ifndef _WIN32
#include <unistd.h>
#endif

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>

#include "error.h"
#include "exchange/skeleton_parsers.h"
#include "exchange/text_scan.h"
#include "exchange/tree_files.h"
#include "random_tree.h"

namespace treerec {
namespace {

std::string text_of(double value) {
    std::string text;
    append_number(text, value);
    return text;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
    std::string line;
    for (size_t i = 0; i < words.size(); i++)
        line += (i > 0 ? between : "") + words[i];
    return line + "\n";
}

// Its nodes but the root, with their parents, by place, in scan coordinates.
std::vector<std::array<double, 7>> segments_of(const Tree& tree) {
    std::vector<std::array<double, 7>> rows;
    for (NodeId id : tree.depth_first()) {
        if (tree.node(id).parent == kNoNode) continue;
        const DVec3 p = tree.frame().to_scan(tree.node(id).position);
        const DVec3 q = tree.frame().to_scan(tree.node(tree.node(id).parent).position);
        rows.push_back({p.x, p.y, p.z, q.x, q.y, q.z, tree.node(id).radius});
    }
    std::sort(rows.begin(), rows.end());
    return rows;
}

void expect_same_segments(const Tree& a, const Tree& b, double tolerance) {
    EXPECT_EQ(b.check().value_or("sound"), "sound");
    const auto rows_a = segments_of(a), rows_b = segments_of(b);
    ASSERT_EQ(rows_a.size(), rows_b.size());
    for (size_t i = 0; i < rows_a.size(); i++)
        for (size_t k = 0; k < 7; k++)
            ASSERT_NEAR(rows_a[i][k], rows_b[i][k], tolerance) << "segment " << i << ", value " << k;
}

// One segment of a tree as a cylinder, in a file's coordinates (Z up).
struct Cylinder {
    int row = 0;     // from 1
    int parent = 0;  // 0: none
    DVec3 start{0.0}, end{0.0}, axis{0.0};
    double radius = 0.0, length = 0.0;
    int order = 0;
};

std::vector<Cylinder> cylinders_of(const Tree& tree) {
    std::vector<Cylinder> cylinders;
    std::vector<int> row(static_cast<size_t>(tree.id_end()), 0);
    for (NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode) continue;
        Cylinder one;
        one.row = row[id] = static_cast<int>(cylinders.size()) + 1;
        one.parent = row[node.parent];
        one.start = tree.frame().to_scan(tree.node(node.parent).position);
        one.end = tree.frame().to_scan(node.position);
        one.length = glm::distance(one.start, one.end);
        one.axis = (one.end - one.start) / one.length;
        one.radius = node.radius;
        one.order = node.is_trunk() ? 0 : 1;
        cylinders.push_back(one);
    }
    return cylinders;
}

struct Dialect {
    const char* program;
    std::string head;
    const char* between;
    std::function<std::vector<std::string>(const Cylinder&)> row;
};

std::vector<Dialect> dialects() {
    const auto triple = [](std::vector<std::string>& row, const DVec3& v) {
        for (int axis = 0; axis < 3; axis++)
            row.push_back(text_of(v[axis]));
    };
    const auto tree_qsm = [triple](const Cylinder& c) {
        std::vector<std::string> row{text_of(c.radius), text_of(c.length)};
        triple(row, c.start);
        triple(row, c.axis);
        for (const double v : {c.parent, 0, 1, c.order, 1})
            row.push_back(text_of(v));
        row.insert(row.end(), {"0.002", "0.7", "0", text_of(c.radius)});
        return row;
    };
    return {
        {"TreeQSM's text",
         "radius (m)\tlength (m)\tstart_point\taxis_direction\tparent\textension\tbranch\tbranch_order\t"
         "position_in_branch\tmad\tSurfCov\tadded\tUnmodRadius (m)\n",
         "\t", tree_qsm},
        {"TreeQSM in R, with the numbers of the rows",
         "\"\",\"radius\",\"length\",\"start.x\",\"start.y\",\"start.z\",\"axis.x\",\"axis.y\",\"axis.z\","
         "\"parent\",\"extension\",\"branch\",\"BranchOrder\",\"PositionInBranch\",\"mad\",\"SurfCov\","
         "\"added\",\"UnmodRadius\"\n",
         ",",
         [tree_qsm](const Cylinder& c) {
             std::vector<std::string> row = tree_qsm(c);
             row.insert(row.begin(), "\"" + std::to_string(c.row) + "\"");
             return row;
         }},
        {"TreeQSM from MATLAB's writetable, rows numbered in a column without a name",
         "radius,length,start_1,start_2,start_3,axis_1,axis_2,axis_3,parent,extension,branch,BranchOrder,"
         "PositionInBranch,mad,SurfCov,added,UnmodRadius\n",
         ",",
         [tree_qsm](const Cylinder& c) {
             std::vector<std::string> row = tree_qsm(c);
             row.insert(row.begin(), std::to_string(c.row));
             return row;
         }},
        {"SimpleForest",
         "type, ID, parentID, startX, startY, startZ, endX, endY, endZ, radius, volume, length, branchOrder, "
         "branchID, species\r\n",
         ", ",
         [triple](const Cylinder& c) {
             std::vector<std::string> row{"cylinder", std::to_string(c.row - 1),
                                          std::to_string(c.parent - 1)};
             triple(row, c.start);
             triple(row, c.end);
             row.insert(row.end(), {text_of(c.radius), "0.1", text_of(c.length), std::to_string(c.order), "7",
                                    "unknown"});
             return row;
         }},
        {"aRchi",
         "startX,startY,startZ,endX,endY,endZ,cyl_ID,parent_ID,extension_ID,radius_cyl,length,volume,axis_ID,"
         "segment_ID,node_ID,branching_order\n",
         ",",
         [triple](const Cylinder& c) {
             std::vector<std::string> row;
             triple(row, c.start);
             triple(row, c.end);
             row.insert(row.end(),
                        {std::to_string(10 * c.row), std::to_string(10 * c.parent), "0", text_of(c.radius),
                         text_of(c.length), "0.1", "1", "1", "0", std::to_string(c.order + 1)});
             return row;
         }},
        {"rTwig",
         "id;parent;start_x;start_y;start_z;axis_x;axis_y;axis_z;end_x;end_y;end_z;radius;raw_radius;length;"
         "branch;branch_order;reverse_order\n",
         ";",
         [triple](const Cylinder& c) {
             std::vector<std::string> row{std::to_string(c.row), std::to_string(c.parent)};
             triple(row, c.start);
             triple(row, DVec3(9.0));  // where a cylinder ends, it says itself
             triple(row, c.end);
             row.insert(row.end(), {text_of(c.radius), "1", "1", "1", std::to_string(c.order), "1"});
             return row;
         }},
        {"Treegraph", "p1,p2,ninternode,sx,sy,sz,ax,ay,az,radius,length\n", ",",
         [triple](const Cylinder& c) {
             std::vector<std::string> row{std::to_string(c.row),
                                          c.parent == 0 ? "NA" : std::to_string(c.parent), "3"};
             triple(row, c.start);
             triple(row, c.axis);
             row.insert(row.end(), {text_of(c.radius), text_of(c.length)});
             return row;
         }},
    };
}

TEST(ForeignSkeletons, TablesOfCylindersByTheNamesOfEveryProgram) {
    for (uint64_t seed = 1; seed <= 40; seed++) {
        Tree tree = test::random_tree(seed, 2 + static_cast<int>(seed * 7));
        ScanFrame frame;
        frame.up = UpAxis::kZ;
        frame.origin = DVec3(1234.5, -77.0, 12.0);
        tree.set_frame(frame);
        for (const Dialect& dialect : dialects()) {
            std::vector<std::string> rows;
            for (const Cylinder& c : cylinders_of(tree))
                rows.push_back(joined(dialect.row(c), dialect.between));
            // Parents may come later where cylinders have ids.
            if (std::string(dialect.program) == "aRchi") std::reverse(rows.begin(), rows.end());
            std::string text = dialect.head;
            for (const std::string& row : rows)
                text += row;
            SCOPED_TRACE(dialect.program);
            const Tree read = parse_qsm_csv(text, "q", UpAxis::kZ);
            expect_same_segments(tree, read, 1e-9);
            for (NodeId id : read.depth_first())
                EXPECT_EQ(read.node(id).is_measured(),
                          id != read.root() && dialect.head.find("added") != std::string::npos);
            size_t trunk = 0, trunk_read = 0;
            for (NodeId id : tree.depth_first())
                trunk += tree.node(id).is_trunk();
            for (NodeId id : read.depth_first())
                trunk_read += read.node(id).is_trunk();
            if (dialect.head.find("rder") != std::string::npos) {
                EXPECT_EQ(trunk, trunk_read);
            }
        }
        if (::testing::Test::HasFatalFailure()) FAIL() << "seed " << seed;
    }
}

TEST(ForeignSkeletons, WrongTablesOfCylindersGetASentence) {
    const std::string head = "id,parent,start_x,start_y,start_z,end_x,end_y,end_z,radius\n";
    for (const char* rows :
         {"", "1,7,0,0,0,0,0,1,1\n", "1,1,0,0,0,0,0,1,1\n", "1,0,0,0,0,0,0,1\n", "1,0,0,0,0,0,0,x,1\n",
          "1,0,0,0,0,0,0,1,1\n1,1,0,0,1,0,0,2,1\n", "1,2,0,0,0,0,0,1,1\n2,1,0,0,1,0,0,2,1\n",
          "1,0,0,0,0,0,0,nan,1\n", "nan,0,0,0,0,0,0,1,1\n", "1,1e300,0,0,0,0,0,1,1\n", "1,0,0,0,0,0,0,1,-1\n",
          "1,0,0,0,0,0,0,1,1,5,5\n"})
        EXPECT_THROW(parse_qsm_csv(head + rows, "q", UpAxis::kZ), Error) << rows;
    EXPECT_EQ(parse_qsm_csv(head + "1,0,0,0,0,0,0,1,1,\n\n", "q", UpAxis::kZ).size(), 2u);
    // Two cylinders without a parent hang together.
    EXPECT_EQ(parse_qsm_csv(head + "1,0,0,0,0,0,0,1,1\n2,0,1,0,0,1,0,1,1\n", "q", UpAxis::kZ).size(), 3u);
    for (const char* nothing : {"", "\n", " \n1,2\n", ",\n", "\"\"\n"})
        EXPECT_THROW(parse_qsm_csv(nothing, "q", UpAxis::kZ), Error);
    EXPECT_THROW(
        parse_qsm_csv("radius,parent,start_x,start_y,start_z,axis_x,axis_y,axis_z\n", "q", UpAxis::kZ),
        Error);
}

// As AdTree saves it: floats; every branch a path that begins at a copy of the node it grows from; lists of
// two as edges.
std::string adtree_ply(const Tree& tree, uint64_t seed, bool ascii) {
    Random random(seed);
    std::vector<std::array<float, 4>> vertices;
    std::vector<std::pair<int32_t, int32_t>> edges;
    const auto add = [&](NodeId id, double radius) {
        const DVec3 p = tree.frame().to_scan(tree.node(id).position);
        vertices.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z),
                            static_cast<float>(radius)});
        return static_cast<int32_t>(vertices.size()) - 1;
    };
    std::vector<int32_t> own(static_cast<size_t>(tree.id_end()), -1);
    for (NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode) {
            own[id] = add(id, node.radius);
            continue;
        }
        // A fork's further children begin at copies.
        const int32_t from =
            node.previous_sibling == kNoNode ? own[node.parent] : add(node.parent, 0.5 * node.radius);
        own[id] = add(id, node.radius);
        edges.push_back(random.below(2) ? std::pair(from, own[id]) : std::pair(own[id], from));
    }
    std::string bytes = std::string("ply\nformat ") + (ascii ? "ascii" : "binary_little_endian") +
                        " 1.0\ncomment Saved by Easy3D\nelement vertex " + std::to_string(vertices.size()) +
                        "\nproperty float x\nproperty float y\nproperty float z\nproperty float radius\n"
                        "element edge " +
                        std::to_string(edges.size()) +
                        "\nproperty list uint32 int vertex_indices\nend_header\n";
    const auto put = [&](auto value, char after) {
        if (ascii) {
            bytes += text_of(static_cast<double>(value)) + after;
            return;
        }
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        bytes.append(raw, sizeof value);
    };
    for (const auto& v : vertices)
        for (int i = 0; i < 4; i++)
            put(v[static_cast<size_t>(i)], i == 3 ? '\n' : ' ');
    for (const auto& [a, b] : edges) {
        put(uint32_t{2}, ' ');
        put(a, ' ');
        put(b, '\n');
    }
    return bytes;
}

TEST(ForeignSkeletons, AdTreesPlyBecomesOneTree) {
    for (uint64_t seed = 1; seed <= 60; seed++) {
        Tree tree = test::random_tree(seed, 2 + static_cast<int>(9 * seed));
        ScanFrame frame;
        frame.up = UpAxis::kZ;
        tree.set_frame(frame);
        const Tree read = parse_skeleton_ply(adtree_ply(tree, seed, seed % 2 == 0), "a", UpAxis::kZ);
        expect_same_segments(tree, read, 2e-6);
        EXPECT_NEAR(glm::distance(read.frame().to_scan(read.node(read.root()).position), DVec3(0.0)), 0.0,
                    1e-6);
        EXPECT_TRUE(read.node(read.root()).is_trunk());
        if (::testing::Test::HasFatalFailure()) FAIL() << "seed " << seed;
    }
}

TEST(ForeignSkeletons, GraphsThatAreNoTrees) {
    const auto ply = [](const std::string& vertices, int count, const std::string& edges, int edge_count,
                        const char* properties = "property int vertex1\nproperty int vertex2\n") {
        return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
               "\nproperty float x\nproperty float y\nproperty float z\nproperty float radius\nelement "
               "edge " +
               std::to_string(edge_count) + "\n" + properties + "end_header\n" + vertices + edges;
    };
    const auto read = [](const std::string& bytes) { return parse_skeleton_ply(bytes, "g", UpAxis::kZ); };
    const std::string stem = "0 0 2 .1\n0 0 1 .1\n0 0 0 .2\n";
    // Edges that make a tree by their directions are believed; others begin below. A ring; a second, smaller
    // piece; a root that is thicker than a twig that hangs as low.
    Tree tree = read(ply(stem, 3, "0 1\n1 2\n", 2));
    EXPECT_EQ(tree.frame().origin.z, 2.0);
    tree = read(ply(stem, 3, "0 1\n2 1\n", 2));
    EXPECT_EQ(tree.size(), 3u);
    EXPECT_EQ(tree.frame().origin.z, 0.0);
    tree = read(ply(stem, 3, "0 1\n1 2\n2 0\n", 3));
    EXPECT_EQ(tree.size(), 3u);
    tree = read(ply("5 0 0 .1\n5 0 1 .1\n9 9 9 1\n" + stem, 6, "0 1\n3 4\n4 5\n", 3));
    EXPECT_EQ(tree.size(), 3u);
    EXPECT_EQ(tree.frame().origin, DVec3(0.0));
    tree = read(ply(stem + "1 0 2 .1\n1 0 -.01 .01\n", 5, "0 1\n2 1\n0 3\n3 4\n", 4));
    EXPECT_EQ(tree.frame().origin, DVec3(0.0));
    EXPECT_EQ(tree.size(), 5u);
    EXPECT_EQ(parse_skeleton_ply(ply(stem, 3, "0 1\n2 1\n", 2), "g", UpAxis::kNegZ).frame().origin.z, 2.0);
    const char* list = "property list uchar int vertex_index\n";
    EXPECT_EQ(read(ply(stem, 3, "2 0 1\n2 1 2\n", 2, list)).size(), 3u);
    for (const std::string& bytes : {ply(stem, 3, "3 0 1 2\n", 1, list), ply(stem, 3, "1 0\n", 1, list),
                                     ply(stem, 3, "2 0 7\n", 1, list), ply(stem, 3, "2 0 -1\n", 1, list),
                                     ply(stem, 3, "2 0 0\n", 1, list), ply(stem, 3, "", 0, list),
                                     ply("0 0 nan 1\n0 0 1 1\n", 2, "2 0 1\n", 1, list),
                                     ply("0 0 0 -1\n0 0 1 1\n", 2, "2 0 1\n", 1, list),
                                     ply(stem, 3, "0 1\n", 1, "property int a\nproperty int b\n")})
        EXPECT_THROW(read(bytes), Error) << bytes;
    // Of our own files nothing is guessed.
    std::string ours = ply(stem, 3, "0 1\n2 1\n", 2);
    ours.insert(ours.find("element"), "comment treerec 1 up z metres_per_unit 1\n");
    EXPECT_THROW(read(ours), Error);
}

TEST(ForeignSkeletons, SwcOfAnyTree) {
    for (uint64_t seed = 1; seed <= 60; seed++) {
        Tree tree = test::random_tree(seed, 1 + static_cast<int>(9 * seed));
        ScanFrame frame;
        frame.up = UpAxis::kZ;
        tree.set_frame(frame);
        std::vector<std::string> lines;
        for (NodeId id : tree.depth_first()) {
            const DVec3 p = tree.frame().to_scan(tree.node(id).position);
            const NodeId parent = tree.node(id).parent;
            lines.push_back(std::to_string(3 * id + 1) + " 0 " + text_of(p.x) + " " + text_of(p.y) + "\t" +
                            text_of(p.z) + " " + text_of(tree.node(id).radius) + " " +
                            std::to_string(parent == kNoNode ? -1 : 3 * parent + 1) + "\r\n");
        }
        if (seed % 2 == 0) std::reverse(lines.begin(), lines.end());
        std::string text = "# ORIGINAL_SOURCE somewhere\n\n  # another\n1000001 2 50 50 50 1 -1\n";
        for (const std::string& line : lines)
            text += line;
        text += "1000002 2 51 50 50 1 1000001";  // a smaller tree of two nodes, and no line's end
        EXPECT_TRUE(looks_like_swc(text, true));
        if (tree.size() < 3) continue;
        expect_same_segments(tree, parse_swc(text, "s", UpAxis::kZ), 1e-9);
        if (::testing::Test::HasFatalFailure()) FAIL() << "seed " << seed;
    }
}

TEST(ForeignSkeletons, WrongSwcGetsASentence) {
    for (const char* text :
         {"", "# nothing\n", "1 0 0 0 0 1\n", "1 0 0 0 0 1 -1 7\n", "1 0 0 0 z 1 -1\n", "1.5 0 0 0 0 1 -1\n",
          "1 0 0 0 0 1 -1\n1 0 0 0 1 1 1\n", "1 0 0 0 0 1 -1\n2 0 0 0 1 1 9\n",
          "1 0 0 0 0 1 2\n2 0 0 0 1 1 1\n", "1 0 0 0 nan 1 -1\n", "1 0 0 0 0 -1 -1\n", "1 0 0 0 0 1 nan\n"})
        EXPECT_THROW(parse_swc(text, "s", UpAxis::kZ), Error) << text;
    EXPECT_THROW(parse_swc("1 1 0 0 0 1 -1", "s", UpAxis::kZ), Error) << "a single node is no tree";
    EXPECT_EQ(parse_swc("1 1 0 0 0 1 -1\n2 1 0 0 1 1 1", "s", UpAxis::kZ).size(), 2u);
}

class ForeignFiles : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("treerec_foreign_" + std::to_string(::getpid()) + "_" +
                   std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::string put(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return (folder_ / name).string();
    }

    std::filesystem::path folder_;
};

TEST_F(ForeignFiles, AreToldApartByTheirContents) {
    Tree tree = test::random_tree(3, 400);
    ScanFrame frame;
    frame.up = UpAxis::kZ;
    tree.set_frame(frame);
    for (const Dialect& dialect : dialects()) {
        std::string text = dialect.head;
        for (const Cylinder& c : cylinders_of(tree))
            text += joined(dialect.row(c), dialect.between);
        const std::string path = put("any.txt", text);
        SCOPED_TRACE(dialect.program);
        EXPECT_TRUE(is_skeleton_file(path));
        expect_same_segments(tree, read_skeleton(path), 1e-9);
    }
    std::string swc;
    for (int i = 1; i < 500; i++)
        swc += std::to_string(i) + " 1 0 0 " + std::to_string(i) + " 0.25 " +
               std::to_string(i > 1 ? i - 1 : -1) + "\n";
    EXPECT_EQ(read_skeleton(put("any", swc)).size(), 499u);
    EXPECT_EQ(read_skeleton(put("b.ply", adtree_ply(tree, 1, false))).size(), tree.size());
    // Clouds with as many columns as SWC.
    EXPECT_FALSE(is_skeleton_file(put("c.xyz", "1 2 3 4 5 6 7\n2 3 4 5 6 7 8\n")));
    EXPECT_FALSE(is_skeleton_file(put("d.xyz", "1.5 2 3 4 5 6 -1\n2 3 4 5 6 7 8\n")));
    EXPECT_FALSE(is_skeleton_file(put("e.xyz", "")));
}

TEST_F(ForeignFiles, OfTheWrongKindAreCalledByTheirNames) {
    const auto sentence = [&](const std::string& bytes) -> std::string {
        try {
            read_skeleton(put("f", bytes));
        } catch (const Error& error) {
            return error.what();
        }
        return "it was read";
    };
    EXPECT_NE(sentence("MATLAB 5.0 MAT-file, Platform").find("MATLAB"), std::string::npos);
    EXPECT_NE(sentence("order\tparent\tdiameter (m)\n0\t0\t1\n").find("branches"), std::string::npos);
    EXPECT_NE(sentence("ply\nformat ascii 1.0\nelement vertex 0\nelement edge 0\n").find("radii"),
              std::string::npos);
    EXPECT_NE(sentence("ply\nformat ascii 1.0\nelement vertex 0\n").find("without edges"), std::string::npos);
    EXPECT_NE(sentence("some words").find("SWC"), std::string::npos);
}

}  // namespace
}  // namespace treerec
