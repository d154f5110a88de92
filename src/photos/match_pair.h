// Two photos' places that show the same thing: the corners of one tracked into the other (Zhang 2013, chapter
// 4).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/vec.h"
#include "photos/affine_track.h"
#include "photos/corner_patches.h"
#include "photos/grey_pyramid.h"
#include "photos/harris.h"
#include "photos/pair_geometry.h"
#include "progress.h"

namespace treerec {

// Which matches both medians of Zhang 2013, 4.3.2 leave.
enum class MedianFilter {
    kNone,
    kEither,  // as printed: better than the median in both; a quarter where they have nothing in common
    kBoth,    // what is worse than the median in both goes: three quarters stay
};

struct MatchOptions {
    AffineTrackOptions track{.window = {.reach = 8}, .levels = 3, .most_stretch = 2.5};
    double back_tolerance = 1.5;    // pixels between a corner and where the way back ends
    double least_similarity = 0.7;  // normalized correlation of the windows
    // A match has to be clearly more similar than what else it may be taken for, as in a fence or in tiles:
    // the distance from 1 of its similarity at most this share of theirs (Lowe 2004, 7.1).
    double clearly = 0.8;
    size_t rivals = 2;  // that are tried
    // Matches have to agree on one epipolar geometry; none where nothing shall be asked.
    std::optional<PairGeometryOptions> geometry = PairGeometryOptions{};
    MedianFilter medians = MedianFilter::kBoth;
};

// A photo, ready to be matched.
struct PhotoFeatures {
    GreyPyramid pyramid;
    std::vector<Corner> corners;
    CornerPatches patches;
};

struct FeatureOptions {
    int most_pixels = 1600;  // of the longer side: larger photos are made smaller
    HarrisOptions harris;
};

PhotoFeatures features_of(const Image& photo, const FeatureOptions& options);

struct PointMatch {
    uint32_t corner = 0;      // of the first photo
    DVec2 place{0.0};         // in the second one's picture, pixels
    double similarity = 0.0;  // -1 to 1
    double back_error = 0.0;  // pixels
    bool kept = true;         // by the tolerance, the similarity, rivals, geometry and medians
};

struct PairMatches {
    std::vector<PointMatch> matches;  // by corner; those that were dropped at last, too
    size_t coarse = 0;                // patches that told where to begin

    size_t kept() const;
};

// The improved method: it begins at the motion of the patches around each corner, and where these tell
// nothing, at the corner's own place. Throws Cancelled.
PairMatches match_pair(const PhotoFeatures& one, const PhotoFeatures& other, const MatchOptions& options = {},
                       const Progress* progress = nullptr);

// The plain one (4.1 to 4.4), with nothing checked.
PairMatches match_pair_plain(const PhotoFeatures& one, const PhotoFeatures& other,
                             const LucasKanadeOptions& options = {});

// Both medians, over the matches that are still kept.
void filter_by_medians(std::vector<PointMatch>& matches, MedianFilter filter);

}  // namespace treerec
