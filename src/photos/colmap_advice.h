// What to say of photos that COLMAP placed badly, or not at all. Internal to photos/.
#pragma once

#include <string>
#include <vector>

#include "error.h"
#include "photos/photo_folder.h"
#include "photos/run_colmap.h"

namespace treerec {

Error too_few_photos(size_t photos, const std::string& folder);

// features: of a usual photo; 0 where that is not known.
Error none_registered(size_t photos, size_t features);

// On what a model lacks: photos, a part of the circle. models: the sizes of COLMAP's models, the largest
// first, each but the first one without the photos that are in those before.
std::vector<std::string> advice_on(const ColmapRun& run, const std::vector<size_t>& models);

}  // namespace treerec
