// Films that become photos.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "cli_runner.h"
#include "error.h"
#include "geometry/random.h"
#include "photos/choose_frames.h"
#include "photos/film_frames.h"
#include "photos/photo_folder.h"
#include "photos/photo_picture.h"
#include "photos_standin.h"

namespace treerec {
namespace {

namespace fs = std::filesystem;

// A wall of blurred noise, wider than any picture of it.
Image wall(uint64_t seed) {
    Random random(seed);
    Image picture(1600, 120, 1);
    for (uint8_t& pixel : picture.pixels)
        pixel = static_cast<uint8_t>(255.0 * random.uniform());
    for (int times = 0; times < 2; times++)
        for (int y = 0; y < picture.height; y++)
            for (int x = 1; x + 1 < picture.width; x++)
                *picture.at(x, y) = static_cast<uint8_t>(
                    (*picture.at(x - 1, y) + 2 * *picture.at(x, y) + *picture.at(x + 1, y)) / 4);
    return picture;
}

// What is seen of it from `left`, a part of a pixel counted.
Image view(const Image& wall, double left, int width = 160, int height = 90) {
    Image picture(width, height, 1);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const double at = left + x;
            const int whole = static_cast<int>(std::floor(at));
            const double part = at - whole;
            *picture.at(x, y) = static_cast<uint8_t>(
                std::lround((1.0 - part) * *wall.at(whole, y) + part * *wall.at(whole + 1, y)));
        }
    return picture;
}

TEST(PhotosFilm, MotionIsFoundToAPartOfAPixel) {
    const Image all = wall(3);
    for (const double moved : {0.0, 0.4, -1.3, 3.0, -6.75, 8.5}) {
        const SideMotion found = motion_between(view(all, 400.0), view(all, 400.0 - moved));
        EXPECT_NEAR(found.left * 160.0, moved, 0.25) << moved;
        EXPECT_NEAR(found.right * 160.0, moved, 0.25) << moved;
    }
    // An even sky tells nothing, and what stays before a background that moves does not count.
    EXPECT_EQ(motion_between(Image(160, 90, 1), Image(160, 90, 1)).right, 0.0);
    Image before = view(all, 400.0), after = view(all, 396.0);
    for (int y = 0; y < 90; y++)
        for (int x = 48; x < 112; x++)
            *before.at(x, y) = *after.at(x, y) = *all.at(x, y);
    EXPECT_NEAR(motion_between(before, after).right * 160.0, 4.0, 0.25);
    EXPECT_NEAR(motion_between(before, after).left * 160.0, 0.0, 0.25);
    // What lies before the tree moves to the other side.
    const Image ground_before = view(all, 700.0), ground_after = view(all, 706.0);
    for (int y = 45; y < 90; y++)
        for (int x = 0; x < 160; x++) {
            *before.at(x, y) = *ground_before.at(x, y);
            *after.at(x, y) = *ground_after.at(x, y);
        }
    EXPECT_NEAR(motion_between(before, after).right * 160.0, 4.0, 0.25);
    EXPECT_NEAR(motion_between(before, after).left * 160.0, -6.0, 0.25);
    EXPECT_EQ(motion_between(Image(16, 16, 1), Image(17, 16, 1)).left, 0.0);
}

TEST(PhotosFilm, SharpnessFallsWithBlur) {
    const Image sharp = view(wall(5), 100.0);
    Image blurred = sharp;
    for (int y = 0; y < sharp.height; y++)
        for (int x = 2; x + 2 < sharp.width; x++) {
            int sum = 0;
            for (int k = -2; k <= 2; k++)
                sum += *sharp.at(x + k, y);
            *blurred.at(x, y) = static_cast<uint8_t>(sum / 5);
        }
    EXPECT_LT(sharpness_of(blurred), 0.5 * sharpness_of(sharp));
    EXPECT_EQ(sharpness_of(Image(1, 1, 1)), 0.0);
}

// Random walks: the frames are a step apart, whatever shakes and stops there were.
TEST(PhotosFilm, FramesAreAStepOfTheWalkApart) {
    for (uint64_t seed = 1; seed <= 60; seed++) {
        Random random(seed);
        const double pace = 0.004 + 0.02 * random.uniform(), side = random.uniform() < 0.5 ? -1.0 : 1.0;
        std::vector<FrameLook> frames;
        std::vector<double> way;
        double at = 0.0;
        bool walks = true;
        for (int i = 0; i < 600; i++) {
            if (random.uniform() < 0.02) walks = !walks;
            const double shake = i % 2 ? 0.003 : -0.003;
            // What lies before the tree goes the other way, or isn't seen for a while.
            const double far = side * (walks ? pace : 0.0) + shake,
                         near = i % 200 < 100 ? shake - 0.9 * side * (walks ? pace : 0.0) : shake;
            frames.push_back({{std::min(far, near), std::max(far, near)}, random.uniform()});
            at += walks ? pace : 0.0;
            way.push_back(at);
        }
        const FrameChoice choice;
        const std::vector<size_t> chosen = choose_frames(frames, choice);
        if (at < 0.3) {
            EXPECT_TRUE(chosen.empty()) << seed;
            continue;
        }
        if (at < 1.0) continue;
        EXPECT_LE(chosen.size(), choice.most) << seed;
        EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
        const double step = at / std::clamp(at / choice.step, 48.0, 120.0);
        for (size_t k = 1; k < chosen.size(); k++)
            EXPECT_LT(way[chosen[k]] - way[chosen[k - 1]], 2.0 * step + 5.0 * pace) << seed;
        // No frame of a pair within a step is sharper.
        EXPECT_EQ(choose_frames(frames, choice), chosen);
    }
}

TEST(PhotosFilm, OddFilmsAreNone) {
    EXPECT_TRUE(choose_frames({}).empty());
    const std::vector<FrameLook> still(500, FrameLook{{0.0, 0.0}, 1.0});
    EXPECT_TRUE(choose_frames(still).empty());
    std::vector<FrameLook> shaken(500);
    for (size_t i = 0; i < shaken.size(); i++)
        shaken[i] = i % 2 ? FrameLook{{0.02, 0.02}, 1.0} : FrameLook{{-0.02, -0.02}, 1.0};
    EXPECT_TRUE(choose_frames(shaken).empty());
    std::vector<FrameLook> broken(500, FrameLook{{0.01, 0.01}, 1.0});
    broken[7] = {{NAN, NAN}, NAN};
    EXPECT_FALSE(choose_frames(broken).empty());
}

class PhotosFilmFile : public test::WithStandIn<test::Cli> {
  protected:
    static constexpr double kWall = 1265.0;  // pixels

