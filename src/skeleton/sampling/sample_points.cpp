#include <algorithm>
#include <string>

#include "error.h"
#include "geometry/covariance.h"
#include "skeleton/sampling/piece_ends.h"
#include "skeleton/stages.h"

namespace treerec {

namespace {

constexpr size_t kLeastPoints = 10;
constexpr double kVoxelSpacings = 2.0;  // a stated voxel is at least so many spacings wide
constexpr double kFlatness = 1e-4;      // depth over width: less is rounding, not a scanned tree

// Whether the points all lie on a plane, or on a line.
bool is_flat(const std::vector<Vec3>& points) {
    const DMat3 covariance = covariance_of(points);
    // The determinant is the product of the squared extents along the three main axes.
    const double widest = (covariance[0][0] + covariance[1][1] + covariance[2][2]) / 3.0;
    return !(glm::determinant(covariance) > kFlatness * kFlatness * widest * widest * widest);
}

}  // namespace

void sample_points(SkeletonWork& work) {
    const SkeletonOptions& options = work.options;
    SkeletonResult& result = work.result;
    const std::vector<Vec3>& all = work.cloud.positions;
    work.progress.update(0.0, "Thinning");
    result.spacing = options.spacing > 0.0 ? options.spacing : automatic_spacing(all, &work.progress);
    if (work.floods() && options.voxel > 0.0 && options.spacing <= 0.0)
        result.spacing = std::min(result.spacing, options.voxel / kVoxelSpacings);
    if (work.floods()) result.voxel = options.voxel > 0.0 ? options.voxel : kVoxelSpacings * result.spacing;
    work.thinned = work.floods() ? ThinnedCloud{thin_points(all, result.spacing, work.progress), {}, {}}
                                 : thin_with_sample(all, result.spacing, work.progress, options.left_out);
    if (!work.does(Pass::kSample)) work.thinned.sample.clear();
    if (work.points().size() < kLeastPoints)
        throw Error(
            "The cloud has only " + std::to_string(work.points().size()) + " points more than " +
            std::to_string(result.spacing / work.factor) +
            " m apart, and a tree needs at least 10. Check that the file is complete, that its unit is "
            "right, and that the cleaning steps did not take too much.");
    if (is_flat(work.points()))
        throw Error(
            "All points lie on a plane or on a line, and a tree needs depth: this looks like a photo or a "
            "section of a scan.");
    work.clock.stop("Thinning", work.points().size());
}

void link_neighbours(SkeletonWork& work) {
    const double spacing = work.result.spacing;
    SubProgress linking(work.listener, 0.1, 0.55);
    work.graph = neighbour_graph(work.points(), linking, work.options.left_out);
    work.first_scale = local_scale(work.graph, spacing, &work.progress);
    work.known.emplace(work.cloud, spacing, &work.progress);
    const PointTree tree(work.points(), &work.progress);
    if (work.known->any()) {
        work.first_scale.radius = work.known->at(work.points(), work.progress);
        link_stout_wood(work.points(), tree, work.first_scale, spacing, work.graph, work.progress);
    }
    if (work.does(Pass::kPieceEnds))
        link_piece_ends(work.points(), tree, work.first_scale, work.graph, work.progress);
    work.clock.stop("Neighbours", work.graph.neighbour.size() / 2);
}

}  // namespace treerec
