// HEIC photos that become JPEGs.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "cli_runner.h"
#include "error.h"
#include "photos/film_frames.h"
#include "photos/heic_photos.h"
#include "photos/photo_folder.h"
#include "photos_standin.h"

namespace treerec {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

// In place of heif-convert: writes down its words, and does what the photo's own bytes say.
constexpr const char* kConverter = R"sh(#!/bin/sh
{ echo =; for word in "$@"; do printf '%s\n' "$word"; done; } >>"$CONVERTER_LOG"
from=$3 to=$4
case $(head -c 6 "$from") in
broken) echo "no HEIC at all" >&2; exit 1 ;;
silent) exit 0 ;;
cutoff) head -c 30 "$CONVERTER_LOG.jpg" >"$to"; exit 0 ;;
hanged) echo "hanging"; sleep 1000 ;;
killed) kill -9 $$ ;;
moment) sleep 0.2 ;;
severa) cp "$CONVERTER_LOG.small" "${to%.jpg}-1.jpg"; cp "$CONVERTER_LOG.jpg" "${to%.jpg}-2.jpg"
    cp "$CONVERTER_LOG.jpg" "${to%.jpg}-10.jpg"; cat "$from" >>"${to%.jpg}-2.jpg"; printf '\377\331' >>"${to%.jpg}-2.jpg"; exit 0 ;;
esac
cat "$CONVERTER_LOG.jpg" "$from" >"$to"
printf '\377\331' >>"$to"
)sh";

class PhotosHeic : public test::InFolder {
  protected:
    void SetUp() override {
        InFolder::SetUp();
        fs::create_directories(folder_ / "phone");
        // No program is called by a name of its own: $HEIF_CONVERT may be any file.
        const fs::path program = put("stand in", kConverter);
        fs::permissions(program, fs::perms::owner_all);
        put("words.jpg", test::tiny_jpeg(640, 480) + "\xFF\xD9");
        put("words.small", test::tiny_jpeg(160, 120) + "\xFF\xD9");
        ::setenv("HEIF_CONVERT", program.c_str(), 1);
        ::setenv("CONVERTER_LOG", path("words").c_str(), 1);
        for (int i = 1; i <= 8; i++)
            put("phone/IMG_" + std::to_string(i) + ".HEIC", "photo " + std::to_string(i));
    }
    void TearDown() override {
        ::unsetenv("HEIF_CONVERT");
        ::unsetenv("CONVERTER_LOG");
        InFolder::TearDown();
    }

    ReadablePhotos convert(Progress* progress = nullptr) const {
        return readable_photos(path("phone"), path("out"), progress);
    }
    std::string sentence() const {
        try {
            convert();
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }
    // How often the program was called since the last time.
    size_t calls() const {
        std::ifstream in(path("words"));
        size_t count = 0;
        for (std::string line; std::getline(in, line);)
            count += line == "=";
        in.close();
        fs::remove(folder_ / "words");
        return count;
    }
    std::set<std::string> made() const {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_ / "out" / "photos"))
            names.insert(entry.path().filename().string());
        return names;
    }
};

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST_F(PhotosHeic, AFolderOfThemBecomesJpegs) {
    const ReadablePhotos photos = convert();
    EXPECT_EQ(photos.folder, path("out/photos"));
    EXPECT_EQ(photos.converted, 8U);
    EXPECT_TRUE(photos.warnings.empty());
    EXPECT_EQ(calls(), 8U);
    const PhotoFolder found = list_photos(photos.folder);
    ASSERT_EQ(found.photos.size(), 8U);
    EXPECT_EQ(found.photos[2].name, "IMG_3.jpg");
    EXPECT_EQ(found.photos[2].width, 640);
    EXPECT_TRUE(has(get("out/photos/IMG_3.jpg"), "photo 3"));
    EXPECT_TRUE(has(get("out/photos.log"), "IMG_3.HEIC"));
    EXPECT_FALSE(fs::exists(folder_ / "out" / "colmap" / "photo.part"));
    EXPECT_EQ(get("phone/IMG_3.HEIC"), "photo 3");
}

