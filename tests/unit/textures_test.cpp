#include "textures/textures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <set>
#include <vector>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include "error.h"
#include "exchange/material_textures.h"
#include "exchange/ready_pictures.h"
#include "foliage/leaves.h"
#include "geometry/parallel.h"
#include "textures/linear_light.h"

namespace treerec {
namespace {

double mean_step(const Image& image, int x0, int x1, bool columns) {
    double sum = 0.0;
    for (int i = 0; i < image.height; i++)
        for (int c = 0; c < 3; c++)
            sum += std::abs(columns ? image.at(x0, i)[c] - image.at(x1, i)[c]
                                    : image.at(i, x0)[c] - image.at(i, x1)[c]);
    return sum / (3.0 * image.height);
}

TEST(Textures, BarkIsSeamlessBothWays) {
    for (const std::string& preset : leaf_preset_names()) {
        for (const BarkAge age : {BarkAge::kYoung, BarkAge::kOld}) {
            const BarkTextures bark = make_bark_textures(preset, 128, 5, age);
            for (const Image* image : {&bark.albedo, &bark.normal, &bark.roughness}) {
                for (bool columns : {true, false}) {
                    const int last = (columns ? image->width : image->height) - 1;
                    double within = 0.0;
                    for (int x = 0; x < last; x++)
                        within = std::max(within, mean_step(*image, x, x + 1, columns));
                    EXPECT_LE(mean_step(*image, last, 0, columns), 1.5 * within) << preset;
                }
            }
        }
    }
}

// A photographer's limits: no bark is soot or chalk, and none is bluer than it is red.
TEST(Textures, BarkHasTheColoursOfBark) {
    for (const std::string& preset : leaf_preset_names()) {
        if (!leaf_preset(preset).enabled) continue;
        for (const BarkAge age : {BarkAge::kYoung, BarkAge::kOld}) {
            const BarkTextures bark = make_bark_textures(preset, 128, 1, age);
            DVec3 light(0.0);
            const size_t pixels = bark.albedo.pixels.size() / 3;
            for (size_t i = 0; i < pixels; i++) {
                const uint8_t* p = bark.albedo.pixels.data() + 3 * i;
                ASSERT_GE(std::min({p[0], p[1], p[2]}), 50) << preset;
                ASSERT_LE(std::max({p[0], p[1], p[2]}), 240) << preset;
                light += linear_of(p);
            }
            light /= static_cast<double>(pixels);
            EXPECT_GE(luminance_of(light), 0.10) << preset;
            EXPECT_LE(luminance_of(light), 0.60) << preset;
            EXPECT_GT(light.x, 1.05 * light.z) << preset;
        }
    }
}

// Cracks are dark because little of the sky is seen from them, and they are where the relief says they are.
TEST(Textures, OldRidgesAreDeepAndYoungBarkIsSmooth) {
    const auto share_below = [](const Image& image, int channel, int level) {
        size_t below = 0;
        for (size_t i = static_cast<size_t>(channel); i < image.pixels.size(); i += 3)
            below += image.pixels[i] < level;
        return static_cast<double>(below) / static_cast<double>(image.pixels.size() / 3);
    };
    for (const char* preset : {"oak", "pine", "willow", "poplar", "ginkgo"}) {
        const BarkTextures old = make_bark_textures(preset, 256, 1);
        const BarkTextures young = make_bark_textures(preset, 256, 1, BarkAge::kYoung);
        EXPECT_GT(share_below(old.roughness, 0, 128), 0.01) << preset;
        EXPECT_LT(share_below(young.roughness, 0, 128), 0.001) << preset;
        EXPECT_GT(share_below(old.normal, 2, 192), 5.0 * share_below(young.normal, 2, 192)) << preset;
    }
}

// Half of the bark lies on each side of what moss and lichen start from.
TEST(Textures, MossAndLichenHaveWhereToStart) {
    for (const char* preset : {"oak", "birch"}) {
        const Image packed = make_bark_textures(preset, 256, 1).roughness;
        size_t light = 0, lichen = 0, moss = 0;
        for (size_t i = 2; i < packed.pixels.size(); i += 3) {
            light += packed.pixels[i] > 127;
            lichen += packed.pixels[i] < 77;
            moss += packed.pixels[i] > 166;
        }
        const double pixels = static_cast<double>(packed.pixels.size()) / 3.0;
        EXPECT_NEAR(static_cast<double>(light) / pixels, 0.5, 0.15) << preset;
        EXPECT_GT(static_cast<double>(lichen) / pixels, 0.02) << preset;
        EXPECT_GT(static_cast<double>(moss) / pixels, 0.02) << preset;
    }
}

TEST(Textures, NormalsAreUnitAndPointOut) {
    const BarkTextures bark = make_bark_textures("oak", 64, 1);
    const LeafTextures leaf = make_leaf_textures("oak", 64, 1);
    for (const Image* image : {&bark.normal, &leaf.normal})
        for (int y = 0; y < 64; y++)
            for (int x = 0; x < 64; x++) {
                const uint8_t* p = image->at(x, y);
                const double a = p[0] / 127.5 - 1.0, b = p[1] / 127.5 - 1.0, c = p[2] / 127.5 - 1.0;
                ASSERT_NEAR(a * a + b * b + c * c, 1.0, 0.03);
                ASSERT_GT(c, 0.0);
            }
}

TEST(Textures, LeavesGrowFromTheMiddleOfTheLowerEdgeAndLeaveAMargin) {
    for (const std::string& preset : leaf_preset_names()) {
        const LeafTextures leaf = make_leaf_textures(preset, 256, 1);
        int covered = 0;
        for (int i = 0; i < 256; i++) {
            EXPECT_LT(leaf.albedo.at(0, i)[3], 8) << preset << " left edge, row " << i;
            EXPECT_LT(leaf.albedo.at(255, i)[3], 8) << preset << " right edge, row " << i;
            EXPECT_LT(leaf.albedo.at(i, 0)[3], 8) << preset << " upper edge, column " << i;
            for (int x = 0; x < 256; x++)
                covered += leaf.albedo.at(x, i)[3] > 127;
        }
        EXPECT_GT(leaf.albedo.at(128, 255)[3], 127) << preset;
        EXPECT_GT(covered, 256 * 256 / 5) << preset;
        // No dark fringe: what is transparent is green too.
        EXPECT_GT(leaf.albedo.at(2, 2)[1], 40) << preset;
        EXPECT_GT(leaf.albedo.at(2, 2)[1], leaf.albedo.at(2, 2)[2]) << preset;
    }
}

// What the leaf area of a crown is reckoned with.
TEST(Textures, BladesCoverAsMuchOfASprayAsItsRuleSays) {
    for (const std::string& preset : leaf_preset_names()) {
        if (!leaf_preset(preset).enabled) continue;
        const LeafTextures leaf = make_leaf_textures(preset, 256, kTextureSeed);
        double covered = 0.0;
        for (int y = 0; y < 256; y++)
            for (int x = 0; x < 256; x++)
                covered += leaf.albedo.at(x, y)[3] / 255.0;
        EXPECT_NEAR(covered / (256.0 * 256.0), leaf_preset(preset).spray_cover, 0.02) << preset;
    }
}

// Each stands alone in its cell, so that a shader may show any of them; together they cover as one does.
TEST(Textures, SpraysDifferAndKeepToTheirCells) {
    constexpr int kSize = 128, kCount = kSprayColumns * kSprayRows;
    for (const std::string& preset : leaf_preset_names()) {
        SCOPED_TRACE(preset);
        const LeafTextures one = make_leaf_textures(preset, kSize, kTextureSeed);
        const LeafTextures all = make_spray_textures(preset, kSize, kTextureSeed);
        ASSERT_EQ(all.albedo.width, kSprayColumns * kSize);
        ASSERT_EQ(all.normal.height, kSprayRows * kSize);
        double covered = 0.0;
        std::set<std::vector<uint8_t>> seen;
        for (int i = 0; i < kCount; i++) {
            const int x = i % kSprayColumns * kSize, y = i / kSprayColumns * kSize;
            std::vector<uint8_t> alpha;
            for (int row = 0; row < kSize; row++) {
                EXPECT_LT(all.albedo.at(x, y + row)[3], 8);
                EXPECT_LT(all.albedo.at(x + kSize - 1, y + row)[3], 8);
                EXPECT_LT(all.albedo.at(x + row, y)[3], 8);
                for (int column = 0; column < kSize; column++)
                    alpha.push_back(all.albedo.at(x + column, y + row)[3]);
                if (i > 0) continue;
                EXPECT_TRUE(std::equal(one.albedo.at(0, row), one.albedo.at(0, row) + 4 * kSize,
                                       all.albedo.at(0, row)));
                EXPECT_TRUE(std::equal(one.normal.at(0, row), one.normal.at(0, row) + 3 * kSize,
                                       all.normal.at(0, row)));
            }
            covered += std::accumulate(alpha.begin(), alpha.end(), 0.0) / 255.0;
            seen.insert(std::move(alpha));
        }
        EXPECT_EQ(seen.size(), static_cast<size_t>(kCount));
        if (!leaf_preset(preset).enabled) continue;
        EXPECT_NEAR(covered / (kCount * kSize * kSize), leaf_preset(preset).spray_cover, 0.035);
    }
}

TEST(Textures, SameSeedSameBytesWhateverTheThreads) {
    set_thread_count(1);
    const std::vector<NamedPicture> one = make_pictures("maple", 64, 9);
    set_thread_count(3);
    const std::vector<NamedPicture> three = make_pictures("maple", 64, 9);
    set_thread_count(0);
    const std::vector<NamedPicture> other = make_pictures("maple", 64, 10);
    ASSERT_EQ(one.size(), 12u);
    for (size_t i = 0; i < one.size(); i++) {
        EXPECT_EQ(one[i].bytes, three[i].bytes) << one[i].name;
        EXPECT_NE(one[i].bytes, other[i].bytes) << one[i].name;
    }
}

// Models cannot blend: they have the bark of one age, by the same names.
TEST(Textures, AModelHasOneBark) {
    const std::vector<NamedPicture> all = make_pictures("oak", 64, 1);
    const auto bytes_of = [](const std::vector<NamedPicture>& pictures, const std::string& name) {
        for (const NamedPicture& picture : pictures)
            if (picture.name == name) return picture.bytes;
        return std::string_view();
    };
    for (const bool young : {false, true}) {
        const std::vector<NamedPicture> kept = pictures_of_model(all, false, young);
        EXPECT_EQ(kept.size(), 6u);
        for (const char* name : {"albedo", "normal", "roughness", "roughness_grey"}) {
            const std::string_view given = bytes_of(kept, std::string("bark_") + name);
            EXPECT_FALSE(given.empty()) << name;
            EXPECT_EQ(given, bytes_of(all, std::string(young ? "bark_young_" : "bark_") + name)) << name;
        }
    }
}

Image pixels_of(const NamedPicture& picture) {
    Image image;
    stbi_uc* pixels = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(picture.bytes.data()),
                                            static_cast<int>(picture.bytes.size()), &image.width,
                                            &image.height, &image.channels, 0);
    if (!pixels) return image;
    image.pixels.assign(pixels, pixels + static_cast<size_t>(image.width) * image.height * image.channels);
    stbi_image_free(pixels);
    return image;
}

// What the build drew is what the program would draw.
TEST(Textures, ReadyPicturesAreTheDrawnOnes) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "Sanitized programs carry no pictures.";
#endif
    use_ready_pictures();
    for (const std::string& preset : leaf_preset_names()) {
        if (!leaf_preset(preset).enabled) continue;
        for (const NamedPicture& picture : make_pictures(preset))
            EXPECT_EQ(picture.drawn, nullptr) << preset << " " << picture.name;
    }
    const std::vector<NamedPicture> ready = make_pictures("birch");
    const std::vector<NamedPicture> drawn = draw_pictures("birch", kTextureSize, kTextureSeed);
    EXPECT_NE(make_pictures("pine", 64, 1)[0].drawn, nullptr);
    ASSERT_EQ(ready.size(), drawn.size());
    for (size_t i = 0; i < ready.size(); i++) {
        EXPECT_EQ(ready[i].name, drawn[i].name);
        const Image one = pixels_of(ready[i]), other = pixels_of(drawn[i]);
        const int leaf = ready[i].name.starts_with("blade") ? kTextureSize / 2 : kTextureSize;
        int bark = bark_size(kTextureSize);
        if (ready[i].name.starts_with("bark_young")) bark /= 2;
        if (ready[i].name.find("roughness") != std::string::npos) bark /= 2;
        const bool is_bark = ready[i].name.starts_with("bark");
        EXPECT_EQ(one.width, is_bark ? bark : leaf) << ready[i].name;
        // As many pixels to the metre along as around.
        if (is_bark) {
            EXPECT_NEAR(one.height * kBarkWidth, one.width * kBarkLength, 2.0) << ready[i].name;
        }
        EXPECT_EQ(one.channels, other.channels) << ready[i].name;
        EXPECT_TRUE(one.pixels == other.pixels) << ready[i].name;
    }
}

TEST(Textures, BadArgumentsAreRefused) {
    EXPECT_THROW(make_bark_textures("generic", 0, 1), Error);
    EXPECT_THROW(make_bark_textures("generic", 17, 1), Error);
    EXPECT_THROW(make_leaf_textures("generic", 1 << 20, 1), Error);
    EXPECT_THROW(make_leaf_textures("plastic", 64, 1), Error);
}

}  // namespace
}  // namespace treerec
