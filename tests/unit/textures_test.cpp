#include "textures/textures.h"

#include <gtest/gtest.h>

#include <cstdlib>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
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
    for (const char* preset :
         {"generic", "birch", "apple", "spruce", "palm", "ginkgo", "poplar", "magnolia"}) {
        const BarkTextures bark = make_bark_textures(preset, 128, 5);
        for (const Image* image : {&bark.albedo, &bark.normal, &bark.roughness}) {
            for (bool columns : {true, false}) {
                double within = 0.0;
                for (int x = 0; x + 1 < 128; x++)
                    within = std::max(within, mean_step(*image, x, x + 1, columns));
                EXPECT_LE(mean_step(*image, 127, 0, columns), 1.5 * within) << preset;
            }
        }
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

TEST(Textures, SameSeedSameBytesWhateverTheThreads) {
    set_thread_count(1);
    const std::vector<NamedPicture> one = make_pictures("maple", 64, 9);
    set_thread_count(3);
    const std::vector<NamedPicture> three = make_pictures("maple", 64, 9);
    set_thread_count(0);
    const std::vector<NamedPicture> other = make_pictures("maple", 64, 10);
    ASSERT_EQ(one.size(), 8u);
    for (size_t i = 0; i < one.size(); i++) {
        EXPECT_EQ(one[i].png, three[i].png) << one[i].name;
        EXPECT_NE(one[i].png, other[i].png) << one[i].name;
    }
}

Image pixels_of(const NamedPicture& picture) {
    Image image;
    stbi_uc* pixels = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(picture.png.data()),
                                            static_cast<int>(picture.png.size()), &image.width, &image.height,
                                            &image.channels, 0);
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
    set_ready_pictures({});
    EXPECT_NE(make_pictures("pine", 64, 1)[0].drawn, nullptr);
    ASSERT_EQ(ready.size(), drawn.size());
    for (size_t i = 0; i < ready.size(); i++) {
        EXPECT_EQ(ready[i].name, drawn[i].name);
        const Image one = pixels_of(ready[i]), other = pixels_of(drawn[i]);
        EXPECT_EQ(one.width, ready[i].name.starts_with("blade") ? kTextureSize / 2 : kTextureSize);
        EXPECT_EQ(one.channels, other.channels) << ready[i].name;
        EXPECT_TRUE(one.pixels == other.pixels) << ready[i].name;
    }
}

TEST(Textures, BadArgumentsAreRefused) {
    EXPECT_THROW(make_bark_textures("generic", 0, 1), Error);
    EXPECT_THROW(make_leaf_textures("generic", 1 << 20, 1), Error);
    EXPECT_THROW(make_leaf_textures("plastic", 64, 1), Error);
}

}  // namespace
}  // namespace treerec
