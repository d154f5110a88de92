// What the cameras of photos tell of the way up and of the tree that they were taken of.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <sstream>

#include "error.h"
#include "photos/cameras_tell.h"
#include "pipeline/ask_photos.h"
#include "pipeline/reconstruct.h"
#include "scan_samples.h"
#include "synth/grow.h"
#include "synth/scan.h"

namespace treerec {
namespace {

// A photo from `centre`, ahead as told, held level under `sky` but for `roll` radians and `quarters` of a
// turn.
Photo take_photo(const DVec3& centre, const DVec3& ahead, const DVec3& sky, double roll, int quarters = 0) {
    const DVec3 forward = glm::normalize(ahead);
    const DVec3 level = glm::normalize(glm::cross(forward, sky)), low = glm::cross(forward, level);
    const double turn = roll + 0.5 * kPi * quarters;
    const DVec3 right = std::cos(turn) * level + std::sin(turn) * low;
    const DVec3 down = glm::cross(forward, right);
    // Rows of the rotation from world to camera; glm has columns.
    const glm::dquat q = glm::quat_cast(glm::transpose(DMat3(right, down, forward)));
    Photo photo;
    photo.rotation = {q.w, q.x, q.y, q.z};
    photo.translation = DVec3(0.0);
    photo.translation = -photo.to_camera(centre);
    return photo;
}

struct Orbit {
    int photos = 30;
    double arc = 360.0;  // degrees from the first to where the next would be
    double lying = 0.0;  // share of the photos that are stored turned by a quarter
    double roll = 0.05;  // radians, standard deviation
    double pitch = 0.3;
};

// Photos from around `subject`, `radius` away.
PhotoModel take_orbit(Random& random, const DVec3& subject, const DVec3& sky, double radius,
                      const Orbit& orbit) {
    const DVec3 side = any_perpendicular(sky), other = glm::cross(sky, side);
    PhotoModel model;
    for (int i = 0; i < orbit.photos; i++) {
        const double angle = glm::radians(orbit.arc) * i / orbit.photos;
        const DVec3 out = std::cos(angle) * side + std::sin(angle) * other;
        const DVec3 centre = subject + radius * out + random.normal() * 0.1 * radius * sky;
        const DVec3 aim =
            subject + random.normal() * orbit.pitch * radius * sky + 0.05 * radius * random.direction();
        model.photos.push_back(take_photo(centre, aim - centre, sky, orbit.roll * random.normal(),
                                          random.uniform() < orbit.lying ? 1 : 0));
    }
    return model;
}

double degrees_between(const DVec3& a, const DVec3& b) {
    return glm::degrees(std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)));
}

TEST(PhotosTell, TheSkyOfAnOrbit) {
    Random random(1);
    for (int round = 0; round < 200; round++) {
        const DVec3 sky = random.direction(), subject = 10.0 * random.direction();
        Orbit orbit;
        orbit.lying = std::array{0.0, 0.2, 0.8, 1.0}[static_cast<size_t>(round % 4)];
        const PhotoModel model = take_orbit(random, subject, sky, 3.0, orbit);
        // More of a tree is above the cameras than below.
        std::vector<DVec3> points;
        for (int i = 0; i < 100; i++)
            points.push_back(subject + random.uniform(-1.5, 6.0) * sky);
        const std::optional<DVec3> told = sky_of(model, points);
        ASSERT_TRUE(told) << round;
        EXPECT_LT(degrees_between(*told, sky), 4.0) << round;
        const std::optional<DVec3> at = subject_of(model);
        ASSERT_TRUE(at) << round;
        EXPECT_LT(glm::distance(*at, subject), 1.0) << round;
    }
}

