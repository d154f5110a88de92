// Photos as judges: by masks, and by their sky (fidelity/photo_judge.h), and what pages and reports say.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "error.h"
#include "exchange/material_textures.h"
#include "fidelity/photo_judge.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "geometry/random.h"
#include "photo_orbit.h"
#include "pipeline/html_photos.h"
#include "pipeline/judge_outline.h"
#include "pipeline/report.h"

namespace treerec {
namespace {

namespace fs = std::filesystem;
using test::box;
using test::masks_of;
using test::orbit;
using test::same_frame;

const Vec3 kLow(-0.4F, 0.2F, -0.4F), kHigh(0.4F, 2.2F, 0.4F);

PointCloud points_in(const Vec3& low, const Vec3& high, size_t count) {
    PointCloud cloud;
    cloud.frame = same_frame();
    Random random(7);
    for (size_t i = 0; i < count; i++) {
        DVec3 t;
        for (int k = 0; k < 3; k++)
            t[k] = random.uniform();
        cloud.positions.emplace_back(DVec3(low) + t * DVec3(high - low));
    }
    return cloud;
}

// Photos of a dark box that stands on a meadow before a bright sky, and masks of the box.
class Judges : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ =
            (fs::temp_directory_path() / ("treerec_judges_" + std::to_string(::getpid()) + "_" +
                                          ::testing::UnitTest::GetInstance()->current_test_info()->name()))
                .string();
        fs::remove_all(folder_);
        model_ = orbit(6, 4.0, 1.2);
        masks_ = masks_of(model_, kLow, kHigh);
        for (size_t i = 0; i < model_.photos.size(); i++) {
            model_.photos[i].name = "photo_" + std::to_string(i) + ".png";
            Image photo(320, 240, 3);
            for (int y = 0; y < photo.height; y++)
                for (int x = 0; x < photo.width; x++) {
                    const bool tree = *masks_[i].at(x, y) != 0;
                    const uint8_t speck = static_cast<uint8_t>((x * 7 + y * 13) % 29);
                    const Color8 color = tree      ? Color8{60, 50, 40}
                                         : y > 122 ? Color8{static_cast<uint8_t>(50 + speck), 90, 40}
                                                   : Color8{200, 215, 235};
                    std::copy(color.begin(), color.end(), photo.at(x, y));
                }
            put("photos/" + model_.photos[i].name, photo);
            put("masks/" + model_.photos[i].name + ".png", masks_[i]);
        }
    }
    void TearDown() override { fs::remove_all(folder_); }

    void put(const std::string& name, const Image& picture) const {
        fs::create_directories(fs::path(folder_ + "/" + name).parent_path());
        const std::vector<uint8_t> png = encode_png(picture);
        std::ofstream(folder_ + "/" + name, std::ios::binary)
            .write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
    }
    PhotoJudge by_masks(const PointCloud& cloud) const {
        return PhotoJudge::by_masks(model_, folder_ + "/masks", cloud);
    }
    PhotoJudge by_sky(const PointCloud& cloud) const {
        return PhotoJudge::by_sky(model_, folder_ + "/photos", cloud);
    }

    std::string folder_;
    PhotoModel model_;
    std::vector<Image> masks_;
};

TEST_F(Judges, ByMasksSayWhatIsSaidAtOnce) {
    const PointCloud cloud = points_in(kLow, kHigh + Vec3(0.0F, 0.8F, 0.0F), 20000);
    const PhotoJudge judge = by_masks(cloud);
    EXPECT_EQ(judge.source(), OutlineSource::kMasks);
    const PhotoFidelity at_once = measure_photos(cloud, model_, masks_);
    EXPECT_EQ(judge.cloud().information, at_once.information);
    EXPECT_EQ(judge.cloud().reconstruction, at_once.reconstruction);
    EXPECT_EQ(judge.cloud().seen, at_once.seen);
    ASSERT_EQ(judge.cloud().photos.size(), 6u);
    for (size_t i = 0; i < 6; i++) {
        EXPECT_EQ(judge.cloud().photos[i].name, model_.photos[i].name);
        EXPECT_EQ(judge.cloud().photos[i].inside, at_once.photos[i].inside);
        EXPECT_EQ(judge.cloud().photos[i].unseen, at_once.photos[i].unseen);
    }
    for (const float top : {1.2F, 2.2F, 3.0F}) {
        const std::vector<OutlinePart> parts{box(kLow, {kHigh.x, top, kHigh.z})};
        const OutlineOverlap again = judge.judge(parts, same_frame());
        const OutlineOverlap once = measure_overlap(parts, same_frame(), model_, masks_);
        EXPECT_EQ(again.mean.recall, once.mean.recall);
        EXPECT_EQ(again.mean.precision, once.mean.precision);
        EXPECT_EQ(again.mean.iou, once.mean.iou);
        ASSERT_EQ(again.photos.size(), once.photos.size());
        EXPECT_EQ(again.photos[3].name, once.photos[3].name);
    }
}

