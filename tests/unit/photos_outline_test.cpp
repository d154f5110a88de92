// How thick wood is by its outline in photos, on photos of stems that are drawn with known radii.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>

#include "drawn_bark.h"
#include "exchange/material_textures.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "photo_orbit.h"
#include "photos/outline_radii.h"
#include "with_photos.h"

namespace treerec {
namespace {

using test::bark_at;
using test::take_photo;

constexpr int kWidth = 240, kHeight = 200;
constexpr double kFocal = 300.0, kAway = 2.4, kHigh = 1.2;
constexpr double kRadius = 0.2;
constexpr int kPhotos = 20;

// The grey level, 0 to 1, behind the stem in the direction `way`, of the photo at `degrees`. off: radii
// beside the stem's axis, to the right.
using Behind = std::function<double(const DVec3& way, double off)>;

double plain_sky(const DVec3&, double) {
    return 0.85;
}

double mean_of_bark() {
    double sum = 0.0;
    constexpr int kCount = 4000;
    for (int i = 0; i < kCount; i++) {
        const double angle = 2.39996 * i;
        sum += bark_at({std::cos(angle), 0.8 + 0.8 * i / kCount, std::sin(angle)}).y;
    }
    return sum / kCount;
}

// Far away on all sides, with structure of the sizes that the bark has in a photo.
double forest(const DVec3& way, double) {
    return bark_at(DVec3(4.0 * way.x, 4.0 * way.y + 1.0, 4.0 * way.z)).x;
}

class OutlineRadii : public test::WithPhotos {
  protected:
    void SetUp() override {
        WithPhotos::SetUp();
        use_pinhole(kWidth, kHeight, kFocal);
    }

    // Photos from around an upright stem of the radius at the origin, or of what is behind it alone.
    void take(double radius, const Behind& behind, int photos = kPhotos) {
        model_.photos.clear();
        for (int i = 0; i < photos; i++) {
            const double angle = 2.0 * kPi * (i + 0.3) / photos;
            const DVec3 centre(kAway * std::cos(angle), kHigh, kAway * std::sin(angle));
            Photo photo = take_photo(centre, {0.0, kHigh, 0.0}, "photo" + std::to_string(10 + i) + ".png");
            const DMat3 back = glm::transpose(photo.turn());
            Image picture(kWidth, kHeight, 3);
            parallel_for(kHeight, 8, [&](size_t begin, size_t end) {
                for (int y = static_cast<int>(begin); y < static_cast<int>(end); y++)
                    for (int x = 0; x < kWidth; x++) {
                        double sum = 0.0;
                        for (const double v : {1.0 / 6, 0.5, 5.0 / 6})
                            for (const double u : {1.0 / 6, 0.5, 5.0 / 6}) {
                                const DVec3 ray((x + u - kWidth / 2.0) / kFocal,
                                                (y + v - kHeight / 2.0) / kFocal, 1.0);
                                sum +=
                                    seen_along(centre, back * ray, ray.x * kAway / kRadius, radius, behind);
                            }
                        for (int c = 0; c < 3; c++)
                            picture.at(x, y)[c] = texture::to_byte(sum / 9.0);
                    }
            });
            add_photo(photo, picture);
        }
    }

    static double seen_along(const DVec3& from, const DVec3& way, double off, double radius,
                             const Behind& behind) {
        const double a = way.x * way.x + way.z * way.z, b = from.x * way.x + from.z * way.z;
        const double root = b * b - a * (from.x * from.x + from.z * from.z - radius * radius);
        if (radius > 0.0 && root > 0.0) return bark_at(from + way * ((-b - std::sqrt(root)) / a)).y;
        return behind(glm::normalize(way), off);
    }

    // Where the stem is taken to be, a twentieth of its radius beside it, and `wrong` times as thick.
    static std::vector<WoodPlace> places(double wrong) {
        std::vector<WoodPlace> places;
        for (int k = 0; k < 5; k++) {
            const double angle = 1.3 * k;
            places.push_back({DVec3(0.05 * kRadius * std::cos(angle), kHigh - 0.3 + 0.15 * k,
                                    0.05 * kRadius * std::sin(angle)),
                              {0.0, 1.0, 0.0},
                              wrong * kRadius});
        }
        return places;
    }

    std::vector<double> radii(double wrong) const {
        return outline_radii(model_, folder_.string(), places(wrong));
    }

