// Colours of leaves out of photos: photos/leaf_colours.h, photos/leaf_look.h.
#include "photos/leaf_colours.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "exchange/material_textures.h"
#include "exchange/quiet_tiny_gltf.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "photo_orbit.h"
#include "photos/leaf_look.h"
#include "photos/photo_picture.h"
#include "pipeline/export.h"
#include "synth/grow.h"
#include "textures/linear_light.h"
#include "textures/texture_noise.h"
#include "textures/textures.h"
#include "with_photos.h"

namespace treerec {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 480;
constexpr double kFocal = 420.0;
constexpr double kRadius = 1.0;            // metres, of a crown like a clipped column
constexpr double kLow = 1.0, kHigh = 4.0;  // metres
constexpr double kAway = 5.0;
constexpr double kSpacing = 0.06;
constexpr double kLight = 1.5;  // of what light falls on the lit places, shaded ones have a third

struct Crown {
    DVec3 low{0.05, 0.10, 0.02};  // linear light
    DVec3 high{0.11, 0.15, 0.03};
    double shade = 0.4;  // of the places

    DVec3 albedo(double height) const {
        const double t = std::clamp((height - kLow) / (kHigh - kLow), 0.0, 1.0);
        return glm::exp(glm::mix(glm::log(low), glm::log(high), t));
    }
    DVec3 mean() const { return albedo(0.5 * (kLow + kHigh)); }

    // What comes from a place on it.
    DVec3 at(const DVec3& place) const {
        const DVec2 p(std::atan2(place.z, place.x) / (2.0 * std::numbers::pi) + 0.5, place.y / 8.0);
        const double tone = 1.0 + 0.12 * texture::noise(p, 160, 200, 3);
        const bool shaded = texture::noise(p, 60, 80, 8) < 2.0 * shade - 1.0;
        return albedo(place.y) * tone * (shaded ? kLight / 3.0 : kLight) / kLight;
    }
};

class PhotoLeavesTest : public test::WithPhotos {
  protected:
    void SetUp() override {
        WithPhotos::SetUp();
        use_pinhole(kWidth, kHeight, kFocal);
        frame_.up = UpAxis::kY;
        for (int i = 0; i < 4000; i++) {
            const double angle = 2.39996 * i;
            leaves_.emplace_back(kRadius * std::cos(angle), kLow + (kHigh - kLow) * (i + 0.5) / 4000,
                                 kRadius * std::sin(angle));
        }
    }

    // gain: of all channels. board: something red stands right of the middle, and has points.
    void add(const Crown& crown, double degrees, const DVec3& gain, bool board = false) {
        const double angle = degrees * std::numbers::pi / 180.0, high = 2.2;
        const DVec3 centre(kAway * std::cos(angle), high, kAway * std::sin(angle));
        const Photo photo = test::take_photo(centre, {0.0, high, 0.0},
                                             "photo" + std::to_string(model_.photos.size()) + ".png");
        const DMat3 axes = glm::transpose(photo.turn());
        const DVec3 &right = axes[0], &down = axes[1], &ahead = axes[2];
        Image picture(kWidth, kHeight, 3);
        parallel_for(kHeight, 8, [&](size_t begin, size_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); y++)
                for (int x = 0; x < kWidth; x++) {
                    const DVec3 way = (x + 0.5 - kWidth / 2.0) / kFocal * right +
                                      (y + 0.5 - kHeight / 2.0) / kFocal * down + ahead;
                    DVec3 light(0.5, 0.6, 0.75);  // the sky
                    const double a = way.x * way.x + way.z * way.z, b = centre.x * way.x + centre.z * way.z;
                    const double root = b * b - a * (kAway * kAway - kRadius * kRadius);
                    if (root > 0.0) {
                        const DVec3 place = centre + way * ((-b - std::sqrt(root)) / a);
                        if (place.y > kLow && place.y < kHigh) light = crown.at(place);
                    }
                    if (board && x > kWidth / 2) light = DVec3(0.3, 0.02, 0.02);
                    for (int c = 0; c < 3; c++)
                        picture.at(x, y)[c] = texture::to_byte(stored_of(std::min(1.0, light[c] * gain[c])));
                }
        });
        add_photo(photo, picture);
        if (board)
            for (int i = 0; i < 200; i++)
                for (int k = 0; k < 60; k++)
                    boards_.push_back(centre + ahead + right * (0.002 * i) + down * (0.02 * (k - 30)));
    }

    // All around, of exposures that go up and down by half a stop.
    void add_circle(const Crown& crown, int count = 20) {
        for (int i = 0; i < count; i++) {
            const double stops = 0.5 * std::sin(2.4 * i), warm = 0.08 * std::cos(1.7 * i);
            add(crown, 360.0 * i / count, std::exp2(stops) * DVec3(1.0 + warm, 1.0, 1.0 - warm));
        }
    }

    LeafColours look(const LeafColourOptions& options = {}) const {
        SeenThings things{leaves_, kSpacing};
        things.places.insert(things.places.end(), boards_.begin(), boards_.end());
        return leaf_colours_of_photos(leaves_, frame_, model_, folder_.string(), things, options);
    }

    ScanFrame frame_;
    std::vector<DVec3> leaves_, boards_;
};

