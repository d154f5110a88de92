// Photos matched here, by tracking corners (photos/match_pair.h), and handed to COLMAP as keypoints and
// matches. Internal to photos/.
#pragma once

#include <string>

#include "photos/colmap_work.h"

namespace treerec {

// The database that the mapper gets.
inline constexpr const char* kTracksDatabase = "tracks.db";

// Tracks corners between the photos that look alike, into colmap/tracks/, and gives COLMAP what that found in
// colmap/tracks.db, for it to verify. before: the basis of what is in colmap/matching.db where SIFT's
// keypoints and matches shall be joined to it, or "". Returns the basis of what follows. Pairs that were
// tracked before a kill are not done again. Throws Error, or Cancelled.
std::string track_photos(ColmapWork& work, const std::string& before);

// Whether COLMAP can be told all names: its list of matches takes a blank for the end of one.
bool names_can_be_paired(const PhotoFolder& photos);

}  // namespace treerec
