// Where photos show the sky, on pictures whose sky is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/gtc/quaternion.hpp>

#include "cli_runner.h"
#include "exchange/material_textures.h"
#include "geometry/random.h"
#include "photos/sky_blends.h"
#include "photos/sky_mask.h"

namespace treerec {
namespace {

constexpr int kSide = 300;
constexpr double kFocal = 300.0;

// What stands at the origin: a stem and a ball of a crown, with a hole all around its equator; z to the sky.
bool in_scene(const DVec3& from, const DVec3& way, double& depth) {
    depth = 1e30;
    const double a = way.x * way.x + way.y * way.y, b = from.x * way.x + from.y * way.y,
                 c = from.x * from.x + from.y * from.y - 0.04, root = b * b - a * c;
    if (root > 0.0) {
        const double t = (-b - std::sqrt(root)) / a, z = from.z + t * way.z;
        if (t > 0.0 && z > -1.0 && z < 1.4) depth = t;
    }
    const DVec3 middle(0.0, 0.0, 1.0), away = from - middle;
    const double q = glm::dot(away, way), sphere = q * q - glm::dot(away, away) + 0.49;
    if (sphere > 0.0) {
        const double t = -q - std::sqrt(sphere), z = from.z + t * way.z;
        if (t > 0.0 && std::abs(z - 1.0) > 0.12) depth = std::min(depth, t);
    }
    if (way.z < 0.0) depth = std::min(depth, (-1.0 - from.z) / way.z);
    return depth < 1e30;
}

Camera lens() {
    Camera camera;
    camera.model = LensModel::kSimplePinhole;
    camera.width = camera.height = kSide;
    camera.parameters = {kFocal, 0.5 * kSide, 0.5 * kSide};
    return camera;
}

Photo photo_at(double degrees) {
    const double angle = degrees * kPi / 180.0;
    const DVec3 centre(4.0 * std::cos(angle), 4.0 * std::sin(angle), -0.3);
    const DVec3 ahead = glm::normalize(DVec3(0.0, 0.0, 0.5) - centre);
    const DVec3 right = glm::normalize(glm::cross(ahead, DVec3(0, 0, 1)));
    const glm::dquat q = glm::quat_cast(glm::transpose(DMat3(right, glm::cross(ahead, right), ahead)));
    Photo photo;
    photo.name = std::to_string(static_cast<int>(degrees)) + ".png";
    photo.rotation = {q.w, q.x, q.y, q.z};
    photo.translation = -photo.to_camera(centre);
    return photo;
}

// A sky that is brighter to one side and above, with a camera's noise; bark and grass of all grey levels.
Image drawn(const Photo& photo, std::vector<uint8_t>& is_sky, double slope = 1.0, double noise = 1.5) {
    Random random(4);
    Image image(kSide, kSide, 3);
    is_sky.assign(static_cast<size_t>(kSide) * kSide, 0);
    for (int y = 0; y < kSide; y++)
        for (int x = 0; x < kSide; x++) {
            const DVec3 way =
                glm::transpose(photo.turn()) * glm::normalize(DVec3((x + 0.5 - 0.5 * kSide) / kFocal,
                                                                    (y + 0.5 - 0.5 * kSide) / kFocal, 1.0));
            double depth = 0.0;
            uint8_t* pixel = image.at(x, y);
            if (in_scene(photo.centre(), way, depth)) {
                for (int part = 0; part < 3; part++)
                    pixel[part] = static_cast<uint8_t>(random.uniform(20.0, 150.0));
                continue;
            }
            is_sky[static_cast<size_t>(y) * kSide + static_cast<size_t>(x)] = 1;
            for (int part = 0; part < 3; part++)
                pixel[part] = static_cast<uint8_t>(
                    std::clamp(175.0 + 10.0 * part + slope * (0.08 * x - 0.1 * y) + noise * random.normal(),
                               0.0, 255.0));
        }
    return image;
}

TEST(SkyMask, IsTheSkyAndTheHolesInACrown) {
    const Photo photo = photo_at(20.0);
    const Camera camera = lens();
    std::vector<uint8_t> truth;
    // A grey day, too.
    for (const double slope : {1.0, 0.0}) {
        const Image picture = drawn(photo, truth, slope, 1.5 * slope);
        const std::vector<uint8_t> sky = sky_in({&photo, &camera, picture, 1.0}, {0, 0, 1}, 0).mask;
        ASSERT_EQ(sky.size(), truth.size());
        size_t shown = 0, found = 0, wrong = 0;
        for (size_t i = 0; i < sky.size(); i++) {
            shown += truth[i];
            found += truth[i] && sky[i];
            wrong += !truth[i] && sky[i];
        }
        EXPECT_GT(static_cast<double>(found), 0.9 * static_cast<double>(shown));
        EXPECT_LT(static_cast<double>(wrong), 0.01 * static_cast<double>(shown));
        const std::vector<uint8_t> less = sky_in({&photo, &camera, picture, 1.0}, {0, 0, 1}, 3).mask;
        for (size_t i = 0; i < less.size(); i++)
            EXPECT_LE(less[i], sky[i]);
    }
}

TEST(SkyMask, IsNowhereWhereThereIsNone) {
    const Photo photo = photo_at(0.0);
    const Camera camera = lens();
    Random random(5);
    Image noise(kSide, kSide, 3);
    for (uint8_t& value : noise.pixels)
        value = static_cast<uint8_t>(random.below(256));
    EXPECT_TRUE(sky_in({&photo, &camera, noise, 1.0}, {0, 0, 1}, 1).mask.empty());
    // An even floor below the horizon.
    std::fill(noise.pixels.begin() + 3 * kSide * (3 * kSide / 4), noise.pixels.end(), uint8_t{220});
    EXPECT_TRUE(sky_in({&photo, &camera, noise, 1.0}, {0, 0, 1}, 1).mask.empty());
    EXPECT_FALSE(sky_in({&photo, &camera, noise, 1.0}, {0, 0, -1}, 1).mask.empty());
    EXPECT_TRUE(sky_in({&photo, &camera, Image(2, 2, 3), 0.01}, {0, 0, 1}, 1).mask.empty());
}

class SkyCarving : public test::InFolder {
  protected:
    void SetUp() override {
        InFolder::SetUp();
        model.cameras = {lens()};
        for (int i = 0; i < 12; i++) {
            model.photos.push_back(photo_at(30.0 * i));
            std::vector<uint8_t> ignored;
            const std::vector<uint8_t> png = encode_png(drawn(model.photos.back(), ignored));
            put(model.photos.back().name, std::string(png.begin(), png.end()));
        }
        for (int i = 0; i < 50; i++)
            sparse.emplace_back(0.2 * std::cos(i), 0.2 * std::sin(i), -1.0 + 0.04 * i);
    }

