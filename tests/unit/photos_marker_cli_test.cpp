// 'treerec marker', and the size that 'treerec photos' has from a marker in drawn photos.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "drawn_marker.h"
#include "exchange/material_textures.h"
#include "photos/find_markers.h"
#include "photos/photo_picture.h"
#include "photos_standin.h"

namespace treerec {
namespace {

using test::Cli;
using test::Outcome;

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

GreyPicture as_grey(const Image& picture) {
    GreyPicture grey(picture.width, picture.height);
    grey.pixels = picture.pixels;
    return grey;
}

class MarkerCli : public Cli {};

TEST_F(MarkerCli, APageHasTheMarkerThatIsAskedFor) {
    const Outcome made = run("marker -o page.png --id 33 --side 120mm");
    ASSERT_EQ(made.code, 0) << made.error;
    EXPECT_TRUE(has(made.out, "page.png (A4)")) << made.out;
    EXPECT_TRUE(has(made.out, "id 33. Side of the black square: 120 mm. Print at 100 %.")) << made.out;
    const std::string png = get("page.png");
    // 11811 pixels to a metre, both ways.
    const size_t size = png.find("pHYs");
    ASSERT_NE(size, std::string::npos);
    EXPECT_EQ(png.substr(size + 4, 9), std::string("\0\0\x2e\x23\0\0\x2e\x23\x01", 9));
    const std::optional<Image> page = decode_picture(png, 1);
    ASSERT_TRUE(page);
    EXPECT_EQ(page->width, 2480);
    EXPECT_EQ(page->height, 3508);
    const std::vector<FoundMarker> found = find_markers(as_grey(*page));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].id, 33);
    EXPECT_NEAR(found[0].mean_side() / 300.0 * 25.4, 120.0, 0.1);
    EXPECT_LT(found[0].corners[0].x, found[0].corners[1].x);
    EXPECT_LT(found[0].corners[0].y, found[0].corners[3].y);
}

TEST_F(MarkerCli, AnSvgIsInMillimetres) {
    ASSERT_EQ(run("marker -o page.svg --id 5 --side 0.15 --quiet").code, 0);
    const std::string svg = get("page.svg");
    EXPECT_TRUE(has(svg, "width=\"210mm\" height=\"297mm\" viewBox=\"0 0 210 297\""));
    EXPECT_TRUE(has(svg, "M30 69.5h150v150h-150z"));
    EXPECT_TRUE(has(svg, ">ArUco DICT_4X4_50, id 5. Side of the black square: 150 mm. Print at 100 %.<"));
    // A hole for each white cell.
    size_t holes = 0, white = 0;
    for (size_t at = svg.find("h25v25h-25z"); at != std::string::npos; at = svg.find("h25v25h-25z", at + 1))
        holes++;
    for (int y = 0; y < kMarkerCells; y++)
        for (int x = 0; x < kMarkerCells; x++)
            white += is_white_cell(5, x, y);
    EXPECT_EQ(holes, white);
    ASSERT_EQ(run("marker -o large.svg --side 12in").code, 0);
    EXPECT_TRUE(has(get("large.svg"), "width=\"420mm\""));
}

TEST_F(MarkerCli, WhatIsNoMarkerIsSaid) {
    for (const auto& [words, sentence] : std::vector<std::pair<const char*, const char*>>{
             {"marker", "Where to?"},
             {"marker -o page.gif", ".svg or .png"},
             {"marker -o page.svg --id 50", "0 to 49"},
             {"marker -o page.svg --side 5mm", "from 20 mm to 600 mm"},
             {"marker -o page.svg --side 5furlongs", "needs a length"},
             {"marker -o page.svg --side mm", "needs a length"},
             {"marker -o page.svg --side nan", "from 20 mm"},
             {"marker -o page.svg other", "too much"}}) {
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.code, 2) << words;
        EXPECT_TRUE(has(outcome.error, sentence)) << words << ": " << outcome.error;
    }
}

// Photos of the stand-in's cameras, which go around an upright trunk (z is down), with a marker beside it
// whose side is half of the model's unit.
class PhotosMarkerCli : public test::WithStandIn<Cli> {
  protected:
    static constexpr int kId = 12;

    void SetUp() override {
        test::WithStandIn<Cli>::SetUp();
        if (IsSkipped()) return;
        take_photos({"a.png", "b.png", "c.png", "d.png", "e.png", "f.png", "g.png", "h.png", "i.png"});
        for (size_t i = 0; i < names_.size(); i++) {
            const std::vector<uint8_t> png = encode_png(
                photo_from(2.0 * kPi * static_cast<double>(i) / static_cast<double>(names_.size())));
            put("photos/" + names_[i], std::string(reinterpret_cast<const char*>(png.data()), png.size()));
        }
    }

