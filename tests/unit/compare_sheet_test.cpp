// A tree over its photos: pipeline/compare_sheet.h.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "error.h"
#include "exchange/material_textures.h"
#include "file_bytes.h"
#include "pipeline/compare_sheet.h"
#include "with_photos.h"

namespace treerec {
namespace {

constexpr int kWidth = 120;
constexpr int kHeight = 160;
constexpr double kFocal = 200.0;

// Photos of nothing but blue, from 10 in front of a stem of 4 high and .5 thick that stands upright, y to the
// sky, and one from its other side.
class CompareSheet : public test::WithPhotos {
  protected:
    void SetUp() override {
        WithPhotos::SetUp();
        use_pinhole(kWidth, kHeight, kFocal);
        // Right, down and ahead in the rows: half a turn about x, and half a turn about z.
        add("front.png", {0.0, 1.0, 0.0, 0.0});
        add("back.png", {0.0, 0.0, 0.0, 1.0});
        ScanFrame frame;
        frame.up = UpAxis::kY;
        tree_.set_frame(frame);
        tree_.add_child(tree_.add_root({0.0, -2.0, 0.0}, 0.25), {0.0, 2.0, 0.0}, 0.25);
    }

    void add(const std::string& name, const std::array<double, 4>& rotation) {
        Photo photo;
        photo.name = name;
        photo.rotation = rotation;
        photo.translation = {0.0, 0.0, 10.0};
        Image picture(kWidth, kHeight, 3);
        for (int y = 0; y < kHeight; y++)
            for (int x = 0; x < kWidth; x++)
                picture.at(x, y)[2] = 200;
        add_photo(photo, picture);
    }

    Tree tree_;
};

TEST_F(CompareSheet, ShowsTheWoodWhereTheCameraSeesIt) {
    const Image sheet = compare_sheet(tree_, model_, folder_.string());
    ASSERT_EQ(sheet.width, 2 * kWidth);
    ASSERT_EQ(sheet.height, 2 * kHeight);
    for (int row = 0; row < 2; row++)
        for (int y = 0; y < kHeight; y++)
            for (int x = 0; x < kWidth; x++) {
                const uint8_t* plain = sheet.at(x, row * kHeight + y);
                ASSERT_TRUE(plain[0] == 0 && plain[2] == 200) << x << " " << y;
                const uint8_t* drawn = sheet.at(kWidth + x, row * kHeight + y);
                // 10 pixels wide and 80 high; its upper end is round, and its base flat.
                const double beside = std::abs(x + 0.5 - kWidth / 2.0), below = y + 0.5 - kHeight / 2.0;
                if (beside < 4.0 && std::abs(below) < 40.0) {
                    ASSERT_GT(drawn[0], 180) << x << " " << y;
                } else if (beside > 6.0 || below < -46.0 || below > 41.0) {
                    ASSERT_TRUE(drawn[0] == 0 && drawn[2] == 100) << x << " " << y;
                }
            }
}

// However short the pieces are that a stout trunk begins with.
TEST_F(CompareSheet, ABaseOfShortPiecesIsFlatToo) {
    ScanFrame frame = tree_.frame();
    tree_ = Tree();
    tree_.set_frame(frame);
    NodeId last = tree_.add_root({0.0, -2.0, 0.0}, 0.25);
    for (const double y : {-1.95, -1.85, -1.7, 2.0})
        last = tree_.add_child(last, {0.0, y, 0.0}, 0.25);
    const Image sheet = compare_sheet(tree_, model_, folder_.string());
    for (int y = kHeight / 2 + 42; y < kHeight; y++)
        for (int x = 0; x < kWidth; x++)
            ASSERT_EQ(sheet.at(kWidth + x, y)[0], 0) << x << " " << y;
    EXPECT_GT(sheet.at(kWidth + kWidth / 2, kHeight / 2 + 38)[0], 180);
}

TEST_F(CompareSheet, PassesOverWhatCanNotBeRead) {
    put("front.png", "no picture");
    const Image sheet = compare_sheet(tree_, model_, folder_.string());
    EXPECT_EQ(sheet.height, kHeight);
    put("back.png", "");
    EXPECT_THROW(compare_sheet(tree_, model_, folder_.string()), Error);
}

TEST_F(CompareSheet, IsAsLargeAsAskedAndShowsNoMorePhotosThanThat) {
    const Image sheet = compare_sheet(tree_, model_, folder_.string(), {.photos = 1, .longest = 80});
    EXPECT_EQ(sheet.width, 2 * 60);
    EXPECT_EQ(sheet.height, 80);
}

}  // namespace
}  // namespace treerec
