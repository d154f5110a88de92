// Hollows, obstacles and grain of bark that grows (src/growth).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include "geometry/random.h"
#include "growth/grow_bark.h"
#include "growth/shapes.h"
#include "growth_trees.h"
#include "mesh/branch_tubes.h"

using namespace treerec;

namespace {

constexpr double kRadius = 0.15, kHeight = 1.2;  // of the trunk

Tree trunk() {
    return test::cylinder(kRadius, kHeight);
}

GrownTree grow(const std::string& lines, int check_every = 0) {
    const Tree tree = trunk();
    return grow_bark(tree, read_growth_recipe(tree, "edges longest=0.045\n" + lines), {check_every});
}

void expect_sound(const GrownTree& grown) {
    EXPECT_TRUE(grown.remarks.empty()) << (grown.remarks.empty() ? "" : grown.remarks[0]);
    ASSERT_GE(grown.checks.size(), 3U);
    for (const GrowthStep& step : grown.checks)
        test::expect_sound(step);
}

double from_axis(const GrownBark::Vertex& vertex) {
    return std::hypot(static_cast<double>(vertex.position.x), static_cast<double>(vertex.position.z));
}

// Radians about Y, as `around` of a recipe goes.
double azimuth(const GrownBark::Vertex& vertex) {
    return std::atan2(-static_cast<double>(vertex.position.z), static_cast<double>(vertex.position.x));
}

size_t decayed(const GrownBark& bark) {
    return static_cast<size_t>(std::count_if(bark.vertices.begin(), bark.vertices.end(),
                                             [](const GrownBark::Vertex& v) { return v.decayed; }));
}

// Metres along the ray to the triangle; negative: it misses (Moeller and Trumbore 1997).
double hit(const DVec3& from, const DVec3& way, const DVec3& a, const DVec3& b, const DVec3& c) {
    const DVec3 ab = b - a, ac = c - a, p = glm::cross(way, ac);
    const double det = glm::dot(ab, p);
    if (std::abs(det) < 1e-300) return -1.0;
    const DVec3 s = from - a, q = glm::cross(s, ab);
    const double u = glm::dot(s, p) / det, v = glm::dot(way, q) / det;
    return u < 0.0 || v < 0.0 || u + v > 1.0 ? -1.0 : glm::dot(ac, q) / det;
}

std::vector<std::array<DVec3, 3>> faces_of(const GrownBark& bark) {
    std::vector<std::array<DVec3, 3>> faces;
    for (size_t i = 0; i < bark.indices.size(); i += 3)
        faces.push_back({DVec3(bark.vertices[bark.indices[i]].position),
                         DVec3(bark.vertices[bark.indices[i + 1]].position),
                         DVec3(bark.vertices[bark.indices[i + 2]].position)});
    return faces;
}

// How many edges of either go through faces of the other.
size_t crossings(const growth::Triangles& a, const growth::Triangles& b) {
    size_t count = 0;
    for (const auto& p : a)
        for (const auto& q : b) {
            bool apart = false;
            for (int k = 0; k < 3; k++)
                apart |= std::max({p[0][k], p[1][k], p[2][k]}) < std::min({q[0][k], q[1][k], q[2][k]}) ||
                         std::max({q[0][k], q[1][k], q[2][k]}) < std::min({p[0][k], p[1][k], p[2][k]});
            if (apart) continue;
            for (size_t k = 0; k < 3; k++) {
                const double s = hit(p[k], p[(k + 1) % 3] - p[k], q[0], q[1], q[2]);
                const double t = hit(q[k], q[(k + 1) % 3] - q[k], p[0], p[1], p[2]);
                count += (s >= 0.0 && s <= 1.0 ? 1 : 0) + (t >= 0.0 && t <= 1.0 ? 1 : 0);
            }
        }
    return count;
}

// A post beside the trunk, upright at x: of its sides at half height, the share from which one sees bark.
double swallowed(const GrownBark& bark, double x, double radius) {
    const std::vector<std::array<DVec3, 3>> faces = faces_of(bark);
    int seen = 0;
    for (int i = 0; i < 72; i++) {
        const DVec3 way(std::cos(2.0 * kPi * i / 72), 0.0, std::sin(2.0 * kPi * i / 72));
        const DVec3 from = DVec3(x, 0.5 * kHeight, 0.0) + 0.99 * radius * way;
        seen += std::any_of(faces.begin(), faces.end(), [&](const std::array<DVec3, 3>& face) {
            const double distance = hit(from, way, face[0], face[1], face[2]);
            return distance >= 0.0 && distance < 4.0 * radius;
        });
    }
    return seen / 72.0;
}

}  // namespace

