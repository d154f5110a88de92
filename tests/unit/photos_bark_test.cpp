// Bark out of photos: photos/bark_picture.h, photos/seen_bark.h, photos/quilt.h.
#include "photos/bark_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>

#include "drawn_bark.h"
#include "error.h"
#include "exchange/material_textures.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "geometry/quantile.h"
#include "photo_orbit.h"
#include "photos/bark_maps.h"
#include "photos/quilt.h"
#include "photos/seen_bark.h"
#include "pipeline/export.h"
#include "textures/texture_noise.h"
#include "with_photos.h"

namespace treerec {
namespace {

constexpr int kWidth = 480;
constexpr int kHeight = 640;
constexpr double kFocal = 700.0;
constexpr double kRadius = 0.25;
constexpr double kHeightOfStem = 3.0;
constexpr double kAway = 1.5;
constexpr double kBench = 0.45;  // metres: the radius of one that goes around the stem
constexpr double kBenchLow = 0.95, kBenchHigh = 1.05;

using test::bark_at;

// A stem that stands in the middle of a circle of photos of it.
class PhotoBarkTest : public test::WithPhotos {
  protected:
    void SetUp() override {
        WithPhotos::SetUp();
        use_pinhole(kWidth, kHeight, kFocal);
        ScanFrame frame;
        frame.up = UpAxis::kY;
        tree_.set_frame(frame);
        NodeId last = tree_.add_root({0.0, 0.0, 0.0}, kRadius);
        for (int i = 1; i <= 6; i++)
            last = tree_.add_child(last, {0.0, kHeightOfStem * i / 6, 0.0}, kRadius);
    }

    using Change = std::function<DVec3(int x, int y, const DVec3& colour)>;

    // From `degrees` around the stem, as far as it is high in the middle of the picture.
    void add(double degrees, double away = kAway, const Change& change = {}, double blur = 0.0) {
        const double angle = degrees * std::numbers::pi / 180.0, high = 1.2;
        const DVec3 centre(away * std::cos(angle), high, away * std::sin(angle));
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
                    DVec3 colour(0.55, 0.7, 0.9);  // the sky
                    const double a = way.x * way.x + way.z * way.z, b = centre.x * way.x + centre.z * way.z;
                    const double root = b * b - a * (away * away - kRadius * kRadius);
                    if (root > 0.0) colour = bark_at(centre + way * ((-b - std::sqrt(root)) / a));
                    const double wide = b * b - a * (away * away - kBench * kBench);
                    if (has_bench_ && wide > 0.0) {
                        const double up = (centre + way * ((-b - std::sqrt(wide)) / a)).y;
                        if (up > kBenchLow && up < kBenchHigh) colour = DVec3(0.9, 0.1, 0.1);
                    }
                    if (change) colour = change(x, y, colour);
                    for (int c = 0; c < 3; c++)
                        picture.at(x, y)[c] = texture::to_byte(colour[c]);
                }
        });
        if (blur > 0.0) soften(picture, blur);
        add_photo(photo, picture);
    }

    void add_circle(int count, double away = kAway, double blur = 0.0) {
        for (int i = 0; i < count; i++)
            add(360.0 * i / count, away, {}, blur);
    }

    SeenBark gather(const DVec2& texel, const SeenThings& things = {}) {
        chart_ = chart_trunk(tree_, 3.0);
        return gather_bark(chart_, survey_bark(tree_, chart_, model_, things), texel, tree_.frame(), model_,
                           folder_.string());
    }

    // What is to be seen on the chart, by texel, over what is there.
    DVec3 ratio(const SeenBark& bark, const DVec2& texel, int left, int top, int edge) const {
        DVec3 seen(0.0), there(0.0);
        for (int y = top; y < top + edge; y++)
            for (int x = left; x < left + edge; x++) {
                const auto spot = chart_.at((x + 0.5) * texel.x - 0.5 * chart_.width(),
                                            chart_.length() - (y + 0.5) * texel.y);
                const uint8_t* level = bark.colours.at(x, y);
                if (!spot || level[0] + level[1] + level[2] == 0) return DVec3(0.0);
                seen += DVec3(level[0], level[1], level[2]) / 255.0;
                there += bark_at(spot->place);
            }
        return seen / there;
    }

    static void soften(Image& picture, double deviation) {
        for (int c = 0; c < 3; c++) {
            PixelField field(picture.width, picture.height);
            for (size_t i = 0; i < field.values.size(); i++)
                field.values[i] = picture.pixels[3 * i + static_cast<size_t>(c)];
            field = blurred(field, DVec2(deviation), true);
            for (size_t i = 0; i < field.values.size(); i++)
                picture.pixels[3 * i + static_cast<size_t>(c)] =
                    static_cast<uint8_t>(std::lround(field.values[i]));
        }
    }

    bool has_bench_ = false;
    Tree tree_;
    TrunkChart chart_;
};

