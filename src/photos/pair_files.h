// Matches of photos in files, a few pairs in each, so that a kill loses little. Internal to photos/.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "photos/feature_tracks.h"

namespace treerec {

// As bytes, and back; nothing for what is damaged, or names other pairs than `pairs`, or of all photos that
// are not there.
std::string pairs_as_bytes(const std::vector<PhotoPlaceMatches>& matches);
std::optional<std::vector<PhotoPlaceMatches>> parse_pairs(
    std::string_view bytes, const std::vector<std::pair<size_t, size_t>>& pairs);
std::optional<std::vector<PhotoPlaceMatches>> parse_all_pairs(std::string_view bytes, size_t photos);

}  // namespace treerec