    PhotoModel model;
    std::vector<DVec3> sparse;
};

TEST_F(SkyCarving, TakesWhatIsNotThereAlone) {
    // One is missing.
    std::filesystem::remove(path(model.photos[3].name));
    const SkyCarver carver(model, sparse, folder_.string());
    Random random(6);
    for (int i = 0; i < 300; i++) {
        const double angle = random.uniform(0.0, 2.0 * kPi);
        const DVec3 out(std::cos(angle), std::sin(angle), 0.0);
        EXPECT_FALSE(carver.is_sky(0.2 * out + DVec3(0, 0, random.uniform(-0.9, 1.3))));
        EXPECT_TRUE(carver.is_sky(random.uniform(0.9, 1.2) * out + DVec3(0, 0, random.uniform(0.6, 1.3))));
        EXPECT_FALSE(carver.is_sky(out + DVec3(0, 0, -1.0)));
    }
    EXPECT_FALSE(carver.is_sky({1e9, 0.0, 1e9}));
    EXPECT_FALSE(SkyCarver(model, sparse, path("nowhere")).is_sky({0.0, 1.0, 1.0}));
}

TEST_F(SkyCarving, KnowsHowLightTheSkyIs) {
    const DVec3 colour = SkyCarver(model, sparse, folder_.string()).colour();
    for (int part = 0; part < 3; part++)
        EXPECT_NEAR(colour[part], 175.0 + 10.0 * part, 10.0);
    EXPECT_EQ(SkyCarver(model, sparse, path("nowhere")).colour(), DVec3(0.0));
}

TEST(SkyBlends, GoFromAmongDarkerPointsAndLightBarkStays) {
    Random random(8);
    PointCloud cloud;
    std::vector<uint8_t> stays;
    const auto add = [&](const DVec3& p, double grey, bool stay) {
        const auto level = static_cast<uint8_t>(grey);
        cloud.positions.emplace_back(p);
        cloud.colors.push_back({level, level, level});
        stays.push_back(stay);
    };
    // A crown of dark leaves with light edges, and the white stem of a birch with black marks.
    for (int i = 0; i < 4000; i++) {
        const DVec3 p(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(3.0, 5.0));
        const bool edge = random.below(5) == 0;
        add(p, edge ? random.uniform(155.0, 205.0) : random.uniform(50.0, 110.0), !edge);
    }
    for (int i = 0; i < 4000; i++) {
        const double angle = random.uniform(0.0, 2.0 * kPi);
        const DVec3 p(0.2 * std::cos(angle), 0.2 * std::sin(angle), random.uniform(0.0, 2.0));
        add(p, random.below(5) == 0 ? random.uniform(20.0, 60.0) : random.uniform(175.0, 205.0), true);
    }
    const PointCloud before = cloud;
    const auto edges = static_cast<size_t>(std::count(stays.begin(), stays.end(), 0));
    EXPECT_EQ(drop_sky_blends(cloud, DVec3(210.0)), edges);
    PointCloud wanted = before;
    wanted.keep_only(stays);
    EXPECT_EQ(cloud.positions, wanted.positions);
    EXPECT_EQ(cloud.colors, wanted.colors);
    // A sky as dark as what stands before it tells nothing, nor does none, nor do points without colours.
    cloud = before;
    EXPECT_EQ(drop_sky_blends(cloud, DVec3(90.0)), 0u);
    EXPECT_EQ(drop_sky_blends(cloud, DVec3(0.0)), 0u);
    cloud.colors.clear();
    EXPECT_EQ(drop_sky_blends(cloud, DVec3(210.0)), 0u);
    PointCloud none;
    EXPECT_EQ(drop_sky_blends(none, DVec3(210.0)), 0u);
}

}  // namespace
}  // namespace treerec
