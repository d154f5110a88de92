// Corners of pictures, on drawn ones.
#include <gtest/gtest.h>

#include "photos/harris.h"
#include "photos_warps.h"

namespace treerec {
namespace {

using test::draw_warped;
using test::Warp;

// White squares on black.
Image squares() {
    Image image(160, 120, 1);
    for (const DVec2 corner : {DVec2(30, 30), DVec2(90, 40), DVec2(50, 80)})
        for (int y = 0; y < 20; y++)
            for (int x = 0; x < 20; x++)
                *image.at(static_cast<int>(corner.x) + x, static_cast<int>(corner.y) + y) = 255;
    return image;
}

TEST(PhotosHarris, FindsTheCornersOfSquares) {
    const std::vector<Corner> corners = harris_corners(grey_of(squares(), 1000));
    ASSERT_EQ(corners.size(), 12u);
    for (const DVec2 square : {DVec2(30, 30), DVec2(90, 40), DVec2(50, 80)})
        for (const DVec2 at : {DVec2(0, 0), DVec2(19, 0), DVec2(0, 19), DVec2(19, 19)}) {
            double nearest = INFINITY;
            for (const Corner& corner : corners)
                nearest = std::min(nearest, glm::distance(corner.place, square + at));
            EXPECT_LT(nearest, 2.0);
        }
}

TEST(PhotosHarris, NoneWhereNothingIsToBeSeen) {
    EXPECT_TRUE(harris_corners(GreyPicture(1, 1)).empty());
    EXPECT_TRUE(harris_corners(GreyPicture(16, 500)).empty());
    EXPECT_TRUE(harris_corners(GreyPicture(300, 200)).empty());
    // An edge is no corner.
    Image edge(100, 100, 1);
    for (int y = 0; y < 100; y++)
        for (int x = 50; x < 100; x++)
            *edge.at(x, y) = 200;
    EXPECT_TRUE(harris_corners(grey_of(edge, 1000)).empty());
}

TEST(PhotosHarris, AreSpreadAndApart) {
    HarrisOptions options;
    options.most = 200;
    // Half of it is twenty times paler.
    Image image = draw_warped({"", DMat3(1.0)}, 3);
    for (int y = 0; y < image.height; y++)
        for (int x = 0; x < image.width / 2; x++)
            *image.at(x, y) = static_cast<uint8_t>(100 + *image.at(x, y) / 5);
    const std::vector<Corner> corners = harris_corners(grey_of(image, 1000), options);
    ASSERT_EQ(corners.size(), 200u);
    size_t pale = 0;
    for (size_t i = 0; i < corners.size(); i++) {
        pale += corners[i].place.x < image.width / 2;
        if (i > 0) {
            EXPECT_LE(corners[i].response, corners[i - 1].response);
        }
        for (size_t j = 0; j < i; j++)
            EXPECT_GE(glm::distance(corners[i].place, corners[j].place), options.apart);
    }
    EXPECT_GT(pale, 60u);
}

TEST(PhotosHarris, AreThereAgainWhenTheLightChanges) {
    const std::vector<Corner> first = harris_corners(grey_of(draw_warped({"", DMat3(1.0)}, 3), 1000));
    const std::vector<Corner> darker =
        harris_corners(grey_of(draw_warped({"", DMat3(1.0)}, 3, 0.7, 20.0), 1000));
    size_t again = 0;
    for (const Corner& corner : first)
        for (const Corner& other : darker)
            if (glm::distance(corner.place, other.place) < 0.5) {
                again++;
                break;
            }
    EXPECT_GT(static_cast<double>(again), 0.85 * static_cast<double>(first.size()));
}

TEST(PhotosPyramid, IsHalfAsLargeAndKeepsItsPlaces) {
    const Image image = draw_warped({"", DMat3(1.0)}, 3);
    const GreyPyramid pyramid = pyramid_of(image, 1000);
    ASSERT_EQ(pyramid.levels.size(), 4u);
    EXPECT_EQ(pyramid.levels[0].pixels, image.pixels);
    EXPECT_EQ(pyramid.levels[3].width, 60);
    EXPECT_EQ(pyramid.levels[3].height, 45);
    EXPECT_EQ(pyramid.in_photo({0.0, 0.0}), DVec2(0.5));
    // Smaller by no whole number: the mean stays, and COLMAP's places are those of the photo.
    const GreyPyramid small = pyramid_of(image, 200);
    EXPECT_EQ(small.levels[0].width, 200);
    EXPECT_EQ(small.levels[0].height, 150);
    EXPECT_EQ(small.in_photo({199.5, 149.5}), DVec2(480.0, 360.0));
    double whole = 0.0, shrunk = 0.0;
    for (const uint8_t value : image.pixels)
        whole += value / static_cast<double>(image.pixels.size());
    for (const uint8_t value : small.levels[0].pixels)
        shrunk += value / static_cast<double>(small.levels[0].pixels.size());
    EXPECT_NEAR(whole, shrunk, 0.2);
    EXPECT_EQ(pyramid_of(Image(1, 1, 3), 1000).levels.size(), 1u);
    EXPECT_EQ(grey_of(Image(5000, 1, 1), 100).height, 1);
}

}  // namespace
}  // namespace treerec
