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

// That corners were tracked, too, since SIFT's matches alone had placed `by_sift` photos, or doubtfully.
std::string more_matches(size_t by_sift, const ColmapRun& run);
// That this could not be done. why: a sentence.
std::string no_more_matches(const std::string& why);

// On what a model lacks: photos, a part of the circle, what holds it together. models: the sizes of COLMAP's
// models, the largest first, each but the first one without the photos that are in those before. further:
// another matcher may find more.
std::vector<std::string> advice_on(const ColmapRun& run, const std::vector<size_t>& models, bool further);

}  // namespace treerec
