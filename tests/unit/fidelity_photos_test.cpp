// Photos, their cameras and masks: I, R_3d and Q (Zhang 2013, 7.1 and 7.2).
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "error.h"
#include "exchange/material_textures.h"
#include "fidelity/fidelity.h"
#include "fidelity/photo_fidelity.h"
#include "geometry/random.h"

namespace treerec {
namespace {

namespace fs = std::filesystem;

class Photos : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ =
            fs::temp_directory_path() / ("treerec_photos_" + std::to_string(::getpid()) + "_" +
                                         ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    void put(const std::string& name, const std::string& bytes) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
    }
    std::string folder() const { return folder_.string(); }
    // A mask whose left `white` columns are tree.
    void put_mask(const std::string& name, int width, int height, int white) const {
        Image image(width, height, 3);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < white; x++)
                std::fill_n(image.at(x, y), 3, uint8_t{200});
        const std::vector<uint8_t> png = encode_png(image);
        put(name, std::string(png.begin(), png.end()));
    }
    template <typename Call>
    std::string error_of(Call call) const {
        try {
            call();
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }

    fs::path folder_;
};

constexpr const char* kCameras =
    "# Camera list\n"
    "1 PINHOLE 100 80 50 60 50 40\n"
    "7 SIMPLE_RADIAL 64 64 50 32 32 0.1\n";
// The second looks back along z: half a turn about y.
constexpr const char* kImages =
    "# two lines each\n"
    "3 1 0 0 0 0 0 5 1 b.jpg\n"
    "\n"
    "9 0 0 1 0 0 0 5 7 folder/a.png\n"
    "1.5 2.5 -1 3 4 5\n";

template <typename T>
void append(std::string& bytes, T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
}

std::string camera_bytes() {
    std::string bytes;
    append<uint64_t>(bytes, 2);
    append<uint32_t>(bytes, 1);
    append<int32_t>(bytes, 1);
    append<uint64_t>(bytes, 100);
    append<uint64_t>(bytes, 80);
    for (double v : {50.0, 60.0, 50.0, 40.0})
        append(bytes, v);
    append<uint32_t>(bytes, 7);
    append<int32_t>(bytes, 2);
    append<uint64_t>(bytes, 64);
    append<uint64_t>(bytes, 64);
    for (double v : {50.0, 32.0, 32.0, 0.1})
        append(bytes, v);
    return bytes;
}

std::string image_bytes() {
    std::string bytes;
    append<uint64_t>(bytes, 2);
    append<uint32_t>(bytes, 3);
    for (double v : {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 5.0})
        append(bytes, v);
    append<uint32_t>(bytes, 1);
    bytes += std::string("b.jpg") + '\0';
    append<uint64_t>(bytes, 0);
    append<uint32_t>(bytes, 9);
    for (double v : {0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 5.0})
        append(bytes, v);
    append<uint32_t>(bytes, 7);
    bytes += std::string("folder/a.png") + '\0';
    append<uint64_t>(bytes, 1);
    append(bytes, 1.5);
    append(bytes, 2.5);
    append<uint64_t>(bytes, 12);
    return bytes;
}

TEST_F(Photos, TextAndBinaryModelsAreTheSame) {
    put("text/cameras.txt", kCameras);
    put("text/images.txt", kImages);
    put("binary/cameras.bin", camera_bytes());
    put("binary/images.bin", image_bytes());
    for (const char* kind : {"/text", "/binary"}) {
        const PhotoModel model = read_photo_model(folder() + kind);
        ASSERT_EQ(model.photos.size(), 2u);
        EXPECT_EQ(model.photos[0].name, "b.jpg");
        EXPECT_EQ(model.photos[1].name, "folder/a.png");
        const Camera& pinhole = model.cameras[static_cast<size_t>(model.photos[0].camera)];
        EXPECT_EQ(pinhole.width, 100);
        EXPECT_EQ(pinhole.height, 80);
        // 1 right, 2 down, 5 + 5 ahead.
        const auto at = pinhole.project(model.photos[0].to_camera(DVec3(1.0, 2.0, 5.0)));
        ASSERT_TRUE(at);
        EXPECT_NEAR(at->x, 50.0 + 50.0 * 0.1, 1e-12);
        EXPECT_NEAR(at->y, 40.0 + 60.0 * 0.2, 1e-12);
        EXPECT_FALSE(pinhole.project(DVec3(0.0, 0.0, -1.0)));
        // Turned, x goes left and z comes nearer; the lens bends outwards by 1 + k r^2.
        const Camera& bent = model.cameras[static_cast<size_t>(model.photos[1].camera)];
        const auto there = bent.project(model.photos[1].to_camera(DVec3(1.0, 2.0, 1.0)));
        ASSERT_TRUE(there);
        const double x = -0.25, y = 0.5, factor = 1.0 + 0.1 * (x * x + y * y);
        EXPECT_NEAR(there->x, 32.0 + 50.0 * x * factor, 1e-12);
        EXPECT_NEAR(there->y, 32.0 + 50.0 * y * factor, 1e-12);
    }
}

TEST_F(Photos, DamagedModelsAreSentences) {
    put("cameras.bin", camera_bytes());
    put("images.bin", image_bytes());
    ASSERT_NO_THROW(read_photo_model(folder()));
    for (const std::string& whole : {camera_bytes(), image_bytes()}) {
        const std::string name = whole == camera_bytes() ? "cameras.bin" : "images.bin";
        for (size_t length = 0; length < whole.size(); length++) {
            put(name, whole.substr(0, length));
            EXPECT_THROW(read_photo_model(folder()), Error) << name << " " << length;
        }
        Random random(1);
        for (int i = 0; i < 500; i++) {
            std::string bytes = whole;
            for (int k = 0; k < 3; k++)
                bytes[random.below(static_cast<uint32_t>(bytes.size()))] =
                    static_cast<char>(random.below(256));
            put(name, bytes);
            try {
                read_photo_model(folder());
            } catch (const Error&) {
            }
        }
        put(name, whole);
    }
    std::string unknown = camera_bytes();
    unknown[12] = 42;
    put("cameras.bin", unknown);
    EXPECT_NE(error_of([&] { read_photo_model(folder()); }).find("42"), std::string::npos);
    EXPECT_NE(error_of([&] { read_photo_model(folder() + "/nowhere"); }).find("cameras.bin"),
              std::string::npos);
}

TEST_F(Photos, InformationGrowsFastThenSlowly) {
    EXPECT_EQ(photo_information(0), 0.0);
    EXPECT_NEAR(photo_information(1), 0.2, 1e-12);
    EXPECT_NEAR(photo_information(2), 0.36, 1e-12);
    EXPECT_NEAR(photo_information(20), 1.0 - std::pow(0.8, 20), 1e-12);
    for (size_t n = 1; n < 30; n++)
        EXPECT_LT(photo_information(n + 1) - photo_information(n),
                  photo_information(n) - photo_information(n - 1));
}

// Points of which it is known how many fall where; the cloud's frame is turned and in another unit.
TEST_F(Photos, CountsTheHitsOfEveryPhoto) {
    put("model/cameras.txt", kCameras);
    put("model/images.txt", kImages);
    put_mask("masks/b.jpg.png", 100, 80, 60);
    put_mask("masks/folder/a.png", 64, 64, 0);
    PointCloud cloud;
    cloud.frame = {DVec3(1.0, 2.0, 3.0), 0.5, UpAxis::kZ};
    const std::vector<DVec3> scan = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0},   {2.5, 0.0, 0.0},
                                     {4.0, 0.0, 0.0}, {100.0, 0.0, 0.0}, {0.0, 0.0, -9.0}};
    for (const DVec3& p : scan)
        cloud.positions.emplace_back(cloud.frame.to_tree(p));
    // At columns 50, 60 (no tree: 0 to 59 are), 75, 90; beside the picture; behind the camera.
    const PhotoFidelity found = measure_photos(cloud, folder() + "/model", folder() + "/masks");
    ASSERT_EQ(found.photos.size(), 2u);
    EXPECT_EQ(found.photos[0].inside, 1u);
    EXPECT_EQ(found.photos[0].outside, 5u);
    EXPECT_EQ(found.photos[1].inside, 0u);
    EXPECT_NEAR(found.reconstruction, 0.5 * (1.0 / 6.0), 1e-12);
    EXPECT_NEAR(found.information, 0.36, 1e-12);
    Fidelity fidelity;
    fidelity.skeleton = 0.5;
    EXPECT_NEAR(modelling_fidelity(found, fidelity), 0.36 / 12.0 * 0.5, 1e-12);
}

