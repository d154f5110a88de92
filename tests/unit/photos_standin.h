// A folder of photos and a program that behaves as COLMAP does: it knows the option names of 3.8 or of 4,
// ends at any other one, writes down what it was called with, and hands out a model that was made beforehand.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/gtc/quaternion.hpp>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "cli_runner.h"
#include "geometry/random.h"
#include "geometry/vec.h"

namespace treerec::test {

// STANDIN_VERSION 3.8 or 4; STANDIN_LOG where to write the words; STANDIN_MODEL a folder of models;
// STANDIN_DATABASE what the feature_extractor makes, else a list of names;
// STANDIN_DO "COMMAND=exit1", "COMMAND=hang", "mapper=none", "COMMAND=slow"; STANDIN_FEATURES of a photo.
inline constexpr const char* kStandIn = R"sh(#!/bin/sh
sift=SiftExtraction match=SiftMatching size=SiftExtraction version=3.8
case "$STANDIN_VERSION" in 4*) sift=FeatureExtraction match=FeatureMatching size=FeatureExtraction version=4.0.1 ;; esac
common="--database_path"
known() {
    case $1 in
    feature_extractor) echo "$common --image_path --image_list_path --ImageReader.single_camera --ImageReader.camera_model --ImageReader.existing_camera_id
        --$sift.use_gpu --$sift.num_threads --$size.max_image_size --SiftExtraction.max_num_features" ;;
    feature_importer) echo "$common --image_path --image_list_path --import_path --ImageReader.single_camera --ImageReader.camera_model" ;;
    exhaustive_matcher) echo "$common --$match.use_gpu --$match.num_threads --ExhaustiveMatching.block_size" ;;
    sequential_matcher) echo "$common --$match.use_gpu --$match.num_threads --SequentialMatching.overlap" ;;
    matches_importer) echo "$common --$match.use_gpu --$match.num_threads --match_list_path --match_type" ;;
    mapper) echo "$common --image_path --output_path --Mapper.num_threads --Mapper.abs_pose_min_num_inliers" ;;
    esac
}
if [ "$1" = -h ]; then
    echo "COLMAP $version -- Structure-from-Motion and Multi-View Stereo"
    echo "              (Commit Unknown on Unknown without CUDA)"
    exit 0
fi
command=$1
shift
if [ "$1" = -h ]; then
    for name in $(known "$command"); do echo "  $name arg (=0)"; done
    exit 0
fi
{ echo "= $command"; for word in "$@"; do printf '%s\n' "$word"; done; } >>"$STANDIN_LOG"
database= output= list= import=
while [ $# -gt 0 ]; do
    case " $(known "$command" | tr '\n' ' ') " in
    *" $1 "*) ;;
    *) echo "ERROR: Failed to parse options - unrecognised option '$1'." >&2; exit 1 ;;
    esac
    case $1 in
    --database_path) database=$2 ;;
    --output_path) output=$2 ;;
    --image_list_path) list=$2 ;;
    --import_path) import=$2 ;;
    --match_list_path) cp "$2" "$STANDIN_LOG.matches" ;;
    esac
    shift 2
done
pause=0
case " $STANDIN_DO " in
*" $command=exit1 "*) echo "some words"; echo "ERROR: the disk is on fire" >&2; exit 1 ;;
*" $command=hang "*) echo "hanging"; sleep 1000 & echo $! >"$STANDIN_LOG.sleeper"; wait; exit 0 ;;
*" $command=slow "*) pause=0.3 ;;
esac
case $command in
feature_extractor)
    count=$(wc -l <"$list") i=0
    [ -z "$STANDIN_DATABASE" ] || cp "$STANDIN_DATABASE" "$database"
    while IFS= read -r name; do
        i=$((i + 1))
        [ "$pause" = 0 ] || sleep $pause
        [ -n "$STANDIN_DATABASE" ] || printf '%s\n' "$name" >>"$database"
        echo "Processed file [$i/$count]"
        echo "  Name:            $name"
        echo "  Features:        ${STANDIN_FEATURES:-2400}"
    done <"$list" ;;