    // Makes a film of a walk past a wall with ffmpeg; false where that is not installed. pace: pixels from
    // frame to frame, of 320, and back again at the wall's end; rate: frames of a second.
    bool film(const std::string& name, int frames, double pace, int rate = 10) const {
        if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) return false;
        const Image all = wall(11);
        std::ofstream out(folder_ / "frames.pgm", std::ios::binary);
        for (int i = 0; i < frames; i++) {
            const double way = std::fmod(pace * i, 2.0 * kWall);
            const Image picture = view(all, 10.0 + std::min(way, 2.0 * kWall - way), 320, 96);
            out << "P5\n320 96\n255\n";
            out.write(reinterpret_cast<const char*>(picture.pixels.data()),
                      static_cast<std::streamsize>(picture.pixels.size()));
        }
        out.close();
        const std::string command = "cd '" + folder_.string() +
                                    "' && ffmpeg -v error -y -f image2pipe -framerate " +
                                    std::to_string(rate) +
                                    " -c:v pgm -i frames.pgm "
                                    "-c:v mpeg4 -q:v 2 film.mp4 && mv film.mp4 \"./$NAME\"";
        ::setenv("NAME", name.c_str(), 1);
        return std::system(command.c_str()) == 0;
    }

    // The photos' names in out/frames, in their order.
    std::vector<std::string> frames() const {
        std::vector<std::string> names;
        for (const PhotoFile& photo : list_photos(path("out/frames")).photos)
            names.push_back(photo.name);
        return names;
    }
};

TEST_F(PhotosFilmFile, AWalkBecomesPhotos) {
    // A name that is no option, no pattern and no word of ASCII.
    const std::string name = "-walk 100% 'дуб'.mp4";
    if (!film(name, 300, 4.0)) GTEST_SKIP() << "ffmpeg is not installed.";
    const FilmPhotos photos = photos_of_film(path(name), path("out"));
    EXPECT_GE(photos.photos, 45U);
    EXPECT_LE(photos.photos, 120U);
    const std::vector<std::string> names = frames();
    ASSERT_EQ(names.size(), photos.photos);
    EXPECT_FALSE(fs::exists(folder_ / "out" / "colmap" / "film.pgm"));
    const auto written = fs::last_write_time(folder_ / "out" / "frames" / names[0]);
    const FilmPhotos again = photos_of_film(path(name), path("out"));
    EXPECT_EQ(again.photos, photos.photos);
    EXPECT_NEAR(again.seconds, photos.seconds, 1e-3);
    EXPECT_EQ(fs::last_write_time(folder_ / "out" / "frames" / names[0]), written);
    // A frame that somebody took away is made again.
    fs::remove(folder_ / "out" / "frames" / names[1]);
    EXPECT_EQ(photos_of_film(path(name), path("out")).photos, photos.photos);
    EXPECT_EQ(frames(), names);
    // A folder with it in it means the same.
    fs::create_directories(folder_ / "phone");
    fs::rename(folder_ / name, folder_ / "phone" / name);
    ASSERT_TRUE(film_of(path("phone")));
    fs::copy_file(folder_ / "phone" / name, folder_ / "phone" / "b.mov");
    EXPECT_THROW(film_of(path("phone")), Error);
    fs::remove(folder_ / "phone" / "b.mov");
    // A stray photo beside it makes no folder of photos; enough of them do, and the film is told.
    for (size_t i = 1; i <= kLeastPhotos; i++) {
        fs::copy_file(folder_ / "photos" / "a.jpg", folder_ / "phone" / (std::to_string(i) + ".jpg"));
        EXPECT_EQ(film_of(path("phone")).has_value(), i < kLeastPhotos) << i;
    }
    const PhotoFolder beside = list_photos(path("phone"));
    ASSERT_EQ(beside.warnings.size(), 1U);
    EXPECT_NE(beside.warnings[0].find("name the film"), std::string::npos) << beside.warnings[0];
}

