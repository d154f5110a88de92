// Whether the photos of a model hold together: circles of photos that are right, bent, or hardly joined.
#include <gtest/gtest.h>

#include "cases.h"
#include "geometry/random.h"
#include "photo_orbit.h"
#include "photos/colmap_advice.h"
#include "photos/photo_joints.h"

namespace treerec {
namespace {

constexpr size_t kPhotos = 20;

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// Photos from around a tree, and what neighbours match, from where they truly were.
struct Circle {
    PhotoModel model = test::orbit(kPhotos, 8.0, 1.5);
    std::vector<std::string> names;
    std::vector<CameraAround> around;
    std::vector<PhotoPlaceMatches> matches;
    std::vector<DVec3> scene;

    explicit Circle(uint64_t seed) {
        Random random(seed);
        model.cameras = parse_photo_model("1 SIMPLE_RADIAL 1600 2400 1700 800 1200 -0.05\n",
                                          "1 1 0 0 0 0 0 5 1 a.jpg\n\n", true, "")
                            .cameras;
        // As high as a tree is: near the horizon, points hardly tell how far a camera is swung.
        for (int i = 0; i < 400; i++)
            scene.emplace_back(random.uniform(-2.5, 2.5), random.uniform(0, 7), random.uniform(-2.5, 2.5));
        for (size_t i = 0; i < kPhotos; i++) {
            model.photos[i].number = static_cast<uint32_t>(i + 1);
            names.push_back(model.photos[i].name);
            around.push_back({names[i], 360.0 * static_cast<double>(i) / kPhotos, 8.0});
        }
        for (size_t i = 0; i < kPhotos; i++)
            for (const size_t step : {1, 2, 7})
                match(i, (i + step) % kPhotos, random);
    }

