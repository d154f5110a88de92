// COLMAP's own features and what they share. Internal to photos/.
#pragma once

#include <string>

#include "photos/colmap_work.h"

namespace treerec {

// Finds what can be recognised in each photo, into colmap/features.db. Returns the basis of what follows.
// Throws Error, or Cancelled.
std::string find_features(ColmapWork& work);

// Finds what the photos share, into colmap/matching.db. Returns the basis of what follows.
std::string match_photos(ColmapWork& work, const std::string& before);

}  // namespace treerec