    // As write_tiny_model() has its cameras.
    static Image photo_from(double angle) {
        const DVec3 centre(4.0 * std::cos(angle), 4.0 * std::sin(angle), 0.0);
        const DVec3 ahead = -glm::normalize(centre), down(0.0, 0.0, 1.0), right = glm::cross(down, ahead);
        Image picture(640, 480, 1);
        for (int y = 0; y < picture.height; y++)
            for (int x = 0; x < picture.width; x++) {
                const double behind = 0.4 * test::drawn_grey({x, y}, 3);
                double sum = 0.0;
                for (int k = 0; k < 9; k++) {
                    const DVec3 ray = ahead + right * ((x + (k % 3 + 0.5) / 3.0 - 320.0) / 500.0) +
                                      down * ((y + (k / 3 + 0.5) / 3.0 - 240.0) / 500.0);
                    // It looks to the first camera, one unit from the trunk.
                    const double away = (1.0 - centre.x) / ray.x;
                    const DVec3 at = centre + away * ray;
                    std::optional<double> print;
                    if (ray.x < 0.0 && away > 0.0)
                        print = test::print_at(kId, 0.5 - 2.0 * at.y, 0.5 + 2.0 * at.z, false);
                    sum += print ? 30.0 + 190.0 * *print : behind;
                }
                *picture.at(x, y) = static_cast<uint8_t>(sum / 9.0 + 0.5);
            }
        return picture;
    }

    nlohmann::json report() const { return nlohmann::json::parse(get("out/report.json")); }
};

TEST_F(PhotosMarkerCli, ATreeHasTheMarkersSize) {
    const Outcome outcome = run("photos photos -o out --sparse --marker 200mm");
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    EXPECT_TRUE(has(outcome.out, "marker 12 in 3 photos, 3 agree")) << outcome.out;
    EXPECT_TRUE(has(outcome.out, "the scale is the marker's")) << outcome.out;
    EXPECT_FALSE(has(outcome.error, "have no scale")) << outcome.error;
    const nlohmann::json made = report();
    EXPECT_TRUE(made["scale_from_marker"].get<bool>());
    EXPECT_FALSE(made["scale_from_gps"].get<bool>());
    EXPECT_FALSE(made["scale_guessed"].get<bool>());
    EXPECT_NEAR(made["metres_per_unit"].get<double>(), 0.4, 0.4 * 0.003);
    const nlohmann::json& marker = made["photos"]["marker"];
    EXPECT_EQ(marker["photos"].get<int>(), 3);
    EXPECT_EQ(marker["markers"][0]["id"].get<int>(), kId);
    EXPECT_NEAR(marker["markers"][0]["side_units"].get<double>(), 0.5, 0.0015);
    EXPECT_LT(marker["spread"].get<double>(), 0.01);
    // Another side is no reason to look at the photos again.
    const std::string mark = get("out/colmap/markers.json");
    ASSERT_EQ(run("photos photos -o out --sparse --marker 0.5").code, 0);
    EXPECT_NEAR(report()["metres_per_unit"].get<double>(), 1.0, 0.003);
    EXPECT_EQ(get("out/colmap/markers.json"), mark);
}

TEST_F(PhotosMarkerCli, WhatIsToldGoesFirstAndTheMarkerIsComparedWithIt) {
    const Outcome hint = run("photos photos -o out --sparse");
    EXPECT_TRUE(has(hint.error, "A printed marker (id 12) is in 3 photos")) << hint.error;
    EXPECT_FALSE(report()["scale_from_marker"].get<bool>());
    EXPECT_TRUE(report()["photos"]["marker"]["metres_per_unit"].is_null());
    const Outcome told = run("photos photos -o out --sparse --scale 0.5 --marker 200mm");
    EXPECT_TRUE(
        has(told.error, "By the size that was told, the tree is 25 % higher than by the printed marker"))
        << told.error;
    EXPECT_NEAR(report()["metres_per_unit"].get<double>(), 0.5, 1e-9);
    EXPECT_FALSE(has(run("photos photos -o out --sparse --scale 0.41 --marker 200mm").error, "higher than"));
    // No hint where the size is told.
    EXPECT_FALSE(has(run("photos photos -o out --sparse --scale 0.41").error, "marker"));
    EXPECT_EQ(run("photos photos -o out --marker 200").code, 2);
    EXPECT_EQ(run("photos photos -o out --marker -0.2").code, 2);
}

TEST_F(PhotosMarkerCli, AMarkerThatIsNotThereIsSaid) {
    for (const std::string& name : names_)
        put("photos/" + name, test::tiny_jpeg(640, 480) + name);
    const Outcome outcome = run("photos photos -o out --sparse --marker 200mm");
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    EXPECT_TRUE(has(outcome.error, "and 9 of them could not be looked at")) << outcome.error;
    EXPECT_TRUE(has(outcome.error, "have no scale")) << outcome.error;
    EXPECT_FALSE(report()["scale_from_marker"].get<bool>());
}

}  // namespace
}  // namespace treerec