TEST_F(Photos, MasksThatAreMissingOrWrongAreSentences) {
    put("model/cameras.txt", kCameras);
    put("model/images.txt", kImages);
    PointCloud cloud;
    cloud.positions.emplace_back(0.0F);
    const auto error = [&] {
        return error_of([&] { measure_photos(cloud, folder() + "/model", folder() + "/masks"); });
    };
    EXPECT_NE(error().find("no folder"), std::string::npos);
    fs::create_directories(folder_ / "masks");
    EXPECT_NE(error().find("2 of 2 photos have no mask"), std::string::npos);
    EXPECT_NE(error().find("b.jpg"), std::string::npos);
    put_mask("masks/b.png", 100, 80, 3);
    EXPECT_NE(error().find("1 of 2 photos have no mask"), std::string::npos);
    put_mask("masks/folder/a.png.png", 64, 63, 3);
    EXPECT_NE(error().find("64 x 63 pixels, but the photo has 64 x 64"), std::string::npos) << error();
    put("masks/folder/a.png.png", "no picture");
    EXPECT_NE(error().find("no picture that can be read"), std::string::npos);
    put_mask("masks/folder/a.png.png", 64, 64, 3);
    EXPECT_EQ(error(), "");
    cloud.positions.clear();
    EXPECT_NE(error().find("empty"), std::string::npos);
}

// The lens formulas must not fold what is far to the side back into the picture.
TEST_F(Photos, LensesDoNotFold) {
    Camera camera;
    camera.model = LensModel::kSimpleRadial;
    camera.width = camera.height = 1000;
    camera.parameters = {500.0, 500.0, 500.0, -0.2};
    double last = -1.0;
    for (double x = 0.0; x < 3.0; x += 0.01) {
        const auto at = camera.project(DVec3(x, 0.0, 1.0));
        if (x * x > 1.0 / 0.6) {
            EXPECT_FALSE(at) << x;
        } else if (x * x < 0.99 / 0.6) {
            ASSERT_TRUE(at) << x;
            EXPECT_GT(at->x, last);
            last = at->x;
        }
    }
}

}  // namespace
}  // namespace treerec
