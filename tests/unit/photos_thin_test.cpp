// Thin wood from photos, on drawn branches of which every axis is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numeric>

#include "geometry/random.h"
#include "photos/thin_points.h"

namespace treerec {
namespace {

struct Branch {
    DVec3 a{0.0}, b{0.0};
    double radius = 0.0;
};

double away_from(const Branch& branch, const DVec3& p) {
    const DVec3 way = branch.b - branch.a;
    const double t = std::clamp(glm::dot(p - branch.a, way) / glm::dot(way, way), 0.0, 1.0);
    return glm::distance(p, branch.a + t * way);
}

// Branches in all directions around the origin, z to the sky, `width` pixels wide.
std::vector<Branch> some_branches(uint64_t seed, double pixel) {
    Random random(seed);
    std::vector<Branch> branches;
    for (int i = 0; i < 14; i++) {
        const DVec3 a = 0.9 * random.uniform(0.2, 1.0) * random.direction();
        branches.push_back(
            {a, a + random.uniform(0.6, 1.2) * random.direction(), 0.5 * pixel * random.uniform(1.8, 6.0)});
    }
    return branches;
}

constexpr int kWidth = 480, kHeight = 480;
constexpr double kFocal = 520.0, kAway = 5.0;

Camera lens() {
    Camera camera;
    camera.model = LensModel::kSimpleRadial;
    camera.width = kWidth;
    camera.height = kHeight;
    camera.parameters = {kFocal, 0.5 * kWidth, 0.5 * kHeight, 0.08};
    return camera;
}

Photo photo_at(double degrees, double height) {
    const double angle = degrees * kPi / 180.0;
    const DVec3 centre(kAway * std::cos(angle), kAway * std::sin(angle), height);
    const DVec3 ahead = glm::normalize(-centre), right = glm::normalize(glm::cross(ahead, DVec3(0, 0, 1)));
    const glm::dquat q = glm::quat_cast(glm::transpose(DMat3(right, glm::cross(ahead, right), ahead)));
    Photo photo;
    photo.rotation = {q.w, q.x, q.y, q.z};
    photo.translation = -photo.to_camera(centre);
    return photo;
}

// Dark branches before a light sky, each pixel the share of it that they cover, with a camera's noise.
GreyPicture drawn(const Photo& photo, const Camera& camera, const std::vector<Branch>& branches,
                  Random& random) {
    std::vector<float> covered(static_cast<size_t>(kWidth) * kHeight, 0.0F);
    for (const Branch& branch : branches) {
        constexpr int kPieces = 400;
        DVec2 before(0.0);
        double wide = 0.0;
        for (int k = 0; k <= kPieces; k++) {
            const DVec3 p = photo.to_camera(glm::mix(branch.a, branch.b, static_cast<double>(k) / kPieces));
            const DVec2 here = *camera.project(p) - 0.5;
            if (k > 0) {
                const DVec2 low = glm::min(before, here) - wide - 2.0,
                            high = glm::max(before, here) + wide + 2.0;
                for (int y = std::max(0, static_cast<int>(low.y)); y <= std::min(kHeight - 1.0, high.y); y++)
                    for (int x = std::max(0, static_cast<int>(low.x)); x <= std::min(kWidth - 1.0, high.x);
                         x++) {
                        const Branch piece{DVec3(before, 0.0), DVec3(here, 0.0), 0.0};
                        const double inside = wide + 0.5 - away_from(piece, DVec3(x, y, 0.0));
                        auto& cover = covered[static_cast<size_t>(y) * kWidth + static_cast<size_t>(x)];
                        cover = std::max(cover, static_cast<float>(std::clamp(inside, 0.0, 1.0)));
                    }
            }
            before = here;
            wide = kFocal * branch.radius / p.z;
        }
    }
    GreyPicture picture(kWidth, kHeight);
    for (size_t i = 0; i < covered.size(); i++)
        picture.pixels[i] = static_cast<uint8_t>(
            std::clamp(205.0 - 140.0 * static_cast<double>(covered[i]) + 2.0 * random.normal(), 0.0, 255.0));
    return picture;
}

GreyPyramid pyramid_over(const GreyPicture& picture) {
    Image image(picture.width, picture.height, 1);
    image.pixels = picture.pixels;
    return pyramid_of(image, std::max(picture.width, picture.height));
}

struct Orbit {
    PhotoModel model;
    std::vector<std::vector<std::vector<Ridge>>> ridges;
    std::vector<double> scales;
};

Orbit orbit_of(const std::vector<Branch>& branches, int photos) {
    Orbit orbit;
    orbit.model.cameras = {lens()};
    Random random(9);
    for (int i = 0; i < photos; i++) {
        orbit.model.photos.push_back(photo_at(360.0 * i / photos, random.uniform(-2.0, 2.0)));
        orbit.ridges.push_back(
            find_ridges(pyramid_over(drawn(orbit.model.photos.back(), lens(), branches, random))));
        orbit.scales.push_back(1.0);
    }
    return orbit;
}

DepthRange near_middle(const DVec3&, const DVec3&) {
    return {2.0, 8.0};
}

TEST(Ridges, LieInTheMiddleOfLinesAndAreAsWide) {
    Random random(2);
    for (const double width : {1.5, 2.5, 4.0, 7.0, 14.0}) {
        const double angle = random.uniform(0.0, kPi);
        const DVec2 way(std::cos(angle), std::sin(angle)), across(-way.y, way.x);
        GreyPicture picture(200, 200);
        for (int y = 0; y < 200; y++)
            for (int x = 0; x < 200; x++) {
                const double inside =
                    0.5 * width + 0.5 - std::abs(glm::dot(DVec2(x, y) - DVec2(98.3, 101.8), across));
                picture.row(y)[x] = static_cast<uint8_t>(190.0 - 120.0 * std::clamp(inside, 0.0, 1.0));
            }
        double off = 0.0, wide = 0.0, turned = 0.0;
        size_t count = 0;
        for (const auto& row : find_ridges(pyramid_over(picture)))
            for (const Ridge& ridge : row) {
                off += std::abs(glm::dot(ridge.place - DVec2(98.3, 101.8), across));
                turned += std::abs(glm::dot(ridge.way, across));
                wide += ridge.width;
                count++;
            }
        ASSERT_GT(count, 15u) << width;
        const auto all = static_cast<double>(count);
        EXPECT_LT(off / all, 0.1 + 0.02 * width) << width;
        EXPECT_LT(turned / all, 0.05) << width;
        EXPECT_NEAR(wide / all, width, 0.3 + 0.12 * width) << width;
    }
}

// What a lens and a sensor that blur by 1.15 pixels at half height make of a line.
GreyPicture blurred_line(double width, double angle, const DVec2& place, bool light) {
    constexpr int kSize = 120;
    const DVec2 across(-std::sin(angle), std::cos(angle));
    const double sigma = 1.15 / (2.0 * std::sqrt(2.0 * std::log(2.0)));
    const auto cover = [&](double off) {
        const double scale = 1.0 / (sigma * std::sqrt(2.0));
        return 0.5 * (std::erf((off + 0.5 * width) * scale) - std::erf((off - 0.5 * width) * scale));
    };
    GreyPicture picture(kSize, kSize);
    for (int y = 0; y < kSize; y++)
        for (int x = 0; x < kSize; x++) {
            const double sum = cover(glm::dot(DVec2(x, y) - place, across));
            const double side = light ? 70.0 : 200.0, line = light ? 200.0 : 70.0;
            picture.row(y)[x] = static_cast<uint8_t>(std::lround(glm::mix(side, line, sum)));
        }
    return picture;
}

TEST(Ridges, AreAsWideAsTheLinesBeforeTheLensBlurredThem) {
    Random random(21);
    for (const double width : {0.8, 1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0})
        for (const bool light : {false, true}) {
            double wide = 0.0, count = 0.0;
            for (int turn = 0; turn < 6; turn++) {
                const GreyPicture picture = blurred_line(
                    width, random.uniform(0.0, kPi),
                    DVec2(60.0 + random.uniform(-1.0, 1.0), 60.0 + random.uniform(-1.0, 1.0)), light);
                for (const auto& row : find_ridges(pyramid_over(picture)))
                    for (const Ridge& ridge : row) {
                        wide += ridge.width;
                        count += 1.0;
                    }
            }
            ASSERT_GT(count, 300.0) << width;
            EXPECT_NEAR(wide / count, width, (width < 1.2 ? 0.2 : 0.12) * width)
                << (light ? "light" : "dark");
        }
}

TEST(Ridges, AreNotInPlainPicturesNorAtEdges) {
    GreyPicture plain(100, 100), edge(100, 100);
    for (int y = 0; y < 100; y++)
        for (int x = 0; x < 100; x++) {
            plain.row(y)[x] = static_cast<uint8_t>(100 + x / 4);
            edge.row(y)[x] = x + y / 3 > 60 ? 200 : 60;
        }
    EXPECT_TRUE(find_ridges(pyramid_over(plain)).empty());
    EXPECT_TRUE(find_ridges(pyramid_over(edge)).empty());
    EXPECT_TRUE(find_ridges(pyramid_over(GreyPicture(2, 2))).empty());
}

TEST(ThinWood, IsFoundWhereItIs) {
    const double pixel = kAway / kFocal;
    for (const uint64_t seed : {1, 2}) {
        const std::vector<Branch> branches = some_branches(seed, pixel);
        const Orbit orbit = orbit_of(branches, 30);
        const std::vector<ThinPlace> places =
            match_lines(orbit.model, orbit.ridges, orbit.scales, DVec3(0.0), near_middle, {});
        const std::vector<ThinPlace> merged = merged_places(places);
        ASSERT_GT(merged.size(), 100u);
        size_t right = 0, wide = 0;
        for (const ThinPlace& place : merged) {
            const auto nearest =
                std::min_element(branches.begin(), branches.end(), [&](const Branch& a, const Branch& b) {
                    return away_from(a, place.position) < away_from(b, place.position);
                });
            const bool on = away_from(*nearest, place.position) < 1.5 * pixel;
            right += on;
            wide += on && std::abs(place.radius - nearest->radius) < 0.3 * nearest->radius + 0.25 * pixel;
        }
        EXPECT_GT(static_cast<double>(right), 0.93 * static_cast<double>(merged.size()));
        EXPECT_GT(static_cast<double>(wide), 0.9 * static_cast<double>(right));
        // What of the branches is near a place.
        size_t covered = 0, all = 0;
        for (const Branch& branch : branches)
            for (int k = 0; k < 50; k++) {
                const DVec3 p = glm::mix(branch.a, branch.b, (k + 0.5) / 50.0);
                all++;
                covered += std::any_of(merged.begin(), merged.end(), [&](const ThinPlace& place) {
                    return glm::distance(place.position, p) < 6.0 * pixel;
                });
            }
        EXPECT_GT(static_cast<double>(covered), 0.7 * static_cast<double>(all));
    }
}

TEST(ThinWood, IsNotFoundWherePhotosHaveNothingInCommon) {
    // Each photo of branches of its own.
    Orbit orbit;
    orbit.model.cameras = {lens()};
    Random random(3);
    for (int i = 0; i < 24; i++) {
        const std::vector<Branch> branches = some_branches(100 + static_cast<uint64_t>(i), kAway / kFocal);
        orbit.model.photos.push_back(photo_at(15.0 * i, 0.0));
        orbit.ridges.push_back(
            find_ridges(pyramid_over(drawn(orbit.model.photos.back(), lens(), branches, random))));
        orbit.scales.push_back(1.0);
    }
    const auto places = match_lines(orbit.model, orbit.ridges, orbit.scales, DVec3(0.0), near_middle, {});
    EXPECT_LT(merged_places(places).size(), 20u);
    // Nor without a line, or a photo.
    orbit.ridges.assign(24, {});
    EXPECT_TRUE(match_lines(orbit.model, orbit.ridges, orbit.scales, DVec3(0.0), near_middle, {}).empty());
    EXPECT_TRUE(match_lines({}, {}, {}, DVec3(0.0), near_middle, {}).empty());
    EXPECT_TRUE(merged_places({}).empty());
}

TEST(ThinWood, TakesTheCoarsePointsPlaceButNotASurfaces) {
    constexpr double kCell = 0.02;
    std::vector<ThinPlace> thin;
    const auto add = [&](const DVec3& p) {
        thin.push_back({p, {0.0, 0.0, 1.0}, 0.004, 0.003, 0, {9, 8, 7}, false});
    };
    for (int k = 0; k < 100; k++)
        add({1.0, 0.0, 0.006 * k});  // a twig
    for (int k = 0; k < 100; k++)
        add({0.0, 0.3, 0.006 * k});  // a furrow in a wall
    PointCloud cloud;
    cloud.frame.origin = {10.0, 20.0, 30.0};
    for (ThinPlace& place : thin)
        place.position += cloud.frame.origin;
    const auto put = [&](double x, double y, double z) {
        cloud.positions.emplace_back(x, y, z);
        cloud.colors.push_back({100, 100, 100});
    };
    size_t on_twig = 0;
    for (int k = 0; k < 30; k++, on_twig++)
        put(1.0, 0.004, kCell * k);
    for (int y = 0; y < 40; y++)
        for (int z = 0; z < 40; z++)
            put(0.001, kCell * y, kCell * z);
    const size_t wall = cloud.size() - on_twig;
    EXPECT_EQ(add_thin_wood(cloud, kCell, thin), 100u);
    size_t rings = 0, old = 0;
    for (size_t i = 0; i < cloud.size(); i++) {
        const bool ring = cloud.colors[i][0] == 9;
        rings += ring;
        old += !ring;
        const double off = glm::distance(DVec2(cloud.positions[i]), DVec2(1.0, 0.0));
        EXPECT_TRUE(!ring || std::abs(off - 0.004) < 1e-4);
    }
    EXPECT_GE(rings, 300u);
    EXPECT_EQ(old, wall);
    PointCloud none;
    EXPECT_EQ(add_thin_wood(none, kCell, {}), 0u);
}

}  // namespace
}  // namespace treerec