TEST_F(PhotosHeic, OnlyWhatChangedIsDoneAgain) {
    convert();
    calls();
    EXPECT_EQ(convert().converted, 8U);
    EXPECT_EQ(calls(), 0U);
    put("phone/IMG_2.HEIC", "another photo");
    fs::remove(folder_ / "out" / "photos" / "IMG_4.jpg");
    put("out/photos/IMG_5.jpg", "\xFF\xD8 cut off by a power cut");
    fs::remove(folder_ / "phone" / "IMG_6.HEIC");
    put("phone/IMG_9.heic", "photo 9");
    put("out/photos/mine.jpg", "what I put there");
    EXPECT_EQ(convert().converted, 8U);
    EXPECT_EQ(calls(), 4U);
    EXPECT_EQ(get("out/photos/mine.jpg"), "what I put there");
    EXPECT_TRUE(has(get("out/photos/IMG_2.jpg"), "another photo"));
    EXPECT_TRUE(has(get("out/photos/IMG_5.jpg"), "photo 5"));
    EXPECT_FALSE(made().contains("IMG_6.jpg")) << "A photo that is gone is still there.";
    // A damaged note is none.
    put("out/colmap/heic.json", "{\"basis\": 7, \"note");
    EXPECT_EQ(convert().converted, 8U);
    EXPECT_EQ(calls(), 8U);
}

TEST_F(PhotosHeic, TheOthersAreBesideThem) {
    put("phone/a.png", "png");
    put("phone/IMG_1.JPG", "the same photo");
    put("phone/IMG_2.png", "another one");
    put("phone/IMG_3.avif", "photo of the same name");
    put("phone/IMG_4.MOV", "the moment around photo 4");
    put("phone/._IMG_5.HEIC", "a note of macOS");
    put("phone/walk.mp4", "a film");
    const ReadablePhotos photos = convert();
    EXPECT_EQ(photos.converted, 8U);
    EXPECT_EQ(made(), (std::set<std::string>{"a.png", "IMG_1.JPG", "IMG_2.png", "IMG_2.jpg", "IMG_3.jpg",
                                             "IMG_3.avif.jpg", "IMG_4.jpg", "IMG_5.jpg", "IMG_6.jpg",
                                             "IMG_7.jpg", "IMG_8.jpg"}));
    EXPECT_EQ(get("out/photos/IMG_1.JPG"), "the same photo");
    EXPECT_TRUE(has(get("out/photos/IMG_3.avif.jpg"), "of the same name") ||
                has(get("out/photos/IMG_3.jpg"), "of the same name"));
    ASSERT_EQ(photos.warnings.size(), 1U);
    EXPECT_TRUE(has(photos.warnings[0], "walk.mp4")) << photos.warnings[0];
    calls();
    put("phone/a.png", "changed");
    convert();
    EXPECT_EQ(get("out/photos/a.png"), "changed");
    EXPECT_EQ(calls(), 0U);
}

TEST_F(PhotosHeic, AFolderWithoutThemIsLeftAlone) {
    for (int i = 1; i <= 8; i++)
        put("phone/IMG_" + std::to_string(i) + ".jpg", test::tiny_jpeg(64, 48));
    const ReadablePhotos photos = convert();
    EXPECT_EQ(photos.folder, path("phone"));
    EXPECT_EQ(photos.converted, 0U);
    EXPECT_TRUE(fs::is_empty(folder_ / "out"));
}

TEST_F(PhotosHeic, OfSeveralPicturesTheFirstLargeOneIsThePhoto) {
    put("phone/IMG_1.HEIC", "several pictures");
    EXPECT_EQ(convert().converted, 8U);
    EXPECT_TRUE(has(get("out/photos/IMG_1.jpg"), "several pictures"));
    EXPECT_EQ(made().size(), 8U);
}