constexpr double kTexel = 0.002;

size_t red_texels(const SeenBark& bark) {
    size_t red = 0;
    for (size_t i = 0; i < bark.seen.size(); i++)
        red += bark.seen[i] && bark.colours.pixels[3 * i] > 150 && bark.colours.pixels[3 * i + 1] < 60;
    return red;
}

TEST_F(PhotoBarkTest, ComesBackWithTheColoursThatItHas) {
    add_circle(12);
    const DVec2 texel(kTexel);
    const SeenBark bark = gather(texel);
    ASSERT_GT(bark.photos, 8U);
    EXPECT_NEAR(bark.pixel, (kAway - kRadius) / kFocal, 0.0003);
    double off = 0.0, plain = 0.0, count = 0.0;
    for (int y = 0; y < bark.colours.height; y++)
        for (int x = 0; x < bark.colours.width; x++) {
            const auto spot =
                chart_.at((x + 0.5) * texel.x - 0.5 * chart_.width(), chart_.length() - (y + 0.5) * texel.y);
            if (!bark.seen[static_cast<size_t>(y) * static_cast<size_t>(bark.colours.width) +
                           static_cast<size_t>(x)])
                continue;
            ASSERT_TRUE(spot);
            const DVec3 there = 255.0 * bark_at(spot->place);
            off += std::abs(bark.colours.at(x, y)[1] - there.y);
            plain += std::abs(255.0 * 0.36 - there.y);
            count += 1.0;
        }
    ASSERT_GT(count * kTexel * kTexel, 1.0);
    EXPECT_LT(off / count, 0.4 * plain / count);
    EXPECT_LT(off / count, 9.0);
}

TEST_F(PhotoBarkTest, DifferentExposuresDoNotShow) {
    constexpr double kExposures[] = {1.0, 0.75, 1.25, 0.9};
    for (int i = 0; i < 12; i++)
        add(30.0 * i, kAway, [&](int, int, const DVec3& colour) { return colour * kExposures[i % 4]; });
    const DVec2 texel(kTexel);
    const SeenBark bark = gather(texel);
    double sum = 0.0, squares = 0.0, count = 0.0;
    constexpr int kEdge = 20;
    for (int y = 0; y + kEdge <= bark.colours.height; y += kEdge)
        for (int x = 0; x + kEdge <= bark.colours.width; x += kEdge) {
            const double here = ratio(bark, texel, x, y, kEdge).y;
            if (!(here > 0.0)) continue;
            sum += here;
            squares += here * here;
            count += 1.0;
        }
    ASSERT_GT(count, 200.0);
    const double mean = sum / count;
    EXPECT_NEAR(mean, 0.97, 0.1);
    EXPECT_LT(std::sqrt(squares / count - mean * mean), 0.04) << "exposures spread by .18";
}

