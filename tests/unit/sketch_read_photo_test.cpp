// Drawings as JPEGs, turned as cameras leave them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "drawn_sketch.h"
#include "exif_jpeg.h"
#include "geometry/random.h"
#include "photos/exif.h"
#include "sketch/sketch_picture.h"

#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
#include <stb/stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace treerec {
namespace {

using test::Polyline;

std::string jpeg_of(const Image& picture, int quality) {
    std::string bytes;
    const auto append = [](void* out, void* data, int size) {
        static_cast<std::string*>(out)->append(static_cast<char*>(data), static_cast<size_t>(size));
    };
    EXPECT_NE(stbi_write_jpg_to_func(append, &bytes, picture.width, picture.height, picture.channels,
                                     picture.pixels.data(), quality),
              0);
    return bytes;
}

// An EXIF record that tells nothing but the orientation.
std::string turned_by(uint32_t orientation, bool big) {
    const test::ExifWriter writer(big);
    return (big ? "MM" : "II") + writer.number(42, 2) + writer.number(8, 4) + writer.number(1, 2) +
           writer.number(0x0112, 2) + writer.number(3, 2) + writer.number(1, 4) +
           writer.number(orientation, 2) + writer.number(0, 2) + writer.number(0, 4);
}

// How the first row and the first column lie, seen upright (Exif 2.32, 4.6.4): the picture as a camera that
// says so stores it.
Image stored(const Image& upright, int orientation) {
    const bool swapped = orientation >= 5;
    Image picture(swapped ? upright.height : upright.width, swapped ? upright.width : upright.height, 4);
    for (int row = 0; row < picture.height; row++)
        for (int column = 0; column < picture.width; column++) {
            // 1: rows from the top, columns from the left; 6: rows from the right, columns from the top; ..
            const int w = upright.width - 1, h = upright.height - 1;
            const std::array<std::pair<int, int>, 8> places = {{{column, row},
                                                                {w - column, row},
                                                                {w - column, h - row},
                                                                {column, h - row},
                                                                {row, column},
                                                                {w - row, column},
                                                                {w - row, h - column},
                                                                {row, h - column}}};
            const auto [x, y] = places[static_cast<size_t>(orientation - 1)];
            std::copy_n(upright.at(x, y), 4, picture.at(column, row));
        }
    return picture;
}

TEST(SketchPhoto, JpegsAreReadUpright) {
    Random random(3);
    const test::DrawnStrokes drawn = test::random_drawing(random, 400.0, 18.0, true, 3);
    const Image upright = test::paint(460, 400, drawn.all(), {4.0, true});
    for (int orientation = 1; orientation <= 8; orientation++)
        for (const bool big : {false, true}) {
            SCOPED_TRACE(orientation);
            const std::string jpeg = jpeg_of(stored(upright, orientation), 60);
            const Sketch sketch = parse_sketch_picture(
                test::with_exif(jpeg, turned_by(static_cast<uint32_t>(orientation), big)), "'drawing.jpg'");
            EXPECT_EQ(sketch.canvas, DVec2(460.0, 400.0));
            EXPECT_EQ(sketch.strokes.size(), 5U);
            for (const Polyline& line : drawn.all()) {
                double best = 1e30;
                for (const Stroke& stroke : sketch.strokes)
                    best = std::min(best, test::apart(stroke.points, line));
                EXPECT_LT(best, 1.0);
            }
        }
}

TEST(SketchPhoto, OrientationIsOneWhereNoneIsTold) {
    const auto told = [](const std::string& bytes) {
        std::istringstream stream(bytes);
        return read_photo_orientation(stream);
    };
    const std::string jpeg = jpeg_of(Image(8, 8, 4), 50);
    EXPECT_EQ(told(jpeg), 1);
    EXPECT_EQ(told(""), 1);
    EXPECT_EQ(told(test::with_exif(jpeg, turned_by(0, true))), 1);
    EXPECT_EQ(told(test::with_exif(jpeg, turned_by(9, false))), 1);
    EXPECT_EQ(told(test::with_exif(jpeg, turned_by(7, false))), 7);
    const std::string whole = test::with_exif(jpeg, turned_by(6, true));
    for (size_t size = 0; size < 46; size++) {
        const int orientation = told(whole.substr(0, size));
        EXPECT_TRUE(orientation == 1 || orientation == 6) << size;
    }
}

}  // namespace
}  // namespace treerec