TEST(PhotosTell, NothingWhereTheyCanNotKnow) {
    Random random(2);
    const DVec3 sky(0.0, 0.0, 1.0);
    PhotoModel flight, grid, one_way, tumbled, around;
    for (int i = 0; i < 40; i++) {
        const DVec3 place(random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0), 30.0);
        const DVec3 down = DVec3(0.0, 0.0, -1.0) + 0.02 * random.direction();
        // To and fro, and across that.
        const DVec3 heading = i % 2 ? DVec3(1.0, 0.0, 0.0) : DVec3(-1.0, 0.0, 0.0);
        flight.photos.push_back(take_photo(place, down, heading, 0.02 * random.normal()));
        grid.photos.push_back(take_photo(place, down, heading, 0.02 * random.normal(), i / 10));
        one_way.photos.push_back(
            take_photo(place, DVec3(1.0, 0.0, 0.0) + 0.05 * random.direction(), sky, 0.02 * random.normal()));
        tumbled.photos.push_back(
            take_photo(place, random.direction(), random.direction(), 2.0 * kPi * random.uniform()));
        DVec3 out = random.direction();
        out.z = 0.0;
        around.photos.push_back(take_photo(0.1 * out, out, sky, 0.0));
    }
    for (const PhotoModel& model : {flight, grid, one_way, tumbled, PhotoModel()})
        EXPECT_FALSE(sky_of(model, {}));
    for (const PhotoModel& model : {flight, one_way, around, PhotoModel()})
        EXPECT_FALSE(subject_of(model));
    // From the middle of a room the way up can be told.
    ASSERT_TRUE(sky_of(around, {}));
    EXPECT_LT(degrees_between(*sky_of(around, {}), sky), 1.0);
}

TEST(PhotosTell, ThatTheyLookAtOneSide) {
    Random random(4);
    for (int round = 0; round < 50; round++) {
        const DVec3 sky = random.direction(), subject = 10.0 * random.direction();
        std::vector<DVec3> points;
        for (int i = 0; i < 100; i++)
            points.push_back(subject + random.uniform(-1.5, 6.0) * sky + random.direction());
        Orbit orbit;
        orbit.pitch = 0.05;
        for (const double arc : {15.0, 45.0, 80.0, 150.0, 180.0, 360.0}) {
            orbit.arc = arc;
            const auto told = one_sided_arc(take_orbit(random, subject, sky, 4.0, orbit), points);
            ASSERT_EQ(told.has_value(), arc < 120.0) << arc << " in round " << round;
            EXPECT_LT(told.value_or(0.0), 1.5 * arc + 20.0) << arc << " in round " << round;
        }
    }
    // A flight over a plot is none, though all its photos look down.
    PhotoModel flight, pass;
    std::vector<DVec3> ground;
    for (int i = 0; i < 40; i++) {
        const DVec3 place(random.uniform(-20.0, 20.0), random.uniform(-20.0, 20.0), 30.0);
        ground.emplace_back(place.x, place.y, 0.0);
        flight.photos.push_back(take_photo(place, {0.0, 0.0, -1.0}, {1.0, 0.0, 0.0}, 0.0));
        pass.photos.push_back(
            take_photo(0.2 * place + DVec3(0.0, 0.0, 24.0), {0.0, 0.0, -1.0}, {1.0, 0.0, 0.0}, 0.0));
    }
    EXPECT_FALSE(one_sided_arc(flight, ground));
    EXPECT_TRUE(one_sided_arc(pass, ground));
    EXPECT_FALSE(one_sided_arc({}, ground));
    EXPECT_FALSE(one_sided_arc(pass, {}));
}