TEST_F(PhotosHeic, BrokenOnesAreNamed) {
    for (int i = 11; i <= 18; i++)
        put("phone/IMG_" + std::to_string(i) + ".HEIC", "photo");
    convert();
    put("phone/IMG_2.HEIC", "broken");
    put("phone/IMG_3.HEIC", "silent");
    put("phone/IMG_4.HEIC", "cutoff");
    put("phone/IMG_5.HEIC", "killed");
    const ReadablePhotos photos = convert();
    EXPECT_EQ(photos.converted, 12U);
    ASSERT_EQ(photos.warnings.size(), 4U);
    EXPECT_TRUE(has(photos.warnings[0], "IMG_2.HEIC") && has(photos.warnings[0], "no HEIC at all"))
        << photos.warnings[0];
    EXPECT_FALSE(made().contains("IMG_2.jpg")) << "What it was before is still there.";
    EXPECT_FALSE(made().contains("IMG_4.jpg"));
    for (const int i : {1, 6, 7, 8, 11, 12})
        put("phone/IMG_" + std::to_string(i) + ".HEIC", "broken");
    const std::string told = sentence();
    EXPECT_TRUE(has(told, "Only 6 of the 16") && has(told, "no HEIC at all")) << told;
    for (int i = 1; i <= 18; i++)
        if (i < 9 || i > 10) put("phone/IMG_" + std::to_string(i) + ".HEIC", "broken");
    EXPECT_TRUE(has(sentence(), "None of the 16 HEIC photos")) << sentence();
    for (int i = 21; i <= 28; i++)
        put("phone/" + std::to_string(i) + ".jpg", test::tiny_jpeg(64, 48));
    const ReadablePhotos others = convert();
    EXPECT_EQ(others.converted, 0U);
    ASSERT_EQ(others.warnings.size(), 9U);
    EXPECT_TRUE(has(others.warnings[8], "8 more")) << others.warnings[8];
}

TEST_F(PhotosHeic, HostileNamesAreNames) {
    const std::vector<std::string> names = {"-q",   "--help", "a b  c", "it's \"it\"", "дуб 日本", "100%d",
                                            "a[1]", "$HOME",  "a;b&c",  "a.b.c",       "*?",       "x:y"};
    fs::remove_all(folder_ / "phone");
    fs::create_directories(folder_ / "phone");
    for (const std::string& name : names)
        put("phone/" + name + ".heif", "photo " + name);
    const ReadablePhotos photos = readable_photos(path("phone"), path("out/100%d 'дуб'"));
    EXPECT_EQ(photos.converted, names.size());
    EXPECT_TRUE(photos.warnings.empty());
    for (const std::string& name : names)
        EXPECT_TRUE(has(get("out/100%d 'дуб'/photos/" + name + ".jpg"), "photo " + name)) << name;
    put("phone/a\nb.heic", "photo");
    EXPECT_TRUE(has(sentence(), "no line break")) << sentence();
}

TEST_F(PhotosHeic, IsCancelledAtAnyMomentAndGoesOn) {
    put("phone/IMG_5.HEIC", "hanged");
    test::StopAfter stop(700ms);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_THROW(convert(&stop), Cancelled);
    EXPECT_LT(std::chrono::steady_clock::now() - start, 10s);
    EXPECT_FALSE(fs::exists(folder_ / "out" / "photos" / "IMG_5.jpg"));
    const size_t before = calls();
    EXPECT_GE(before, 1U);
    put("phone/IMG_5.HEIC", "photo 5");
    EXPECT_EQ(convert().converted, 8U);
    EXPECT_EQ(calls(), 8U - (before - 1U)) << "What was done was done again.";
}

TEST_F(PhotosHeic, GoesOnAfterAKill) {
    for (int i = 1; i <= 8; i++)
        put("phone/IMG_" + std::to_string(i) + ".HEIC", "moment " + std::to_string(i));
    const pid_t child = ::fork();
    if (child == 0) {
        convert();
        ::_exit(0);
    }
    std::this_thread::sleep_for(700ms);
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    for (int i = 1; i <= 8; i++) {
        const std::string bytes = get("out/photos/IMG_" + std::to_string(i) + ".jpg");
        EXPECT_TRUE(bytes.empty() || bytes.ends_with("\xFF\xD9")) << "A half-written photo was taken.";
    }
    const size_t before = calls();
    EXPECT_EQ(convert().converted, 8U);
    EXPECT_LE(before + calls(), 10U) << "What was done was done again.";
    EXPECT_EQ(made().size(), 8U);
}

TEST_F(PhotosHeic, WhatCantBeDoneIsASentence) {
    fs::create_directories(folder_ / "out" / "photos");
    EXPECT_TRUE(has(sentence(), "not made of HEIC photos here")) << sentence();
    fs::remove_all(folder_ / "out");
    ::setenv("HEIF_CONVERT", path("nowhere").c_str(), 1);
    EXPECT_TRUE(has(sentence(), "$HEIF_CONVERT")) << sentence();
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    fs::remove(folder_ / "phone" / "IMG_1.HEIC");
    EXPECT_TRUE(has(sentence(), "There are 7 photos")) << sentence();
    EXPECT_THROW(film_of(path("phone/IMG_2.HEIC")), Error);
    // Phones save a film of a moment with each photo.
    for (int i = 1; i <= 8; i++) {
        put("phone/IMG_" + std::to_string(i) + ".HEIC", "photo");
        put("phone/IMG_" + std::to_string(i) + ".MOV", "film");
    }
    EXPECT_FALSE(film_of(path("phone")));
}

