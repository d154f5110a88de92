// How true grown bark is to the scan that its tree was made of, beside the tubes that it stands for.
#pragma once

#include <cstddef>
#include <vector>

#include "growth/recipe.h"
#include "mesh/grown_bark.h"
#include "progress.h"
#include "scan/point_cloud.h"
#include "tree/tree.h"

namespace treerec {

// Metres from the points to the nearest triangle.
struct BarkDistances {
    double median = 0.0, mean = 0.0, p95 = 0.0;
};

struct BarkFitPart {
    double from = 0.0, to = 0.0;  // metres along the trunk
    size_t points = 0;
    BarkDistances tubes, grown;
    // How far the scan's bark lies from round, over the wood's radius: by p95 of the points' cells.
    double lumpy = 0.0;
};

struct BarkFit {
    BarkFitPart all;                   // of all covered branches; from, to: of the trunk
    BarkFitPart lumpy;                 // of the parts below that count as lumpy
    std::vector<BarkFitPart> heights;  // of the trunk, metre by metre, where there are points
    size_t worse = 0;                  // of those: where the grown bark is farther off than the tubes
    // Of slices 0.1 m high of all covered branches, where both are seen in three quarters of 24 directions:
    // |r_grown / r_scan - 1|, r the mean over those directions.
    size_t slices = 0;
    double radius_median = 0.0, radius_p95 = 0.0;
    // At breast height; 0 where the scan shows less than half of it.
    double dbh_scan = 0.0, dbh_grown = 0.0;
};

// A part is lumpy whose `lumpy` is above this; it is worse where the mean distance is more than this share,
// and a tenth of a millimetre, above that of the tubes.
inline constexpr double kLumpyBark = 0.1;
inline constexpr double kWorseBark = 0.02;

// Looks at the points of the cloud that lie on the covered branches' bark: nearest to them, less than a
// radius and 5 cm outside, in cells of bark whose points are one sheet. recipe: by which the bark was grown.
// Throws Error for an empty cloud, or one of another tree; Cancelled.
BarkFit measure_bark_fit(const Tree& tree, const GrowthRecipe& recipe, const GrownBark& bark,
                         const PointCloud& cloud, Progress* progress = nullptr);

}  // namespace treerec
