// Tracked corners on their way to COLMAP, with a program that stands in for it (photos_standin.h).
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <set>

#include "exchange/material_textures.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "photos/pair_files.h"
#include "photos/run_colmap.h"
#include "photos_database.h"
#include "photos_standin.h"
#include "photos_warps.h"

namespace treerec {
namespace {

namespace fs = std::filesystem;
using test::InFolder;
using test::WithStandIn;

class PhotosTrack : public WithStandIn<InFolder> {
  protected:
    void SetUp() override {
        WithStandIn<InFolder>::SetUp();
        options_.matcher = PhotoMatcher::kPyrlk;
        take_walk("photo", ".png");
    }
    // Nine pictures, each of which shows the next part.
    void take_walk(const std::string& begin, const std::string& end) {
        std::vector<std::string> names;
        for (int i = 0; i < 9; i++)
            names.push_back(begin + std::to_string(i) + end);
        take_photos(names);
        for (size_t i = 0; i < names.size(); i++)
            put("photos/" + names[i],
                picture(test::about_middle("", DMat3(1.0), {-18.0 * static_cast<double>(i), 0.0})));
    }
    // The middle of what is drawn.
    static constexpr int kWidth = test::kDrawnWidth / 2, kHeight = test::kDrawnHeight / 2;
    static std::string picture(const test::Warp& warp) {
        const Image drawn = test::draw_warped(warp, 11);
        Image image(kWidth, kHeight, 1);
        for (int y = 0; y < kHeight; y++)
            for (int x = 0; x < kWidth; x++)
                *image.at(x, y) = *drawn.at(x + kWidth / 2, y + kHeight / 2);
        return bytes_of(image);
    }
    static std::string bytes_of(const Image& image) {
        const std::vector<uint8_t> png = encode_png(image);
        return {png.begin(), png.end()};
    }
    ColmapRun run(Progress* progress = nullptr) {
        return run_colmap(path("photos"), path("out"), options_, progress);
    }
    std::string sentence() {
        try {
            run();
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }
    std::string log_since() {
        const std::string log = get("out/photos.log");
        const std::string rest = log.substr(std::min(read_, log.size()));
        read_ = log.size();
        return rest;
    }
    // All that COLMAP was given.
    std::string given() const {
        std::string text = get("words.matches");
        for (const std::string& name : names_)
            text += get("words." + name + ".txt");
        return text;
    }

    ColmapOptions options_;
    size_t read_ = 0;
};

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST_F(PhotosTrack, ReachesColmapWithoutSift) {
    for (const std::string version : {"3.8", "4"}) {
        ::setenv("STANDIN_VERSION", version.c_str(), 1);
        fs::remove_all(path("out"));
        EXPECT_EQ(run().registered, 9u);
        const std::vector<Words> told = calls();
        ASSERT_EQ(commands(told), "feature_importer matches_importer mapper");
        EXPECT_EQ(value_of(told[0], "--ImageReader.single_camera"), "1");
        EXPECT_EQ(value_of(told[0], "--ImageReader.camera_model"), "RADIAL");
        EXPECT_EQ(value_of(told[1], "--match_type"), "raw");
        EXPECT_EQ(value_of(told[0], "--database_path"), value_of(told[2], "--database_path"));
    }
    EXPECT_FALSE(fs::exists(folder_ / "out/colmap/keypoints"));
    // Keypoints: as many as the head says, 132 numbers each, in the picture.
    std::map<std::string, size_t> counts;
    for (const std::string& name : names_) {
        std::istringstream text(get("words." + name + ".txt"));
        size_t count = 0, numbers = 0;
        text >> count >> numbers;
        EXPECT_GT(count, 50u);
        EXPECT_EQ(numbers, 128u);
        counts[name] = count;
        for (size_t i = 0; i < count; i++) {
            double x = 0.0, y = 0.0, rest = 0.0;
            text >> x >> y;
            EXPECT_TRUE(x > 0.0 && y > 0.0 && x < kWidth && y < kHeight);
            for (int k = 0; k < 130; k++)
                ASSERT_TRUE(text >> rest);
        }
        double more = 0.0;
        EXPECT_FALSE(text >> more);
    }
    // Matches: of pairs of photos, with keypoints that are there, each once.
    std::istringstream text(get("words.matches"));
    size_t pairs = 0;
    for (std::string line; std::getline(text, line);) {
        const std::string one = line.substr(0, line.find(' ')), other = line.substr(line.find(' ') + 1);
        ASSERT_TRUE(counts.count(one) && counts.count(other)) << line;
        pairs++;
        std::set<size_t> seen;
        while (std::getline(text, line) && !line.empty()) {
            size_t a = 0, b = 0;
            std::istringstream(line) >> a >> b;
            EXPECT_LT(a, counts[one]);
            EXPECT_LT(b, counts[other]);
            EXPECT_TRUE(seen.insert(a).second);
        }
    }
    EXPECT_GE(pairs, 15u);
}

TEST_F(PhotosTrack, IsTheSameOnAnyNumberOfThreads) {
    std::string first;
    for (const int threads : {1, 2, 5}) {
        fs::remove_all(path("out"));
        set_thread_count(threads);
        run();
        if (threads == 1) first = given();
        EXPECT_EQ(given(), first) << threads;
    }
    set_thread_count(0);
}

TEST_F(PhotosTrack, DoesNothingTwice) {
    run();
    calls();
    run();
    EXPECT_EQ(commands(calls()), "");
    // The same places in another number of photos are others.
    put("photos/photo9.png", picture(test::about_middle("", DMat3(1.0), {-162.0, 0.0})));
    run();
    EXPECT_EQ(commands(calls()), "feature_importer matches_importer mapper");
    // SIFT's work has its own place, and is not done again for an excursion.
    options_.matcher = PhotoMatcher::kSift;
    run();
    EXPECT_EQ(commands(calls()), "feature_extractor exhaustive_matcher mapper");
    options_.matcher = PhotoMatcher::kPyrlk;
    run();
    EXPECT_EQ(commands(calls()), "mapper");
}

TEST_F(PhotosTrack, GoesOnAfterItsEnd) {
    class Stop : public Progress {
      public:
        void update(double, const char* stage) override { stage_ = stage; }
        void count(size_t done, size_t) override {
            stop_ = stop_ || (std::string(stage_) == "Matching" && done >= 18);
        }
        bool cancelled() const override { return stop_; }
        const char* stage_ = "";
        std::atomic<bool> stop_ = false;
    } stop;
    EXPECT_THROW(run(&stop), Cancelled);
    EXPECT_TRUE(fs::exists(folder_ / "out/colmap/tracks/0.bin"));
    EXPECT_FALSE(has(log_since(), "were tracked before"));
    run();
    EXPECT_TRUE(has(log_since(), "16 pairs were tracked before"));
    const std::string first = given();
    EXPECT_FALSE(fs::exists(folder_ / "out/colmap/tracks/0.bin"));
    // A file that is damaged is none, and other photos are others.
    fs::remove_all(path("out"));
    stop.stop_ = false;
    EXPECT_THROW(run(&stop), Cancelled);
    put("out/colmap/tracks/0.bin", get("out/colmap/tracks/0.bin").substr(0, 500));
    run();
    EXPECT_FALSE(has(log_since(), "were tracked before"));
    EXPECT_EQ(given(), first);
    fs::remove_all(path("out"));
    stop.stop_ = false;
    EXPECT_THROW(run(&stop), Cancelled);
    put("photos/photo3.png", picture(test::about_middle("", test::turned(7), {-52.0, 0.0})));
    run();
    EXPECT_FALSE(has(log_since(), "were tracked before"));
    // And after COLMAP's.
    for (const std::string command : {"feature_importer", "matches_importer", "mapper"}) {
        fs::remove_all(path("out"));
        read_ = 0;
        standin_does(" " + command + "=exit1 ");
        EXPECT_TRUE(has(sentence(), "COLMAP's " + command + " ended with exit code 1"));
        standin_does("");
        EXPECT_EQ(run().registered, 9u);
        // What was tracked is taken from the file.
        const std::string log = get("out/photos.log");
        EXPECT_EQ(log.find("pairs to track"), log.rfind("pairs to track"));
    }
}

TEST_F(PhotosTrack, PhotosThatShowNothingAreLeftOut) {
    put("photos/photo2.png", bytes_of(Image(1, 1, 3)));
    put("photos/photo4.png", bytes_of(Image(240, 180, 3)));
    put("photos/photo6.png", "no picture");
    put("photos/photo7.png", picture(test::about_middle("", test::turned(0, 0.8))).substr(0, 9000));
    const ColmapRun result = run();
    EXPECT_TRUE(fs::exists(path("words.photo0.png.txt")));
    for (const char* name : {"words.photo2.png.txt", "words.photo4.png.txt", "words.photo6.png.txt"})
        EXPECT_FALSE(fs::exists(path(name))) << name;
    ASSERT_FALSE(result.warnings.empty());
    EXPECT_TRUE(has(result.warnings[0], "could not be read")) << result.warnings[0];
    const std::vector<Words> told = calls();
    EXPECT_EQ(value_of(told[0], "--ImageReader.single_camera"), "");
    EXPECT_EQ(value_of(told[0], "--ImageReader.camera_model"), "");
    // Nothing at all.
    for (int i = 0; i < 9; i++)
        put("photos/photo" + std::to_string(i) + ".png", bytes_of(Image(i + 1, 300, 1)));
    fs::remove_all(path("out"));
    standin_does(" mapper=none ");
    EXPECT_NE(sentence(), "");
}

TEST_F(PhotosTrack, NamesWithBlanksAreToldAtOnce) {
    take_walk("a photo ", ".png");
    EXPECT_TRUE(has(sentence(), "rename them")) << sentence();
    EXPECT_EQ(commands(calls()), "");
    options_.matcher = PhotoMatcher::kBoth;
    const ColmapRun result = run();
    EXPECT_EQ(commands(calls()), "feature_extractor exhaustive_matcher mapper");
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_TRUE(has(result.warnings[0], "rename them"));
}

TEST_F(PhotosTrack, BothJoinsWhatSiftFound) {
    options_.matcher = PhotoMatcher::kBoth;
    std::vector<DVec2> places = {{11.5, 12.25}};
    for (int i = 1; i < 40; i++)
        places.emplace_back(11.5 + 5.0 * i, 12.25);
    put("sift.db", test::DatabaseWriter().bytes(test::colmap_tables(names_, places)));
    ::setenv("STANDIN_DATABASE", path("sift.db").c_str(), 1);
    EXPECT_EQ(run().registered, 9u);
    EXPECT_EQ(commands(calls()),
              "feature_extractor exhaustive_matcher feature_importer matches_importer mapper");
    for (const std::string& name : names_)
        EXPECT_TRUE(has(get("words." + name + ".txt"), "\n11.500 12.250 1 0 0")) << name;
    run();
    EXPECT_EQ(commands(calls()), "");
    // Where not all photos are placed, SIFT's matches alone have their turn.
    test::write_tiny_model(folder_ / "models" / "0", {{names_.begin(), names_.begin() + 7}});
    fs::remove_all(path("out"));
    EXPECT_EQ(run().registered, 7u);
    const std::vector<Words> told = calls();
    EXPECT_EQ(commands(told),
              "feature_extractor exhaustive_matcher feature_importer matches_importer mapper mapper");
    EXPECT_TRUE(value_of(told[4], "--database_path").ends_with("tracks.db"));
    EXPECT_TRUE(value_of(told[5], "--database_path").ends_with("matching.db"));
    EXPECT_FALSE(fs::exists(path("out/colmap/models.more")));
    // A database that is none.
    put("sift.db", "no database");
    fs::remove_all(path("out"));
    EXPECT_TRUE(has(sentence(), "matching.db' is damaged")) << sentence();
}

TEST_F(PhotosTrack, CornersAreTrackedAsNeeded) {
    options_.matcher = PhotoMatcher::kAuto;
    // So few matches of a pair are not asked whether they fit.
    std::vector<DVec2> places;
    for (int i = 0; i < 20; i++)
        places.emplace_back(11.5 + 5.0 * i, 12.25);
    put("sift.db", test::DatabaseWriter().bytes(test::colmap_tables(names_, places)));
    ::setenv("STANDIN_DATABASE", path("sift.db").c_str(), 1);
    EXPECT_EQ(run().registered, 9u);
    EXPECT_EQ(commands(calls()), "feature_extractor exhaustive_matcher mapper");
    run();
    EXPECT_EQ(commands(calls()), "");
    test::write_tiny_model(folder_ / "models" / "0", {{names_.begin(), names_.begin() + 7}});
    fs::remove_all(path("out"));
    EXPECT_EQ(run().registered, 7u);
    const std::vector<Words> told = calls();
    EXPECT_EQ(commands(told),
              "feature_extractor exhaustive_matcher mapper feature_importer matches_importer mapper");
    EXPECT_TRUE(value_of(told[2], "--database_path").ends_with("matching.db"));
    EXPECT_TRUE(value_of(told[5], "--database_path").ends_with("tracks.db"));
    EXPECT_FALSE(fs::exists(path("out/colmap/models.more")));
    run();
    EXPECT_EQ(commands(calls()), "");
}

TEST(PhotosPairFiles, DamagedOnesAreNone) {
    const std::vector<PhotoPlaceMatches> pairs = {{0, 1, {{{1.5, 2}, {3, 4}, 0.9}, {{5, 6}, {7, 8}, 0.8}}},
                                                  {1, 3, {}}};
    const std::string whole = pairs_as_bytes(pairs);
    const auto found = parse_pairs(whole, {{0, 1}, {1, 3}});
    ASSERT_TRUE(found);
    EXPECT_EQ((*found)[0].matches[1].other, DVec2(7, 8));
    EXPECT_EQ((*found)[0].matches[0].weight, 0.9);
    EXPECT_FALSE(parse_pairs(whole, {{0, 1}}));
    EXPECT_FALSE(parse_pairs(whole, {{0, 1}, {1, 2}}));
    EXPECT_FALSE(parse_all_pairs(whole, 3));
    EXPECT_TRUE(parse_all_pairs(whole, 4));
    for (size_t size = 0; size < whole.size(); size++)
        EXPECT_FALSE(parse_pairs(whole.substr(0, size), {{0, 1}, {1, 3}}));
    std::string huge = whole;
    huge.replace(32, 8, 8, '\xFF');
    EXPECT_FALSE(parse_all_pairs(huge, 4));
}

}  // namespace
}  // namespace treerec