// A tree may have another unit and place in its scan than the one that the masks were read for.
TEST_F(Judges, KnowWhereTheTreeIs) {
    const PhotoJudge judge = by_masks(points_in(kLow, kHigh, 100));
    ScanFrame larger = same_frame();
    larger.metres_per_unit = 10.0;
    larger.origin = {0.5, 0.25, 0.0};
    OutlinePart part = box(kLow, kHigh);
    for (Vec3& p : part.mesh.positions)
        p = Vec3(larger.to_tree(DVec3(p)));
    const std::vector<OutlinePart> parts{part}, same{box(kLow, kHigh)};
    EXPECT_NEAR(judge.judge(parts, larger).mean.iou, judge.judge(same, same_frame()).mean.iou, 1e-3);
}

TEST_F(Judges, BySkySeeWhatIsTooMuchAndNotWhatIsMissing) {
    const PhotoJudge judge = by_sky(points_in(kLow, kHigh, 20000));
    EXPECT_EQ(judge.source(), OutlineSource::kSky);
    ASSERT_EQ(judge.cloud().photos.size(), 6u);
    EXPECT_GT(judge.cloud().reconstruction, 0.98);
    const auto precision = [&](float top) {
        const std::vector<OutlinePart> parts{box(kLow, {kHigh.x, top, kHigh.z})};
        const OutlineOverlap found = judge.judge(parts, same_frame());
        EXPECT_EQ(found.mean.recall, 0.0);
        EXPECT_EQ(found.mean.iou, 0.0);
        EXPECT_EQ(found.photos[0].overlap.recall, 0.0);
        return found.mean.precision;
    };
    EXPECT_GT(precision(1.0F), 0.98);
    EXPECT_GT(precision(2.2F), 0.97);
    // What is in the sky is seen as well as with masks.
    const PhotoJudge masks = by_masks(points_in(kLow, kHigh, 100));
    for (const float top : {2.4F, 2.6F}) {
        const std::vector<OutlinePart> parts{box(kLow, {kHigh.x, top, kHigh.z})};
        const double told = masks.judge(parts, same_frame()).mean.precision;
        EXPECT_LT(told, 0.95);
        EXPECT_NEAR(precision(top), told, 0.02);
    }
    const PointCloud half = points_in({kLow.x, 1.4F, kLow.z}, {kHigh.x, 3.0F, kHigh.z}, 20000);
    EXPECT_LT(by_masks(half).cloud().reconstruction, 0.7);
    EXPECT_NEAR(by_sky(half).cloud().reconstruction, by_masks(half).cloud().reconstruction, 0.03);
    // Masks are never kinder than the sky.
    for (const float top : {1.8F, 2.6F, 3.4F}) {
        const PointCloud cloud = points_in(kLow, {kHigh.x, top, kHigh.z}, 5000);
        EXPECT_LE(by_masks(cloud).cloud().reconstruction, by_sky(cloud).cloud().reconstruction + 1e-9);
    }
    set_thread_count(1);
    const double again = by_sky(points_in(kLow, kHigh, 20000)).cloud().reconstruction;
    set_thread_count(0);
    EXPECT_EQ(again, judge.cloud().reconstruction);
}