double largest(const DVec3& v) {
    return std::max({v.x, v.y, v.z});
}

// How far two colours differ, by channel, but for their luminance.
double hue_error(const DVec3& a, const DVec3& b) {
    return largest(glm::abs(a / luminance_of(a) / (b / luminance_of(b)) - 1.0));
}

TEST_F(PhotoLeavesTest, KnownColoursComeBack) {
    const Crown crown;
    add_circle(crown);
    const LeafColours found = look();
    ASSERT_TRUE(found.seen()) << found.why_not;
    EXPECT_EQ(found.photos, 20U);
    EXPECT_GT(found.points, 3500U);
    EXPECT_LT(hue_error(found.albedo, crown.mean()), 0.06);
    EXPECT_NEAR(luminance_of(found.albedo) / luminance_of(crown.mean()), 1.0, 0.12);
    ASSERT_EQ(found.bands.size(), 5U);
    for (const LeafBand& band : found.bands) {
        const DVec3 there = crown.albedo(0.5 * (band.low + band.high));
        EXPECT_LT(hue_error(band.colour, there), 0.1) << band.low;
        EXPECT_NEAR(luminance_of(band.colour) / luminance_of(there), 1.0, 0.15) << band.low;
        EXPECT_GT(band.points, 100U);
    }
    // The course of the hue is kept, half of the luminance's.
    EXPECT_NEAR(found.high.x / found.high.y, found.low.x / found.low.y * (0.11 / 0.15) / (0.05 / 0.10), 0.15);
    const double tone =
        std::log(luminance_of(found.high * found.albedo) / luminance_of(found.low * found.albedo));
    EXPECT_NEAR(tone, 0.5 * std::log(luminance_of(crown.high) / luminance_of(crown.low)), 0.1);
    EXPECT_NEAR(found.low_height, kLow, 0.15);
    EXPECT_NEAR(found.high_height, kHigh, 0.15);
}

TEST_F(PhotoLeavesTest, ShadeDoesNotDarkenThem) {
    Crown half;
    half.shade = 0.45;
    add_circle(half);
    const DVec3 shaded = look().albedo;
    model_.photos.clear();
    half.shade = 0.0;
    add_circle(half);
    const DVec3 lit = look().albedo;
    EXPECT_NEAR(luminance_of(shaded) / luminance_of(lit), 1.0, 0.12);
}

TEST_F(PhotoLeavesTest, AutumnIsRed) {
    Crown crown;
    crown.low = crown.high = DVec3(0.22, 0.07, 0.03);
    add_circle(crown);
    const LeafColours found = look();
    ASSERT_TRUE(found.seen()) << found.why_not;
    EXPECT_LT(hue_error(found.albedo, crown.low), 0.08);
    EXPECT_LT(largest(glm::abs(found.high - found.low)), 0.06) << "leaves are alike at all heights";
}

