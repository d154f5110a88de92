// Printed markers in drawn pictures, whose every corner is known, and in real ones, which have none.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "cases.h"
#include "drawn_marker.h"
#include "file_bytes.h"
#include "photos/find_markers.h"
#include "photos/marker_code.h"
#include "photos/photo_picture.h"

namespace treerec {
namespace {

using test::DrawnMarker;
using test::MarkerLook;

// A quarter turn with the clock.
uint16_t turned(uint16_t code) {
    unsigned out = 0;
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 4; x++)
            if (code >> (15 - (4 * (3 - x) + y)) & 1) out |= 1U << (15 - (4 * y + x));
    return static_cast<uint16_t>(out);
}

uint16_t mirrored(uint16_t code) {
    unsigned out = 0;
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 4; x++)
            if (code >> (15 - (4 * y + 3 - x)) & 1) out |= 1U << (15 - (4 * y + x));
    return static_cast<uint16_t>(out);
}

// Four of the patterns look the same in a mirror, as no one can tell.
bool is_its_mirror(int id) {
    uint16_t code = mirrored(marker_code(id));
    for (int k = 0; k < 4; k++, code = turned(code))
        if (code == marker_code(id)) return true;
    return false;
}

TEST(MarkerCode, EveryCodeIsReadInEveryTurnAlsoWithOneWrongCell) {
    for (int id = 0; id < kMarkerCount; id++) {
        uint16_t code = marker_code(id);
        for (int turns = 0; turns < 4; turns++, code = turned(code)) {
            const std::optional<ReadCode> read = identify_marker(code);
            ASSERT_TRUE(read) << id;
            EXPECT_EQ(read->id, id);
            EXPECT_EQ(read->turns, turns) << id;
            EXPECT_EQ(read->mended, 0);
            for (int bit = 0; bit < 16; bit++) {
                const std::optional<ReadCode> mended =
                    identify_marker(static_cast<uint16_t>(code ^ 1 << bit));
                ASSERT_TRUE(mended);
                EXPECT_EQ(mended->id, id);
                EXPECT_EQ(mended->turns, turns);
                EXPECT_EQ(mended->mended, 1);
            }
        }
    }
}

// Of all codes that can be read, those are a marker that differ in one cell at most: 50 ids, 4 turns, 17
// codes.
TEST(MarkerCode, NothingElseIsAMarker) {
    int count = 0;
    for (int code = 0; code < 1 << 16; code++)
        count += identify_marker(static_cast<uint16_t>(code)).has_value();
    EXPECT_EQ(count, 50 * 4 * 17);
    int mirrors = 0;
    for (int id = 0; id < kMarkerCount; id++) {
        mirrors += is_its_mirror(id);
        EXPECT_EQ(identify_marker(mirrored(marker_code(id))).has_value(), is_its_mirror(id)) << id;
    }
    EXPECT_EQ(mirrors, 4);
}

// How far the corners are off, the farthest last; empty where the marker was not found.
std::vector<double> misses_of(const DrawnMarker& drawn, const std::vector<FoundMarker>& found) {
    std::vector<double> misses;
    for (const FoundMarker& marker : found) {
        if (marker.id != drawn.id || glm::distance(marker.centre(), drawn.centre()) > drawn.side / 2)
            continue;
        for (size_t k = 0; k < 4; k++)
            misses.push_back(glm::distance(marker.corners[k], drawn.corners[k]));
        break;
    }
    std::sort(misses.begin(), misses.end());
    return misses;
}

struct Tally {
    size_t drawn = 0, found = 0, others = 0;
    std::vector<double> misses;

    double median() {
        std::sort(misses.begin(), misses.end());
        return misses.empty() ? INFINITY : misses[misses.size() / 2];
    }
};

Tally tally_of(double side, double tilt, int count, uint64_t seed) {
    Random random(seed);
    Tally tally;
    for (int i = 0; i < count; i++) {
        MarkerLook look;
        look.side = side;
        look.tilt = tilt;
        look.blur = i % 3 == 0 ? 0.0 : i % 3 == 1 ? 0.7 : 1.2;
        look.noise = 2.0 + 4.0 * random.uniform();
        look.falling_light = i % 2 == 0 ? 0.0 : 0.35;
        look.size = static_cast<int>(std::max(160.0, 2.4 * side));
        const DrawnMarker drawn = test::draw_marker(look, random);
        const std::vector<FoundMarker> found = find_markers(drawn.picture);
        const std::vector<double> misses = misses_of(drawn, found);
        tally.drawn++;
        tally.found += !misses.empty();
        tally.others += found.size() - !misses.empty();
        tally.misses.insert(tally.misses.end(), misses.begin(), misses.end());
    }
    return tally;
}

class DrawnMarkers : public testing::TestWithParam<double> {};

