// 'treerec photos' as a user runs it: with a program that stands in for COLMAP, and with COLMAP itself.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <thread>

#include "cases.h"
#include "exchange/material_textures.h"
#include "photos/photo_picture.h"
#include "photos_standin.h"
#include "photos_warps.h"
#include "scan/formats/read_cloud.h"

namespace treerec {
namespace {

namespace fs = std::filesystem;
using test::Cli;
using test::Outcome;
using test::WithStandIn;
using namespace std::chrono_literals;

class PhotosCli : public WithStandIn<Cli> {
  protected:
    // Starts "treerec photos photos -o out", and returns its process.
    pid_t start() const {
        const pid_t child = ::fork();
        if (child != 0) return child;
        if (::chdir(folder_.c_str()) != 0) ::_exit(99);
        if (!std::freopen("stdout.log", "w", stdout) || !std::freopen("stderr.log", "w", stderr)) ::_exit(99);
        ::execl(program_.c_str(), "treerec", "photos", "photos", "-o", "out", nullptr);
        ::_exit(99);
    }
    void wait_for(const std::string& words) const {
        for (int i = 0; i < 1000 && get("out/photos.log").find(words) == std::string::npos; i++)
            std::this_thread::sleep_for(20ms);
    }
    static int end_of(pid_t process) {
        int status = 0;
        ::waitpid(process, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    }
};

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST_F(PhotosCli, PhotosBecomeATree) {
    const Outcome outcome = run("photos photos -o out --known-length 0,0,1,0,0,-1.5,2.5");
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    for (const char* name : {"tree.glb", "tree.txt", "report.json", "report.html", "stages.png",
                             "fidelity.png", "cloud.ply", "photos.log", "sparse/0/images.bin"})
        EXPECT_TRUE(fs::exists(folder_ / "out" / name)) << name;
    EXPECT_TRUE(has(outcome.out, "9 of 9 photos placed")) << outcome.out;
    EXPECT_TRUE(has(outcome.out, "4800 points")) << outcome.out;
    EXPECT_TRUE(has(outcome.out, "height 2.")) << outcome.out;
    EXPECT_TRUE(has(outcome.error, "Features\n")) << outcome.error;
    EXPECT_TRUE(has(get("out/report.json"), "\"up_from_photos\": 9")) << get("out/report.json");
    EXPECT_FALSE(has(outcome.error, "scale")) << outcome.error;
    // They are no pictures, and nothing in them was matched; what was made at another time is not left there.
    EXPECT_TRUE(has(outcome.error, "The tree has drawn bark. The photos were not matched")) << outcome.error;
    EXPECT_TRUE(has(get("out/report.json"), "\"from\": \"drawn\"")) << get("out/report.json");
    EXPECT_TRUE(has(get("out/report.json"), "so that it is not known where they show leaves."));
    put("out/bark/albedo.png", "old");
    // Nor has anybody asked their sky for its word: that it can't tell is no warning.
    EXPECT_FALSE(has(outcome.error, "not judged")) << outcome.error;
    EXPECT_TRUE(has(get("out/report.json"), "\"outline\": null")) << get("out/report.json");
    EXPECT_TRUE(has(get("out/report.html"), "There is no Q")) << outcome.error;
    // The tree alone is made again, and without a length its sizes are relative.
    calls();
    const std::string first = get("out/cloud.ply");
    const Outcome again = run("photos photos -o out --quiet");
    EXPECT_EQ(again.code, 0) << again.error;
    EXPECT_EQ(commands(calls()), "");
    EXPECT_EQ(get("out/cloud.ply"), first);
    EXPECT_FALSE(fs::exists(folder_ / "out/bark/albedo.png"));
    EXPECT_TRUE(has(again.error, "scale")) << again.error;
    // What lies there is a scan.
    EXPECT_EQ(run("reconstruct out -o out/again.txt").code, 0);
    EXPECT_EQ(run("reconstruct out/sparse/0 -o out/sparse.txt").code, 0);
}

// A folder that is not there is told before the work, and one without the masks loses nothing of it.
TEST_F(PhotosCli, MasksThatAreMissingAreTold) {
    const Outcome nowhere = run("photos photos -o out --masks nowhere");
    EXPECT_EQ(nowhere.code, 1);
    EXPECT_TRUE(has(nowhere.error, "There is no folder 'nowhere'")) << nowhere.error;
    EXPECT_EQ(commands(calls()), "");
    fs::create_directories(folder_ / "masks");
    const Outcome empty = run("photos photos -o out --masks masks --hold-out 4");
    EXPECT_EQ(empty.code, 0) << empty.error;
    EXPECT_TRUE(has(empty.error, "The tree's outline was not judged. 2 of 2 photos have no mask"))
        << empty.error;
    EXPECT_TRUE(has(get("out/report.json"), "was not judged")) << get("out/report.json");
}

TEST_F(PhotosCli, TheCleanedCloudLiesInTheCloudOfThePhotos) {
    // The folder comes with the run.
    fs::remove_all(folder_ / "out");
    const Outcome outcome = run("photos photos -o out --cloud out/clean.ply --quiet");
    ASSERT_EQ(outcome.code, 0) << outcome.error;
    const PointCloud all = read_cloud(path("out/cloud.ply")), clean = read_cloud(path("out/clean.ply"));
    EXPECT_LE(clean.size(), all.size());
    EXPECT_GT(clean.size(), all.size() / 2);
    EXPECT_EQ(clean.spacing, all.spacing);
    EXPECT_TRUE(clean.has_colors());
    size_t at = 0;
    const auto place = [](const PointCloud& cloud, size_t i) {
        return cloud.frame.to_scan(DVec3(cloud.positions[i]));
    };
    for (size_t i = 0; i < clean.size(); i++, at++) {
        while (at < all.size() && glm::length(place(all, at) - place(clean, i)) > 1e-5)
            at++;
        ASSERT_LT(at, all.size()) << i << " is no point of the photos";
    }
    // Again, and over nothing else.
    EXPECT_EQ(run("photos photos -o out --cloud out/clean.ply --quiet").code, 0);
    const std::string cloud = get("out/cloud.ply");
    for (const char* name : {"out/cloud.ply", "out/../out/cloud.ply", "out/tree.txt", "out/clean.glb"})
        EXPECT_EQ(run("photos photos -o out --quiet --cloud " + std::string(name)).code, 2) << name;
    EXPECT_EQ(get("out/cloud.ply"), cloud);
    put("mine.ply", cloud);
    EXPECT_EQ(run("photos photos -o out --quiet --cloud mine.ply").code, 2);
    EXPECT_EQ(get("mine.ply"), cloud);
}

TEST_F(PhotosCli, WrongWordsAreTold) {
    EXPECT_EQ(run("photos").code, 2);
    EXPECT_EQ(run("photos photos").code, 2);
    EXPECT_EQ(run("photos photos photos -o out").code, 2);
    EXPECT_EQ(run("photos photos -o out --order often").code, 2);
    EXPECT_EQ(run("photos photos -o out --time never").code, 2);
    EXPECT_EQ(run("photos photos -o out --matcher surf").code, 2);
    EXPECT_EQ(run("photos photos -o out --bark birch").code, 2);
    EXPECT_EQ(run("photos photos -o out --leaf-colors green").code, 2);
    EXPECT_EQ(run("photos photos -o out --show-matches a.jpg").code, 1);
    EXPECT_EQ(run("photos photos -o out --show-matches a.jpg,b.jpg").code, 1) << "they are no pictures";
    EXPECT_EQ(run("photos photos -o out --known-length 1,2").code, 2);
    EXPECT_EQ(run("photos photos -o out --height 2 --known-length 0,0,0,0,0,1,1").code, 2);
    EXPECT_EQ(run("photos nowhere -o out").code, 1);
    EXPECT_TRUE(out_is_empty());
}

// Figure 4.1 of Zhang 2013, without COLMAP.
TEST_F(PhotosCli, MatchesCanBeSeen) {
    const auto picture = [](const test::Warp& warp) {
        const std::vector<uint8_t> png = encode_png(test::draw_warped(warp, 5));
        return std::string(png.begin(), png.end());
    };
    put("photos/first one.png", picture(test::about_middle("", DMat3(1.0))));
    put("photos/a,b.png", picture(test::about_middle("", test::turned(10))));
    const Outcome outcome = run("photos photos -o out --show-matches 'first one.png,a,b.png'");
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    EXPECT_TRUE(has(outcome.out, "of the improved one")) << outcome.out;
    const auto shown = decode_picture(get("out/matches_first one_a,b.png"), 3);
    ASSERT_TRUE(shown);
    EXPECT_EQ(shown->width, 2 * test::kDrawnWidth + 8);
    EXPECT_EQ(shown->height, 2 * test::kDrawnHeight + 8);
    EXPECT_EQ(commands(calls()), "");
    EXPECT_FALSE(fs::exists(folder_ / "out/colmap"));
}

TEST_F(PhotosCli, ControlCEndsColmapToo) {
    standin_does(" exhaustive_matcher=hang ");
    const pid_t process = start();
    wait_for("hanging");
    ::kill(process, SIGINT);
    EXPECT_EQ(end_of(process), 1);
    EXPECT_TRUE(has(get("stderr.log"), "Cancelled.")) << get("stderr.log");
    const std::string sleeper = get("words.sleeper");
    std::string state = "R";
    for (int i = 0; i < 100 && state != "" && !has(state, ") Z"); i++) {
        std::this_thread::sleep_for(20ms);
        std::ifstream stat("/proc/" + sleeper.substr(0, sleeper.find('\n')) + "/stat");
        state.clear();
        std::getline(stat, state);
    }
    EXPECT_TRUE(state.empty() || has(state, ") Z")) << state;
}

TEST_F(PhotosCli, GoesOnAfterAKill) {
    const std::pair<const char*, const char*> moments[] = {
        {"feature_extractor", "Processed file [4/9]"},
        {"exhaustive_matcher", "Matching block [1/2, 2/2]"},
        {"mapper", "Registering image #4"}};
    std::string commands_after[] = {"feature_extractor exhaustive_matcher mapper",
                                    "exhaustive_matcher mapper", "mapper"};
    std::string cloud;
    for (size_t i = 0; i < 3; i++) {
        fs::remove_all(folder_ / "out");
        calls();
        standin_does(std::string(" ") + moments[i].first + "=slow ");
        const pid_t process = start();
        wait_for(moments[i].second);
        ::kill(process, SIGKILL);
        EXPECT_EQ(end_of(process), 1000 + SIGKILL);
        calls();
        standin_does("");
        const Outcome outcome = run("photos photos -o out");
        EXPECT_EQ(outcome.code, 0) << outcome.error;
        const std::vector<Words> told = calls();
        EXPECT_EQ(commands(told), commands_after[i]);
        // The rest of the photos have the same camera as those before.
        if (i == 0) {
            EXPECT_EQ(value_of(told[0], "--ImageReader.existing_camera_id"), "1");
        }
        EXPECT_FALSE(fs::exists(folder_ / "out/colmap/models.part"));
        if (i == 0) cloud = get("out/cloud.ply");
        EXPECT_EQ(get("out/cloud.ply"), cloud);
    }
}

TEST_F(PhotosCli, ASecondRunInTheSameFolderIsKeptOut) {
    standin_does(" exhaustive_matcher=hang ");
    const pid_t process = start();
    wait_for("hanging");
    const Outcome second = run("photos photos -o out");
    EXPECT_EQ(second.code, 1);
    EXPECT_TRUE(has(second.error, "Another run works in")) << second.error;
    ::kill(process, SIGTERM);
    EXPECT_EQ(end_of(process), 1);
}

// COLMAP itself, where it is installed.
TEST_F(PhotosCli, RealPhotosWithColmapItself) {
    const char* scans = std::getenv("TREEREC_SCANS");
    if (!test::is_long_run()) GTEST_SKIP() << "It takes a minute: './dev test --long unit' has it.";
    if (!scans) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of real scans.";
    if (std::system("colmap -h >/dev/null 2>&1") != 0) GTEST_SKIP() << "COLMAP is not installed.";
    ::unsetenv("COLMAP");
    fs::remove_all(folder_ / "photos");
    fs::create_directories(folder_ / "photos");
    // Neighbours on the orbit, whose first and last photos meet between the eighth and the ninth of these.
    for (const int number :
         {8874, 8876, 8878, 8880, 8882, 8884, 8886, 8888, 8902, 8904, 8906, 8908, 8910, 8912}) {
        const std::string name = "_DSC" + std::to_string(number) + ".JPG";
        const fs::path photo = fs::path(scans) / "photos" / "treehill_71" / name;
        if (!fs::exists(photo)) GTEST_SKIP() << photo << " is not there.";
        fs::create_symlink(photo, folder_ / "photos" / name);
    }
    for (const std::string matcher : {"sift", "pyrlk", "both"}) {
        const Outcome outcome = run("photos photos -o out --time quick --matcher " + matcher);
        EXPECT_EQ(outcome.code, 0) << outcome.error;
        EXPECT_TRUE(fs::exists(folder_ / "out/tree.glb"));
        EXPECT_TRUE(has(outcome.out, " of 14 photos placed")) << matcher << outcome.out;
        EXPECT_TRUE(has(get("out/report.json"), "up_from_photos")) << outcome.error;
    }
}

}  // namespace
}  // namespace treerec
