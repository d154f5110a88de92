#include "scan/usual_size.h"
#include "skeleton/delaunay/delaunay_skeleton.h"
#include "skeleton/flood/flood_skeleton.h"
#include "skeleton/skeleton.h"
#include "skeleton/stages.h"

namespace treerec {

namespace {

void geodesic_skeleton(SkeletonWork& work) {
    link_neighbours(work);
    find_paths(work);
    find_branches(work);
    fit_cylinders(work);
    find_twigs(work);
    refine_cylinders(work);
    simplify(work);
}

void make_skeleton(SkeletonWork& work) {
    sample_points(work);
    if (take_stump(work)) return;
    switch (work.options.method) {
        case SkeletonMethod::kGeodesic:
            return geodesic_skeleton(work);
        case SkeletonMethod::kDelaunay:
            return delaunay_skeleton(work);
        case SkeletonMethod::kFlood:
            return flood_skeleton(work);
    }
}

// All lengths back to those of the cloud that was enlarged, whose frame is given.
void shrink(SkeletonResult& result, const ScanFrame& frame, double factor) {
    const double back = 1.0 / factor;
    for (Tree* tree : {&result.tree, &result.raw}) {
        if (tree->size() == 0) continue;
        tree->scale(back);
        tree->set_frame({tree->frame().origin, frame.metres_per_unit, frame.up, frame.tilt});
    }
    result.spacing *= back;
    result.voxel *= back;
    for (FloodStep& step : result.steps) {
        step.position *= back;
        for (Vec3& voxel : step.voxels)
            voxel = Vec3(DVec3(voxel) * back);
        for (FloodDirection& direction : step.directions) {
            direction.length *= back;
            direction.radius *= back;
        }
    }
}

}  // namespace

SkeletonResult skeletonize(const PointCloud& cloud, const SkeletonOptions& options, Progress* listener) {
    const double factor = enlargement_to_usual(cloud.positions);
    if (factor == 1.0) {
        SkeletonWork work(cloud, options, factor, listener);
        make_skeleton(work);
        return std::move(work.result);
    }
    SkeletonOptions sized = options;
    sized.voxel *= factor;
    sized.spacing *= factor;
    sized.minimum_branch *= factor;
    sized.simplify_distance *= factor;
    sized.noise *= factor;
    if (sized.stem_base) *sized.stem_base *= factor;
    const PointCloud large = enlarged(cloud, factor);
    SkeletonWork work(large, sized, factor, listener);
    make_skeleton(work);
    shrink(work.result, cloud.frame, factor);
    // As they were stated.
    if (options.spacing > 0.0) work.result.spacing = options.spacing;
    if (options.voxel > 0.0) work.result.voxel = options.voxel;
    return std::move(work.result);
}

}  // namespace treerec
