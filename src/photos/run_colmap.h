// From a folder of photos to the places that they were taken from, with COLMAP as its own process
// (Chen 2025, 3.2.1; Zhang 2013, chapter 3).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "photos/cameras_tell.h"
#include "photos/gps_scale.h"
#include "photos/photo_joints.h"
#include "progress.h"

namespace treerec {

// Which photos are compared.
enum class PhotoOrder {
    kAuto,        // exhaustive for up to 80 photos, else in sequence
    kSequence,    // neighbours by name, and the last ones with the first
    kExhaustive,  // each with each
};

// How it is found out what the photos share.
enum class PhotoMatcher {
    kAuto,   // kSift, and kBoth where that does not place all photos, or places them doubtfully
    kSift,   // COLMAP's own features
    kPyrlk,  // corners tracked from photo to photo (photos/match_pair.h): no SIFT
    kBoth,   // the tracks of both; no fewer photos are placed than with kSift, unless these contradict
             // themselves
};

// How long it may take.
enum class PhotoEffort { kQuick, kNormal, kBest };

// "auto", "sequence", "exhaustive"; "auto", "sift", "pyrlk", "both"; "quick", "normal", "best". Throw Error
// for another word.
PhotoOrder parse_photo_order(const std::string& word);
PhotoMatcher parse_photo_matcher(const std::string& word);
PhotoEffort parse_photo_effort(const std::string& word);

struct ColmapOptions {
    std::string program;  // or its folder; "": $COLMAP, PATH, the usual folders
    PhotoOrder order = PhotoOrder::kAuto;
    PhotoMatcher matcher = PhotoMatcher::kAuto;
    PhotoEffort effort = PhotoEffort::kNormal;
    int threads = 0;  // 0: one per core
};

struct ColmapRun {
    std::string model;                    // the folder of cameras.bin, images.bin and points3D.bin
    std::string version;                  // COLMAP's
    size_t photos = 0;                    // in the folder
    size_t registered = 0;                // whose places are known
    std::vector<std::string> missing;     // the names of the others
    std::vector<CameraAround> around;     // those that are known, around what was photographed
    std::optional<CircleGap> widest_gap;  // between them
    PhotoJoints joints;                   // where they may be placed wrongly
    std::vector<std::string> warnings;    // what could be done better, as sentences
    GpsScale gps;                         // the model's unit, as far as the photos say where they were taken
};

// The absolute path of `out`, which is made, with colmap/ in it. Throws Error where it is the folder of the
// photos, or has things of our names in it that are not ours.
std::string claim_folder(const std::string& out, const std::string& photos);

// Runs COLMAP's stages in out/colmap and leaves the model in out/sparse/0, everything that COLMAP says in
// out/photos.log, and nothing outside of `out`; the photos are only read. Stages that ended with the same
// photos and options are not done again, one that was killed goes on. Counts photos in `progress`. Throws
// Error with a sentence that says what to do (no COLMAP, fewer than 8 photos, none of them placed, …), or
// Cancelled.
ColmapRun run_colmap(const std::string& folder, const std::string& out, const ColmapOptions& options,
                     Progress* progress = nullptr);

}  // namespace treerec