TEST_F(PhotoBarkTest, WhatStandsBeforeTheTrunkInOnePhotoIsLeftOut) {
    for (int i = 0; i < 16; i++)
        add(22.5 * i, kAway, [&](int, int y, const DVec3& colour) {
            return i == 3 && y > 250 && y < 420 ? DVec3(0.9, 0.1, 0.1) : colour;
        });
    const SeenBark bark = gather(DVec2(kTexel));
    EXPECT_EQ(red_texels(bark), 0U);
}

TEST_F(PhotoBarkTest, WhatStandsBeforeTheTrunkInAllPhotosIsLeftOutWhereItHasPoints) {
    has_bench_ = true;
    add_circle(16);
    const SeenBark without = gather(DVec2(kTexel));
    SeenThings things{{}, 0.02};
    for (int i = 0; i < 3000; i++) {
        // Evenly over the bench, and over the trunk, which hides nothing.
        const double share = (i + 0.5) / 3000, angle = 2.39996 * i;
        const DVec3 out(std::cos(angle), 0.0, std::sin(angle));
        things.places.push_back(kBench * out + DVec3(0.0, kBenchLow + (kBenchHigh - kBenchLow) * share, 0.0));
        things.places.push_back(kRadius * out + DVec3(0.0, kHeightOfStem * share, 0.0));
    }
    const SeenBark with = gather(DVec2(kTexel), things);
    EXPECT_GT(red_texels(without), 500U);
    EXPECT_LT(red_texels(with), red_texels(without) / 20);
    EXPECT_GT(with.area, 0.6 * without.area);
}