TEST(GrowthHollow, IsAsDeepAsAskedAndLeavesTheRest) {
    const GrownTree grown =
        grow("hollow along=0.6 around=0 width=0.16 height=0.3 depth=0.09 growth=0 wrap=0 until=0.95", 10);
    expect_sound(grown);
    EXPECT_GT(decayed(grown.bark), 15U);
    double ground = 1.0;
    for (const GrownBark::Vertex& vertex : grown.bark.vertices) {
        const double y = static_cast<double>(vertex.position.y), x = static_cast<double>(vertex.position.x);
        if (std::abs(y - 0.6) < 0.05 && std::abs(azimuth(vertex)) < 0.3) ground = std::min(ground, x);
        if (y < 0.3 || y > 0.9) continue;
        if (std::abs(azimuth(vertex)) > 2.0) {
            EXPECT_NEAR(from_axis(vertex), kRadius, 0.03 * kRadius);
        }
    }
    EXPECT_NEAR(ground, kRadius - 0.09, 0.15 * 0.09);
}

TEST(GrowthHollow, LipsGrowOverIt) {
    const std::string mouth = "hollow along=0.6 width=0.16 height=0.3 depth=0.06 from=0.4 until=0.5 ";
    const GrownBark open = grow(mouth + "growth=0 wrap=0").bark,
                    closing = grow(mouth + "growth=0 wrap=1").bark,
                    swollen = grow(mouth + "growth=1 swell=0.1 wrap=0").bark;
    EXPECT_LT(static_cast<double>(decayed(closing)), 0.8 * static_cast<double>(decayed(open)));
    const auto highest = [](const GrownBark& bark) {
        double most = 0.0;
        for (const GrownBark::Vertex& vertex : bark.vertices)
            if (vertex.position.y > 0.3f && vertex.position.y < 0.9f)
                most = std::max(most, from_axis(vertex));
        return most;
    };
    // k of the S_c steps that are left when it begins.
    EXPECT_GT(highest(swollen) - highest(open), 0.5 * 0.6 * kRadius);
    EXPECT_LT(highest(swollen) - highest(open), 1.2 * 0.6 * kRadius);
}

TEST(GrowthHollow, LipsAreAsThickInAnyStepsAndEdges) {
    for (const char* edges : {"0.045", "0.08"})
        for (const char* steps : {"0", "400"}) {
            const std::string name = std::string("edges ") + edges + ", steps " + steps;
            const GrownBark bark =
                grow(std::string("edges longest=") + edges + "\nsteps count=" + steps +
                     "\nhollow along=0.6 around=0 width=0.14 height=0.36 depth=0.17 growth=0.5 swell=0.1 "
                     "wrap=0.4 from=0.35 until=0.85")
                    .bark;
            // Of an ellipse half as wide as the mouth, the share through which one sees wood.
            const std::vector<std::array<DVec3, 3>> faces = faces_of(bark);
            int seen = 0, all = 0;
            for (int row = -4; row <= 4; row++)
                for (int column = -4; column <= 4; column++) {
                    if (row * row + column * column > 16) continue;
                    const DVec3 from(4.0 * kRadius, 0.6 + 0.09 * row / 4.0, 0.035 * column / 4.0);
                    double nearest = 1e9;
                    size_t face = 0;
                    for (size_t i = 0; i < faces.size(); i++) {
                        const double way =
                            hit(from, DVec3(-1.0, 0.0, 0.0), faces[i][0], faces[i][1], faces[i][2]);
                        if (way < 0.0 || way >= nearest) continue;
                        nearest = way;
                        face = i;
                    }
                    all++;
                    for (size_t k = 0; k < 3; k++)
                        if (bark.vertices[bark.indices[3 * face + k]].decayed) {
                            seen++;
                            break;
                        }
                }
            EXPECT_GT(seen, 0.9 * all) << name;
            // And round the back, how far bark lies from the axis where it is thinnest.
            constexpr int kRows = 5, kBins = 6;
            double highest = 0.0, outer[kRows][kBins] = {};
            for (const GrownBark::Vertex& vertex : bark.vertices) {
                const double up = static_cast<double>(vertex.position.y) - 0.6;
                const double turn = std::abs(azimuth(vertex)) - 1.3;
                if (std::abs(up) > 0.3) continue;
                highest = std::max(highest, from_axis(vertex));
                if (turn < 0.0 || std::abs(up) > 0.2) continue;
                double& most = outer[std::min(static_cast<int>((up + 0.2) / 0.4 * kRows), kRows - 1)]
                                    [std::min(static_cast<int>(turn / (kPi - 1.3) * kBins), kBins - 1)];
                most = std::max(most, from_axis(vertex));
            }
            double thinnest = 1.0;
            for (const auto& row : outer)
                for (const double most : row)
                    if (most > 0.0) thinnest = std::min(thinnest, most);
            // k of the growth that is left when it begins.
            EXPECT_LT(highest, kRadius * (1.0 + 0.5 * 0.65 * 1.2)) << name;
            EXPECT_GT(highest, kRadius * (1.0 + 0.5 * 0.65 * 0.15)) << name;
            EXPECT_GT(thinnest, 0.93 * kRadius) << name;
        }
}