TEST_F(Judges, PhotosThatCanNotJudgeAreLeftOutOrSaid) {
    const PointCloud cloud = points_in(kLow, kHigh, 100);
    // Nothing in it is even.
    Image thicket(320, 240, 3);
    Random random(3);
    for (uint8_t& pixel : thicket.pixels)
        pixel = static_cast<uint8_t>(random.below(256));
    put("photos/photo_2.png", thicket);
    put("photos/photo_3.png", Image(32, 24, 3));
    const PhotoJudge judge = by_sky(cloud);
    EXPECT_EQ(judge.cloud().photos.size(), 4u);
    EXPECT_EQ(judge.cloud().information, photo_information(6));
    EXPECT_EQ(judge.masks().size(), 4u);
    const auto sentence = [&](const auto& call) -> std::string {
        try {
            call();
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    for (const Photo& photo : model_.photos)
        put("photos/" + photo.name, thicket);
    EXPECT_NE(sentence([&] { by_sky(cloud); }).find("No sky is sure"), std::string::npos);
    fs::remove_all(folder_ + "/photos");
    EXPECT_NE(sentence([&] { by_sky(cloud); }).find("None of the photos"), std::string::npos);
    EXPECT_NE(sentence([&] { by_masks({}); }).find("point cloud is empty"), std::string::npos);
    put("masks/photo_1.png.png", Image(10, 10, 1));
    EXPECT_NE(sentence([&] { by_masks(cloud); }).find("10 x 10 pixels"), std::string::npos);
    fs::remove(folder_ + "/masks/photo_1.png.png");
    fs::remove(folder_ + "/masks/photo_1.png");
    EXPECT_NE(sentence([&] { by_masks(cloud); }).find("photo_1.png"), std::string::npos);
}

// --- what is told --------------------------------------------------------------------------------

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

ReportDetails judged(OutlineSource source) {
    ReportDetails details;
    details.photos.emplace();
    OutlineJudgement outline;
    outline.source = source;
    outline.cloud.information = 0.8;
    outline.cloud.reconstruction = 0.5;
    outline.cloud.seen = 0.75;
    outline.cloud.photos = {{"a <1>.jpg", 60, 40, 0, 0.6}, {"black.jpg", 40, 60, 0, 0.4}};
    outline.shapes.mean = {0.25, 0.875, 0.125};
    outline.shapes.photos = {{"a <1>.jpg", {0.25, 0.875, 0.125}}};
    details.outline = outline;
    return details;
}

TEST(PhotosSection, TellsQAndEachPhoto) {
    Fidelity fidelity;
    fidelity.skeleton = 0.5;
    const std::string page = photos_section(judged(OutlineSource::kMasks), fidelity);
    for (const char* wanted :
         {"0.200", "0.800", "0.500", "87.5 %", "25.0 %", "12.5 %", "Recall and precision", "a &lt;1&gt;.jpg",
          "black.jpg", "2 photos", "<th>IoU</th>"})
        EXPECT_TRUE(has(page, wanted)) << wanted << page;
    EXPECT_FALSE(has(page, "at most")) << page;
    EXPECT_FALSE(has(page, "<1>"));
}

TEST(PhotosSection, SaysPlainlyWhereItIsPrecisionOnly) {
    Fidelity fidelity;
    fidelity.skeleton = 0.5;
    const std::string page = photos_section(judged(OutlineSource::kSky), fidelity);
    for (const char* wanted : {"Precision only.", "at most", "not known", "points not on the sky"})
        EXPECT_TRUE(has(page, wanted)) << wanted << page;
    for (const char* made_up : {"25.0 %", "12.5 %", "<th>recall</th>"})
        EXPECT_FALSE(has(page, made_up)) << made_up << page;
}

TEST(PhotosSection, SaysWhyThereIsNoQ) {
    ReportDetails details;
    EXPECT_EQ(photos_section(details, {}), "");
    details.photos.emplace();
    EXPECT_EQ(photos_section(details, {}), "");
    details.outline_lacks = "No sky is sure.";
    EXPECT_TRUE(has(photos_section(details, {}), "There is no Q"));
    EXPECT_TRUE(has(photos_section(details, {}), "No sky is sure."));
}

TEST(Report, TellsByWhatTheOutlineWasJudged) {
    Reconstruction result;
    result.tree.add_child(result.tree.add_root(DVec3(0.0), 0.1), {0.0, 1.0, 0.0}, 0.1);
    for (int i = 0; i < 50; i++)
        result.cloud.positions.emplace_back(0.1, 0.02 * i, 0.0);
    for (const OutlineSource source : {OutlineSource::kMasks, OutlineSource::kSky}) {
        const auto report = nlohmann::json::parse(report_json(result, judged(source)));
        const auto outline = report["photos"]["outline"];
        const bool masks = source == OutlineSource::kMasks;
        EXPECT_EQ(outline["by"], masks ? "masks" : "sky");
        EXPECT_EQ(outline["R_s"], report["fidelity"]["R_s"]);
        EXPECT_NEAR(outline["Q"].get<double>(), 0.8 * 0.5 * outline["R_s"].get<double>(), 1e-12);
        EXPECT_EQ(outline["precision"], 0.875);
        EXPECT_EQ(outline["recall"].is_null(), !masks);
        EXPECT_EQ(outline["iou"].is_null(), !masks);
        ASSERT_EQ(outline["by_photo"].size(), 2u);
        EXPECT_EQ(outline["by_photo"][0]["recall"].is_null(), !masks);
        EXPECT_TRUE(outline["by_photo"][1]["precision"].is_null());
        EXPECT_EQ(outline["by_photo"][1]["inside"], 40);
    }
    ReportDetails details;
    details.photos.emplace();
    details.outline_lacks = "No sky is sure.";
    const auto report = nlohmann::json::parse(report_json(result, details));
    EXPECT_TRUE(report["photos"]["outline"].is_null());
    EXPECT_EQ(report["photos"]["outline_lacks"], "No sky is sure.");
}

}  // namespace
}  // namespace treerec
