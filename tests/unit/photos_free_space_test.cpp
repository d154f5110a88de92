// What a photo sees through, where all that it sees is known.
#include <gtest/gtest.h>

#include "photos/free_space.h"

namespace treerec {
namespace {

// A camera at the origin that looks along z, with a picture of half its size.
struct Looks {
    Camera camera;
    Photo photo;
    LoadedPhoto loaded;
    Looks() {
        camera.model = LensModel::kPinhole;
        camera.width = 400;
        camera.height = 200;
        camera.parameters = {200.0, 200.0, 200.0, 100.0};
        loaded.photo = &photo;
        loaded.camera = &camera;
        loaded.scale = 0.5;
    }
    // In the middle of a pixel of the picture.
    static DVec3 at(int x, int y, double depth) {
        return {(2.0 * x + 1.0 - 200.0) / 200.0 * depth, (2.0 * y + 1.0 - 100.0) / 200.0 * depth, depth};
    }
};

TEST(FreeSpace, WhatIsBehindIsSeenThrough) {
    const Looks looks;
    FreeSpace space(looks.loaded);
    for (int x = 100; x < 140; x++)
        for (int y = 40; y < 60; y++)
            space.add(Looks::at(x, y, 10.0), 0.5);
    EXPECT_TRUE(space.sees_through(Looks::at(120, 50, 9.0), 0.3));
    EXPECT_TRUE(space.sees_through(Looks::at(120, 50, 0.1), 0.3));
    // Within the slack and what is unsure of the depth, at it, and behind it.
    EXPECT_FALSE(space.sees_through(Looks::at(120, 50, 9.3), 0.3));
    EXPECT_FALSE(space.sees_through(Looks::at(120, 50, 10.0), 0.3));
    EXPECT_FALSE(space.sees_through(Looks::at(120, 50, 20.0), 0.3));
    // Where the pair sees nothing, behind the camera, and beside the picture.
    EXPECT_FALSE(space.sees_through(Looks::at(60, 50, 5.0), 0.3));
    EXPECT_FALSE(space.sees_through({0.0, 0.0, -5.0}, 0.3));
    EXPECT_FALSE(space.sees_through({50.0, 0.0, 5.0}, 0.3));
    EXPECT_FALSE(FreeSpace().sees_through({0.0, 0.0, 5.0}, 0.3));
}

TEST(FreeSpace, ThinThingsStay) {
    const Looks looks;
    FreeSpace space(looks.loaded);
    for (int x = 100; x < 140; x++)
        for (int y = 40; y < 60; y++)
            space.add(Looks::at(x, y, x == 120 ? 5.0 : 10.0), 0.1);
    EXPECT_FALSE(space.sees_through(Looks::at(120, 50, 5.0), 0.3));
    EXPECT_FALSE(space.sees_through(Looks::at(121, 50, 5.0), 0.3));
    EXPECT_TRUE(space.sees_through(Looks::at(123, 50, 5.0), 0.3));
}

TEST(FreeSpace, EachPhotoCountsOnce) {
    const Looks looks;
    FreeSpace far(looks.loaded), near(looks.loaded);
    far.add(Looks::at(120, 50, 10.0), 0.1);
    near.add(Looks::at(120, 50, 4.0), 0.1);
    const std::vector<FreeSpace> photos{far, near, far, FreeSpace()};
    const std::vector<DVec3> places{Looks::at(120, 50, 2.0), Looks::at(120, 50, 5.0),
                                    Looks::at(120, 50, 10.0)};
    EXPECT_EQ(count_seen_through(places, photos, 0.3), (std::vector<uint32_t>{3, 2, 0}));
}

}  // namespace
}  // namespace treerec