// What a photo shows is what the film shows at the time that its name tells, also where that isn't looked at
// as often as it has frames: a place beside it would be seen by whoever knows where the camera was.
TEST_F(PhotosFilmFile, NamesTellWhereInTheFilmTheyAre) {
    constexpr double kPace = 2.0;
    if (!film("walk.mp4", 630, kPace, 30)) GTEST_SKIP() << "ffmpeg is not installed.";
    photos_of_film(path("walk.mp4"), path("out"));
    const Image all = wall(11);
    const std::vector<std::string> names = frames();
    ASSERT_GE(names.size(), 40U);
    for (size_t i = 0; i < names.size(); i += 5) {
        double seconds = -1.0;
        ASSERT_EQ(std::sscanf(names[i].c_str(), "frame_%lfs.jpg", &seconds), 1) << names[i];
        const Image shown = read_photo(path("out/frames/" + names[i]));
        double best = INFINITY;
        int found = -1;
        for (int frame = 0; frame < 630; frame++) {
            const Image there = view(all, 10.0 + kPace * frame, 320, 96);
            double sum = 0.0;
            for (int y = 8; y < 96; y += 16)
                for (int x = 0; x < 320; x++)
                    sum +=
                        std::abs(static_cast<double>(*shown.at(x, y)) - static_cast<double>(*there.at(x, y)));
            if (sum < best) {
                best = sum;
                found = frame;
            }
        }
        EXPECT_EQ(found, static_cast<int>(std::floor(30.0 * seconds + 0.05))) << names[i];
    }
}

// More photos than ffmpeg adds up in a row.
TEST_F(PhotosFilmFile, ALongWalkIsManyPhotos) {
    if (!film("walk.mp4", 300, 8.0)) GTEST_SKIP() << "ffmpeg is not installed.";
    EXPECT_GT(photos_of_film(path("walk.mp4"), path("out")).photos, 105U);
}

// From one tenth of a second to the next more moves than is found again.
TEST_F(PhotosFilmFile, AQuickWalkIsOne) {
    if (!film("walk.mp4", 90, 8.0, 30)) GTEST_SKIP() << "ffmpeg is not installed.";
    EXPECT_GE(photos_of_film(path("walk.mp4"), path("out")).photos, 30U);
    EXPECT_EQ(frames().front().substr(0, 10), "frame_0000");
}

TEST_F(PhotosFilmFile, TheProgramTakesAFilm) {
    if (!film("walk.mp4", 300, 4.0)) GTEST_SKIP() << "ffmpeg is not installed.";
    // The stand-in's model is of these photos.
    photos_of_film(path("walk.mp4"), path("out"));
    std::vector<std::string> names = frames();
    ASSERT_GE(names.size(), 12U);
    names.resize(12);
    fs::remove_all(folder_ / "models");
    test::write_tiny_model(folder_ / "models" / "0", {names});
    const test::Outcome outcome = run("photos walk.mp4 -o out --sparse");
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    EXPECT_NE(outcome.error.find("Film"), std::string::npos) << outcome.error;
    EXPECT_TRUE(fs::exists(folder_ / "out" / "tree.glb"));
    bool sequence = false;
    for (const Words& call : calls())
        sequence = sequence || call[0] == "sequential_matcher";
    EXPECT_TRUE(sequence) << "The frames were not taken for a sequence.";
}

TEST_F(PhotosFilmFile, WhatIsNoFilmIsTold) {
    std::ofstream(folder_ / "words.mp4") << "no film at all";
    const auto sentence_of = [&](const std::string& name) {
        try {
            photos_of_film(path(name), path("out"));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    ::setenv("FFMPEG", path("nowhere").c_str(), 1);
    EXPECT_NE(sentence_of("words.mp4").find("$FFMPEG"), std::string::npos);
    ::unsetenv("FFMPEG");
    EXPECT_THROW(film_of(path("photos/a.jpg")), Error);
    EXPECT_NE(sentence_of("none.mp4").find("no film"), std::string::npos);
    if (!film("still.mp4", 40, 0.0)) GTEST_SKIP() << "ffmpeg is not installed.";
    EXPECT_NE(sentence_of("words.mp4").find("is no film"), std::string::npos) << sentence_of("words.mp4");
    EXPECT_NE(sentence_of("still.mp4").find("no walk"), std::string::npos) << sentence_of("still.mp4");
    EXPECT_FALSE(fs::exists(folder_ / "out" / "colmap" / "film.pgm"));
    // What somebody else put there stays.
    fs::create_directories(folder_ / "mine" / "colmap");
    fs::create_directories(folder_ / "mine" / "frames");
    EXPECT_THROW(photos_of_film(path("still.mp4"), path("mine")), Error);
    EXPECT_TRUE(fs::exists(folder_ / "mine" / "frames"));
}

}  // namespace
}  // namespace treerec
