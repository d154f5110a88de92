// Joints worth a close-up: how branches come out of each other's bark.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string>

#include "mesh/branch_tubes.h"
#include "mesh_tubes.h"
#include "pipeline/reconstruct.h"
#include "synth/grow.h"

namespace treerec {
namespace {

using namespace test;

constexpr double kStout = 0.021;  // metres: branches from here on have collars

struct Sample {
    std::string name;
    Tree tree;
};

std::vector<Sample> samples() {
    std::vector<Sample> list;
    for (const Habit habit : all_habits()) {
        GrowOptions options;
        options.habit = habit;
        options.seed = 2;
        list.push_back({habit_name(habit), grow_tree(options)});
    }
    if (const char* folder = std::getenv("TREEREC_SCANS")) {
        for (const char* file : {"wytham_Tf18_birch", "wytham_Tf8_ash"}) {
            ReconstructOptions options;
            options.orient.up = UpAxis::kZ;
            options.orient.metres_per_unit = 1.0;
            list.push_back(
                {file, reconstruct_file(std::string(folder) + "/clouds/" + file + ".txt", options).tree});
        }
    }
    return list;
}

const std::vector<Sample>& all_samples() {
    static const std::vector<Sample> list = samples();
    return list;
}

// How often a surface winds around p, by the solid angles of its triangles (van Oosterom and Strackee 1983):
// 1 within a closed one, 0 without.
double winding(const Mesh& mesh, const TubeRange& tube, const DVec3& p) {
    double sum = 0.0;
    for (size_t i = tube.first_index; i < tube.end_index; i += 3) {
        const DVec3 a = corner_of(mesh, i) - p, b = corner_of(mesh, i + 1) - p,
                    c = corner_of(mesh, i + 2) - p;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        sum += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                                   glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return sum / (4.0 * kPi);
}

struct Box {
    DVec3 low{1e30}, high{-1e30};
    bool holds(const DVec3& p) const {
        return glm::all(glm::greaterThanEqual(p, low)) && glm::all(glm::lessThanEqual(p, high));
    }
};

std::vector<Box> boxes_of(const Mesh& mesh, const std::vector<TubeRange>& tubes) {
    std::vector<Box> boxes(tubes.size());
    for (size_t i = 0; i < tubes.size(); i++)
        for (uint32_t v = tubes[i].first_vertex; v < tubes[i].end_vertex; v++) {
            boxes[i].low = glm::min(boxes[i].low, DVec3(mesh.positions[v]));
            boxes[i].high = glm::max(boxes[i].high, DVec3(mesh.positions[v]));
        }
    return boxes;
}

double start_radius(const Mesh& mesh, const TubeRange& tube) {
    double least = 1e9;
    for (uint32_t v = tube.first_vertex; v < tube.end_vertex && mesh.colors[v].g < 0.5f; v++)
        least = std::max(least == 1e9 ? 0.0 : least, static_cast<double>(mesh.radii[v]));
    return least;
}

bool cross(const DVec3* a, const DVec3* b) {
    // An edge of one goes through the other's inside.
    const auto through = [](const DVec3& from, const DVec3& to, const DVec3* t) {
        const DVec3 e1 = t[1] - t[0], e2 = t[2] - t[0], way = to - from;
        const DVec3 h = glm::cross(way, e2);
        const double det = glm::dot(e1, h);
        if (std::abs(det) < 1e-15) return false;
        const DVec3 s = from - t[0];
        const double u = glm::dot(s, h) / det;
        const DVec3 q = glm::cross(s, e1);
        const double v = glm::dot(way, q) / det, w = glm::dot(e2, q) / det;
        constexpr double kIn = 1e-6;
        return u > kIn && v > kIn && u + v < 1.0 - kIn && w > kIn && w < 1.0 - kIn;
    };
    for (int k = 0; k < 3; k++)
        if (through(a[k], a[(k + 1) % 3], b) || through(b[k], b[(k + 1) % 3], a)) return true;
    return false;
}

// The first faces of a tube: those of its collar, or as many.
size_t joint_end(const Mesh& mesh, const TubeRange& tube) {
    size_t corners = 0;
    while (tube.first_vertex + corners < tube.end_vertex &&
           mesh.colors[tube.first_vertex + corners].g == 0.0f)
        corners++;
    return std::min(tube.end_index, tube.first_index + 5 * 6 * corners);
}

TEST(Joints, TubesAreClosedWhereTheyAreSeen) {
    for (const Sample& sample : all_samples())
        for (int level = 0; level < 2; level++) {
            SCOPED_TRACE(sample.name + " " + std::to_string(level));
            const Mesh mesh = build_branch_tubes(sample.tree, {.level = level});
            const std::vector<TubeRange> tubes = tubes_of(mesh);
            const std::vector<Box> boxes = boxes_of(mesh, tubes);
            size_t twice = 0, seen = 0, checked = 0;
            for (size_t i = 0; i < tubes.size(); i++) {
                const std::vector<std::pair<uint32_t, uint32_t>> open = open_edges(mesh, tubes[i], twice);
                // What stands for many twigs is wider than its parent, and so closed itself.
                ASSERT_TRUE(level > 0 || !open.empty());
                for (const auto& [from, to] : open) {
                    ASSERT_EQ(mesh.colors[from].g, 0.0f);
                    ASSERT_EQ(mesh.colors[to].g, 0.0f);
                    if (i == 0) continue;  // the trunk's cut, below the ground
                    // Thin wood by the ten thousand takes too long.
                    if (std::abs(mesh.radii[to]) < 0.004f && i % 8 != 0) continue;
                    const DVec3 middle = 0.5 * (DVec3(mesh.positions[from]) + DVec3(mesh.positions[to]));
                    bool hidden = false;
                    for (size_t k = 0; k < tubes.size() && !hidden; k++)
                        hidden = k != i && boxes[k].holds(middle) && winding(mesh, tubes[k], middle) > 0.5;
                    seen += !hidden;
                    checked++;
                }
                double volume = 0.0;
                const DVec3 inside(mesh.custom0[tubes[i].first_vertex]);
                for (size_t k = tubes[i].first_index; k < tubes[i].end_index; k += 3)
                    volume += glm::dot(corner_of(mesh, k) - inside, face_normal(mesh, k));
                EXPECT_GT(volume, 0.0);
            }
            EXPECT_EQ(twice, 0u);
            // Where a collar itself bends, what grows out of it may stand off by a hair.
            EXPECT_LE(seen, checked / 200) << checked;
            RecordProperty(sample.name + std::to_string(level), static_cast<int>(seen));
        }
}

TEST(Joints, CollarsDoNotCrossThemselves) {
    for (const Sample& sample : all_samples())
        for (int level = 0; level < 2; level++) {
            SCOPED_TRACE(sample.name + " " + std::to_string(level));
            const Mesh mesh = build_branch_tubes(sample.tree, {.level = level});
            size_t crossing = 0, faces = 0;
            for (const TubeRange& tube : tubes_of(mesh)) {
                if (mesh.custom0[tube.first_vertex].w == 0.0f || start_radius(mesh, tube) < kStout) continue;
                const std::vector<uint32_t> corner = joined_corners(mesh, tube);
                const size_t end = joint_end(mesh, tube);
                const auto share = [&](size_t a, size_t b) {
                    for (size_t k = 0; k < 3; k++)
                        for (size_t m = 0; m < 3; m++)
                            if (corner[mesh.indices[a + k] - tube.first_vertex] ==
                                corner[mesh.indices[b + m] - tube.first_vertex])
                                return true;
                    return false;
                };
                for (size_t a = tube.first_index; a < end; a += 3) {
                    const DVec3 one[3] = {corner_of(mesh, a), corner_of(mesh, a + 1), corner_of(mesh, a + 2)};
                    bool crosses = false;
                    for (size_t b = tube.first_index; b < end && !crosses; b += 3) {
                        if (a == b || share(a, b)) continue;
                        const DVec3 other[3] = {corner_of(mesh, b), corner_of(mesh, b + 1),
                                                corner_of(mesh, b + 2)};
                        crosses = cross(one, other);
                    }
                    crossing += crosses;
                    faces++;
                }
            }
            EXPECT_LE(crossing, faces / 200) << faces;
            RecordProperty("crossing_" + sample.name + std::to_string(level), static_cast<int>(crossing));
        }
}

TEST(Joints, NormalsLookOutOfTheirFaces) {
    for (const Sample& sample : all_samples())
        for (int level = 0; level < 2; level++) {
            SCOPED_TRACE(sample.name + " " + std::to_string(level));
            const Mesh mesh = build_branch_tubes(sample.tree, {.level = level});
            size_t inward = 0, corners = 0;
            for (const TubeRange& tube : tubes_of(mesh)) {
                if (mesh.custom0[tube.first_vertex].w == 0.0f || start_radius(mesh, tube) < kStout) continue;
                for (size_t i = tube.first_index; i < joint_end(mesh, tube); i += 3)
                    for (size_t k = 0; k < 3; k++) {
                        inward +=
                            glm::dot(DVec3(mesh.normals[mesh.indices[i + k]]), face_normal(mesh, i)) <= 0.0;
                        corners++;
                    }
            }
            EXPECT_LE(inward, corners / 100) << corners;
            RecordProperty("inward_" + sample.name + std::to_string(level), static_cast<int>(inward));
        }
}

// On the base of a collar the bark looks as the parent's beside it: the same picture, light and normal.
TEST(Joints, TheBaseContinuesTheParentsBark) {
    for (const Sample& sample : all_samples()) {
        SCOPED_TRACE(sample.name);
        const TubeOptions options;
        const Mesh mesh = build_branch_tubes(sample.tree, options);
        const std::vector<TubeRange> tubes = tubes_of(mesh);
        const std::vector<Box> boxes = boxes_of(mesh, tubes);
        size_t bases = 0, stout = 0, collars = 0, jumps = 0, kinks = 0, shades = 0;
        for (const TubeRange& tube : tubes) {
            if (mesh.custom0[tube.first_vertex].w == 0.0f || start_radius(mesh, tube) < kStout) continue;
            stout++;
            uint32_t end = tube.first_vertex;
            while (mesh.colors[end].g == 0.0f)
                end++;
            // With a collar the next two rows are at one place.
            const uint32_t stride = end - tube.first_vertex;
            if (mesh.positions[end] != mesh.positions[end + stride]) continue;
            collars++;
            for (uint32_t v = tube.first_vertex; v < end; v++) {
                const DVec3 p(mesh.positions[v]);
                // The nearest face of its parent's tube, one order below.
                double best = 1e9;
                DVec2 uv(0.0);
                DVec3 normal(0.0);
                double light = 0.0;
                for (size_t k = 0; k < tubes.size(); k++) {
                    if (mesh.custom0[tubes[k].first_vertex].w != mesh.custom0[v].w - 1.0f ||
                        !boxes[k].holds(p))
                        continue;
                    for (size_t i = tubes[k].first_index; i < tubes[k].end_index; i += 3) {
                        const DVec3 a = corner_of(mesh, i), e1 = corner_of(mesh, i + 1) - a,
                                    e2 = corner_of(mesh, i + 2) - a, n = glm::cross(e1, e2);
                        const double square = glm::dot(n, n);
                        const DVec3 from = p - a;
                        const double s = glm::dot(glm::cross(from, e2), n) / square,
                                     t = glm::dot(glm::cross(e1, from), n) / square;
                        const double off = std::abs(glm::dot(from, n)) / std::sqrt(square);
                        if (s < -0.01 || t < -0.01 || s + t > 1.01 || off >= best) continue;
                        best = off;
                        const auto mix = [&](const auto& values) {
                            return (1.0 - s - t) * glm::dvec4(values(i)) + s * glm::dvec4(values(i + 1)) +
                                   t * glm::dvec4(values(i + 2));
                        };
                        const glm::dvec4 at = mix([&](size_t c) {
                            const uint32_t w = mesh.indices[c];
                            return Vec4(mesh.uvs[w], mesh.colors[w].a, 0.0f);
                        });
                        uv = {at.x, at.y};
                        light = at.z;
                        normal =
                            DVec3(mix([&](size_t c) { return Vec4(mesh.normals[mesh.indices[c]], 0.0f); }));
                    }
                }
                if (best > 0.02) continue;
                bases++;
                // Beyond the parent's seam the picture goes on, a round of it further.
                const double round = 2.0 * kPi * std::abs(mesh.radii[v]) / options.bark_width;
                double around = std::abs(uv.x - mesh.uvs[v].x);
                around = std::min(around, std::abs(around - round));
                jumps += std::max(around, std::abs(uv.y - mesh.uvs[v].y)) > 0.01;
                kinks += glm::dot(glm::normalize(normal), DVec3(mesh.normals[v])) < std::cos(0.12);
                shades += std::abs(light - mesh.colors[v].a) > 0.05;
            }
        }
        RecordProperty("collars_" + sample.name, static_cast<int>(collars));
        // Several stems grow from one root, which has no bark above it to lie on.
        if (sample.name != "shrub") {
            EXPECT_GE(2 * collars, stout);
        }
        EXPECT_LE(jumps, bases / 20);
        EXPECT_LE(kinks, bases / 20);
        EXPECT_LE(shades, bases / 20);
    }
}

// Metres of bark per repeat of its picture, on all wood but the threads of three sides.
TEST(Joints, TheBarksPictureHasOneScale) {
    for (const Sample& sample : all_samples()) {
        SCOPED_TRACE(sample.name);
        const TubeOptions options;
        const Mesh mesh = build_branch_tubes(sample.tree, options);
        double off = 0.0, all = 0.0;
        const double ground = sample.tree.node(sample.tree.root()).position.y;
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
            if (mesh.colors[a].g >= 1.0f || mesh.colors[b].g >= 1.0f || mesh.colors[c].g >= 1.0f) continue;
            if (std::max({mesh.positions[a].y, mesh.positions[b].y, mesh.positions[c].y}) < ground + 0.01)
                continue;  // under the ground
            const DVec3 e1(mesh.positions[b] - mesh.positions[a]), e2(mesh.positions[c] - mesh.positions[a]);
            const DVec2 width(options.bark_width, 1.0);
            const DVec2 d1 = DVec2(mesh.uvs[b] - mesh.uvs[a]) * width,
                        d2 = DVec2(mesh.uvs[c] - mesh.uvs[a]) * width;
            const double area = glm::length(glm::cross(e1, e2)),
                         picture = std::abs(d1.x * d2.y - d1.y * d2.x);
            const double ratio = std::sqrt(picture / area);
            all += area;
            if (ratio < 0.75 || ratio > 1.25) off += area;
        }
        RecordProperty("off_scale_" + sample.name, std::to_string(off / all));
        EXPECT_LT(off, 0.05 * all);
    }
}

// Where the branch's picture gives way to its parent's, the shader fades between them: there it is told so.
TEST(Joints, WherePicturesMeetBothSidesAreMarked) {
    size_t collars[2] = {0, 0};
    for (const Sample& sample : all_samples())
        for (int level = 0; level < 2; level++) {
            SCOPED_TRACE(sample.name + " " + std::to_string(level));
            const Mesh mesh = build_branch_tubes(sample.tree, {.level = level});
            size_t marks = 0;
            for (const float radius : mesh.radii)
                marks += radius < 0.0f;
            for (const TubeRange& tube : tubes_of(mesh)) {
                uint32_t end = tube.first_vertex;
                while (mesh.colors[end].g == 0.0f)
                    end++;
                const uint32_t stride = end - tube.first_vertex;
                if (end + 2 * stride > tube.end_vertex || mesh.positions[end] != mesh.positions[end + stride])
                    continue;
                collars[level]++;
                for (uint32_t v = end; v < end + stride; v++) {
                    EXPECT_EQ(mesh.positions[v], mesh.positions[v + stride]);
                    EXPECT_LT(mesh.radii[v], 0.0f);
                    EXPECT_LT(mesh.radii[v + stride], 0.0f);
                }
                ASSERT_GE(marks, 2 * stride) << "marks elsewhere";
                marks -= 2 * stride;
            }
            EXPECT_EQ(marks, 0u) << "marks elsewhere";
        }
    EXPECT_GT(collars[0], 20u);
    EXPECT_GT(collars[1], 10u);  // the stouter ones
}

TEST(Joints, FarLevelsHaveNoCollars) {
    const Mesh mesh = build_branch_tubes(all_samples()[0].tree, {.level = 2});
    for (const float radius : mesh.radii)
        EXPECT_GE(radius, 0.0f);
    for (const TubeRange& tube : tubes_of(mesh)) {
        std::set<std::tuple<float, float, float>> places;
        uint32_t end = tube.first_vertex;
        while (mesh.colors[end].g == 0.0f)
            end++;
        const uint32_t stride = end - tube.first_vertex;
        if (end + stride < tube.end_vertex) {
            EXPECT_NE(mesh.positions[end], mesh.positions[end + stride]);
        }
    }
}

// A trunk of 6 m; radius_at gives its radius by height.
template <typename Radius>
Tree straight_trunk(const Radius& radius_at) {
    Tree tree;
    NodeId at = tree.add_root({0, 0, 0}, radius_at(0.0), kTrunkFlag);
    for (int i = 1; i <= 30; i++)
        at = tree.add_child(at, {0.0, 0.2 * i, 0.0}, radius_at(0.2 * i), kTrunkFlag);
    return tree;
}

TEST(Joints, ATrunkWithoutABaseIsGivenOne) {
    for (const double radius : {0.05, 0.15, 0.4}) {
        SCOPED_TRACE(radius);
        Tree tree = straight_trunk([&](double y) { return radius * (1.0 - 0.1 * y); });
        tree.add_child(tree.node(10).parent, {0.1, 3.0, 0.1}, 0.1 * radius);
        const Mesh mesh = build_branch_tubes(tree);
        double widest = 0.0;
        std::map<float, double> rows;  // by height
        std::map<float, int> corners;
        for (size_t v = 0; v < mesh.positions.size(); v++) {
            const Vec3 p = mesh.positions[v];
            if (mesh.custom0[v].w > 0.0f) continue;  // the branch
            const double wide = std::hypot(p.x, p.z);
            if (p.y < 0.01f) widest = std::max(widest, wide);
            // Wood is not quite round, but as thick as it was measured.
            if ((p.y > 1.4f || p.y > 2.6 * radius) && p.y < 5.9f) {
                EXPECT_LE(wide, 1.04 * radius * (1.0 - 0.1 * p.y));
                double& sum = rows[p.y];
                sum += wide / (radius * (1.0 - 0.1 * p.y));
                corners[p.y]++;
            }
        }
        for (const auto& [height, sum] : rows)
            EXPECT_NEAR(sum / corners[height], 1.0, 0.005) << height;
        EXPECT_GT(rows.size(), 3u);
        EXPECT_GT(widest, 1.4 * radius);  // on its roots
        EXPECT_LT(widest, 4.0 * radius);
    }
}

TEST(Joints, ABaseThatWasScannedStays) {
    const auto radius_at = [](double y) { return 0.15 * (1.0 + 0.5 * std::exp(-3.0 * y)); };
    const Mesh mesh = build_branch_tubes(straight_trunk(radius_at));
    for (size_t v = 0; v < mesh.positions.size(); v++) {
        const Vec3 p = mesh.positions[v];
        EXPECT_LE(std::hypot(p.x, p.z), radius_at(0.0) + 1e-5);
        EXPECT_LE(mesh.radii[v], radius_at(0.0) + 1e-5);
    }
}

}  // namespace
}  // namespace treerec