TEST_F(PhotosHeic, WithoutAProgramTheFolderIsLeftAlone) {
    ::unsetenv("HEIF_CONVERT");
    const std::string before = std::getenv("PATH");
    for (const char* folder : {"/usr/local/bin", "/opt/homebrew/bin", "/opt/local/bin", "/snap/bin"})
        for (const char* name : {"heif-dec", "heif-convert", "sips", "magick"})
            if (fs::exists(fs::path(folder) / name)) GTEST_SKIP() << name << " is installed in " << folder;
    ::setenv("PATH", path("out").c_str(), 1);
    const ReadablePhotos photos = convert();
    ::setenv("PATH", before.c_str(), 1);
    EXPECT_EQ(photos.folder, path("phone"));
    EXPECT_TRUE(fs::is_empty(folder_ / "out"));
    EXPECT_THROW(list_photos(photos.folder), Error);
}

// What each program is told, with a stand-in that takes any words.
TEST_F(PhotosHeic, EachProgramGetsItsWords) {
    ::unsetenv("HEIF_CONVERT");
    const fs::path program = put("any", std::string("#!/bin/sh\n"
                                                    "printf '%s ' \"$@\" >\"$CONVERTER_LOG\"\n"
                                                    "for to in \"$@\"; do :; done\n"
                                                    "cp \"$CONVERTER_LOG.jpg\" \"$to\"\n"));
    fs::permissions(program, fs::perms::owner_all);
    const std::string part = path("out/colmap/photo.part/photo");
    for (const auto& [variable, words] : std::vector<std::pair<const char*, std::string>>{
             {"HEIF_DEC", "-q 95 " + part + ".heic " + part + ".jpg "},
             {"SIPS", "-s format jpeg -s formatOptions 95 " + part + ".heic --out " + part + ".jpg "},
             {"MAGICK", part + ".heic[0] -quality 95 " + part + ".jpg "}}) {
        ::setenv(variable, program.c_str(), 1);
        fs::remove_all(folder_ / "out");
        EXPECT_EQ(convert().converted, 8U) << variable;
        ::unsetenv(variable);
        EXPECT_EQ(get("words"), words);
    }
}

TEST_F(PhotosHeic, RealOnesKeepWhatTheySay) {
    ::unsetenv("HEIF_CONVERT");
    if (std::system("command -v heif-enc heif-convert >/dev/null 2>&1") != 0)
        GTEST_SKIP() << "libheif's programs are not installed.";
    fs::remove_all(folder_ / "phone");
    fs::create_directories(folder_ / "phone");
    for (int i = 0; i < 8; i++) {
        // An even picture, which PNG and HEIC hold in a few bytes.
        std::ofstream ppm(folder_ / "a.ppm", std::ios::binary);
        ppm << "P6\n128 96\n255\n" << std::string(3UL * 128 * 96, static_cast<char>(40 + 20 * i));
        ppm.close();
        const std::string name = i == 0 ? "-100% 'дуб'" : "IMG " + std::to_string(i);
        ::setenv("NAME", ("./phone/" + name + ".heic").c_str(), 1);
        const std::string command =
            "cd '" + folder_.string() +
            "' && ffmpeg -v error -y -i a.ppm a.png && heif-enc a.png -o \"$NAME\" >/dev/null 2>&1";
        if (std::system(command.c_str()) != 0) GTEST_SKIP() << "ffmpeg or a coder of HEIC is not installed.";
    }
    put("phone/broken.heic", "no photo");
    const ReadablePhotos photos = convert();
    EXPECT_EQ(photos.converted, 8U);
    ASSERT_EQ(photos.warnings.size(), 1U);
    EXPECT_TRUE(has(photos.warnings[0], "broken.heic")) << photos.warnings[0];
    for (const PhotoFile& photo : list_photos(photos.folder).photos) {
        EXPECT_EQ(photo.width, 128) << photo.name;
        EXPECT_EQ(photo.height, 96) << photo.name;
    }
}

}  // namespace
}  // namespace treerec
