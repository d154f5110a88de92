// How bark grew, kept to be scrubbed through (src/growth/recording.h), and obstacles that are meshes kept
// beside the recipe.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "growth/grow_bark.h"
#include "growth/recording.h"
#include "growth_trees.h"

using namespace treerec;
using test::cylinder;
using test::expect_sound;

namespace {

GrownBark bark_of(size_t vertices) {
    GrownBark bark;
    bark.branches.push_back({0, 1.0});
    bark.vertices.resize(vertices);
    for (size_t i = 0; i < vertices; i++) {
        bark.vertices[i].position = Vec3(static_cast<float>(i), 0.0f, 0.0f);
        bark.vertices[i].normal = Vec3(0.0f, 1.0f, 0.0f);
    }
    bark.indices = {0, 1, 2};
    return bark;
}

class Cancels : public Progress {
  public:
    void update(double fraction, const char*) override { far_ = fraction > 0.3; }
    bool cancelled() const override { return far_; }

  private:
    bool far_ = false;
};

}  // namespace

TEST(GrowthRecording, ChangesNothingAndEndsWithTheResult) {
    const Tree tree = cylinder(0.1, 1.0);
    const GrowthRecipe recipe = read_growth_recipe(
        tree, "edges longest=0.05\nburl along=0.5 radius=0.1\nhollow along=0.6 around=180");
    const GrownTree plain = grow_bark(tree, recipe);
    GrowthRecording recording;
    GrowBarkOptions options;
    options.watcher = &recording;
    const GrownTree watched = grow_bark(tree, recipe, options);
    EXPECT_EQ(pack_grown_bark(watched.bark), pack_grown_bark(plain.bark));
    const std::vector<GrowthRecording::Frame>& frames = recording.frames();
    ASSERT_GT(frames.size(), 20U);
    EXPECT_EQ(frames.back().bark, pack_grown_bark(plain.bark));
    EXPECT_EQ(frames.back().step, plain.steps);
    size_t bytes = 0;
    for (size_t i = 0; i < frames.size(); i++) {
        bytes += frames[i].bark.size();
        const GrownBark bark = unpack_grown_bark(frames[i].bark);
        ASSERT_FALSE(bark.empty());
        EXPECT_EQ(bark.vertices.size() - bark.indices.size() / 6, 2U);  // V - F / 2, of a ball
        if (i == 0) continue;
        EXPECT_GT(frames[i].step, frames[i - 1].step);
    }
    EXPECT_EQ(bytes, recording.bytes());
    // It grows: the middle is smaller than the end.
    EXPECT_LT(unpack_grown_bark(frames[frames.size() / 2].bark).vertices.size(), plain.bark.vertices.size());
}

TEST(GrowthRecording, HoldsAtMostSoManyBytesOfEvenlySpreadSteps) {
    constexpr size_t kMost = 200000;
    constexpr int kSteps = 1000;
    GrowthRecording recording(kMost);
    for (int step = 1; step <= kSteps; step++) {
        if (!recording.wants(step, kSteps)) continue;
        recording.take(step, bark_of(static_cast<size_t>(3 + step / 5)));
        ASSERT_LE(recording.bytes(), kMost);
    }
    const std::vector<GrowthRecording::Frame>& frames = recording.frames();
    ASSERT_GT(frames.size(), 10U);
    EXPECT_GT(recording.bytes(), kMost / 4);
    EXPECT_EQ(frames.back().step, kSteps);
    const int every = frames[1].step - frames[0].step;
    for (size_t i = 1; i + 1 < frames.size(); i++)
        EXPECT_EQ(frames[i].step - frames[i - 1].step, every);
    EXPECT_LE(frames.back().step - frames[frames.size() - 2].step, 2 * every);
}

TEST(GrowthRecording, HoldsNothingThatHasNoRoom) {
    GrowthRecording recording(100);
    for (int step = 1; step <= 10; step++)
        if (recording.wants(step, 10)) recording.take(step, bark_of(50));
    EXPECT_TRUE(recording.frames().empty());
    EXPECT_EQ(recording.bytes(), 0U);
}

TEST(GrowthRecording, StopsWithTheGrowth) {
    const Tree tree = cylinder(0.1, 1.0);
    Cancels cancels;
    GrowthRecording recording;
    GrowBarkOptions options;
    options.watcher = &recording;
    const GrowthRecipe recipe = read_growth_recipe(tree, "edges longest=0.05");
    const int steps = grow_bark(tree, recipe).steps;
    EXPECT_THROW(grow_bark(tree, recipe, options, &cancels), Cancelled);
    // Its progress goes by the square of the steps.
    ASSERT_FALSE(recording.frames().empty());
    EXPECT_NEAR(recording.frames().back().step, std::sqrt(0.3) * steps, 3.0);
}

namespace {

using Triangle = std::array<DVec3, 3>;

// A square of two triangles in the plane x = 0, a metre wide.
std::vector<Triangle> square() {
    const DVec3 a(0.0, -0.5, -0.5), b(0.0, 0.5, -0.5), c(0.0, 0.5, 0.5), d(0.0, -0.5, 0.5);
    return {{a, b, c}, {a, c, d}};
}

double farthest_x(const GrownBark& bark) {
    double most = 0.0;
    for (const GrownBark::Vertex& vertex : bark.vertices)
        if (std::abs(vertex.position.y - 0.6f) < 0.1f && std::abs(vertex.position.z) < 0.05f)
            most = std::max(most, static_cast<double>(vertex.position.x));
    return most;
}

}  // namespace

TEST(GrowthRecipe, AMeshBesideTheRecipeStandsWhereItsAxesSay) {
    const Tree tree = cylinder(0.12, 1.2);
    const std::string edges = "edges longest=0.05\n", wall = "obstacle shape=mesh mesh=wall growth=0 ";
    const double free = farthest_x(grow_bark(tree, read_growth_recipe(tree, edges)).bark);
    EXPECT_NEAR(free, 0.12, 0.01);
    // Turned about and mirrored: it is a wall a tenth of a metre away all the same.
    for (const char* axes :
         {"middle=0.09,0.6,0", "middle=0.09,0.6,0 x=-1,0,0", "middle=0.09,0.6,0 x=2,0,0 y=0,0,1 z=0,1,0"}) {
        GrowthRecipe recipe = read_growth_recipe(tree, edges + wall + axes);
        ASSERT_EQ(recipe.obstacles.size(), 1U);
        recipe.obstacles[0].triangles = square();
        const GrownTree grown = grow_bark(tree, recipe, {20});
        for (const GrowthStep& step : grown.checks)
            expect_sound(step);
        EXPECT_LT(farthest_x(grown.bark), 0.09) << axes;
        EXPECT_GT(farthest_x(grown.bark), 0.07) << axes;
    }
    // Whoever has no such mesh says so.
    EXPECT_THROW(grow_bark(tree, read_growth_recipe(tree, edges + wall)), Error);
    EXPECT_THROW(read_growth_recipe(tree, "obstacle shape=mesh"), Error);
    EXPECT_THROW(read_growth_recipe(tree, "obstacle shape=post mesh=wall"), Error);
    EXPECT_THROW(read_growth_recipe(tree, "obstacle shape=mesh mesh=wall file=wall.obj"), Error);
}
