#include "photos/pinhole_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "error.h"
#include "exchange/material_textures.h"
#include "file_bytes.h"
#include "photos/shown_photo.h"

namespace treerec {
namespace {

std::vector<Camera> all_lenses() {
    const auto camera = [](LensModel model, std::array<double, 12> parameters) {
        return Camera{model, 640, 480, parameters};
    };
    return {
        camera(LensModel::kSimplePinhole, {500, 330, 236}),
        camera(LensModel::kPinhole, {500, 520, 330, 236}),
        camera(LensModel::kSimpleRadial, {500, 330, 236, -0.12}),
        camera(LensModel::kRadial, {500, 330, 236, 0.1, -0.05}),
        camera(LensModel::kOpenCv, {500, 510, 330, 236, -0.1, 0.02, 0.003, -0.002}),
        camera(LensModel::kOpenCvFisheye, {500, 510, 330, 236, -0.03, 0.01, 0.002, -0.001}),
        camera(LensModel::kFullOpenCv,
               {500, 510, 330, 236, -0.1, 0.02, 0.003, -0.002, 0.01, 0.02, 0.01, 0.005}),
        camera(LensModel::kSimpleRadialFisheye, {500, 330, 236, -0.04}),
        camera(LensModel::kRadialFisheye, {500, 330, 236, -0.04, 0.01}),
    };
}

ScanFrame tilted_frame() {
    ScanFrame frame;
    frame.origin = {3.0, -1.0, 2.0};
    frame.metres_per_unit = 1.7;
    frame.set_sky({0.2, -0.9, 0.1});
    return frame;
}

Photo turned_photo() {
    Photo photo;
    photo.name = "a.jpg";
    photo.rotation = {0.8, 0.36, -0.288, 0.384};
    photo.translation = {0.4, -0.7, 1.1};
    return photo;
}

// The place of the picture's light, in pixels.
DVec2 middle_of_light(const Image& picture) {
    DVec2 sum(0.0);
    double light = 0.0;
    for (int y = 0; y < picture.height; y++)
        for (int x = 0; x < picture.width; x++) {
            const double weight = *picture.at(x, y);
            sum += weight * DVec2(x + 0.5, y + 0.5);
            light += weight;
        }
    return sum / light;
}

// A photo of one point of light that is a few pixels wide.
Image light_at(const DVec2& at, int width, int height, double spread) {
    Image picture(width, height, 1);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const DVec2 off = DVec2(x + 0.5, y + 0.5) - at;
            *picture.at(x, y) =
                static_cast<uint8_t>(std::lround(255.0 * std::exp(-glm::dot(off, off) / (spread * spread))));
        }
    return picture;
}

// What a lens bent lies where the pinhole sees the tree's own place: pose, frame and lens together.
TEST(PinholeView, LaysAPhotoOnTheTreeForEveryLens) {
    const ScanFrame frame = tilted_frame();
    const Photo photo = turned_photo();
    for (const Camera& camera : all_lenses()) {
        for (const int longest : {640, 320, 250}) {
            const PinholeView view = fitted(pinhole_view(photo, camera, frame), longest);
            for (const DVec2 ray : {DVec2(0, 0), DVec2(0.4, 0.25), DVec2(-0.45, -0.3), DVec2(-0.3, 0.3)}) {
                const DVec3 in_camera = 5.0 * DVec3(ray.x, ray.y, 1.0);
                const DVec3 world = glm::transpose(photo.turn()) * (in_camera - photo.translation);
                const auto at = camera.project(photo.to_camera(world));
                const auto wanted = view.project(frame.to_tree(world));
                ASSERT_TRUE(at && wanted);
                const Image seen = undistorted(light_at(*at, camera.width, camera.height, 4.0), camera, view);
                const DVec2 found = middle_of_light(seen);
                EXPECT_LT(glm::length(found - *wanted), 0.2)
                    << "lens " << static_cast<int>(camera.model) << ", " << longest << " pixels, ray "
                    << ray.x << " " << ray.y;
            }
        }
    }
}

TEST(PinholeView, StandsUprightInTreeSpace) {
    const ScanFrame frame = tilted_frame();
    const Photo photo = turned_photo();
    const PinholeView view = pinhole_view(photo, all_lenses()[1], frame);
    EXPECT_NEAR(glm::determinant(view.turn), 1.0, 1e-12);
    EXPECT_LT(glm::length(frame.to_scan(view.centre) - photo.centre()), 1e-12);
    EXPECT_LT(glm::length(frame.turn_to_scan(-view.turn[2]) - photo.ahead()), 1e-12);
    EXPECT_FALSE(view.project(view.centre + view.turn[2]));
}

TEST(PinholeView, ShowsNothingWhereThePhotoHasNone) {
    Image white(640, 480, 3);
    std::fill(white.pixels.begin(), white.pixels.end(), uint8_t{255});
    const Camera bent{LensModel::kSimpleRadial, 640, 480, {500, 320, 240, 0.3}};
    const Image seen = undistorted(white, bent, pinhole_view(turned_photo(), bent, {}));
    EXPECT_EQ(*seen.at(0, 0), 0);
    EXPECT_EQ(*seen.at(320, 240), 255);
}

// Grey, as a PNG of its own folder.
std::string write_grey(const std::string& name, int width, int height) {
    Image grey(width, height, 3);
    std::fill(grey.pixels.begin(), grey.pixels.end(), uint8_t{128});
    const std::string path = testing::TempDir() + name;
    const std::vector<uint8_t> bytes = encode_png(grey);
    write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    return path;
}

TEST(ShownPhoto, IsTransparentWhereThePhotoShowsNothing) {
    const Camera bent{LensModel::kSimpleRadial, 640, 480, {500, 320, 240, 0.3}};
    const PinholeView view = pinhole_view(turned_photo(), bent, {});
    // A smaller copy of the photo will do.
    for (const int times : {1, 3}) {
        const Image seen = shown_photo(write_grey("shown_photo.png", 640 / times, 480 / times), bent, view);
        ASSERT_EQ(seen.channels, 4);
        EXPECT_EQ(seen.at(0, 0)[3], 0);
        for (int k = 0; k < 3; k++)
            EXPECT_EQ(seen.at(320, 240)[k], 128);
        EXPECT_EQ(seen.at(320, 240)[3], 255);
    }
}

TEST(ShownPhoto, RefusesWhatIsNoPictureOfItsCamera) {
    const Camera camera{LensModel::kSimplePinhole, 640, 480, {500, 320, 240}};
    const PinholeView view = pinhole_view(turned_photo(), camera, {});
    EXPECT_THROW(shown_photo(write_grey("turned.png", 480, 640), camera, view), Error);
    EXPECT_THROW(shown_photo(write_grey("cropped.png", 600, 480), camera, view), Error);
    EXPECT_THROW(shown_photo(testing::TempDir() + "no such photo.png", camera, view), Error);
}

TEST(CheckedCamera, TakesWhatIsOneAlone) {
    const std::vector<double> parameters{500, 320, 240, 0.1};
    const Camera camera = checked_camera(2, 640, 480, parameters, "a.jpg");
    EXPECT_EQ(camera.model, LensModel::kSimpleRadial);
    EXPECT_EQ(camera.parameters[3], 0.1);
    EXPECT_THROW(checked_camera(7, 640, 480, parameters, "a.jpg"), Error);
    EXPECT_THROW(checked_camera(2, 0, 480, parameters, "a.jpg"), Error);
    EXPECT_THROW(checked_camera(2, 640, 1 << 20, parameters, "a.jpg"), Error);
    EXPECT_THROW(checked_camera(4, 640, 480, parameters, "a.jpg"), Error);
    const std::vector<double> endless{HUGE_VAL, 320, 240, 0.1};
    EXPECT_THROW(checked_camera(2, 640, 480, endless, "a.jpg"), Error);
}

TEST(PinholeView, RefusesALensWithoutAMiddle) {
    Camera none{LensModel::kSimplePinhole, 640, 480, {0.0, 320, 240}};
    EXPECT_THROW(pinhole_view(turned_photo(), none, {}), std::exception);
}

}  // namespace
}  // namespace treerec
