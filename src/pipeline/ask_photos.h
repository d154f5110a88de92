// What the photos that a cloud was made of tell of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "photos/subject_stem.h"
#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

struct PhotosTell {
    size_t photos = 0;                // whose cameras were asked; 0: there are none, or they do not agree
    DVec3 sky{0.0};                   // the way up in scan coordinates, where `photos` is not 0
    std::optional<DVec3> subject;     // the place that they were taken of, in scan coordinates
    std::optional<SubjectStem> stem;  // what they show there, where that is a stem without a crown
    std::optional<double> one_sided;  // photos/cameras_tell.h, one_sided_arc()
    std::vector<std::string> warnings;
};

// Asks the COLMAP model that lies beside the cloud's file (photos/cameras_tell.h), if one does whose points
// lie where the cloud's do: a cloud that was turned or scaled since then is not theirs any more. cloud: as
// read. Throws Cancelled; a model that can't be read is a warning.
PhotosTell ask_photos(const std::string& path, const PointCloud& cloud, Progress& progress);

}  // namespace treerec
