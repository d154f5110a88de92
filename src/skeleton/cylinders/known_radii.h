// How thick wood is where the cloud's maker knows it better than its points tell (PointCloud::radii).
#pragma once

#include <optional>
#include <vector>

#include "geometry/point_tree.h"
#include "progress.h"
#include "scan/point_cloud.h"
#include "skeleton/cylinders/axis.h"
#include "skeleton/sampling/point_graph.h"

namespace treerec {

// Points scatter by a pixel or two around a twig that is one or two pixels wide, and so far apart the twig's
// own surface is lost; but each photo shows how wide it is.
class KnownRadii {
  public:
    // cloud: metres, Y up; of several points at one place the thickest counts. spacing: between its points,
    // metres. Throws Cancelled.
    KnownRadii(const PointCloud& cloud, double spacing, const Progress* progress);

    // Stations amid points of known radius get it, as measured. What was measured as far thicker, and is a
    // surface with lines on it, stays. Wood stouter than the points are apart whose section was not measured
    // gets no more than its length allows: stray points between two limbs that a photo shows as one are as
    // wide as both, and no stump.
    void tell(std::vector<std::vector<Station>>& axes) const;

    bool any() const { return tree_.has_value(); }

    // The radius at each of some points of the cloud; 0 where it is not known.
    std::vector<float> at(const std::vector<Vec3>& points, const Progress& progress) const;

  private:
    std::optional<double> around(const Station& station) const;

    double spacing_;
    std::vector<float> radii_;       // by point of the tree; 0 where it is not known
    std::optional<PointTree> tree_;  // of all places; none where no radius is known
};

// Links wood of known radius (scale.radius) to the nearest other wood that is about as thick or thicker,
// within a few radii: a branch may well be seen from where it leaves the trunk's bark on, or not where others
// stand before it, and the nearest points to its end are all its own. points: metres. tree: over them. Throws
// Cancelled.
void link_stout_wood(const std::vector<Vec3>& points, const PointTree& tree, const LocalScale& scale,
                     double spacing, PointGraph& graph, const Progress& progress);

}  // namespace treerec