TEST(PhotosTell, TheSkyOfRealPhotos) {
    const std::string folder = scan_test::scans_folder();
    if (folder.empty()) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    // Walked around at one height: across the plane of the cameras' places, by principal components.
    const PhotoModel orbit = read_photo_model(folder + "../colmap_sparse/treehill_71");
    ASSERT_TRUE(sky_of(orbit, {}));
    EXPECT_LT(degrees_between(*sky_of(orbit, {}), glm::normalize(DVec3(-0.020, -0.965, -0.261))), 2.0);
    // 19 of 23 were taken upright and stored lying, their upper edge to the left, as their EXIF says.
    const PhotoModel mixed = read_photo_model(folder + "../colmap_sparse/monstree_23");
    const std::optional<DVec3> sky = sky_of(mixed, {});
    ASSERT_TRUE(sky);
    int lying = 0, level = 0;
    for (const Photo& photo : mixed.photos) {
        const DVec3 seen = photo.to_camera(*sky) - photo.to_camera(DVec3(0.0));
        lying += seen.x < -0.7;
        level += seen.y < -0.6;
    }
    EXPECT_EQ(lying, 19);
    EXPECT_EQ(level, 4);
    // All from one side.
    const PhotoModel fern = read_photo_model(folder + "../colmap_sparse/fern_20");
    EXPECT_FALSE(sky_of(fern, {}));
    // What becomes no tree: a plant before a wall, and a piece of bark.
    const auto points_of = [&](const std::string& name) {
        std::vector<DVec3> points;
        const PointCloud cloud = read_cloud(folder + "../colmap_sparse/" + name + "/points3D.bin");
        for (const Vec3& p : cloud.positions)
            points.push_back(cloud.frame.to_scan(DVec3(p)));
        return points;
    };
    EXPECT_NEAR(one_sided_arc(fern, points_of("fern_20")).value_or(0.0), 19.0, 2.0);
    EXPECT_NEAR(one_sided_arc(mixed, points_of("monstree_23")).value_or(0.0), 114.0, 2.0);
    EXPECT_FALSE(one_sided_arc(orbit, points_of("treehill_71")));
}

// The 71 photos of a trunk in a round bench: it alone is the tree, where its branches were the bench's and
// the ground's. Its radius by circles through the points at three heights.
TEST(PhotosTell, OfATrunkTheTrunk) {
    const std::string folder = scan_test::scans_folder();
    if (folder.empty()) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
    const std::string path = folder + "../colmap_sparse/treehill_71/points3D.bin";
    const Reconstruction made = reconstruct_file(path, ReconstructOptions());
    EXPECT_EQ(made.tree.nodes_of_kind(NodeKind::kLeaf).size(), 1U);
    EXPECT_FALSE(made.palm);
    EXPECT_EQ(made.leaf_points, 0U);
    EXPECT_NEAR(made.measured.dbh, 0.81, 0.05);  // of the model's unit
    EXPECT_GT(made.measured.height, 1.7);
    EXPECT_LT(made.measured.height, 2.4);
    size_t told = 0;
    for (const std::string& warning : made.warnings)
        told += warning.find("show a stem") != std::string::npos;
    EXPECT_EQ(told, 1U);
    // The scan that is laid over the tree is that of the stem, too, unless the user keeps the ground.
    const auto widest = [&](const ReconstructOptions& options) {
        double away = 0.0;
        for (const Vec3& p : load_scan(path, options, made.tree.frame(), 100000).positions)
            away = std::max(away, std::hypot(static_cast<double>(p.x), static_cast<double>(p.z)));
        return away;
    };
    ReconstructOptions whole;
    EXPECT_LT(widest(whole), 1.2);
    whole.clean.remove_ground = false;
    EXPECT_GT(widest(whole), 5.0);
}

// A virtual scan as photogrammetry leaves it: in its own place, turned, with a model of its photos beside.
class PhotosBeside : public ::testing::Test {
  protected:
    void SetUp() override {
        sky_ = glm::normalize(DVec3(0.1, -0.95, -0.28));
        turned_.set_sky(sky_);
        turned_.origin = DVec3(3.0, 1.0, -2.0);
        std::filesystem::create_directories(folder_.file("dense/sparse"));
        put_scene(scan_of(5.0, 3), {0.0, 1.6, 0.0}, 6.0);
    }

    static std::vector<Vec3> scan_of(double height, uint64_t seed) {
        VirtualScanOptions options;
        options.points = 8000;
        const PointCloud scan = scan_tree(grow_tree({Habit::kBroadleaf, height, seed}), options).cloud;
        std::vector<Vec3> points;
        for (const Vec3& p : scan.positions)
            points.emplace_back(scan.frame.to_scan(DVec3(p)));
        // Virtual scans are Z up.
        ScanFrame upright;
        upright.up = scan.frame.up;
        for (Vec3& p : points)
            p = Vec3(upright.turn_to_tree(DVec3(p)));
        return points;
    }

