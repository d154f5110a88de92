// Thins a cloud to an even density, so that nothing superlinear sees a dense one.
#pragma once

#include <vector>

#include "geometry/vec.h"
#include "progress.h"
#include "skeleton/passes.h"

namespace treerec {

struct ThinnedCloud {
    // At most one point per cube of edge `spacing` (metres): the one nearest to the mean of its cube, so that
    // every result is a scanned point. Sorted along the cubes.
    std::vector<Vec3> points;
    // What to take measures from where cubes hold many points: at most twice as many, and as dense as the
    // cloud is there. (Of one point per cube, too many are those that noise put beside the wood: a twig
    // thinner than the noise would seem half as thick again.) Empty where `points` themselves will do.
    std::vector<Vec3> sample;
    std::vector<uint32_t> cube;  // by sample: which of `points` is of the same cube

    const std::vector<Vec3>& measured() const { return sample.empty() ? points : sample; }
};

// Where cubes hold many points, those that far fewer lie about than about most near them are strays and left
// out. The result depends neither on the order of the points nor on repeated points. Points that are not
// finite are dropped.
ThinnedCloud thin_with_sample(const std::vector<Vec3>& points, double spacing, Progress& progress,
                              PassSet left_out = {});

// The same without the sample, strays included.
std::vector<Vec3> thin_points(const std::vector<Vec3>& points, double spacing, Progress& progress);

// The spacing to use when the user gives none: 1/2000 of the cloud's diagonal, between 1 mm and 2 cm, and
// coarser where the cloud would keep more than kMostPoints and more than a share of its distinct points.
inline constexpr size_t kMostPoints = 400000;
inline constexpr size_t kOneOf = 6;
double automatic_spacing(const std::vector<Vec3>& points, const Progress* progress = nullptr);

}  // namespace treerec
