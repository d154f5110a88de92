// The scale of a model, from markers that its photos show; cameras and markers are known to the last bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "geometry/random.h"
#include "photos/marker_scale.h"

namespace treerec {
namespace {

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

using Corners = std::array<DVec3, 4>;

// One that looks from `centre` at `at`, upright.
Photo photo_from(const DVec3& centre, const DVec3& at, int index) {
    const DVec3 ahead = glm::normalize(at - centre),
                right = glm::normalize(glm::cross(ahead, DVec3(0, 0, 1)));
    const DVec3 down = glm::cross(ahead, right);
    const glm::dquat turn = glm::quat_cast(glm::transpose(DMat3(right, down, ahead)));
    Photo photo;
    photo.name = "IMG_" + std::to_string(100 + index) + ".jpg";
    photo.rotation = {turn.w, turn.x, turn.y, turn.z};
    photo.translation = -(photo.turn() * centre);
    return photo;
}

// On an arc around the origin, in units of which one is `unit` metres.
PhotoModel some_model(int count, double arc, double radius) {
    PhotoModel model;
    model.cameras.push_back({LensModel::kRadial, 1600, 2400, {1700, 800, 1200, -0.05, 0.01}});
    for (int i = 0; i < count; i++) {
        const double angle = arc * kPi / 180.0 * (count > 1 ? static_cast<double>(i) / (count - 1) : 0.0);
        model.photos.push_back(
            photo_from(radius * DVec3(std::cos(angle), std::sin(angle), 0.2), DVec3(0, 0, 0.1 * radius), i));
    }
    return model;
}

// A square whose side and place are in the model's unit, turned any way but not away from the cameras.
Corners square_of(double side, const DVec3& at, Random& random) {
    const DVec3 normal = glm::normalize(DVec3(1.0, 0.0, 0.4) + 0.3 * random.direction());
    const DVec3 right = any_perpendicular(normal), down = glm::cross(normal, right);
    Corners corners;
    for (size_t k = 0; k < 4; k++)
        corners[k] =
            at + 0.5 * side * ((k == 1 || k == 2 ? 1.0 : -1.0) * right + (k >= 2 ? 1.0 : -1.0) * down);
    return corners;
}

// noise: pixels, the deviation of each corner.
void see(const PhotoModel& model, const Corners& corners, int id, double noise, Random& random,
         std::vector<PhotoMarkers>& seen) {
    seen.resize(model.photos.size());
    for (size_t i = 0; i < model.photos.size(); i++) {
        FoundMarker marker;
        marker.id = id;
        for (size_t k = 0; k < 4; k++) {
            const auto at = model.cameras[0].project(model.photos[i].to_camera(corners[k]));
            ASSERT_TRUE(at);
            marker.corners[k] = *at + noise * DVec2(random.normal(), random.normal());
        }
        seen[i].photo = i;
        seen[i].markers.push_back(marker);
    }
}

TEST(MarkerScale, KnownCamerasGiveItsSide) {
    Random random(1);
    for (int trial = 0; trial < 100; trial++) {
        const double unit = std::exp(random.uniform(-3.0, 3.0)), side = random.uniform(0.1, 0.4);
        const PhotoModel model = some_model(12, 100.0, 3.0 / unit);
        std::vector<PhotoMarkers> seen;
        see(model, square_of(side / unit, 0.3 / unit * random.direction(), random), 7, 0.1, random, seen);
        const MarkerScale scale = measure_markers(model, seen, side);
        ASSERT_TRUE(scale.usable()) << marker_sentence(scale, false);
        EXPECT_NEAR(scale.metres_per_unit() / unit, 1.0, 0.003);
        ASSERT_EQ(scale.markers.size(), 1u);
        EXPECT_EQ(scale.markers[0].kept, 12u);
        EXPECT_LT(scale.spread, 0.01);
        EXPECT_GT(scale.markers[0].parallax, 60.0);
        EXPECT_EQ(marker_sentence(scale, false), "");
    }
}

TEST(MarkerScale, PhotosThatAreWrongAreLeftOut) {
    Random random(2);
    const PhotoModel model = some_model(9, 80.0, 3.0);
    std::vector<PhotoMarkers> seen;
    see(model, square_of(0.3, {}, random), 7, 0.1, random, seen);
    // Two were placed elsewhere by COLMAP, one shows the marker turned.
    for (const size_t i : {2, 5})
        for (DVec2& corner : seen[i].markers[0].corners)
            corner += DVec2(60.0, -25.0);
    std::rotate(seen[7].markers[0].corners.begin(), seen[7].markers[0].corners.begin() + 1,
                seen[7].markers[0].corners.end());
    const MarkerScale scale = measure_markers(model, seen, 0.3);
    ASSERT_TRUE(scale.usable());
    EXPECT_EQ(scale.markers[0].photos, 9u);
    EXPECT_EQ(scale.markers[0].kept, 6u);
    EXPECT_NEAR(scale.metres_per_unit(), 1.0, 0.003);
}

// Two of one id: photos that show both can't tell them apart, and those that show one agree on one of them.
TEST(MarkerScale, TwoOfOneIdAreToldApartOrNotUsed) {
    Random random(3);
    const PhotoModel model = some_model(8, 80.0, 3.0);
    std::vector<PhotoMarkers> seen, other;
    see(model, square_of(0.3, {}, random), 7, 0.1, random, seen);
    see(model, square_of(0.3, {0.0, 0.8, 0.0}, random), 7, 0.1, random, other);
    for (size_t i = 0; i < 3; i++)
        seen[i].markers.push_back(other[i].markers[0]);
    seen[7].markers = other[7].markers;
    MarkerScale scale = measure_markers(model, seen, 0.3);
    ASSERT_TRUE(scale.usable());
    EXPECT_EQ(scale.markers[0].kept, 4u);
    EXPECT_NEAR(scale.metres_per_unit(), 1.0, 0.004);
    for (size_t i = 3; i < 8; i++)
        seen[i].markers.push_back(other[i].markers[0]);
    scale = measure_markers(model, seen, 0.3);
    EXPECT_FALSE(scale.usable());
    EXPECT_NE(marker_sentence(scale, false), "");
}

TEST(MarkerScale, TheMiddleOfSeveral) {
    Random random(4);
    const PhotoModel model = some_model(10, 90.0, 3.0);
    std::vector<PhotoMarkers> seen;
    see(model, square_of(0.30, {}, random), 1, 0.05, random, seen);
    see(model, square_of(0.302, {0.2, 0.5, 0.0}, random), 2, 0.05, random, seen);
    // One that was printed too small.
    see(model, square_of(0.25, {0.2, -0.5, 0.0}, random), 3, 0.05, random, seen);
    const MarkerScale scale = measure_markers(model, seen, 0.3);
    ASSERT_EQ(scale.markers.size(), 3u);
    EXPECT_NEAR(scale.metres_per_unit(), 1.0, 0.004);
    EXPECT_GT(scale.spread, 0.05);
}

TEST(MarkerScale, SaysWhyItTellsNoSize) {
    Random random(5);
    const auto sentence = [&](const PhotoModel& model, const Corners& corners) {
        std::vector<PhotoMarkers> seen;
        see(model, corners, 7, 0.02, random, seen);
        const MarkerScale scale = measure_markers(model, seen, 0.3);
        EXPECT_FALSE(scale.usable());
        return marker_sentence(scale, false);
    };
    const Corners square = square_of(0.3, {}, random);
    EXPECT_TRUE(has(sentence(some_model(1, 0.0, 3.0), square), "one photo alone"));
    EXPECT_TRUE(has(sentence(some_model(6, 0.1, 3.0), square), "from one side"));
    EXPECT_TRUE(has(sentence(some_model(6, 3.0, 3.0), square), "too near to each other"));
    Corners bent = square;
    bent[2] += 0.12 * glm::normalize(glm::cross(square[1] - square[0], square[3] - square[0]));
    EXPECT_TRUE(has(sentence(some_model(8, 80.0, 3.0), bent), "no square"));
    EXPECT_TRUE(has(marker_sentence(measure_markers(some_model(8, 80.0, 3.0), {}, 0.3), false), "No photo"));
}

TEST(MarkerScale, IsHintedAtWhereItsSideIsNotTold) {
    Random random(6);
    const PhotoModel model = some_model(8, 80.0, 3.0);
    std::vector<PhotoMarkers> seen;
    see(model, square_of(0.3, {}, random), 7, 0.1, random, seen);
    const MarkerScale scale = measure_markers(model, seen, 0.0);
    EXPECT_FALSE(scale.usable());
    EXPECT_EQ(scale.metres_per_unit(), 0.0);
    EXPECT_TRUE(has(marker_sentence(scale, false), "A printed marker (id 7) is in 8 photos"));
    EXPECT_EQ(marker_sentence(scale, true), "");
    EXPECT_EQ(marker_sentence(measure_markers(model, {}, 0.0), false), "");
}

TEST(MarkerScale, TwoScalesThatDisagreeAreSaid) {
    EXPECT_EQ(disagreement("the printed marker", 1.0, "the photos' GPS", 1.04), "");
    EXPECT_EQ(disagreement("the printed marker", 1.0, "the photos' GPS", 0.0), "");
    EXPECT_EQ(
        disagreement("the printed marker", 1.2, "the photos' GPS", 1.0),
        "By the printed marker, the tree is 20 % higher than by the photos' GPS; the former was taken.");
    EXPECT_TRUE(has(disagreement("the printed marker", 0.9, "the photos' GPS", 1.0), "10 % lower"));
}

}  // namespace
}  // namespace treerec
