// A picture of what was tracked from one photo into another one (Zhang 2013, figure 4.1).
#pragma once

#include <string>

#include "mesh/image.h"
#include "photos/match_pair.h"
#include "photos/run_colmap.h"
#include "progress.h"

namespace treerec {

// Both photos side by side, twice: above with the plain method's matches, below with the improved one's, a
// colour for each; what the improved one dropped is dim.
Image draw_matches(const PhotoFeatures& one, const PhotoFeatures& other, const PairMatches& plain,
                   const PairMatches& improved);

struct ShownMatches {
    std::string path;     // of the picture
    size_t plain = 0;     // matches
    size_t improved = 0;  // that were kept
    size_t dropped = 0;
};

// Tracks the corners of one photo of a folder into another one, without COLMAP, and writes the picture to
// out/matches_A_B.png. names: "A.jpg,B.jpg". Throws Error where they are not in the folder, or can't be read,
// or Cancelled.
ShownMatches show_matches(const std::string& folder, const std::string& out, const std::string& names,
                          PhotoEffort effort, const Progress* progress = nullptr);

}  // namespace treerec