TEST(GrowthHollow, DoesNotPierceTheFarSide) {
    const GrownTree grown = grow("hollow along=0.6 width=0.2 height=0.3 depth=1.0 wall=0.03 from=0.5", 10);
    expect_sound(grown);
    for (const GrownBark::Vertex& vertex : grown.bark.vertices)
        if (vertex.decayed && std::abs(azimuth(vertex)) > 1.6) {
            EXPECT_LT(from_axis(vertex), kRadius - 0.03 + 0.005) << azimuth(vertex);
        }
}

TEST(GrowthHollow, BareWoodLooksLikeWood) {
    const Tree tree = trunk();
    const GrownTree grown = grow("hollow along=0.6 width=0.16 height=0.3");
    TubeOptions options;
    options.grown = &grown.bark;
    const Mesh mesh = build_branch_tubes(tree, options);
    ASSERT_EQ(mesh.radii.size(), mesh.positions.size());
    const auto wood = static_cast<size_t>(
        std::count_if(mesh.radii.begin(), mesh.radii.end(), [](float r) { return r == 0.008f; }));
    EXPECT_GE(wood, decayed(grown.bark));
}

TEST(GrowthCuts, CallusGrowsOverCutEnds) {
    const auto bare = [](const std::string& line) {
        const GrownTree grown = grow(line, 40);
        expect_sound(grown);
        EXPECT_TRUE(std::isinf(grown.bark.branches[0].until));
        double area = 0.0;
        for (size_t i = 0; i < grown.bark.indices.size(); i += 3) {
            const GrownBark::Vertex* v[3];
            for (size_t k = 0; k < 3; k++)
                v[k] = &grown.bark.vertices[grown.bark.indices[i + k]];
            if (!(v[0]->decayed || v[1]->decayed || v[2]->decayed)) continue;
            // At the end alone, facing up.
            EXPECT_GT(v[0]->position.y, static_cast<float>(kHeight - kRadius)) << line;
            const DVec3 a(v[0]->position), b(v[1]->position), c(v[2]->position);
            area += 0.5 * std::abs(glm::cross(b - a, c - a).y);
        }
        return area;
    };
    EXPECT_EQ(bare("burl along=0.5 radius=0.1"), 0.0);
    const double face = kPi * kRadius * kRadius;
    const double cut = bare("cuts from=0.6 growth=0 wrap=0"), healed = bare("cuts from=0.6 growth=1 wrap=1");
    EXPECT_GT(cut, 0.15 * face);
    EXPECT_LT(cut, 0.8 * face);
    EXPECT_LT(healed, 0.7 * cut);
    EXPECT_LT(bare("cuts from=0.2 growth=1 wrap=1"), 0.7 * healed);
    // What ends thinner is no cut.
    EXPECT_EQ(bare("cuts least=0.2"), 0.0);
}