TEST_P(DrawnMarkers, AreFoundWithTheirCorners) {
    for (const double tilt : {0.0, 30.0, 50.0, 65.0}) {
        Tally tally = tally_of(GetParam(), tilt, test::cases(GetParam() > 200 ? 3 : 24), 7);
        const double least = GetParam() < 40 && tilt > 60 ? 0.6 : 0.95;
        EXPECT_GE(static_cast<double>(tally.found), least * static_cast<double>(tally.drawn)) << tilt;
        EXPECT_LT(tally.median(), 0.3) << tilt;
        EXPECT_EQ(tally.others, 0u) << tilt;
    }
}

INSTANTIATE_TEST_SUITE_P(FindMarkers, DrawnMarkers, testing::Values(24.0, 32.0, 60.0, 150.0, 400.0));

// The dictionary tells a print from its mirror image, and so does the search.
TEST(FindMarkers, AMirroredPrintIsNone) {
    Random random(3);
    for (int id = 0; id < kMarkerCount; id++) {
        if (is_its_mirror(id)) continue;
        MarkerLook look;
        look.id = id;
        look.mirrored = true;
        EXPECT_TRUE(find_markers(test::draw_marker(look, random).picture).empty()) << id;
        look.mirrored = false;
        EXPECT_EQ(find_markers(test::draw_marker(look, random).picture).size(), 1u) << id;
    }
}

TEST(FindMarkers, TwoOfOneIdAreBothThere) {
    Random random(5);
    MarkerLook look;
    look.id = 11;
    const DrawnMarker one = test::draw_marker(look, random), other = test::draw_marker(look, random);
    GreyPicture both(one.picture.width * 2, one.picture.height);
    for (int y = 0; y < both.height; y++) {
        std::copy_n(one.picture.row(y), one.picture.width, both.row(y));
        std::copy_n(other.picture.row(y), one.picture.width, both.row(y) + one.picture.width);
    }
    const std::vector<FoundMarker> found = find_markers(both);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].id, 11);
    EXPECT_EQ(found[1].id, 11);
    EXPECT_LT(found[0].centre().x, found[1].centre().x);
}

// A large picture is searched at a smaller size, and its corners are as sharp as the picture.
TEST(FindMarkers, ALargePicturesCornersAreItsOwn) {
    Random random(9);
    MarkerLook look;
    look.side = 90.0;
    look.blur = 1.0;
    look.size = 300;
    const DrawnMarker drawn = test::draw_marker(look, random);
    GreyPicture large(4000, 3000);
    std::fill(large.pixels.begin(), large.pixels.end(), uint8_t{120});
    for (int y = 0; y < 300; y++)
        std::copy_n(drawn.picture.row(y), 300, large.row(y + 1501) + 2203);
    const std::vector<FoundMarker> found = find_markers(large);
    ASSERT_EQ(found.size(), 1u);
    for (size_t k = 0; k < 4; k++)
        EXPECT_LT(glm::distance(found[0].corners[k], drawn.corners[k] + DVec2(2203, 1501)), 0.3);
}

TEST(FindMarkers, HostilePictures) {
    EXPECT_TRUE(find_markers(GreyPicture()).empty());
    for (const auto& [width, height] : {std::pair{1, 1}, {2, 2}, {3, 3}, {1, 5000}, {5000, 1}, {9000, 4}})
        for (const int level : {0, 255}) {
            GreyPicture picture(width, height);
            std::fill(picture.pixels.begin(), picture.pixels.end(), static_cast<uint8_t>(level));
            EXPECT_TRUE(find_markers(picture).empty()) << width << " " << height;
        }
    Random random(1);
    GreyPicture noise(640, 480), board(640, 480);
    for (int y = 0; y < 480; y++)
        for (int x = 0; x < 640; x++) {
            noise.row(y)[x] = static_cast<uint8_t>(random.below(256));
            board.row(y)[x] = (x / 8 + y / 8) % 2 ? 255 : 0;
        }
    EXPECT_TRUE(find_markers(noise).empty());
    EXPECT_TRUE(find_markers(board).empty());
    GreyPicture huge(12000, 9000);
    EXPECT_TRUE(find_markers(huge).empty());
}

TEST(FindMarkers, EndsWhenItIsCancelled) {
    class Ended : public Progress {
        bool cancelled() const override { return true; }
    } ended;
    EXPECT_THROW(find_markers(GreyPicture(640, 480), {}, &ended), Cancelled);
}

// Trees, ferns, a bench, a house with its windows: no marker among them.
TEST(FindMarkers, RealPhotosHaveNone) {
    const char* scans = std::getenv("TREEREC_SCANS");
    const std::filesystem::path folder = std::filesystem::path(scans ? scans : "../shared/scans") / "photos";
    if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no photos in " << folder;
    std::set<std::filesystem::path> photos;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) photos.insert(entry.path());
    size_t index = 0, looked = 0;
    for (const std::filesystem::path& photo : photos) {
        if (index++ % (test::is_long_run() ? 1 : 5) != 0) continue;
        const std::optional<Image> picture = decode_picture(read_file(utf8_of(photo)).view(), 1);
        if (!picture) continue;
        looked++;
        EXPECT_TRUE(find_markers(grey_of(*picture, std::max(picture->width, picture->height))).empty())
            << photo;
    }
    EXPECT_GT(looked, 10u);
}

}  // namespace
}  // namespace treerec
