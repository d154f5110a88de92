// How thick wood is by its outline, which each photo shows more sharply than points matched between photos
// tell: these scatter by a few pixels of the smaller pictures that are matched.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geometry/vec.h"
#include "photos/colmap_model.h"
#include "progress.h"

namespace treerec {

struct OutlineOptions {
    int most_pixels = 2400;     // of the longer side: larger photos are made smaller
    double least_pixels = 2.5;  // of a radius: what is thinner has no two edges, but is a line (ridges.h)
    size_t least_photos = 5;    // that show a place
};

// A place on the axis of wood about as thick as that. What is no place (no radius above 0, no finite number)
// is not measured.
struct WoodPlace {
    DVec3 position{0.0};  // in the model
    DVec3 way{0.0};       // along the wood, a unit vector
    double radius = 0.0;  // in the model's unit
};

// The radius of each place, in the model's unit; 0 where the photos do not agree on one between half and one
// and a half of what it is taken for. Of each photo the grey levels' slope across the wood is taken, the mean
// of a piece as long as the wood is thick, so that the outline stays and the bark's furrows go; edges that
// most photos have at the same distance to both sides of one axis are the outline. folder: of the photos;
// those that can't be read do not count. Some .3 s of one core per photo. Throws Cancelled.
std::vector<double> outline_radii(const PhotoModel& model, const std::string& folder,
                                  std::span<const WoodPlace> places, const OutlineOptions& options = {},
                                  Progress* progress = nullptr);

}  // namespace treerec