    // points, subject: metres, Y up. Photos are taken around the subject.
    void put_scene(const std::vector<Vec3>& points, const DVec3& subject, double radius,
                   const Orbit& orbit = {}) {
        Random random(3);
        cloud_ = {};
        for (const Vec3& p : points)
            cloud_.positions.emplace_back(turned_.to_scan(DVec3(p)));
        const PhotoModel model = take_orbit(random, turned_.to_scan(subject), sky_, radius, orbit);
        std::ostringstream images, places;
        images.precision(17);
        places.precision(17);
        int id = 0;
        for (const Photo& photo : model.photos) {
            images << ++id;
            for (const double q : photo.rotation)
                images << ' ' << q;
            images << ' ' << photo.translation.x << ' ' << photo.translation.y << ' ' << photo.translation.z
                   << " 1 " << id << ".jpg\n\n";
        }
        places << "# 3D point list with one line of data per point:\n"
                  "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n";
        for (size_t i = 0; i < cloud_.size(); i += 3)
            places << i + 1 << ' ' << cloud_.positions[i].x << ' ' << cloud_.positions[i].y << ' '
                   << cloud_.positions[i].z << " 90 80 70 0.5 1 2\n";
        images_ = images.str();
        folder_.write("dense/sparse/cameras.txt", "1 PINHOLE 640 480 500 500 320 240\n");
        folder_.write("dense/sparse/images.txt", images_);
        folder_.write("dense/sparse/points3D.txt", places.str());
        write_cloud(folder_.file("dense/fused.ply"), cloud_);
    }

    static bool says(const std::vector<std::string>& warnings, const std::string& part) {
        return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& warning) {
            return warning.find(part) != std::string::npos;
        });
    }

    scan_test::Folder folder_;
    PointCloud cloud_;  // in scan axes
    ScanFrame turned_;
    DVec3 sky_{0.0};
    std::string images_;
};

TEST_F(PhotosBeside, SetATreeUpright) {
    for (const char* name : {"dense/fused.ply", "dense/sparse/points3D.txt"}) {
        ReconstructOptions options;
        const Reconstruction made = reconstruct_file(folder_.file(name), options);
        EXPECT_EQ(made.orient.photos, 30u) << name;
        EXPECT_TRUE(made.orient.scale_unknown) << name;
        const ScanFrame& frame = made.tree.frame();
        EXPECT_EQ(frame.up, UpAxis::kNegY);
        EXPECT_LT(degrees_between(frame.turn_to_scan({0.0, 1.0, 0.0}), sky_), 4.0) << name;
        EXPECT_NEAR(made.measured.height, 5.0, 0.6) << name;
        // What it says of the scan is true, and the scan can be found again.
        EXPECT_GT(made.fit.explained_2cm, 0.8) << name;
        const PointCloud again = load_scan(folder_.file(name), options, frame, 5000);
        const ScanScore fit = score_scan(made.tree, again);
        EXPECT_GT(fit.explained_2cm, 0.8) << name;
        EXPECT_LT(glm::distance(frame.to_scan(made.tree.node(made.tree.root()).position),
                                turned_.to_scan({0, 0, 0})),
                  0.4)
            << name;
    }
}

// Out by a degree, they would tilt what is level.
TEST_F(PhotosBeside, LeaveALevelledSceneLevel) {
    turned_ = {};
    turned_.up = UpAxis::kNegZ;
    sky_ = turned_.turn_to_scan({0.0, 1.0, 0.0});
    put_scene(scan_of(5.0, 3), {0.0, 1.6, 0.0}, 6.0);
    const Reconstruction made = reconstruct_file(folder_.file("dense/fused.ply"), {});
    EXPECT_EQ(made.orient.photos, 30u);
    EXPECT_EQ(made.tree.frame().up, UpAxis::kNegZ);
    EXPECT_EQ(made.tree.frame().tilt, DVec3(0.0));
}

