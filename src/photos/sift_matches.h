// What COLMAP matched, out of its database.
#pragma once

#include <string>
#include <vector>

#include "photos/feature_tracks.h"
#include "photos/photo_folder.h"
#include "photos/sqlite_tables.h"

namespace treerec {

// The matches that COLMAP verified (its table two_view_geometries), as places in the photos by COLMAP's
// counting; photos that are not in the folder are left out. They weigh less than tracked corners do. Throws
// Error with a sentence for a file that is damaged, or no database of COLMAP's (3.8 to 4).
std::vector<PhotoPlaceMatches> read_sift_matches(const std::string& path, const PhotoFolder& photos);

// The same from a database that is open.
std::vector<PhotoPlaceMatches> sift_matches_in(const SqliteTables& database, const std::string& path,
                                               const PhotoFolder& photos);

}  // namespace treerec