TEST_F(PhotoLeavesTest, WhatStandsBeforeThemCountsForNothing) {
    const Crown crown;
    for (int i = 0; i < 20; i++)
        add(crown, 18.0 * i, DVec3(1.0), true);
    const LeafColours found = look();
    ASSERT_TRUE(found.seen()) << found.why_not;
    EXPECT_LT(hue_error(found.albedo, crown.mean()), 0.06);
    boards_.clear();
    EXPECT_GT(hue_error(look().albedo, crown.mean()), 0.2) << "without its points, it is taken for leaves";
}

TEST_F(PhotoLeavesTest, DarkPhotosGiveLeavesAsLightAsLeavesAre) {
    const Crown crown;
    for (int i = 0; i < 20; i++)
        add(crown, 18.0 * i, DVec3(0.2));
    const LeafColours found = look();
    EXPECT_LT(luminance_of(found.as_seen), 0.03);
    EXPECT_NEAR(luminance_of(found.albedo), LeafColourOptions().darkest, 1e-9);
    EXPECT_LT(hue_error(found.albedo, crown.mean()), 0.1);
}

TEST_F(PhotoLeavesTest, TooFewLeavesGiveASentence) {
    const Crown crown;
    for (int i = 0; i < 3; i++)
        add(crown, 18.0 * i, DVec3(1.0));
    leaves_.resize(200);
    EXPECT_EQ(look().why_not, "The photos show too few leaves: 200 points of them, and colors need 300.");
    leaves_.clear();
    EXPECT_EQ(look().why_not, "No leaves were found in the photos.");
    SetUp();
    model_.photos.clear();
    for (int i = 0; i < 2; i++)
        add(crown, 18.0 * i, DVec3(1.0));
    const LeafColours found = look();
    EXPECT_FALSE(found.seen());
    EXPECT_NE(found.why_not.find(" in 2 photos, and colors need 300 in 3."), std::string::npos)
        << found.why_not;
}

TEST_F(PhotoLeavesTest, ThreadsMakeNoDifference) {
    add_circle(Crown());
    set_thread_count(1);
    const LeafColours one = look();
    set_thread_count(4);
    const LeafColours four = look();
    EXPECT_EQ(one.albedo, four.albedo);
    EXPECT_EQ(one.low, four.low);
    EXPECT_EQ(one.least_green, four.least_green);
    EXPECT_EQ(one.tone_spread, four.tone_spread);
    EXPECT_EQ(one.points, four.points);
}

TEST(LeafLook, APictureGetsTheMeanAndKeepsItsVeins) {
    for (const char* preset : {"oak", "pine", "birch"})
        for (const DVec3& mean : {DVec3(0.06, 0.11, 0.02), DVec3(0.24, 0.08, 0.03)}) {
            const Image before = make_leaf_textures(preset, 128, 1).albedo;
            Image after = before;
            const DVec3 gain = picture_gain(after, mean);
            recolour(after, mean);
            DVec3 sum(0.0);
            double count = 0.0, products = 0.0, squares_a = 0.0, squares_b = 0.0, a = 0.0, b = 0.0;
            for (size_t i = 0; i < after.pixels.size(); i += 4) {
                ASSERT_EQ(after.pixels[i + 3], before.pixels[i + 3]);
                if (after.pixels[i + 3] < 102) continue;
                sum += linear_of(&after.pixels[i]);
                const double x = luminance_of(linear_of(&before.pixels[i]));
                const double y = luminance_of(linear_of(&after.pixels[i]));
                a += x, b += y, products += x * y, squares_a += x * x, squares_b += y * y;
                count += 1.0;
            }
            const double likeness = (products - a * b / count) /
                                    std::sqrt((squares_a - a * a / count) * (squares_b - b * b / count));
            EXPECT_LT(largest(glm::abs(sum / count / mean - 1.0)), 0.05) << preset;
            EXPECT_GT(likeness, 0.85) << preset;
            EXPECT_GT(std::min({gain.x, gain.y, gain.z}), 0.0);
        }
}

tinygltf::Model read_model(const std::string& path) {
    tinygltf::TinyGLTF reader;
    reader.SetImageLoader(
        [](tinygltf::Image* image, const int, std::string*, std::string*, int, int,
           const unsigned char* bytes, int size, void*) {
            image->image.assign(bytes, bytes + size);
            return true;
        },
        nullptr);
    tinygltf::Model model;
    std::string error, warning;
    EXPECT_TRUE(reader.LoadBinaryFromFile(&model, &error, &warning, path)) << error;
    return model;
}

