// What pairs of photos show alike, put together: each place that several photos show becomes one keypoint in
// each of these, so that COLMAP gets long tracks.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

// A place of one photo that is one of another photo.
struct PlaceMatch {
    DVec2 one{0.0};  // pixels of the photos, by their own counting
    DVec2 other{0.0};
    double weight = 0.0;  // the higher ones are believed first
};

struct PhotoPlaceMatches {
    size_t one = 0;  // photos
    size_t other = 0;
    std::vector<PlaceMatch> matches;
};

struct TrackOptions {
    double same = 1.0;         // pixels: places of a photo that are nearer are the same
    size_t least_shared = 15;  // tracks of a pair of photos that nobody compared, for it to be one
};

struct KeypointMatches {
    size_t one = 0;  // photos, one < other
    size_t other = 0;
    std::vector<std::pair<uint32_t, uint32_t>> keypoints;
};

struct FeatureTracks {
    std::vector<std::vector<DVec2>> keypoints;  // of each photo: the mean of the places that became it
    std::vector<KeypointMatches> pairs;         // by photos; each keypoint at most once
    size_t tracks = 0;
    size_t conflicts = 0;  // matches that would have put two places of a photo into one track; left out
};

// Photos that share tracks are pairs, too, though nobody compared them. Depends on the order of `pairs`, and
// on nothing else.
FeatureTracks join_tracks(size_t photos, const std::vector<PhotoPlaceMatches>& pairs,
                          const TrackOptions& options = {});

}  // namespace treerec