// The mean difference between lines of pixels `a` and `b`, rows or columns.
double difference(const Image& picture, bool rows, int a, int b) {
    double sum = 0.0;
    const int count = rows ? picture.width : picture.height;
    for (int i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            sum += rows ? std::abs(picture.at(i, a)[c] - picture.at(i, b)[c])
                        : std::abs(picture.at(a, i)[c] - picture.at(b, i)[c]);
    return sum / count;
}

// Where it repeats, it changes no more than it does within: cracks have edges that run up and down there,
// too.
void expect_seamless(const Image& picture) {
    for (const bool rows : {true, false}) {
        const int count = rows ? picture.height : picture.width;
        std::vector<double> inside;
        for (int i = 0; i + 1 < count; i++)
            inside.push_back(difference(picture, rows, i, i + 1));
        const double most = quantile(inside, 0.98);
        EXPECT_LT(difference(picture, rows, count - 1, 0), most) << (rows ? "rows" : "columns");
        EXPECT_GT(difference(picture, rows, count / 2, 0), 1.2 * most) << "of lines that are no neighbours";
    }
}

TEST_F(PhotoBarkTest, RepeatsWithoutASeam) {
    add_circle(12);
    const PhotoBark bark = bark_of_photos(tree_, model_, folder_.string());
    ASSERT_TRUE(bark.textures) << bark.why_not;
    EXPECT_EQ(bark.textures->albedo.width, 512);
    expect_seamless(bark.textures->albedo);
    expect_seamless(bark.textures->normal);
    expect_seamless(bark.textures->roughness);
    // As light as the bark is, and as warm.
    DVec3 mean(0.0);
    const Image& albedo = bark.textures->albedo;
    for (size_t i = 0; i < albedo.pixels.size(); i++)
        mean[static_cast<int>(i % 3)] += albedo.pixels[i] / (albedo.pixels.size() / 3.0);
    EXPECT_NEAR(mean.x, 112.0, 20.0);
    EXPECT_NEAR(mean.y / mean.x, 0.85, 0.05);
    EXPECT_NEAR(mean.z / mean.x, 0.70, 0.05);
}

TEST_F(PhotoBarkTest, IsTheSameForAnyNumberOfThreads) {
    add_circle(10);
    set_thread_count(1);
    const PhotoBark alone = bark_of_photos(tree_, model_, folder_.string());
    set_thread_count(3);
    const PhotoBark together = bark_of_photos(tree_, model_, folder_.string());
    ASSERT_TRUE(alone.textures && together.textures);
    EXPECT_EQ(alone.textures->albedo.pixels, together.textures->albedo.pixels);
    EXPECT_EQ(alone.textures->normal.pixels, together.textures->normal.pixels);
    EXPECT_EQ(alone.textures->roughness.pixels, together.textures->roughness.pixels);
}

TEST_F(PhotoBarkTest, TellsWhyPhotosAreNotEnough) {
    const auto why = [&] {
        const PhotoBark bark = bark_of_photos(tree_, model_, folder_.string());
        EXPECT_FALSE(bark.textures);
        return bark.why_not;
    };
    EXPECT_NE(why().find("No photo"), std::string::npos) << why();
    add_circle(8, 5.0);
    EXPECT_NE(why().find("pixels of 6.8 mm"), std::string::npos) << why();
    model_.photos.clear();
    add_circle(8, kAway, 6.0);
    EXPECT_NE(why().find("out of focus"), std::string::npos) << why();
    model_.photos.clear();
    // The stem is a rod that is seen from one side.
    for (NodeId id = 0; id < tree_.id_end(); id++)
        tree_.set_radius(id, 0.02);
    add(0.0);
    EXPECT_NE(why().find("Too little"), std::string::npos) << why();
    put(model_.photos[0].name, "no picture");
    EXPECT_NE(why().find("can be read"), std::string::npos) << why();
    EXPECT_NE(bark_of_photos(Tree(), model_, folder_.string()).why_not.find("no piece of trunk"),
              std::string::npos);
}

TEST(PhotoBark, IsWhatTheTreesFileCarries) {
    const BarkTextures bark = make_bark_textures("birch", 64, 5);
    const std::string path = utf8_of(std::filesystem::temp_directory_path() / "treerec_bark_of_its_own.glb");
    Tree tree;
    tree.add_child(tree.add_root({0.0, 0.0, 0.0}, 0.1), {0.0, 3.0, 0.0}, 0.05);
    ExportOptions options;
    options.bark = encode_bark(bark);
    TreeExporter(tree, options).write(path);
    const FileBytes written = read_file(path);
    for (const Image* picture : {&bark.albedo, &bark.normal, &bark.roughness}) {
        const std::vector<uint8_t> jpeg = encode_jpeg(*picture);
        EXPECT_NE(
            written.view().find(std::string_view(reinterpret_cast<const char*>(jpeg.data()), jpeg.size())),
            std::string_view::npos);
    }
    std::filesystem::remove(path_of(path));
}

TEST(Quilt, UsesNoFaultyPixelAndTellsWhereThereIsNoRoom) {
    Image source(400, 300, 3);
    std::vector<float> fault(400 * 300, 0.0f);
    for (int y = 0; y < 300; y++)
        for (int x = 0; x < 400; x++) {
            for (int c = 0; c < 3; c++)
                source.at(x, y)[c] = static_cast<uint8_t>(60 + (x * 7 + y * 13 + c * 5) % 60);
            if (x > 150 && x < 180 && y < 200) {
                source.at(x, y)[0] = 255;
                fault[static_cast<size_t>(y) * 400 + static_cast<size_t>(x)] = 1.0f;
            }
        }
    const QuiltOptions options{128, 160};
    const auto pieces = pieces_of(source, fault, options);
    ASSERT_TRUE(pieces);
    EXPECT_EQ(*pieces, 3);
    const Image made = quilt(source, fault, *pieces, options);
    EXPECT_EQ(made.width, 128);
    EXPECT_EQ(made.height, 160);
    for (size_t i = 0; i < made.pixels.size(); i += 3)
        ASSERT_LT(made.pixels[i], 200);
    std::fill(fault.begin(), fault.end(), 1.0f);
    EXPECT_FALSE(pieces_of(source, fault, options));
    EXPECT_THROW(quilt(source, fault, 8, options), Error);
}

}  // namespace
}  // namespace treerec
