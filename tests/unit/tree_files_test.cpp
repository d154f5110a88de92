#include "exchange/tree_files.h"

#include <gtest/gtest.h>
#ifndef _WIN32
#include <unistd.h>
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "error.h"
#include "geometry/random.h"

namespace treerec {
namespace {

namespace fs = std::filesystem;

class TreeFiles : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  ("treerec_files_" + std::to_string(::getpid()) + "_" +
                   std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string put(const std::string& name, const std::string& bytes) const {
        std::ofstream(path(name), std::ios::binary) << bytes;
        return path(name);
    }
    std::string get(const std::string& name) const {
        std::ifstream in(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    fs::path folder_;
};

Tree random_tree(uint64_t seed, int nodes, const ScanFrame& frame) {
    Random random(seed);
    Tree tree;
    tree.add_root(DVec3(random.normal(), 0.0, random.normal()), random.uniform(0.05, 0.5), kTrunkFlag);
    for (int i = 1; i < nodes; i++) {
        const NodeId parent = static_cast<NodeId>(random.below(static_cast<uint32_t>(i)));
        tree.add_child(parent, tree.node(parent).position + random.direction() * random.uniform(0.01, 1.0),
                       random.uniform(0.001, 0.3), static_cast<uint8_t>(random.below(8)));
    }
    tree.set_frame(frame);
    return tree;
}

ScanFrame utm_frame() {
    ScanFrame frame;
    frame.origin = DVec3(500123.4567890123, 5432109.876543, 231.5);
    frame.metres_per_unit = 1.0;
    frame.up = UpAxis::kZ;
    return frame;
}

void expect_same_in_scan(const Tree& a, const Tree& b) {
    const std::vector<NodeId> ids_a = a.depth_first(), ids_b = b.depth_first();
    ASSERT_EQ(ids_a.size(), ids_b.size());
    EXPECT_EQ(b.check().value_or("sound"), "sound");
    for (size_t i = 0; i < ids_a.size(); i++) {
        const Node &x = a.node(ids_a[i]), &y = b.node(ids_b[i]);
        const DVec3 p = a.frame().to_scan(x.position), q = b.frame().to_scan(y.position);
        for (int axis = 0; axis < 3; axis++)
            EXPECT_NEAR(p[axis], q[axis], 1e-9 * std::max(1.0, std::abs(p[axis])));
        const double radius = a.frame().length_to_scan(x.radius);
        EXPECT_NEAR(radius, b.frame().length_to_scan(y.radius), 1e-9 * radius);
        EXPECT_EQ(x.flags, y.flags);
        EXPECT_EQ(x.depth, y.depth);
        EXPECT_EQ(x.child_count, y.child_count);
    }
    EXPECT_EQ(a.frame().up, b.frame().up);
    EXPECT_EQ(a.frame().metres_per_unit, b.frame().metres_per_unit);
    EXPECT_EQ(a.frame().tilt, b.frame().tilt);
}

TEST_F(TreeFiles, RoundTripsAtUtmCoordinatesInEveryAxisAndUnit) {
    uint64_t seed = 1;
    for (UpAxis up : {UpAxis::kX, UpAxis::kY, UpAxis::kZ, UpAxis::kNegX, UpAxis::kNegY, UpAxis::kNegZ})
        for (double unit : {1.0, 0.001, 0.3048, 37.5}) {
            ScanFrame frame = utm_frame();
            frame.up = up;
            frame.metres_per_unit = unit;
            if (seed % 2) frame.tilt = DVec3(0.1, -0.2, 0.03) / static_cast<double>(seed);
            const Tree tree = random_tree(seed, static_cast<int>(1 + 37 * seed), frame);
            write_treefile(path("t.txt"), tree);
            expect_same_in_scan(tree, read_treefile(path("t.txt")));
            write_skeleton_ply(path("t.ply"), tree);
            expect_same_in_scan(tree, read_skeleton_ply(path("t.ply")));
            seed++;
        }
}

TEST_F(TreeFiles, WritingWhatWasReadGivesTheSameBytes) {
    write_treefile(path("a.txt"), random_tree(5, 300, utm_frame()));
    write_treefile(path("b.txt"), read_treefile(path("a.txt")));
    EXPECT_EQ(get("a.txt"), get("b.txt"));
}

TEST_F(TreeFiles, ReadsWhatOtherProgramsWrite) {
    // Per-tree attributes first, more fields per node, the larger of two trees.
    const Tree a = read_treefile(put("a.txt",
                                     "# Tree file. Optional per-tree attributes\r\n"
                                     "height,crown_radius, x,y,z,radius,parent_id,section_id\r\n"
                                     "9,9, 5,5,5,0.1,-1,0, 5,5,6,0.05,0,1\r\n"
                                     "2,1, 0,0,0,0.3,-1,0, 0,0,1,0.2,0,1, 0,1,2,0.1,1,2,\r\n"));
    EXPECT_EQ(a.size(), 3u);
    EXPECT_NEAR(a.node(2).position.y, 2.0, 1e-12);  // Z up in the file
    EXPECT_NEAR(a.node(2).position.z, -1.0, 1e-12);
    EXPECT_NEAR(a.node(2).radius, 0.1, 1e-12);
    // Root fields apart from branch fields.
    const Tree b = read_treefile(put("b.txt",
                                     "# Tree file. Tree attributes optionally followed by branch attributes\n"
                                     "x,y,z,radius,height x,y,z,radius,parent_id,volume\n"
                                     "1,2,3,0.4,12, 1,2,4,0.3,0,0.01, 1,2,5,0.2,1,0.01\n"));
    EXPECT_EQ(b.size(), 3u);
    EXPECT_EQ(b.frame().origin, DVec3(1, 2, 3));
    // Children before their parents, an old file's zero radius, another axis.
    const Tree c = read_treefile(
        put("c.txt", "x,y,z,radius,parent_id\n0,2,0,0,1, 0,1,0,0.1,2, 0,0,0,0.2,-1\n"), UpAxis::kY);
    EXPECT_EQ(c.node(c.root()).child_count, 1);
    EXPECT_NEAR(c.bounds().max.y, 2.0, 1e-3);
}

TEST_F(TreeFiles, ReadsNodeTables) {
    const Tree tree = read_node_csv(put(
        "n.csv", "node,parent,x,y,z,radius\n7,-1,1,2,3,.2\n9,7,1,2,4,.1\n12,9,1,2,5,.05\n3,7,1,3,3.5,0.1\n"));
    EXPECT_EQ(tree.size(), 4u);
    EXPECT_EQ(tree.node(tree.root()).child_count, 2);
    EXPECT_THROW(read_node_csv(put("nan.csv", "id,parent,x,y,z,radius\nnan,-1,0,0,0,1\n")), Error);
    EXPECT_THROW(read_node_csv(put("d.csv", "id,parent,x,y,z,radius\n1,0,0,0,0,1\n1,0,0,0,1,1\n")), Error);
    EXPECT_THROW(read_node_csv(put("e.csv", "id,parent,x,y,z,radius\n1,2,0,0,0,1\n2,1,0,0,1,1\n")), Error);
}

TEST_F(TreeFiles, ReadsSkeletonPlyInEveryEncoding) {
    const std::string body =
        "comment by hand\nelement face 1\nproperty list uchar int vertex_indices\n"
        "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
        "property float radius\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n";
    const Tree text = read_skeleton_ply(
        put("t.ply", "ply\nformat ascii 1.0\n" + body + "3 0 1 0\n0 0 0 9 0.2\n0 0 3 9 0.1\n0 1\n"));
    EXPECT_NEAR(text.node(1).position.y, 3.0, 1e-6);
    std::string big = "ply\nformat binary_big_endian 1.0\n" + body;
    const auto word = [&](uint32_t bits) {
        for (int shift = 24; shift >= 0; shift -= 8)
            big += static_cast<char>(bits >> shift);
    };
    big += '\1';
    word(0);
    for (float z : {0.0F, 3.0F}) {
        word(0);
        word(0);
        word(std::bit_cast<uint32_t>(z));
        big += '\x7f';
        word(std::bit_cast<uint32_t>(0.125F));
    }
    word(0);
    word(1);
    const Tree binary = read_skeleton_ply(put("b.ply", big));
    EXPECT_NEAR(binary.node(1).position.y, 3.0, 1e-6);
    EXPECT_EQ(binary.node(1).radius, 0.125);
    for (size_t cut = 1; cut < big.size(); cut++)
        EXPECT_THROW(read_skeleton_ply(put("cut.ply", big.substr(0, cut))), Error) << cut;
}

TEST_F(TreeFiles, TellsSkeletonsFromClouds) {
    const Tree tree = random_tree(2, 20, utm_frame());
    write_treefile(path("a.txt"), tree);
    write_skeleton_ply(path("a.ply"), tree);
    write_qsm_csv(path("a.csv"), tree);
    EXPECT_TRUE(is_skeleton_file(path("a.txt")));
    EXPECT_TRUE(is_skeleton_file(path("a.ply")));
    EXPECT_EQ(read_skeleton(path("a.ply")).size(), 20u);
    EXPECT_EQ(read_skeleton(path("a.txt")).size(), 20u);
    EXPECT_FALSE(is_skeleton_file(put("c.txt", "x y z r g b\n1 2 3 4 5 6\n")));
    EXPECT_FALSE(
        is_skeleton_file(put("c.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n")));
    EXPECT_FALSE(is_skeleton_file(put("d.txt", "")));
    EXPECT_THROW(is_skeleton_file(path("none.txt")), Error);
    EXPECT_THROW(read_skeleton(path("c.txt")), Error);
}

// Their comments are longer than what tells a file from others.
TEST_F(TreeFiles, ATreeOfManySectionsIsASkeleton) {
    Tree tree = random_tree(5, 300, utm_frame());
    std::vector<SectionShape> shapes(200);
    for (size_t i = 0; i < shapes.size(); i++)
        shapes[i].cosine[0] = 0.01f + 1e-4f * static_cast<float>(i);
    const size_t first = tree.add_sections(shapes);
    const std::vector<NodeId> ids = tree.depth_first();
    for (size_t i = 0; i < shapes.size(); i++)
        tree.set_section(ids[i], first + i + 1);
    write_treefile(path("many.txt"), tree);
    EXPECT_TRUE(is_skeleton_file(path("many.txt")));
    const Tree read = read_skeleton(path("many.txt"));
    EXPECT_EQ(read.size(), 300u);
    EXPECT_EQ(read.sections().size(), 200u);
}

TEST_F(TreeFiles, QsmCylindersJoinUp) {
    const Tree tree = random_tree(9, 200, utm_frame());
    write_qsm_csv(path("q.csv"), tree);
    std::ifstream in(path("q.csv"));
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(
        line,
        "radius,length,start_x,start_y,start_z,axis_x,axis_y,axis_z,parent_1based,branch,order,measured");
    std::vector<DVec3> ends{DVec3(0.0)};
    double length = 0.0;
    while (std::getline(in, line)) {
        double v[12];
        const char* at = line.c_str();
        for (double& value : v) {
            char* end = nullptr;
            value = std::strtod(at, &end);
            at = end + 1;
        }
        const DVec3 start(v[2], v[3], v[4]), axis(v[5], v[6], v[7]);
        EXPECT_NEAR(glm::length(axis), 1.0, 1e-9);
        ASSERT_LT(v[8], static_cast<double>(ends.size()));  // parents come first
        if (v[8] > 0) {
            EXPECT_LT(glm::distance(start, ends[static_cast<size_t>(v[8])]), 1e-6);
        }
        ends.push_back(start + v[1] * axis);
        length += v[1];
    }
    EXPECT_EQ(ends.size(), tree.size());
    EXPECT_GT(length, 1.0);
}

TEST_F(TreeFiles, QsmCylindersReadBackAsTheTree) {
    const Tree tree = random_tree(9, 200, utm_frame());
    write_qsm_csv(path("q.csv"), tree);
    EXPECT_TRUE(is_skeleton_file(path("q.csv")));
    const Tree read = read_skeleton(path("q.csv"));
    EXPECT_EQ(read.check().value_or("sound"), "sound");
    ASSERT_EQ(read.size(), tree.size());
    // Branches come one after the other in the file: compare places, not the order.
    const auto places = [](const Tree& t) {
        std::vector<std::array<double, 4>> rows;
        for (NodeId id : t.depth_first()) {
            if (t.node(id).parent == kNoNode) continue;
            const DVec3 p = t.frame().to_scan(t.node(id).position);
            rows.push_back({p.x, p.y, p.z, t.node(id).radius});
        }
        std::sort(rows.begin(), rows.end());
        return rows;
    };
    const auto a = places(tree), b = places(read);
    for (size_t i = 0; i < a.size(); i++)
        for (int k = 0; k < 4; k++)
            EXPECT_NEAR(a[i][k], b[i][k], 2e-9 * std::abs(a[i][k]) + 1e-9);
    EXPECT_THROW(read_qsm_csv(put("a.csv", "radius,length\n1,2\n")), Error);
    const std::string head = "radius,length,start_x,start_y,start_z,axis_x,axis_y,axis_z,parent_1based\n";
    EXPECT_THROW(read_qsm_csv(put("b.csv", head)), Error);
    EXPECT_THROW(read_qsm_csv(put("c.csv", head + "1,1,0,0,0,0,0,1,1\n")), Error);
    EXPECT_THROW(read_qsm_csv(put("d.csv", head + "1,1,0,0,0,0,0,1,0\n1,1,0,0,0,0,0,1,7\n")), Error);
    EXPECT_THROW(read_qsm_csv(put("e.csv", head + "1,1,0,0,0,0,0,1\n")), Error);
    EXPECT_EQ(read_qsm_csv(put("f.csv", head + "1,1,0,0,0,0,0,1,0\n1,1,0,0,1,0,0,1,1\n")).size(), 3u);
}

TEST_F(TreeFiles, HostileTextGetsASentence) {
    const std::vector<std::string> bad = {
        "",
        "\n\n\n",
        "# only a comment\n",
        "x,y,z\n1,2,3\n",
        "x,y,z,radius,parent_id\n",
        "x,y,z,radius,parent_id\n1,2,3\n",
        "x,y,z,radius,parent_id\n1,2,3,0.1,-1, 1,2,4\n",
        "x,y,z,radius,parent_id\n1,2,3,0.1,-1, 1,2,4,0.1,7\n",
        "x,y,z,radius,parent_id\n1,2,3,0.1,1, 1,2,4,0.1,0\n",
        "x,y,z,radius,parent_id\n1,2,3,0.1,-1, 1,2,4,0.1,-1\n",
        "x,y,z,radius,parent_id\n1,2,3,0.1,-1, 1,2,4,0.1,1e300\n",
        "x,y,z,radius,parent_id\n1,2,3,0.1,-1, 1,2,4,0.1,nan\n",
        "x,y,z,radius,parent_id\n1,2,nan,0.1,-1\n",
        "x,y,z,radius,parent_id\n1,2,inf,0.1,-1\n",
        "x,y,z,radius,parent_id\n1,2,3,-0.1,-1\n",
        "x,y,z,radius,parent_id\n1,2,three,0.1,-1\n",
        "# treerec 2 up z metres_per_unit 1\nx,y,z,radius,parent_id\n1,2,3,0.1,-1\n",
        std::string(100000, ','),
        std::string("\0\1\2\3ply", 7),
    };
    for (size_t i = 0; i < bad.size(); i++) {
        const std::string file = put("bad.txt", bad[i]);
        try {
            read_treefile(file);
            ADD_FAILURE() << "case " << i << " was read";
        } catch (const Error& error) {
            EXPECT_GT(std::string(error.what()).size(), 15u);
        }
    }
}

// Every way of damaging a good file ends in a sound tree or a sentence.
TEST_F(TreeFiles, MutatedFilesNeverBreakTheReader) {
    const Tree tree = random_tree(4, 30, utm_frame());
    write_treefile(path("a.txt"), tree);
    write_skeleton_ply(path("a.ply"), tree);
    const std::string text = get("a.txt"), ply = get("a.ply");
    Random random(11);
    int sound = 0, refused = 0;
    for (int i = 0; i < 4000; i++) {
        const bool is_text = i % 2 == 0;
        std::string bytes = is_text ? text : ply;
        const int edits = 1 + static_cast<int>(random.below(4));
        for (int k = 0; k < edits; k++) {
            const size_t at = random.below(static_cast<uint32_t>(bytes.size()));
            switch (random.below(4)) {
                case 0:
                    bytes[at] = static_cast<char>(random.below(256));
                    break;
                case 1:
                    bytes.erase(at, 1 + random.below(20));
                    break;
                case 2:
                    bytes.insert(at, 1, "0123456789,.-e \n"[random.below(16)]);
                    break;
                default:
                    bytes.resize(at + 1);
            }
        }
        const std::string file = put(is_text ? "m.txt" : "m.ply", bytes);
        try {
            const Tree read = is_text ? read_treefile(file) : read_skeleton_ply(file);
            EXPECT_EQ(read.check().value_or("sound"), "sound");
            sound++;
        } catch (const Error&) {
            refused++;
        }
    }
    EXPECT_GT(sound, 50);
    EXPECT_GT(refused, 50);
}

TEST_F(TreeFiles, AFailedWriteLeavesNothing) {
    const Tree tree = random_tree(4, 30, utm_frame());
    EXPECT_THROW(write_treefile(path("no/such/folder/t.txt"), tree), Error);
    EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace treerec