TEST_F(PhotosBeside, TellWhichTreeTheyWereTakenOf) {
    std::vector<Vec3> both = scan_of(6.0, 3);
    for (const Vec3& p : scan_of(4.0, 4))
        both.push_back(p + Vec3(9.0F, 0.0F, 0.0F));
    for (const double x : {0.0, 9.0}) {
        put_scene(both, {x, 1.5, 0.0}, 4.0);
        const Reconstruction made = reconstruct_file(folder_.file("dense/fused.ply"), {});
        EXPECT_EQ(made.clean.pick.trees.size(), 2u);
        EXPECT_NEAR(made.measured.height, x == 0.0 ? 6.0 : 4.0, 0.6);
        // The scan that is shown with it is that of the same tree.
        const PointCloud again = load_scan(folder_.file("dense/fused.ply"), {}, made.tree.frame(), 5000);
        EXPECT_GT(score_scan(made.tree, again).explained_2cm, 0.8);
    }
}

TEST_F(PhotosBeside, OfOneSideNeedToldWhereATreeStands) {
    Orbit orbit;
    orbit.arc = 60.0;
    put_scene(scan_of(5.0, 3), {0.0, 1.6, 0.0}, 6.0, orbit);
    const std::string path = folder_.file("dense/fused.ply");
    try {
        reconstruct_file(path, {});
        FAIL() << "A wall would have become a tree, too.";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(" of the 360 degrees around"), std::string::npos)
            << error.what();
    }
    ReconstructOptions options;
    options.clean.pick.position = turned_.to_scan({0.0, 0.0, 0.0});
    const Reconstruction made = reconstruct_file(path, options);
    EXPECT_NEAR(made.measured.height, 5.0, 0.6);
    EXPECT_FALSE(load_scan(path, options, made.tree.frame(), 5000).empty());
    // Half a circle shows a tree.
    orbit.arc = 180.0;
    put_scene(scan_of(5.0, 3), {0.0, 1.6, 0.0}, 6.0, orbit);
    EXPECT_NEAR(reconstruct_file(path, {}).measured.height, 5.0, 0.6);
}

TEST_F(PhotosBeside, GiveWayToTheUser) {
    ReconstructOptions options;
    options.orient.up = UpAxis::kNegY;
    const Reconstruction made = reconstruct_file(folder_.file("dense/fused.ply"), options);
    EXPECT_EQ(made.orient.photos, 0u);
    EXPECT_EQ(made.tree.frame().tilt, DVec3(0.0));
}

TEST_F(PhotosBeside, AreNotThoseOfACloudThatWasTurnedSince) {
    PointCloud levelled = cloud_;
    for (Vec3& p : levelled.positions)
        p = Vec3(turned_.to_tree(DVec3(p)));
    write_cloud(folder_.file("dense/levelled.ply"), levelled);
    EXPECT_EQ(reconstruct_file(folder_.file("dense/levelled.ply"), {}).orient.photos, 0u);
}

TEST_F(PhotosBeside, CanBeCancelledAnywhere) {
    struct Impatient : Progress {
        mutable int left = 0;
        bool cancelled() const override { return left-- <= 0; }
    };
    const PointCloud cloud = read_cloud(folder_.file("dense/fused.ply"));
    Impatient progress;
    int looks = 0;
    for (bool done = false; !done; looks++) {
        progress.left = looks;
        try {
            EXPECT_TRUE(ask_photos(folder_.file("dense/fused.ply"), cloud, progress).warnings.empty());
            done = true;
        } catch (const Cancelled&) {
            ASSERT_LT(looks, 10000);
        }
    }
    EXPECT_GT(looks, 5);
}

TEST_F(PhotosBeside, AreToldWhenTheyCanNotBeRead) {
    folder_.write("dense/sparse/images.txt", images_.substr(0, images_.size() / 2 - 40) + " x y\n");
    const Reconstruction made = reconstruct_file(folder_.file("dense/fused.ply"), {});
    EXPECT_EQ(made.orient.photos, 0u);
    EXPECT_TRUE(says(made.warnings, "The photos' cameras were not asked for the way up: "))
        << made.warnings.size();
}

}  // namespace
}  // namespace treerec