// Picture and vertices together, at every level.
TEST(LeafLook, TheTreesFileShowsTheMeasuredColours) {
    LeafColours colours;
    colours.albedo = {0.2, 0.1, 0.03};
    colours.low = {0.8, 1.1, 1.05};
    colours.high = {1.2, 0.9, 0.95};
    colours.low_height = 1.0;
    colours.high_height = 4.0;
    const Tree tree = grow_tree({.height = 4.0});
    ExportOptions options;
    options.leaves = leaf_preset("oak");
    options.textures = "oak";
    options.levels = 3;
    options.leaf_colours = colours;
    const std::string path = utf8_of(std::filesystem::temp_directory_path() / "treerec_leaves_of_photos.glb");
    TreeExporter(tree, options).write(path);
    const tinygltf::Model model = read_model(path);
    const auto leaves = std::find_if(model.materials.begin(), model.materials.end(),
                                     [](const tinygltf::Material& m) { return m.name == "leaves"; });
    ASSERT_NE(leaves, model.materials.end());
    EXPECT_EQ(leaves->pbrMetallicRoughness.baseColorFactor, std::vector<double>(4, 1.0));
    const auto& texture =
        model.textures[static_cast<size_t>(leaves->pbrMetallicRoughness.baseColorTexture.index)];
    const auto& png = model.images[static_cast<size_t>(texture.source)].image;
    const auto picture =
        decode_picture(std::string_view(reinterpret_cast<const char*>(png.data()), png.size()), 3);
    ASSERT_TRUE(picture);
    // The transparent part has the leaves' mean colour, so that all of it counts.
    DVec3 mean(0.0);
    for (size_t i = 0; i < picture->pixels.size(); i += 3)
        mean += linear_of(&picture->pixels[i]);
    mean /= static_cast<double>(picture->pixels.size() / 3);
    ASSERT_EQ(model.meshes.size(), 3U);
    for (const tinygltf::Mesh& mesh : model.meshes) {
        ASSERT_EQ(mesh.primitives.size(), 2U);
        EXPECT_EQ(mesh.primitives[0].attributes.count("COLOR_0"), 0U) << "bark";
        const auto& attributes = mesh.primitives[1].attributes;
        ASSERT_EQ(attributes.count("COLOR_0"), 1U) << mesh.name;
        const auto bytes_of = [&](const char* name) {
            const auto& accessor = model.accessors[static_cast<size_t>(attributes.at(name))];
            const auto& view = model.bufferViews[static_cast<size_t>(accessor.bufferView)];
            return std::pair(accessor, &model.buffers[0].data[view.byteOffset + accessor.byteOffset]);
        };
        const auto [accessor, tints] = bytes_of("COLOR_0");
        EXPECT_TRUE(accessor.normalized);
        const auto* positions = reinterpret_cast<const float*>(bytes_of("POSITION").second);
        const auto* winds = bytes_of("_WIND").second;
        size_t open = 0;
        for (size_t i = 0; i < accessor.count; i++) {
            if (winds[4 * i + 3] != 255) continue;  // some shade
            open++;
            const DVec3 shown = mean * DVec3(tints[4 * i], tints[4 * i + 1], tints[4 * i + 2]) / 255.0;
            const DVec3 wanted =
                colours.albedo * course_at(colours, static_cast<double>(positions[3 * i + 1]));
            ASSERT_LT(largest(glm::abs(shown / wanted - 1.0)), 0.12) << positions[3 * i + 1];
        }
        EXPECT_GT(open, 20U) << mesh.name;
    }
    std::filesystem::remove(path_of(path));
    options.leaf_colours->why_not = "No leaves were found in the photos.";
    TreeExporter(tree, options).write(path);
    const tinygltf::Model drawn = read_model(path);
    for (const tinygltf::Primitive& primitive : drawn.meshes[0].primitives)
        EXPECT_EQ(primitive.attributes.count("COLOR_0"), 0U);
    std::filesystem::remove(path_of(path));
}

}  // namespace
}  // namespace treerec
