// The printed markers in a folder of photos.
#pragma once

#include <string>
#include <vector>

#include "photos/colmap_model.h"
#include "photos/find_markers.h"
#include "progress.h"

namespace treerec {

// What a photo of a model shows of markers, in its camera's pixels.
struct PhotoMarkers {
    size_t photo = 0;  // index into PhotoModel::photos
    std::vector<FoundMarker> markers;
};

struct SeenMarkers {
    std::vector<PhotoMarkers> photos;  // those that show any, in the model's order
    size_t unreadable = 0;             // photos that could not be looked at
};

// Looks for markers in the photos of a model, which lie in `folder`, on several threads. mark: a file that
// keeps what was found, for the next time with the same photos. Photos that can't be read are counted. Throws
// Error where `mark` can't be written, or Cancelled.
SeenMarkers markers_of_photos(const PhotoModel& model, const std::string& folder, const std::string& mark,
                              Progress* progress = nullptr);

}  // namespace treerec
