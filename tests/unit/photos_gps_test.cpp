// The scale of a model, from where its photos say that they were taken.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "exif_jpeg.h"
#include "geometry/random.h"
#include "photos/gps_scale.h"
#include "photos_standin.h"

namespace treerec {
namespace {

using test::ExifWriter;
using test::place_in_jpeg;
using test::with_exif;

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

PhotoPlace some_place(Random& random) {
    PhotoPlace place{random.uniform(-90.0, 90.0), random.uniform(-180.0, 180.0), {}};
    if (random.uniform() < 0.5) place.error = random.uniform(1.0, 50.0);
    return place;
}

TEST(PhotosExif, APlaceIsReadBack) {
    Random random(1);
    const std::string jpeg = test::tiny_jpeg(64, 48);
    EXPECT_FALSE(place_in_jpeg(jpeg));
    for (int i = 0; i < 200; i++) {
        const PhotoPlace place = some_place(random);
        const std::optional<PhotoPlace> got =
            place_in_jpeg(with_exif(jpeg, ExifWriter(i % 2 == 0).write(place)));
        ASSERT_TRUE(got) << i;
        EXPECT_NEAR(got->latitude, place.latitude, 1e-7);
        EXPECT_NEAR(got->longitude, place.longitude, 1e-7);
        ASSERT_EQ(got->error.has_value(), place.error.has_value());
        EXPECT_NEAR(got->error.value_or(0.0), place.error.value_or(0.0), 1e-3);
    }
}

TEST(PhotosExif, DegreesMinutesAndSecondsAddUp) {
    const ExifWriter writer(true);
    std::string tiff = writer.write({10.0, 20.0, {}});
    const std::string old =
        writer.fraction(10.0, 10000000) + writer.fraction(0.0, 1) + writer.fraction(0.0, 1);
    const size_t at = tiff.find(old);
    ASSERT_NE(at, std::string::npos);
    const auto latitude = [&](const std::string& angle) {
        std::string changed = tiff;
        const std::optional<PhotoPlace> place =
            place_in_jpeg(with_exif("\xFF\xD8", changed.replace(at, old.size(), angle)));
        return place ? place->latitude : NAN;
    };
    const auto fraction = [&](double value, uint32_t under) { return writer.fraction(value, under); };
    EXPECT_NEAR(latitude(fraction(48, 1) + fraction(30, 1) + fraction(36.36, 100)), 48.5101, 1e-9);
    // Not known, as some write it: 0/0.
    const std::string none = writer.number(0, 4) + writer.number(0, 4);
    EXPECT_NEAR(latitude(fraction(48, 1) + fraction(30.606, 1000) + none), 48.5101, 1e-9);
    EXPECT_TRUE(std::isnan(latitude(none + none + none)));
    EXPECT_TRUE(std::isnan(latitude(fraction(48, 1) + writer.number(7, 4) + writer.number(0, 4) + none)));
    EXPECT_TRUE(std::isnan(latitude(fraction(90, 1) + fraction(0, 1) + fraction(1, 1))));
    // What a camera without a fix writes.
    EXPECT_FALSE(place_in_jpeg(with_exif("\xFF\xD8", writer.write({0.0, 0.0, {}}))));
}

TEST(PhotosExif, HostileBytesAreNoPlaceOrOneInRange) {
    Random random(7);
    for (int i = 0; i < 20000; i++) {
        std::string bytes =
            with_exif(test::tiny_jpeg(64, 48), ExifWriter(i % 2 == 0).write(some_place(random)));
        for (uint32_t k = random.below(8) + 1; k-- > 0;)
            bytes[random.below(static_cast<uint32_t>(bytes.size()))] = static_cast<char>(random.below(256));
        if (i % 3 == 0) bytes.resize(random.below(static_cast<uint32_t>(bytes.size())));
        // Bytes of its own, so that what is read beyond them is noticed.
        const std::vector<char> exact(bytes.begin(), bytes.end());
        const std::optional<PhotoPlace> place = place_in_jpeg({exact.data(), exact.size()});
        if (!place) continue;
        EXPECT_LE(std::abs(place->latitude), 90.0);
        EXPECT_LE(std::abs(place->longitude), 180.0);
        EXPECT_GT(place->error.value_or(1.0), 0.0);
    }
}

// The place `east` and `north` metres from another one, by the ellipsoid's radii of curvature there; around a
// pole, by its meridians.
PhotoPlace moved(const PhotoPlace& from, double east, double north) {
    constexpr double kA = 6378137.0, kB = 6356752.314245, kSquared = 1.0 - kB * kB / (kA * kA);
    PhotoPlace place = from;
    if (std::abs(from.latitude) == 90.0) {
        const double side = from.latitude > 0.0 ? 1.0 : -1.0;
        place.latitude = side * (90.0 - glm::degrees(std::hypot(east, north) / (kA * kA / kB)));
        place.longitude = glm::degrees(std::atan2(east, -side * north));
        return place;
    }
    const double sine = std::sin(glm::radians(from.latitude)), root = std::sqrt(1.0 - kSquared * sine * sine);
    place.latitude += glm::degrees(north / (kA * (1.0 - kSquared) / (root * root * root)));
    place.longitude += glm::degrees(east / (kA / root * std::cos(glm::radians(from.latitude))));
    if (place.longitude > 180.0) place.longitude -= 360.0;
    if (place.longitude < -180.0) place.longitude += 360.0;
    return place;
}

struct Walk {
    int photos = 30;
    double radius = 8.0;  // metres
    double noise = 3.0;   // metres, in each direction
    int repeated = 1;     // photos that get the same fix
    int outliers = 0;     // fixes that are 60 to 200 m off
    std::optional<double> told = {};
};

// Photos from around a tree, in a model that lies and is as large as it likes. unit: its own, in metres.
std::vector<PlacedCamera> walk(Random& random, const PhotoPlace& middle, const Walk& walk, const DVec3& sky,
                               double unit) {
    const DVec3 side = any_perpendicular(sky), other = glm::cross(sky, side);
    const double turn = random.uniform(0.0, 2.0 * kPi);
    const DVec3 shift = 100.0 * random.direction();
    std::vector<PlacedCamera> cameras;
    PhotoPlace fix;
    for (int i = 0; i < walk.photos; i++) {
        const double angle = 2.0 * kPi * i / walk.photos;
        const double x = walk.radius * std::cos(angle), y = walk.radius * std::sin(angle);
        if (i % walk.repeated == 0) {
            fix = moved(middle, x + walk.noise * random.normal(), y + walk.noise * random.normal());
            if (i / walk.repeated < walk.outliers) {
                const double way = random.uniform(0.0, 2.0 * kPi), far = random.uniform(60.0, 200.0);
                fix = moved(middle, x + far * std::cos(way), y + far * std::sin(way));
            }
            fix.error = walk.told;
        }
        const double east = std::cos(turn) * x - std::sin(turn) * y,
                     north = std::sin(turn) * x + std::cos(turn) * y;
        const DVec3 place = east * side + north * other + 0.7 * random.normal() * sky;
        cameras.push_back({shift + place / unit, fix});
    }
    return cameras;
}

const std::vector<PhotoPlace> kPlaces = {{48.5, 9.05, {}},    {-33.9, 151.2, {}}, {0.0, 179.99999, {}},
                                         {-17.8, -180.0, {}}, {89.9, 12.0, {}},   {90.0, 0.0, {}},
                                         {-90.0, 0.0, {}},    {0.0, 0.0, {}}};

TEST(PhotosGps, WithoutNoiseTheUnitIsExactAnywhere) {
    Random random(2);
    for (const PhotoPlace& middle : kPlaces)
        for (const double unit : {0.01, 1.0, 37.0}) {
            const DVec3 sky = random.direction();
            const GpsScale scale = fit_gps_scale(walk(random, middle, {.noise = 0.0}, sky, unit), sky);
            EXPECT_NEAR(scale.metres_per_unit / unit, 1.0, 2e-5) << middle.latitude << ' ' << unit;
            EXPECT_EQ(scale.fixes, 30U);
            EXPECT_EQ(scale.kept, 30U);
            // 3 / (8 sqrt(30)): no surer than a phone is.
            EXPECT_NEAR(scale.relative_error, 0.0685, 1e-3);
            EXPECT_TRUE(scale.usable());
        }
}

// How often the truth lies within one and two of the errors that are told.
TEST(PhotosGps, TheErrorIsWhatItSays) {
    for (const Walk& kind :
         {Walk{}, Walk{.photos = 24, .radius = 12.0, .noise = 6.0}, Walk{.photos = 60, .repeated = 3},
          Walk{.photos = 40, .outliers = 5}, Walk{.photos = 30, .noise = 8.0, .told = 8.0}}) {
        int within = 0, within_two = 0;
        double mean = 0.0;
        constexpr int kTimes = 400;
        for (uint64_t seed = 1; seed <= kTimes; seed++) {
            Random random(seed);
            const DVec3 sky = random.direction();
            const PhotoPlace& middle = kPlaces[seed % kPlaces.size()];
            const GpsScale scale = fit_gps_scale(walk(random, middle, kind, sky, 2.5), sky);
            const double off = scale.metres_per_unit / 2.5 - 1.0;
            within += std::abs(off) < scale.relative_error;
            within_two += std::abs(off) < 2.0 * scale.relative_error;
            mean += off / kTimes;
        }
        const auto share = [](int count) { return static_cast<double>(count) / kTimes; };
        std::printf("%d photos, %d with one fix, %.0f m off, %d outliers: %.2f within, %.2f within two\n",
                    kind.photos, kind.repeated, kind.noise, kind.outliers, share(within), share(within_two));
        EXPECT_NEAR(share(within), 0.68, 0.1);
        EXPECT_GT(share(within_two), 0.9);
        EXPECT_NEAR(mean, 0.0, 0.05);
    }
}

TEST(PhotosGps, WhatIsTooVagueIsNotUsed) {
    Random random(3);
    const DVec3 sky(0.0, 0.0, 1.0);
    const auto scale_of = [&](const Walk& kind) {
        return fit_gps_scale(walk(random, kPlaces[0], kind, sky, 1.0), sky);
    };
    // All the same fix, few ones, a small circle, a camera that says that it is not sure.
    EXPECT_EQ(scale_of({.repeated = 30}).fixes, 1U);
    EXPECT_FALSE(scale_of({.repeated = 30}).usable());
    EXPECT_EQ(scale_of({.repeated = 6}).fixes, 5U);
    EXPECT_FALSE(scale_of({.radius = 50.0, .repeated = 6}).usable());
    EXPECT_FALSE(scale_of({.photos = 20, .radius = 2.0}).usable());
    EXPECT_FALSE(scale_of({.told = 20.0}).usable());
    EXPECT_TRUE(scale_of({.noise = 0.3, .told = 0.3}).usable());
    EXPECT_LT(scale_of({.noise = 0.3, .told = 0.3}).relative_error, 0.02);
    // Random places of a town.
    int used = 0;
    for (int i = 0; i < 100; i++)
        used += scale_of({.radius = 8.0, .noise = 500.0}).usable();
    EXPECT_LE(used, 2);
    // Cameras in one place, none at all, and ones that are nowhere.
    std::vector<PlacedCamera> cameras = walk(random, kPlaces[0], {}, sky, 1.0);
    for (PlacedCamera& camera : cameras)
        camera.centre = DVec3(5.0, 6.0, 7.0);
    EXPECT_FALSE(fit_gps_scale(cameras, sky).usable());
    EXPECT_FALSE(fit_gps_scale({}, sky).usable());
    for (PlacedCamera& camera : cameras)
        camera.centre = DVec3(NAN);
    EXPECT_EQ(fit_gps_scale(cameras, sky).fixes, 0U);
}

TEST(PhotosGps, OutliersWeighNothing) {
    for (uint64_t seed = 1; seed <= 60; seed++) {
        Random random(seed);
        const DVec3 sky = random.direction();
        const GpsScale scale = fit_gps_scale(
            walk(random, kPlaces[seed % 8], {.photos = 40, .noise = 0.0, .outliers = 8}, sky, 1.0), sky);
        EXPECT_NEAR(scale.metres_per_unit, 1.0, 1e-3) << seed;
        EXPECT_EQ(scale.kept, 32U) << seed;
    }
}

class PhotosGpsCli : public test::WithStandIn<test::Cli> {
  protected:
    // Gives each photo of the stand-in's model a fix; one unit is `unit` metres long.
    void place_photos(double unit) const {
        const PhotoModel model = read_photo_model(path("models/0"));
        for (const Photo& photo : model.photos) {
            // z is down.
            const DVec3 at = unit * photo.centre();
            put("photos/" + photo.name,
                with_exif(test::tiny_jpeg(640, 480) + photo.name,
                          ExifWriter(false).write(moved({52.0, 13.0, {}}, at.x, -at.y))));
        }
    }
};

TEST_F(PhotosGpsCli, PhotosWithPlacesGiveTheSize) {
    place_photos(4.0);
    const test::Outcome outcome = run("photos photos -o out --sparse");
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    EXPECT_TRUE(has(outcome.error, "The size comes from the photos' GPS")) << outcome.error;
    EXPECT_FALSE(has(outcome.error, "have no scale")) << outcome.error;
    const nlohmann::json report = nlohmann::json::parse(get("out/report.json"));
    EXPECT_TRUE(report["scale_from_gps"].get<bool>());
    EXPECT_FALSE(report["scale_guessed"].get<bool>());
    EXPECT_NEAR(report["metres_per_unit"].get<double>(), 4.0, 0.01);
    EXPECT_EQ(report["photos"]["gps"]["fixes"].get<int>(), 9);
    EXPECT_NEAR(report["photos"]["gps"]["relative_error"].get<double>(), 3.0 / (16.0 * 3.0), 1e-3);
    // What the user says goes first.
    const test::Outcome told = run("photos photos -o out --sparse --height 5");
    EXPECT_FALSE(has(told.error, "The size comes from")) << told.error;
    EXPECT_TRUE(has(told.error, "% lower than by the photos' GPS; the former was taken.")) << told.error;
    EXPECT_FALSE(nlohmann::json::parse(get("out/report.json"))["scale_from_gps"].get<bool>());
}

TEST_F(PhotosGpsCli, WhatIsTooVagueIsTold) {
    place_photos(1.0);
    const test::Outcome outcome = run("photos photos -o out --sparse");
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    EXPECT_TRUE(has(outcome.error, "have no scale")) << outcome.error;
    EXPECT_TRUE(has(outcome.error, "too vague")) << outcome.error;
    EXPECT_FALSE(nlohmann::json::parse(get("out/report.json"))["scale_from_gps"].get<bool>());
}

}  // namespace
}  // namespace treerec
