// Learns where the wood is thick, so that slices can be cut to its measure.
#pragma once

#include "skeleton/cylinders/axis.h"

namespace treerec {

struct ThicknessOptions {
    BranchOptions branches;
    AxisOptions axes;
};

// The scale to cut the final slices with. A slice of a stem shall be a whole ring, however finely or patchily
// its bark is sampled, and a slice of a twig no thicker than the twig's points ask for; so the point spacing
// is lowered a little everywhere and raised to a share of the radius on thick wood. The radii come from
// trial cuts, the coarsest first, of which only the fitted circles are believed.
LocalScale follow_thickness(const LocalScale& scale, const std::vector<Vec3>& points, const PointGraph& graph,
                            const PathTree& paths, const DVec3& root, const ThicknessOptions& options,
                            Progress& progress);

}  // namespace treerec
