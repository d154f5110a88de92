// What a whole plot is like, by some of its points.
#pragma once

#include <string>
#include <vector>

#include "geometry/bounds.h"
#include "scan/cleaning/clean_cloud.h"
#include "scan/plots/cloud_pieces.h"
#include "scan/robust.h"

namespace treerec {

struct PlotGuide {
    ScanFrame frame;
    Range x, y, z;        // metres, tree space: the plot's extent without stray points
    double height = 0.0;  // metres: of the highest things over the ground below them
    size_t points = 0;    // of the file
    bool has_colors = false;
    std::vector<std::string> warnings;

    bool holds(const DVec3& p) const { return x.contains(p.x) && y.contains(p.y) && z.contains(p.z); }
};

// Reads all of it once. Throws as read_cloud() and orient_cloud().
PlotGuide guide_to(CloudPieces& pieces, const OrientOptions& options, Progress* progress);

}  // namespace treerec
