// COLMAP's stages, with a program that stands in for it (photos_standin.h).
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "file_bytes.h"
#include "photos/cameras_tell.h"
#include "photos/find_colmap.h"
#include "photos/make_cloud.h"
#include "photos/run_colmap.h"
#include "photos/sparse_points.h"
#include "photos_standin.h"
#include "scan/formats/read_cloud.h"

namespace treerec {
namespace {

namespace fs = std::filesystem;
using test::InFolder;
using test::WithStandIn;
using namespace std::chrono_literals;

class RunColmap : public WithStandIn<InFolder> {
  protected:
    // Corners are tracked in pictures that show something: photos_track_test.cpp has these.
    static ColmapOptions sift() {
        ColmapOptions options;
        options.matcher = PhotoMatcher::kSift;
        return options;
    }
    ColmapRun run(const ColmapOptions& options = sift(), Progress* progress = nullptr) {
        return run_colmap(path("photos"), path("out"), options, progress);
    }
    std::string sentence(const ColmapOptions& options = sift()) {
        try {
            run(options);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }
    // Every file below the test's folder but those that the run may write, with its bytes and time.
    std::vector<std::string> rest() const {
        std::vector<std::string> files;
        for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
            const std::string name = fs::relative(entry.path(), folder_).string();
            if (name.starts_with("out") || name == "words" || name == "words.sleeper") continue;
            std::string told = name;
            if (entry.is_regular_file())
                told += get(name) + std::to_string(entry.last_write_time().time_since_epoch().count());
            files.push_back(told);
        }
        std::sort(files.begin(), files.end());
        return files;
    }
};

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST_F(RunColmap, GivesEachVersionItsOwnOptions) {
    for (const std::string version : {"3.8", "4"}) {
        ::setenv("STANDIN_VERSION", version.c_str(), 1);
        fs::remove_all(path("out"));
        const std::vector<std::string> before = rest();
        const ColmapRun result = run();
        EXPECT_EQ(result.version, version == "4" ? "4.0.1" : "3.8");
        EXPECT_EQ(result.photos, 9u);
        EXPECT_EQ(result.registered, 9u);
        EXPECT_TRUE(result.missing.empty());
        EXPECT_TRUE(result.warnings.empty()) << result.warnings[0];
        EXPECT_TRUE(fs::exists(folder_ / "out/sparse/0/points3D.bin"));
        EXPECT_EQ(rest(), before) << "something was written outside of OUT";
        EXPECT_TRUE(has(get("out/photos.log"), "Processed file [9/9]"));
        const std::vector<Words> told = calls();
        ASSERT_EQ(commands(told), "feature_extractor exhaustive_matcher mapper");
        EXPECT_EQ(value_of(told[2], "--Mapper.abs_pose_min_num_inliers"), "20");
        const std::string extraction = version == "4" ? "--FeatureExtraction" : "--SiftExtraction";
        EXPECT_EQ(value_of(told[0], extraction + ".use_gpu"), "0");
        EXPECT_EQ(value_of(told[0], extraction + ".max_image_size"), "1600");
        EXPECT_EQ(value_of(told[0], "--ImageReader.single_camera"), "1");
        EXPECT_EQ(value_of(told[0], "--ImageReader.camera_model"), "RADIAL");
        EXPECT_EQ(value_of(told[1], (version == "4" ? "--FeatureMatching" : "--SiftMatching") +
                                        std::string(".use_gpu")),
                  "0");
    }
}

TEST_F(RunColmap, TakesAnyFileName) {
    take_photos({"a b.jpg", "b'c\".JPG", "в лесу.jpeg", "$(rm -rf x).png", "d;e&f.jpg", "#g.jpg", "-h.jpg",
                 "i%d.tif"});
    put("photos/notes.txt", "not a photo");
    put("photos/._a b.jpg", "macOS's");
    fs::rename(folder_ / "photos", folder_ / "фото 'und' mehr");
    const ColmapRun result = run_colmap(path("фото 'und' mehr"), path("out/в \"саду\""), {});
    EXPECT_EQ(result.registered, 8u);
    EXPECT_TRUE(result.missing.empty());
    std::string list = get("out/в \"саду\"/colmap/photos.txt");
    EXPECT_TRUE(has(list, "в лесу.jpeg\n"));
    EXPECT_FALSE(has(list, "notes"));
    EXPECT_EQ(std::count(list.begin(), list.end(), '\n'), 8);
}

TEST_F(RunColmap, ANameThatCannotBeToldIsASentence) {
    put("photos/ blank.jpg", test::tiny_jpeg(640, 480));
    EXPECT_TRUE(has(sentence(), "rename it"));
}

TEST_F(RunColmap, DoesNothingTwice) {
    run();
    calls();
    const ColmapRun again = run();
    EXPECT_EQ(again.registered, 9u);
    EXPECT_EQ(commands(calls()), "");
}

TEST_F(RunColmap, OtherPhotosBeginAnew) {
    run();
    calls();
    put("photos/new.jpg", test::tiny_jpeg(640, 480));
    EXPECT_EQ(run().missing, std::vector<std::string>{"new.jpg"});
    EXPECT_EQ(commands(calls()), "feature_extractor exhaustive_matcher mapper");
    put("photos/a.jpg", test::tiny_jpeg(640, 480) + "other pixels");
    run();
    EXPECT_EQ(commands(calls()), "feature_extractor exhaustive_matcher mapper");
    // What was found in other photos before is no part of it.
    const std::string database = get("out/colmap/features.db");
    EXPECT_EQ(std::count(database.begin(), database.end(), '\n'), 10);
}

TEST_F(RunColmap, OtherOptionsDoAgainWhatTheyChange) {
    run();
    calls();
    ColmapOptions options;
    options.order = PhotoOrder::kSequence;
    run(options);
    const std::vector<Words> told = calls();
    EXPECT_EQ(commands(told), "sequential_matcher matches_importer mapper");
    EXPECT_TRUE(has(get("out/colmap/closing.txt"), "a.jpg i.jpg\n"));
    options.effort = PhotoEffort::kQuick;
    run(options);
    EXPECT_EQ(commands(calls()), "feature_extractor sequential_matcher matches_importer mapper");
    options.threads = 1;
    run(options);
    EXPECT_EQ(commands(calls()), "") << "threads change nothing";
}

TEST_F(RunColmap, PhotosOfSeveralSizesHaveCamerasOfTheirOwn) {
    put("photos/a.jpg", test::tiny_jpeg(480, 640));
    run();
    const std::vector<Words> told = calls();
    EXPECT_EQ(value_of(told[0], "--ImageReader.single_camera"), "");
    EXPECT_EQ(value_of(told[0], "--ImageReader.camera_model"), "");
}

TEST_F(RunColmap, ManyPhotosAreMatchedInSequence) {
    std::vector<std::string> names;
    for (int i = 100; i < 190; i++)
        names.push_back(std::to_string(i) + ".jpg");
    take_photos(names);
    run();
    EXPECT_EQ(commands(calls()), "feature_extractor sequential_matcher matches_importer mapper");
}

TEST_F(RunColmap, ItsFailureIsToldWithItsLastWords) {
    for (const std::string command : {"feature_extractor", "exhaustive_matcher", "mapper"}) {
        standin_does(" " + command + "=exit1 ");
        const std::string told = sentence();
        EXPECT_TRUE(has(told, "COLMAP's " + command + " ended with exit code 1")) << told;
        EXPECT_TRUE(has(told, "the disk is on fire")) << told;
        EXPECT_TRUE(has(told, "photos.log")) << told;
        EXPECT_FALSE(fs::exists(folder_ / "out/sparse"));
    }
    // And the next time it goes on from there.
    standin_does("");
    calls();
    run();
    EXPECT_EQ(commands(calls()), "mapper");
}

TEST_F(RunColmap, OneThatHangsIsCancelled) {
    class Stop : public Progress {
      public:
        explicit Stop(const std::string& file) : file_(file) {}
        bool cancelled() const override { return fs::exists(file_); }
        std::string file_;
    } stop(path("words.sleeper"));
    for (const std::string command : {"feature_extractor", "exhaustive_matcher", "mapper"}) {
        fs::remove(path("words.sleeper"));
        standin_does(" " + command + "=hang ");
        const auto start = std::chrono::steady_clock::now();
        EXPECT_THROW(run({}, &stop), Cancelled);
        EXPECT_LT(std::chrono::steady_clock::now() - start, 30s);
    }
    standin_does("");
    EXPECT_EQ(run().registered, 9u);
}

TEST_F(RunColmap, NoneAtAllIsASentence) {
    ColmapOptions options;
    options.program = path("no such program");
    EXPECT_TRUE(has(sentence(options), "Install")) << sentence(options);
    ::setenv("COLMAP", path("neither").c_str(), 1);
    EXPECT_TRUE(has(sentence(), "There is no program COLMAP at")) << sentence();
    options.program = "/bin/ls";
    EXPECT_TRUE(has(sentence(options), "does not answer as COLMAP does")) << sentence(options);
    EXPECT_TRUE(fs::is_empty(folder_ / "out"));
}

TEST_F(RunColmap, IsFoundByItsFolderAndOnThePath) {
    EXPECT_EQ(find_colmap((folder_ / "colmap program").string()).program(), program().string());
    put_program(folder_ / "unpacked" / "bin" / "colmap");
    EXPECT_EQ(find_colmap(path("unpacked")).program(), path("unpacked/bin/colmap"));
    EXPECT_EQ(find_colmap(path("unpacked/COLMAP.bat")).program(), path("unpacked/bin/colmap"));
    EXPECT_EQ(find_colmap("").program(), program().string());
    ::unsetenv("COLMAP");
    const std::string before = std::getenv("PATH");
    ::setenv("PATH", (path("unpacked/bin") + ":" + before).c_str(), 1);
    EXPECT_EQ(find_colmap("").program(), path("unpacked/bin/colmap"));
    EXPECT_EQ(find_colmap("colmap").program(), path("unpacked/bin/colmap"));
    ::setenv("PATH", before.c_str(), 1);
}

TEST_F(RunColmap, TooFewPhotosAreASentence) {
    take_photos({"a.jpg", "b.jpg", "c.jpg"});
    EXPECT_TRUE(has(sentence(), "There are 3 photos")) << sentence();
    EXPECT_TRUE(fs::is_empty(folder_ / "out"));
}

TEST_F(RunColmap, WhatIsNoPhotoIsASentence) {
    const auto only = [&](const std::string& name) {
        fs::remove_all(folder_ / "photos");
        fs::create_directories(folder_ / "photos");
        put("photos/" + name, "bytes");
        return sentence();
    };
    EXPECT_TRUE(has(only("IMG_1.HEIC"), "heif-convert"));
    EXPECT_TRUE(has(only("walk.MOV"), "no photos"));
    EXPECT_TRUE(has(only("scan.ply"), "There are no photos"));
    fs::remove_all(folder_ / "photos");
    EXPECT_TRUE(has(sentence(), "is no folder"));
}

TEST_F(RunColmap, SomeHeicAmongThemAreAWarning) {
    put("photos/z.heic", "bytes");
    const ColmapRun result = run();
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_TRUE(has(result.warnings[0], "1 picture in")) << result.warnings[0];
}

TEST_F(RunColmap, NonePlacedIsAdvice) {
    standin_does(" mapper=none ");
    EXPECT_TRUE(has(sentence(), "overlap too little")) << sentence();
    ::setenv("STANDIN_FEATURES", "120", 1);
    fs::remove_all(path("out"));
    const std::string told = sentence();
    EXPECT_TRUE(has(told, "blurred")) << told;
    EXPECT_TRUE(has(told, "120 features")) << told;
    // Also where the features are known from before.
    EXPECT_EQ(sentence(), told);
}

TEST_F(RunColmap, APartOfThePhotosAndAGapAreTold) {
    test::write_tiny_model(folder_ / "models" / "0",
                           {{"a.jpg", "b.jpg", "c.jpg", "d.jpg", "e.jpg", "f.jpg"}, 0.0, 180.0});
    const ColmapRun result = run();
    EXPECT_EQ(result.registered, 6u);
    EXPECT_EQ(result.missing, (std::vector<std::string>{"g.jpg", "h.jpg", "i.jpg"}));
    ASSERT_TRUE(result.widest_gap);
    EXPECT_NEAR(result.widest_gap->degrees, 210.0, 0.5);
    // Neither way around is the first one.
    EXPECT_EQ(result.widest_gap->from + result.widest_gap->to == "f.jpga.jpg" ||
                  result.widest_gap->from + result.widest_gap->to == "a.jpgf.jpg",
              true);
    ASSERT_EQ(result.warnings.size(), 2u);
    EXPECT_TRUE(has(result.warnings[0], "6 of 9 photos")) << result.warnings[0];
    EXPECT_TRUE(has(result.warnings[0], "g.jpg, h.jpg, i.jpg")) << result.warnings[0];
    EXPECT_TRUE(has(result.warnings[1], "210 degrees")) << result.warnings[1];
}

TEST_F(RunColmap, OfSeveralModelsTheLargestIsTaken) {
    std::vector<std::string> first, second;
    for (int i = 0; i < 21; i++)
        (i < 9 ? first : second).push_back("photo" + std::to_string(i) + ".jpg");
    std::vector<std::string> all = first;
    all.insert(all.end(), second.begin(), second.end());
    take_photos(all);
    test::write_tiny_model(folder_ / "models" / "0", {first});
    test::write_tiny_model(folder_ / "models" / "1", {second});
    const ColmapRun result = run();
    EXPECT_EQ(result.registered, 12u);
    ASSERT_FALSE(result.warnings.empty());
    EXPECT_TRUE(has(result.warnings[0], "two scenes")) << result.warnings[0];
    EXPECT_TRUE(has(result.warnings[0], "of 12 and 9 photos")) << result.warnings[0];
    EXPECT_FALSE(fs::exists(folder_ / "out/sparse/1"));
}

TEST_F(RunColmap, WhatIsSomebodyElsesStays) {
    for (const std::string name :
         {"out/cloud.ply", "out/photos.log", "out/sparse", "out/colmap", "out/tree.glb", "out/tree.txt",
          "out/report.json", "out/report.html", "out/compare.png", "out/stages.png", "out/fidelity.png"}) {
        put(name, "theirs");
        EXPECT_TRUE(has(sentence(), "is there already")) << name << ": " << sentence();
        EXPECT_EQ(get(name), "theirs");
        fs::remove(folder_ / name);
    }
    EXPECT_THROW(run_colmap(path("photos"), path("photos"), {}), Error);
    EXPECT_EQ(sentence(), "");
}

TEST_F(RunColmap, CountsPhotos) {
    class Listener : public Progress {
      public:
        void update(double fraction, const char* stage) override {
            EXPECT_GE(fraction, fraction_);
            EXPECT_LE(fraction, 1.0);
            fraction_ = fraction;
            stage_ = stage;
        }
        void count(size_t done, size_t all) override {
            told_ += stage_ + " " + std::to_string(done) + " of " + std::to_string(all) + "\n";
        }
        double fraction_ = 0.0;
        std::string stage_, told_;
    } listener;
    run({}, &listener);
    EXPECT_TRUE(has(listener.told_, "Features 3 of 9\n")) << listener.told_;
    EXPECT_TRUE(has(listener.told_, "Matching 3 of 4\n")) << listener.told_;
    EXPECT_TRUE(has(listener.told_, "Cameras 5 of 9\n")) << listener.told_;
}

TEST_F(RunColmap, TheCloudHasWhatSeveralPhotosSawWell) {
    const ColmapRun result = run();
    const MadeCloud made = make_cloud(result.model, path("photos"), path("out/cloud.ply"), {});
    // Of ten points one is seen by two photos, and one is 3.5 pixels off.
    EXPECT_EQ(made.points, 4800u);
    EXPECT_EQ(made.left_out, 1200u);
    const PointCloud cloud = read_cloud(path("out/cloud.ply"));
    EXPECT_EQ(cloud.size(), 4800u);
    ASSERT_TRUE(cloud.has_colors());
    EXPECT_EQ(cloud.colors[0], (Color8{0x60, 0x50, 0x40}));
    EXPECT_EQ(photo_models_beside(path("out/cloud.ply")).size(), 1u);
}

TEST_F(RunColmap, DamagedPointsAreASentence) {
    test::write_tiny_model(folder_ / "model", {names_});
    const std::string whole = get("model/points3D.bin");
    EXPECT_EQ(parse_sparse_points(whole, false, "name").size(), 6000u);
    Random random(5);
    for (int i = 0; i < 200; i++) {
        const std::string cut = whole.substr(0, random.below(static_cast<uint32_t>(whole.size())));
        EXPECT_THROW(parse_sparse_points(cut, false, "name"), Error);
    }
    const std::vector<SparsePoint> text = parse_sparse_points(
        "# words\n1 0.5 -1 2 10 20 30 0.25 1 7 2 9 5 1\n\n2 1 2 3 4 5 6 0.5\n", true, "name");
    ASSERT_EQ(text.size(), 2u);
    EXPECT_EQ(text[0].track, 3u);
    EXPECT_EQ(text[0].error, 0.25);
    EXPECT_EQ(text[0].position, DVec3(0.5, -1.0, 2.0));
    EXPECT_EQ(text[0].color, (Color8{10, 20, 30}));
    EXPECT_EQ(text[1].track, 0u);
    EXPECT_THROW(parse_sparse_points("1 2 3\n", true, "name"), Error);
}

TEST_F(RunColmap, AFolderOfColmapIsACloud) {
    run();
    EXPECT_EQ(cloud_file_of(path("out/sparse/0")), path("out/sparse/0/points3D.bin"));
    EXPECT_EQ(cloud_file_of(path("out/sparse")), path("out/sparse/0/points3D.bin"));
    EXPECT_EQ(cloud_file_of(path("out")), path("out/sparse/0/points3D.bin"));
    put("out/cloud.ply", "denser");
    EXPECT_EQ(cloud_file_of(path("out")), path("out/cloud.ply"));
    EXPECT_EQ(cloud_file_of(path("photos")), path("photos"));
    EXPECT_EQ(read_cloud(path("out/sparse")).size(), 6000u);
    EXPECT_THROW(read_cloud(path("photos")), Error);
}

}  // namespace
}  // namespace treerec