    void expect_radius(double share, const std::string& before) const {
        for (const double wrong : {0.75, 1.0, 1.25})
            for (const double radius : radii(wrong))
                EXPECT_NEAR(radius, kRadius, share * kRadius) << before << ", taken for " << wrong;
    }
};

TEST_F(OutlineRadii, AreThoseOfAStemBeforeTheSky) {
    take(kRadius, plain_sky);
    expect_radius(0.03, "the sky");
}

TEST_F(OutlineRadii, AreThoseOfAStemBeforeAWallAsBrightAsItsBark) {
    const double bright = mean_of_bark();
    take(kRadius, [&](const DVec3&, double) { return bright; });
    // Each photo has an edge only where its bark is lighter or darker than the wall.
    expect_radius(0.05, "a wall as bright");
    for (const double wrong : {0.75, 1.0, 1.25}) {
        double mean = 0.0;
        const std::vector<double> found = radii(wrong);
        for (const double radius : found)
            mean += radius / static_cast<double>(found.size());
        EXPECT_NEAR(mean, kRadius, 0.03 * kRadius) << "taken for " << wrong;
    }
}

TEST_F(OutlineRadii, AreThoseOfAStemBeforeOthers) {
    take(kRadius, forest);
    expect_radius(0.05, "a forest");
}

// A post has an edge on one side of the axis, and none as far on the other.
TEST_F(OutlineRadii, AreNotThoseOfAPostBesideTheStem) {
    take(kRadius, [](const DVec3&, double off) { return off > 1.25 && off < 1.4 ? 0.05 : 0.85; });
    expect_radius(0.03, "a post");
}

TEST_F(OutlineRadii, AreNoneWhereNoStemIs) {
    for (const int photos : {6, 12, 20}) {
        take(0.0, forest, photos);
        for (const double wrong : {0.75, 0.9, 1.0, 1.1, 1.25})
            for (const double radius : radii(wrong))
                EXPECT_EQ(radius, 0.0) << photos << " photos of a forest";
    }
    take(0.0, plain_sky);
    for (const double radius : radii(1.0))
        EXPECT_EQ(radius, 0.0) << "in one colour";
}

TEST_F(OutlineRadii, PhotosThatCannotBeReadDoNotCount) {
    take(kRadius, plain_sky);
    PhotoModel fewer = model_;
    fewer.photos.erase(fewer.photos.begin() + 3);
    fewer.photos.erase(fewer.photos.begin());
    const std::vector<double> expected = outline_radii(fewer, folder_.string(), places(1.0));
    put(model_.photos[0].name, "no picture");
    std::filesystem::remove(path(model_.photos[3].name));
    EXPECT_EQ(radii(1.0), expected);
    EXPECT_GT(expected[0], 0.0);
    // Four are too few to agree.
    for (size_t i = 4; i + 3 < model_.photos.size(); i++)
        put(model_.photos[i].name, "");
    for (const double radius : radii(1.0))
        EXPECT_GT(radius, 0.0) << "five photos";
    put(model_.photos.back().name, "");
    for (const double radius : radii(1.0))
        EXPECT_EQ(radius, 0.0) << "four photos";
    EXPECT_EQ(outline_radii({}, folder_.string(), places(1.0)), std::vector<double>(5, 0.0));
    EXPECT_TRUE(outline_radii(model_, folder_.string(), {}).empty());
}

TEST_F(OutlineRadii, PlacesThatAreNoneHaveNone) {
    take(kRadius, plain_sky);
    const WoodPlace place{{0.0, kHigh, 0.0}, {0.0, 1.0, 0.0}, kRadius};
    std::vector<WoodPlace> odd(9, place);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    odd[1].radius = 0.0;
    odd[2].radius = -kRadius;
    odd[3].radius = nan;
    odd[4].radius = 10.0 * kAway;  // all cameras stand in it
    odd[5].position.x = nan;
    odd[6].way = DVec3(0.0);
    odd[7].position = {0.0, kHigh + 1000.0, 0.0};
    odd[8].position = {1e30, kHigh, std::numeric_limits<double>::infinity()};
    const std::vector<double> found = outline_radii(model_, folder_.string(), odd);
    EXPECT_NEAR(found[0], kRadius, 0.03 * kRadius);
    for (size_t i = 1; i < found.size(); i++)
        EXPECT_EQ(found[i], 0.0) << i;
}

// COLMAP's unit may be any.
TEST_F(OutlineRadii, DoNotDependOnTheModelsUnit) {
    take(kRadius, plain_sky);
    const std::vector<double> metres = radii(1.0);
    for (const double scale : {1e-3, 1e3}) {
        PhotoModel model = model_;
        for (Photo& photo : model.photos)
            photo.translation *= scale;
        std::vector<WoodPlace> scaled = places(1.0);
        for (WoodPlace& place : scaled) {
            place.position *= scale;
            place.radius *= scale;
        }
        const std::vector<double> found = outline_radii(model, folder_.string(), scaled);
        for (size_t i = 0; i < found.size(); i++)
            EXPECT_NEAR(found[i], scale * metres[i], 1e-3 * scale * metres[i]);
    }
}

TEST_F(OutlineRadii, AreTheSameForAnyNumberOfThreads) {
    take(kRadius, forest);
    set_thread_count(1);
    const std::vector<double> alone = radii(1.25);
    set_thread_count(4);
    EXPECT_EQ(radii(1.25), alone);
}

TEST_F(OutlineRadii, CanBeCancelled) {
    struct Impatient : Progress {
        bool cancelled() const override { return true; }
    } impatient;
    take(kRadius, plain_sky);
    EXPECT_THROW(outline_radii(model_, folder_.string(), places(1.0), {}, &impatient), Cancelled);
}

}  // namespace
}  // namespace treerec