TEST(GrowthObstacle, NothingGoesThroughIt) {
    Random random(7);
    for (const char* shape : {"wire", "ring", "sheet", "wire", "ring", "sheet"}) {
        const DVec3 d = random.direction();
        const double angle = random.uniform(0.0, 6.28);
        const double x = 0.13 * std::cos(angle), y = random.uniform(0.4, 0.8), z = 0.13 * std::sin(angle);
        const auto vector = [](double a, double b, double c) {
            return std::to_string(a) + "," + std::to_string(b) + "," + std::to_string(c);
        };
        // As it was written, for the test to see it as the surface does.
        const DVec3 middle(std::stod(std::to_string(x)), std::stod(std::to_string(y)),
                           std::stod(std::to_string(z)));
        const DVec3 direction = glm::normalize(DVec3(
            std::stod(std::to_string(d.x)), std::stod(std::to_string(d.y)), std::stod(std::to_string(d.z))));
        const GrownTree grown = grow(std::string("obstacle shape=") + shape + " middle=" + vector(x, y, z) +
                                         " direction=" + vector(d.x, d.y, d.z) +
                                         " length=0.3 width=0.2 radius=0.1 thickness=0.004",
                                     10);
        ASSERT_GE(grown.checks.size(), 3U);
        for (const GrowthStep& step : grown.checks)
            EXPECT_EQ(step.intersections, 0U) << shape << " step " << step.step;
        const DVec3 side = any_perpendicular(direction), other = glm::cross(direction, side);
        growth::Triangles thing;
        if (std::string(shape) == "wire")
            thing = growth::prism(middle - 0.15 * direction, middle + 0.15 * direction, 0.002 * side,
                                  0.002 * other, 8);
        else if (std::string(shape) == "ring")
            thing = growth::torus(middle, direction, 0.1, 0.004);
        else {
            const DVec3 up = normalized_or(DVec3(0.0, 1.0, 0.0) - direction * direction.y, side);
            thing = growth::sheet(middle, glm::cross(up, direction) * 0.1, up * 0.15);
        }
        EXPECT_EQ(crossings(faces_of(grown.bark), thing), 0U) << shape;
    }
}

TEST(GrowthObstacle, IsSwallowedTheMoreTheLongerAndByGrowthAndWrap) {
    const auto share = [](const std::string& more, double x) {
        const GrownTree grown =
            grow("obstacle shape=post middle=" + std::to_string(x) +
                     ",0.6,0 direction=0,1,0 radius=0.03 length=3 swell=0.08 band=0.06 " + more,
                 20);
        EXPECT_EQ(grown.checks.back().intersections, 0U);
        return swallowed(grown.bark, x, 0.03);
    };
    // A post further in was reached earlier.
    const double late = share("growth=0.5 wrap=1", 0.16), early = share("growth=0.5 wrap=1", 0.12);
    EXPECT_GT(early, late + 0.1);
    const double none = share("growth=0 wrap=0", 0.13);
    EXPECT_GT(share("growth=0 wrap=1", 0.13), none);
    EXPECT_GT(share("growth=0.5 wrap=0", 0.13), none + 0.1);
}

TEST(GrowthObstacle, TipsGoAroundWhatStandsInTheirWay) {
    for (const char* line : {
             "shape=post gap=-0.15 direction=1,0,0 radius=0.03 length=1",
             "shape=post gap=-0.13 around=60 direction=0.6,0.3,0.6 radius=0.04 length=1",
             "shape=wire gap=-0.15 direction=0,0,1 length=1",
             "shape=sheet gap=-0.15 direction=0,1,0 width=0.08 length=1",
         }) {
        SCOPED_TRACE(line);
        const GrownTree grown = grow(std::string("obstacle along=0.6 ") + line, 30);
        expect_sound(grown);
        EXPECT_TRUE(std::isinf(grown.bark.branches[0].until));
        EXPECT_GT(test::radii(grown.bark, 1.0, 1.15).size(), 20U);
    }
    // What is wider than the wood is no way around.
    const GrownTree stopped =
        grow("obstacle shape=sheet along=0.6 gap=-0.15 direction=0,1,0 width=1 length=1");
    EXPECT_LT(stopped.bark.branches[0].until, 0.6);
    EXPECT_GT(stopped.bark.branches[0].until, 0.45);
}

TEST(GrowthObstacle, ComesFromFiles) {
    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "growth_fence.obj";
    const auto write = [&](const char* text) { std::ofstream(path) << text; };
    write("# a rail\nv 0.13 0.5 -1\nv 0.13 0.7 -1\nv 0.13 0.7 1\nv 0.13 0.5 1\nf 1/1 2/2 3/3 -1/4\n");
    const std::string line = "obstacle shape=mesh growth=0 wrap=0 file=\"" + path.string() + "\"";
    const GrownTree grown = grow(line);
    double most = 0.0;
    for (const GrownBark::Vertex& vertex : grown.bark.vertices)
        if (vertex.position.y > 0.53f && vertex.position.y < 0.67f)
            most = std::max(most, static_cast<double>(vertex.position.x));
    EXPECT_LT(most, 0.13);
    EXPECT_GT(most, 0.12);
    write("v 1 2\n");
    EXPECT_THROW(grow(line), Error);
    write("v 1 2 3\nf 1 2 3\n");
    EXPECT_THROW(grow(line), Error);
    write("nothing\n");
    EXPECT_THROW(grow(line), Error);
    std::filesystem::remove(path);
    EXPECT_THROW(grow(line), Error);
    EXPECT_THROW(grow("obstacle shape=box middle=0,-0.19,0 direction=0,1,0 width=2 length=2 thickness=0.1"),
                 Error);
}

