// A dense cloud from photos, on pictures of which every pixel's place is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>

#include "error.h"
#include "exchange/material_textures.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "photos/densify.h"
#include "photos/rectify.h"
#include "photos/semi_global.h"

namespace treerec {
namespace {

constexpr double kRadius = 0.3;  // of a stem that stands upright at the origin, y to the sky

uint32_t scramble(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7FEB352DU;
    x ^= x >> 15;
    x *= 0x846CA68BU;
    return x ^ x >> 16;
}

// Smooth noise in space, 0 to 1.
double noise_at(const DVec3& p) {
    const DVec3 low = glm::floor(p), part = p - low, s = part * part * (3.0 - 2.0 * part);
    double sum = 0.0;
    for (int corner = 0; corner < 8; corner++) {
        const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
        const auto whole = [](double v, int step) {
            return static_cast<uint32_t>(static_cast<int>(v) + step);
        };
        const uint32_t hash =
            scramble(whole(low.x, x) + scramble(whole(low.y, y) + scramble(whole(low.z, z))));
        sum += (x ? s.x : 1 - s.x) * (y ? s.y : 1 - s.y) * (z ? s.z : 1 - s.z) * hash / 4294967296.0;
    }
    return sum;
}

// A fence all around, as high as it is low: it ends at the camera's height, and is as even as the sky.
constexpr double kFence = 5.0;

// What the scene looks like along a ray: a stem of some texture, on a ground, before a grey sky.
uint8_t seen_along(const DVec3& from, const DVec3& way, bool fenced) {
    const double a = way.x * way.x + way.z * way.z;
    const double b = from.x * way.x + from.z * way.z;
    const double c = from.x * from.x + from.z * from.z - kRadius * kRadius;
    const double root = b * b - a * c;
    const double stem = root > 0.0 ? (-b - std::sqrt(root)) / a : -1.0;
    const double ground = way.y < 0.0 ? (-1.0 - from.y) / way.y : -1.0;
    double at = stem > 0.0 ? stem : ground;
    if (stem > 0.0 && ground > 0.0) at = std::min(stem, ground);
    if (fenced && (at <= 0.0 || std::hypot(from.x + at * way.x, from.z + at * way.z) > kFence))
        return way.y < 0.0 ? 60 : 180;
    if (at <= 0.0) return 128;
    const DVec3 p = from + at * way;
    const double bright = 0.6 * noise_at(40.0 * p) + 0.4 * noise_at(90.0 * p);
    return static_cast<uint8_t>(std::lround(255.0 * std::clamp(1.6 * bright - 0.3, 0.0, 1.0)));
}

Photo photo_from(const DVec3& centre, const DVec3& aim) {
    const DVec3 forward = glm::normalize(aim - centre);
    const DVec3 right = glm::normalize(glm::cross(forward, DVec3(0, 1, 0)));
    const glm::dquat q = glm::quat_cast(glm::transpose(DMat3(right, glm::cross(forward, right), forward)));
    Photo photo;
    photo.rotation = {q.w, q.x, q.y, q.z};
    photo.translation = -photo.to_camera(centre);
    return photo;
}

struct Scene {
    PhotoModel model;
    std::vector<DVec3> sparse;
    std::string folder;
    ~Scene() {
        std::error_code failure;
        std::filesystem::remove_all(path_of(folder), failure);
    }
};

Camera usual_camera(int times = 1) {
    Camera camera;
    camera.model = LensModel::kPinhole;
    camera.width = 300 * times;
    camera.height = 220 * times;
    camera.parameters = {260.0 * times, 260.0 * times, 150.0 * times, 110.0 * times};
    return camera;
}

Image take(const Photo& photo, const Camera& camera, bool fenced) {
    Image picture(camera.width, camera.height, 3);
    const DMat3 back = glm::transpose(photo.turn());
    for (int y = 0; y < camera.height; y++)
        for (int x = 0; x < camera.width; x++) {
            double sum = 0.0;
            for (const double v : {0.25, 0.75})
                for (const double u : {0.25, 0.75}) {
                    const DVec3 ray((x + u - camera.parameters[2]) / camera.parameters[0],
                                    (y + v - camera.parameters[3]) / camera.parameters[1], 1.0);
                    sum += seen_along(photo.centre(), glm::normalize(back * ray), fenced);
                }
            const auto grey = static_cast<uint8_t>(std::lround(sum / 4.0));
            const uint8_t pixel[] = {grey, grey, static_cast<uint8_t>(grey / 2)};
            std::copy(pixel, pixel + 3, picture.at(x, y));
        }
    return picture;
}

// Photos on a part of a circle around the stem, 6 degrees apart, or where there is a fence on all of it, and
// points on it as a model has them.
void fill(Scene& scene, int photos, const char* name, int times = 1, bool fenced = false) {
    scene.folder = utf8_of(std::filesystem::temp_directory_path() / name);
    make_folder(scene.folder);
    scene.model.cameras.push_back(usual_camera(times));
    for (int i = 0; i < photos; i++) {
        const double angle = glm::radians((fenced ? 360.0 / photos : 6.0) * i);
        const double height = fenced ? 0.0 : 0.1 * (i % 3);
        Photo photo = photo_from({2.0 * std::sin(angle), height, 2.0 * std::cos(angle)}, {0, 0, 0});
        photo.name = std::to_string(i) + ".png";
        const std::vector<uint8_t> bytes = encode_png(take(photo, scene.model.cameras.front(), fenced));
        write_file(scene.folder + "/" + photo.name,
                   std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
        scene.model.photos.push_back(photo);
    }
    Random random(4);
    for (int i = 0; i < 400; i++) {
        const double angle = random.uniform() * 2.0 * kPi, height = random.uniform() * 2.0 - 1.0;
        scene.sparse.emplace_back(kRadius * std::sin(angle), height, kRadius * std::cos(angle));
    }
}

TEST(Densify, AStemSeenFromAroundIsRoundAndInItsPlace) {
    Scene scene;
    fill(scene, 10, "treerec_dense_stem");
    const Densified made = densify(scene.model, scene.sparse, scene.folder, {});
    EXPECT_EQ(made.photos, 10U);
    EXPECT_GE(made.pairs, 14U);
    EXPECT_TRUE(made.warnings.empty());
    std::vector<double> beside;
    size_t near = 0;
    for (const Vec3& position : made.cloud.positions) {
        const DVec3 p = made.cloud.frame.origin + DVec3(position);
        if (p.y < -0.9) continue;  // the ground
        const double off = std::abs(std::hypot(p.x, p.z) - kRadius);
        beside.push_back(off);
        near += off < 0.03;
    }
    ASSERT_GT(beside.size(), 2000U);
    std::sort(beside.begin(), beside.end());
    // A pixel of disparity is 5 cm of depth for neighbours, 2.5 cm for the photos after these.
    EXPECT_LT(beside[beside.size() / 2], 0.006);
    EXPECT_GT(static_cast<double>(near), 0.9 * static_cast<double>(beside.size()));
    ASSERT_TRUE(made.cloud.has_colors());
    // Blue is half as bright.
    double red = 0.0, blue = 0.0;
    for (const Color8& colour : made.cloud.colors) {
        red += colour[0];
        blue += colour[2];
    }
    EXPECT_NEAR(blue / red, 0.5, 0.02);
}

// How far the middle one of the stem's points is from its surface.
double off_stem(const Densified& made) {
    std::vector<double> beside;
    for (const Vec3& position : made.cloud.positions) {
        const DVec3 p = made.cloud.frame.origin + DVec3(position);
        if (p.y > -0.9) beside.push_back(std::abs(std::hypot(p.x, p.z) - kRadius));
    }
    std::nth_element(beside.begin(), beside.begin() + static_cast<long>(beside.size() / 2), beside.end());
    return beside[beside.size() / 2];
}

// Larger photos are matched at the same size, and tell parts of a pixel.
TEST(Densify, LargerPhotosAreMoreExact) {
    Scene small, large;
    fill(small, 6, "treerec_dense_small");
    fill(large, 6, "treerec_dense_large", 2);
    DensifyOptions options;
    options.megapixels = 0.066;
    const Densified coarse = densify(small.model, small.sparse, small.folder, options);
    const Densified fine = densify(large.model, large.sparse, large.folder, options);
    EXPECT_NEAR(fine.cell / coarse.cell, 1.0, 0.01);
    EXPECT_LT(off_stem(fine), 0.7 * off_stem(coarse)) << off_stem(coarse);
}

// Matching takes the fence's edge for as near as the stem before it; photos from elsewhere see the stem
// through what hangs there.
TEST(Densify, NothingHangsAroundAStemBeforeAFence) {
    Scene scene;
    fill(scene, 36, "treerec_dense_fence", 1, true);
    const Densified made = densify(scene.model, scene.sparse, scene.folder, {});
    size_t on_stem = 0, hanging = 0;
    for (const Vec3& position : made.cloud.positions) {
        const DVec3 p = made.cloud.frame.origin + DVec3(position);
        const double away = std::hypot(p.x, p.z);
        if (std::abs(p.y) > 0.3) continue;
        on_stem += away < 1.2 * kRadius;
        hanging += away > 1.5 * kRadius;
    }
    EXPECT_GT(on_stem, 2000U);
    EXPECT_LT(hanging, on_stem / 100) << on_stem;
}

TEST(Densify, IsTheSameOnAnyThreads) {
    Scene scene;
    fill(scene, 4, "treerec_dense_threads");
    set_thread_count(1);
    const Densified one = densify(scene.model, scene.sparse, scene.folder, {});
    set_thread_count(3);
    const Densified three = densify(scene.model, scene.sparse, scene.folder, {});
    set_thread_count(0);
    EXPECT_EQ(one.cloud.positions, three.cloud.positions);
    EXPECT_EQ(one.cloud.colors, three.cloud.colors);
}

TEST(Densify, SaysWhatIsWrong) {
    Scene scene;
    fill(scene, 6, "treerec_dense_wrong");
    // One photo is gone, and one is no photo.
    std::filesystem::remove(path_of(scene.folder + "/0.png"));
    write_file(scene.folder + "/1.png", "no picture");
    const Densified made = densify(scene.model, scene.sparse, scene.folder, {});
    EXPECT_EQ(made.photos, 4U);
    ASSERT_EQ(made.warnings.size(), 2U);
    EXPECT_NE(made.warnings[1].find("1.png"), std::string::npos) << made.warnings[1];
    // Photos that are too far apart.
    Scene wide;
    fill(wide, 2, "treerec_dense_wide");
    wide.model.photos[1] = photo_from({-2.0, 0.0, 0.0}, {0, 0, 0});
    wide.model.photos[1].name = "1.png";
    EXPECT_THROW(densify(wide.model, wide.sparse, wide.folder, {}), Error);
    EXPECT_THROW(densify(scene.model, {}, scene.folder, {}), Error);
}

TEST(Densify, CanBeCancelled) {
    struct Impatient : Progress {
        bool cancelled() const override { return true; }
    } impatient;
    Scene scene;
    fill(scene, 4, "treerec_dense_cancel");
    EXPECT_THROW(densify(scene.model, scene.sparse, scene.folder, {}, &impatient), Cancelled);
}

// With a lens that bends lines, and cameras that stand and turn anyhow, a point lies in the same row of both.
TEST(Rectify, PutsWhatIsSeenIntoTheSameRows) {
    Random random(9);
    int tried = 0;
    for (int round = 0; round < 60; round++) {
        Camera camera = usual_camera();
        camera.model = LensModel::kRadial;
        camera.parameters = {250.0, 151.0, 108.0, 0.1 * random.normal() * 0.5, 0.02 * random.normal()};
        const auto stand = [&] {
            const DVec3 centre = 2.0 * DVec3(random.normal() * 0.2, random.normal() * 0.2, 1.0);
            return photo_from(centre, 0.2 * random.direction());
        };
        const Photo first = stand(), second = stand();
        const Image grey(camera.width, camera.height, 3);
        const LoadedPhoto one{&first, &camera, grey, 1.0}, other{&second, &camera, grey, 1.0};
        const auto pair = rectify(one, other);
        if (!pair) continue;
        tried++;
        const DMat3 common = glm::transpose(pair->to_world);
        for (int k = 0; k < 10; k++) {
            const DVec3 p = 0.4 * random.uniform() * random.direction();
            const DVec3 left = common * (p - pair->origin);
            const DVec3 right = common * (p - second.centre());
            ASSERT_NEAR(left.y / left.z, right.y / right.z, 1e-9);
            const double disparity = pair->focal * (left.x / left.z - right.x / right.z);
            ASSERT_GT(disparity, 0.0);
            const double x = pair->focal * left.x / left.z + pair->centre.x - 0.5;
            const double y = pair->focal * left.y / left.z + pair->centre.y - 0.5;
            ASSERT_LT(glm::distance(pair->point_at(x, y, disparity), p), 1e-9);
            // And the picture has it there: inside of the photo, inside of the rectified one.
            const auto pixel = camera.project(first.to_camera(p));
            const int column = static_cast<int>(std::lround(x)), row = static_cast<int>(std::lround(y));
            if (!pixel || pixel->x < 3 || pixel->y < 3 || pixel->x > camera.width - 3 ||
                pixel->y > camera.height - 3 || row < 0 || row >= pair->height)
                continue;
            ASSERT_GE(column, 0);
            ASSERT_LT(column, pair->width);
            EXPECT_TRUE(pair->left.inside[static_cast<size_t>(row * pair->width + column)]);
        }
    }
    EXPECT_GT(tried, 40);
}

TEST(Rectify, LeavesPairsAloneThatHaveNoRows) {
    const Camera camera = usual_camera();
    const Image grey(camera.width, camera.height, 3);
    const auto pair_of = [&](const Photo& a, const Photo& b) {
        return rectify({&a, &camera, grey, 1.0}, {&b, &camera, grey, 1.0}).has_value();
    };
    const Photo here = photo_from({0, 0, 2}, {0, 0, 0});
    EXPECT_FALSE(pair_of(here, here));                                // one place
    EXPECT_FALSE(pair_of(here, photo_from({0, 0, 1}, {0, 0, 0})));    // one before the other
    EXPECT_FALSE(pair_of(here, photo_from({0.2, 0, 2}, {0, 0, 4})));  // back to back
    EXPECT_TRUE(pair_of(here, photo_from({0.2, 0, 2}, {0, 0, 0})));
}

// Two pictures without anything in them.
RectifiedPair empty_pair(int width, int height) {
    RectifiedPair pair;
    pair.width = width;
    pair.height = height;
    for (RectifiedView* view : {&pair.left, &pair.right}) {
        view->inside.assign(static_cast<size_t>(width * height), 1);
        view->grey.assign(static_cast<size_t>(width * height), 77);
    }
    return pair;
}

// Noise that one picture shows farther left than the other, by parts of a pixel.
TEST(SemiGlobal, FindsShiftsToAPartOfAPixel) {
    for (const double shift : {6.0, 9.25, 17.6}) {
        RectifiedPair pair = empty_pair(160, 60);
        for (RectifiedView* view : {&pair.left, &pair.right}) {
            const double off = view == &pair.right ? shift : 0.0;
            for (int y = 0; y < pair.height; y++)
                for (int x = 0; x < pair.width; x++)
                    view->grey[static_cast<size_t>(y * pair.width + x)] =
                        static_cast<uint8_t>(std::lround(255.0 * noise_at({0.3 * (x + off), 0.3 * y, 0.5})));
        }
        const std::vector<float> found = match_rectified(pair, 2, 30);
        std::vector<double> wrong;
        size_t sure = 0;
        for (int y = 5; y < pair.height - 5; y++)
            for (int x = 40; x < pair.width - 10; x++) {
                const float disparity = found[static_cast<size_t>(y * pair.width + x)];
                if (std::isnan(disparity)) continue;
                sure++;
                wrong.push_back(std::abs(disparity - shift));
            }
        ASSERT_GT(sure, 5000U);
        std::sort(wrong.begin(), wrong.end());
        EXPECT_LT(wrong[wrong.size() / 2], 0.12) << shift;
        EXPECT_LT(wrong[wrong.size() * 99 / 100], 0.6) << shift;
    }
}

// What has no texture, and what the other picture doesn't show, is not guessed.
TEST(SemiGlobal, IsSilentWhereNothingIsSure) {
    RectifiedPair pair = empty_pair(120, 50);
    for (const float disparity : match_rectified(pair, 1, 20))
        EXPECT_TRUE(std::isnan(disparity));
    Random random(3);
    for (RectifiedView* view : {&pair.left, &pair.right})
        for (uint8_t& grey : view->grey)
            grey = static_cast<uint8_t>(random.uniform() * 256.0);
    size_t sure = 0;
    for (const float disparity : match_rectified(pair, 1, 20))
        sure += !std::isnan(disparity);
    EXPECT_LT(static_cast<double>(sure), 0.05 * static_cast<double>(pair.left.grey.size()));
}

}  // namespace
}  // namespace treerec