    void match(size_t one, size_t other, Random& random) {
        PhotoPlaceMatches pair{one, other, {}};
        const Camera& lens = model.cameras[0];
        for (const DVec3& point : scene) {
            const auto here = lens.project(model.photos[one].to_camera(point)),
                       there = lens.project(model.photos[other].to_camera(point));
            if (!here || !there) continue;
            const auto noise = [&] { return 0.5 * DVec2(random.normal(), random.normal()); };
            pair.matches.push_back({*here + noise(), *there + noise(), 1.0});
        }
        matches.push_back(pair);
    }
    // Swings the photos from `first` to before `last` around the tree, after they were matched.
    void bend(size_t first, size_t last, double degrees) {
        for (size_t i = first; i < last; i++) {
            const double angle = glm::radians(around[i].degrees + degrees);
            const uint32_t number = model.photos[i].number;
            model.photos[i] = test::take_photo({8.0 * std::cos(angle), 1.5, 8.0 * std::sin(angle)},
                                               {0.0, 1.5, 0.0}, names[i]);
            model.photos[i].number = number;
        }
    }
    std::vector<PhotoContradiction> contradictions() const {
        return contradictions_in(model, around, matches, names);
    }
};

TEST(PhotoJoints, AGoodCircleContradictsNothing) {
    for (uint64_t seed = 0; seed < static_cast<uint64_t>(test::cases(20)); seed++) {
        Circle circle(seed);
        EXPECT_TRUE(circle.contradictions().empty());
        // Photos that are not beside each other often match what is alike and not the same.
        for (PhotoPlaceMatches& pair : circle.matches)
            if ((pair.other + kPhotos - pair.one) % kPhotos == 7)
                for (PlaceMatch& match : pair.matches)
                    match.other.y += 40.0;
        EXPECT_TRUE(circle.contradictions().empty());
        // And a third of the matches of neighbours may be wrong.
        for (PhotoPlaceMatches& pair : circle.matches)
            for (size_t i = 0; i < pair.matches.size(); i += 3)
                pair.matches[i].other = DVec2(800.0, 1200.0) + 0.5 * pair.matches[i].one;
        EXPECT_TRUE(circle.contradictions().empty());
    }
}

TEST(PhotoJoints, ABentOneContradictsItsMatchesWhereItIsBent) {
    Random random(5);
    for (uint64_t seed = 0; seed < static_cast<uint64_t>(test::cases(20)); seed++) {
        Circle circle(seed);
        const double degrees = random.uniform(8.0, 14.0) * (seed % 2 ? 1.0 : -1.0);
        circle.bend(5, 11, degrees);
        const std::vector<PhotoContradiction> found = circle.contradictions();
        ASSERT_FALSE(found.empty()) << degrees;
        for (const PhotoContradiction& two : found) {
            const auto inside = [&](const std::string& name) {
                const auto at = static_cast<size_t>(name[0] - 'a');
                return at >= 5 && at < 11;
            };
            EXPECT_NE(inside(two.one), inside(two.other)) << two.one << two.other;
            EXPECT_GE(two.own, 2 * two.fitting);
            EXPECT_GT(two.own, two.shared * 8 / 10);
        }
    }
}

TEST(PhotoJoints, NamesAloneTellNeighboursWhereThereIsNoCircle) {
    Circle circle(3);
    circle.bend(5, 11, 12.0);
    circle.around.clear();
    const std::vector<PhotoContradiction> found = circle.contradictions();
    ASSERT_EQ(found.size(), 2u);
    circle.names[4] = "another.jpg";
    EXPECT_EQ(circle.contradictions().size(), 1u);
}

// Each photo sees `usual` points with the next one, and `few` at the gaps that are named by the photo before.
std::vector<SparsePoint> points_of(size_t usual, const std::vector<std::pair<size_t, size_t>>& few) {
    std::vector<SparsePoint> points;
    for (size_t i = 0; i < kPhotos; i++) {
        size_t count = usual;
        for (const auto& [gap, number] : few)
            if (gap == i) count = number;
        for (size_t k = 0; k < count; k++) {
            SparsePoint point;
            point.photos = {static_cast<uint32_t>(i + 1), static_cast<uint32_t>((i + 1) % kPhotos + 1)};
            points.push_back(point);
        }
    }
    return points;
}

TEST(PhotoJoints, TwoWeakOnesLetTheCircleGiveWay) {
    const Circle circle(1);
    const auto weak = [&](const std::vector<std::pair<size_t, size_t>>& few) {
        return weak_joints(joints_around(circle.model, circle.around, points_of(90, few)));
    };
    EXPECT_TRUE(weak({}).empty());
    EXPECT_TRUE(weak({{4, 10}}).empty());
    EXPECT_TRUE(weak({{4, 27}, {12, 33}}).empty());
    const std::vector<PhotoJoint> two = weak({{4, 32}, {19, 27}});
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[0].from + two[0].to, "ta");
    EXPECT_EQ(two[0].points, 27u);
    EXPECT_NEAR(two[0].degrees, 18.0, 1e-9);
    EXPECT_EQ(two[1].from + two[1].to, "ef");
    EXPECT_EQ(two[1].points, 32u);
    EXPECT_EQ(weak({{4, 0}, {12, 20}, {15, 50}, {17, 70}}).size(), 3u);
    // A point that photos further away see joins all gaps between them.
    std::vector<SparsePoint> points = points_of(90, {{4, 10}, {12, 10}});
    SparsePoint far;
    far.photos = {4, 7};
    points.insert(points.end(), 39, far);
    EXPECT_EQ(weak_joints(joints_around(circle.model, circle.around, points)).size(), 2u);
    points.insert(points.end(), 10, far);
    EXPECT_TRUE(weak_joints(joints_around(circle.model, circle.around, points)).empty());
}

TEST(PhotoJoints, PointsThatTellNothingOfPhotosTellNothing) {
    const Circle circle(1);
    std::vector<SparsePoint> points = points_of(90, {});
    for (SparsePoint& point : points)
        point.photos = {0, 0, 99};
    EXPECT_TRUE(joints_around(circle.model, circle.around, points).empty());
    EXPECT_TRUE(joints_around(circle.model, std::span(circle.around).first(3), points_of(9, {})).empty());
    EXPECT_TRUE(weak_joints({}).empty());
}

TEST(PhotoJoints, SentencesNameThePhotos) {
    ColmapRun run;
    run.photos = run.registered = 30;
    EXPECT_TRUE(advice_on(run, {30}, true).empty());
    run.joints.contradictions = {{"c.jpg", "d.jpg", 473, 116, 470}, {"a.jpg", "b.jpg", 60, 20, 41}};
    run.joints.weak = {{"e.jpg", "f.jpg", 180.0, 3}, {"g.jpg", "h.jpg", 20.0, 27}};
    const std::vector<std::string> told = advice_on(run, {30}, true);
    ASSERT_EQ(told.size(), 3u);
    EXPECT_TRUE(has(told[0], "of 473 points that c.jpg and d.jpg share, 116 fit")) << told[0];
    EXPECT_TRUE(has(told[1], "Only 27 points")) << told[1];
    EXPECT_TRUE(has(told[1], "between g.jpg and h.jpg")) << told[1];
    EXPECT_TRUE(has(told[2], "--matcher both")) << told[2];
    EXPECT_EQ(advice_on(run, {30}, false).size(), 2u);
}

}  // namespace
}  // namespace treerec