// Equation 7: a ridge on the sap links, and the bark's picture, go around with the grain.
TEST(GrowthObstacle, MayBeAsLargeAsTheWorldButMustHaveNumbers) {
    // A wall beside the trunk, whose other end is far away.
    const auto grown = [](double far) {
        const Tree tree = trunk();
        GrowthRecipe recipe =
            read_growth_recipe(tree, "edges longest=0.045\nobstacle shape=mesh mesh=wall growth=0 wrap=0");
        const DVec3 a(0.13, 0.5, -far), b(0.13, far, -far), c(0.13, far, far), d(0.13, 0.5, far);
        recipe.obstacles[0].triangles = {{a, b, c}, {a, c, d}};
        return grow_bark(tree, recipe);
    };
    for (const double far : {10.0, 1e5, 1e30}) {
        double most = 0.0;
        for (const GrownBark::Vertex& vertex : grown(far).bark.vertices)
            if (vertex.position.y > 0.55f) most = std::max(most, static_cast<double>(vertex.position.x));
        EXPECT_LT(most, 0.13) << far;
        EXPECT_GT(most, 0.12) << far;
    }
    EXPECT_THROW(grown(std::nan("")), Error);
    EXPECT_THROW(grown(HUGE_VAL), Error);
}

TEST(GrowthGrain, WindsRidgesAndTheBarksPicture) {
    for (const double twist : {0.0, 3.0, -3.0}) {
        const GrownTree grown =
            grow("grain twist=" + std::to_string(twist) +
                     "\nburl grain=yes along=0.6 around=40 radius=0.07 length=0.8 growth=0.8 from=0.2",
                 20);
        expect_sound(grown);
        double sum = 0.0, picture = 0.0, reach = 0.0;
        const GrownBark::Vertex* below = nullptr;
        for (double y = 0.3; y < 0.9; y += 0.05) {
            const GrownBark::Vertex* crest = nullptr;
            for (const GrownBark::Vertex& vertex : grown.bark.vertices)
                if (std::abs(static_cast<double>(vertex.position.y) - y) < 0.025 &&
                    (!crest || from_axis(vertex) > from_axis(*crest)))
                    crest = &vertex;
            ASSERT_NE(crest, nullptr);
            EXPECT_GT(from_axis(*crest), 1.15 * kRadius) << "twist " << twist << " at " << y;
            if (below) {
                sum += std::remainder(azimuth(*crest) - azimuth(*below), 2.0 * kPi);
                picture += std::remainder(static_cast<double>(crest->around - below->around), 1.0);
                reach += static_cast<double>(crest->position.y - below->position.y);
            }
            below = crest;
        }
        // Links go from vertex to vertex: an edge and a half aside over the height that is measured.
        const double aside = 0.2 * std::abs(twist) + 1.5 * 0.045 / (kRadius * reach);
        EXPECT_NEAR(sum / reach, twist, aside);
        EXPECT_NEAR(2.0 * kPi * picture / reach, 0.0, aside) << "twist " << twist;
    }
}

TEST(GrowthFeatures, AreTheSameEachTime) {
    const std::string lines =
        "grain twist=2\nhollow along=0.4 width=0.12 height=0.2\nobstacle shape=wire along=0.8 gap=-0.03\n"
        "burl grain=yes along=0.7 around=200 radius=0.06 length=0.5";
    const GrownBark a = grow(lines).bark, b = grow(lines).bark;
    ASSERT_EQ(a.vertices.size(), b.vertices.size());
    EXPECT_EQ(a.indices, b.indices);
    for (size_t i = 0; i < a.vertices.size(); i++)
        ASSERT_EQ(a.vertices[i].position, b.vertices[i].position);
}

TEST(GrowthFeatures, RefuseNonsense) {
    const Tree tree = trunk();
    for (const char* text : {"hollow from=0.8 until=0.5", "hollow depth=-1", "hollow swell=0.1 inner=0.2",
                             "obstacle shape=moon", "obstacle shape=mesh", "obstacle shape=post file=a.obj",
                             "obstacle direction=0,0,0", "grain twist=1e9", "burl grain=perhaps"})
        EXPECT_THROW(read_growth_recipe(tree, text), Error) << text;
}