feature_importer)
    while IFS= read -r name; do
        [ "$pause" = 0 ] || sleep $pause
        [ -s "$import/$name.txt" ] || continue
        printf '%s\n' "$name" >>"$database"
        cp "$import/$name.txt" "$STANDIN_LOG.$name.txt"
    done <"$list" ;;
*matcher | matches_importer)
    [ -s "$database" ] || { echo "no features" >&2; exit 1; }
    for i in 1 2 3 4; do
        [ "$pause" = 0 ] || sleep $pause
        printf 'Matching block [%d/2, %d/2] in 0.1s\n' $(((i + 1) / 2)) $(((i + 1) % 2 + 1))
    done
    echo matched >>"$database" ;;
mapper)
    grep -aq matched "$database" || { echo "no matches" >&2; exit 1; }
    case " $STANDIN_DO " in *" mapper=none "*) echo "ERROR: failed to create sparse model"; exit 1 ;; esac
    for i in 3 4 5; do
        [ "$pause" = 0 ] || sleep $pause
        echo "Registering image #$i ($i)"
    done
    cp -r "$STANDIN_MODEL"/. "$output" ;;
esac
)sh";

template <typename T>
void add(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

struct TinyModel {
    std::vector<std::string> photos;
    double from_degrees = 0.0;  // of the circle that the photos are spread over
    double to_degrees = 360.0;
};

// Writes cameras.bin, images.bin and points3D.bin: photos from around an upright trunk (z is down) with
// boughs.
inline void write_tiny_model(const std::filesystem::path& folder, const TinyModel& model) {
    std::filesystem::create_directories(folder);
    std::string cameras, images, points;
    add<uint64_t>(cameras, 1);
    add<uint32_t>(cameras, 1);
    add<int32_t>(cameras, 2);
    add<uint64_t>(cameras, 640);
    add<uint64_t>(cameras, 480);
    for (const double value : {500.0, 320.0, 240.0, 0.0})
        add(cameras, value);
    add<uint64_t>(images, model.photos.size());
    for (size_t i = 0; i < model.photos.size(); i++) {
        const double share = static_cast<double>(i) / static_cast<double>(model.photos.size());
        const double angle =
            glm::radians(model.from_degrees + share * (model.to_degrees - model.from_degrees));
        const DVec3 centre(4.0 * std::cos(angle), 4.0 * std::sin(angle), 0.0);
        const DVec3 ahead = -glm::normalize(centre), down(0.0, 0.0, 1.0), right = glm::cross(down, ahead);
        const DMat3 rotation = glm::transpose(DMat3(right, down, ahead));
        const glm::dquat q = glm::quat_cast(rotation);
        const DVec3 translation = -(rotation * centre);
        add(images, static_cast<uint32_t>(i + 1));
        for (const double value : {q.w, q.x, q.y, q.z, translation.x, translation.y, translation.z})
            add(images, value);
        add<uint32_t>(images, 1);
        images += model.photos[i] + '\0';
        add<uint64_t>(images, 0);
    }
    Random random(7);
    constexpr uint64_t kPoints = 6000;
    add<uint64_t>(points, kPoints);
    for (uint64_t i = 0; i < kPoints; i++) {
        const double up = random.uniform(), angle = 2.0 * kPi * random.uniform();
        const bool bough = i % 3 == 0;
        const double radius = bough ? 0.03 : 0.15 - 0.08 * up;
        DVec3 at(radius * std::cos(angle), radius * std::sin(angle), 1.0 - 2.5 * up);
        if (bough) at = DVec3(at.x + (i % 2 ? 1.0 : -1.0) * up, at.y, -0.5 - up + 0.5 * at.y);
        add(points, i);
        for (int k = 0; k < 3; k++)
            add(points, at[k]);
        points += std::string("\x60\x50\x40", 3);
        // One in ten is seen too seldom, and one badly.
        add(points, i % 10 == 1 ? 3.5 : 0.6);
        const uint64_t track = i % 10 == 0 ? 2 : 4;
        add(points, track);
        points.append(track * 8, '\0');
    }
    std::ofstream(folder / "cameras.bin", std::ios::binary) << cameras;
    std::ofstream(folder / "images.bin", std::ios::binary) << images;
    std::ofstream(folder / "points3D.bin", std::ios::binary) << points;
}

// A JPEG as far as its frame header goes.
inline std::string tiny_jpeg(int width, int height) {
    std::string bytes("\xFF\xD8\xFF\xE0\x00\x04xx\xFF\xC0\x00\x11\x08", 13);
    for (const int value : {height >> 8, height & 255, width >> 8, width & 255})
        bytes += static_cast<char>(value);
    return bytes + std::string(20, '\x01');
}

// A test's folder with photos/, the stand-in and a model of these photos, and what the stand-in was told.
template <typename Base>
class WithStandIn : public Base {
  protected:
    void SetUp() override {
        Base::SetUp();
        if (::testing::Test::IsSkipped()) return;
        put_program(this->folder_ / "colmap program" / "colmap");
        for (const auto& [name, value] :
             std::vector<std::pair<const char*, std::string>>{{"COLMAP", program().string()},
                                                              {"STANDIN_LOG", this->path("words")},
                                                              {"STANDIN_MODEL", this->path("models")},
                                                              {"STANDIN_DO", ""},
                                                              {"STANDIN_FEATURES", ""},
                                                              {"STANDIN_DATABASE", ""},
                                                              {"STANDIN_VERSION", "3.8"}})
            ::setenv(name, value.c_str(), 1);
        take_photos({"a.jpg", "b.jpg", "c.jpg", "d.jpg", "e.jpg", "f.jpg", "g.jpg", "h.jpg", "i.jpg"});
    }
    void TearDown() override {
        for (const char* name : {"COLMAP", "STANDIN_LOG", "STANDIN_MODEL", "STANDIN_DO", "STANDIN_FEATURES",
                                 "STANDIN_DATABASE", "STANDIN_VERSION"})
            ::unsetenv(name);
        Base::TearDown();
    }

    fs::path program() const { return this->folder_ / "colmap program" / "colmap"; }

    void put_program(const fs::path& path) const {
        fs::create_directories(path.parent_path());
        std::ofstream(path, std::ios::binary) << kStandIn;
        fs::permissions(path, fs::perms::owner_all);
    }
    // In place of those that were there.
    void take_photos(const std::vector<std::string>& names) {
        fs::remove_all(this->folder_ / "photos");
        fs::create_directories(this->folder_ / "photos");
        for (const std::string& name : names)
            this->put("photos/" + name, tiny_jpeg(640, 480) + name);
        names_ = names;
        fs::remove_all(this->folder_ / "models");
        write_tiny_model(this->folder_ / "models" / "0", {names});
    }
    void standin_does(const std::string& what) const { ::setenv("STANDIN_DO", what.c_str(), 1); }

    // Words of one call of the stand-in, the command first.
    using Words = std::vector<std::string>;
    // The calls since the last time.
    std::vector<Words> calls() {
        std::ifstream in(this->path("words"));
        std::vector<Words> calls;
        for (std::string line; std::getline(in, line);) {
            if (line.starts_with("= "))
                calls.push_back({line.substr(2)});
            else
                calls.back().push_back(line);
        }
        in.close();
        fs::remove(this->path("words"));
        return calls;
    }
    static std::string commands(const std::vector<Words>& calls) {
        std::string text;
        for (const Words& call : calls)
            text += (text.empty() ? "" : " ") + call[0];
        return text;
    }
    // What follows an option; "" where it was not given.
    static std::string value_of(const Words& call, const std::string& option) {
        for (size_t i = 0; i + 1 < call.size(); i++)
            if (call[i] == option) return call[i + 1];
        return "";
    }

    std::vector<std::string> names_;
};

}  // namespace treerec::test
