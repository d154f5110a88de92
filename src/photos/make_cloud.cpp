#include "photos/make_cloud.h"

#include "error.h"
#include "geometry/parallel.h"
#include "photos/quiet_progress.h"
#include "photos/sky_blends.h"
#include "photos/sky_mask.h"
#include "photos/sparse_points.h"
#include "photos/thin_points.h"
#include "scan/formats/read_cloud.h"

namespace treerec {

namespace {

constexpr size_t kManyThin = 2000;  // places of thin wood: a crown
constexpr double kSpacing = 0.7;    // of the dense points' cells, between points that tell of the shape
constexpr double kDenseEnd = 0.35;  // of the progress
constexpr double kSkyEnd = 0.1;     // of what comes after it

// The model's points that are sure.
PointCloud sure_points(const std::vector<SparsePoint>& points, const MakeCloudOptions& options,
                       MadeCloud& made) {
    PointCloud cloud;
    for (const SparsePoint& point : points) {
        if (point.track < options.least_track || point.error > options.most_error) {
            made.left_out++;
            continue;
        }
        if (cloud.empty()) cloud.frame.origin = glm::round(point.position);
        cloud.positions.emplace_back(point.position - cloud.frame.origin);
        cloud.colors.push_back(point.color);
    }
    if (cloud.empty())
        throw Error("None of the " + std::to_string(made.left_out) + " points that COLMAP found is seen by " +
                    std::to_string(options.least_track) + " photos; take more photos that overlap.");
    return cloud;
}

std::vector<DVec3> places_of(const PointCloud& cloud) {
    std::vector<DVec3> places;
    places.reserve(cloud.size());
    for (const Vec3& p : cloud.positions)
        places.push_back(cloud.frame.origin + DVec3(p));
    return places;
}

// Leaves out of a dense cloud what the photos show the sky at, which is what matching makes of the sky beside
// a twig, and puts thin wood in.
void refine(PointCloud& cloud, const PhotoModel& model, const std::vector<DVec3>& sparse,
            const std::string& photos, const MakeCloudOptions& options, MadeCloud& made, Progress* progress) {
    SubProgress carving(progress, 0.0, kSkyEnd), looking(progress, kSkyEnd, 1.0);
    const SkyCarver sky(model, sparse, photos, options.carve, &carving);
    std::vector<uint8_t> keep(cloud.size(), 1);
    parallel_for(cloud.size(), 1024, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; i++)
            keep[i] = !sky.is_sky(cloud.frame.origin + DVec3(cloud.positions[i]));
    });
    cloud.keep_only(keep);
    made.sky = sky.colour();
    drop_sky_blends(cloud, made.sky, progress);
    made.thin = add_thin_wood(
        cloud, made.cell, find_thin_wood(model, sparse, photos, sky, options.thin_wood, &looking), progress);
    // Rings of points around twigs are denser than they are sure.
    if (made.thin > kManyThin) cloud.spacing = kSpacing * made.cell;
}

}  // namespace

MadeCloud make_cloud(const std::string& model_folder, const std::string& photos, const std::string& out,
                     const MakeCloudOptions& options, Progress* progress) {
    QuietProgress quiet(progress);
    MadeCloud made;
    PointCloud cloud = sure_points(read_sparse_points(model_folder, &quiet), options, made);
    if (options.dense) {
        const PhotoModel model = without_held_out(read_photo_model(model_folder, &quiet), options.hold_out);
        const std::vector<DVec3> sparse = places_of(cloud);
        SubProgress matching(progress, 0.0, kDenseEnd), refining(progress, kDenseEnd, 1.0);
        try {
            Densified dense = densify(model, sparse, photos, options.densify, &matching);
            made.warnings.insert(made.warnings.end(), dense.warnings.begin(), dense.warnings.end());
            made.cell = dense.cell;
            refine(dense.cloud, model, sparse, photos, options, made, &refining);
            if (dense.cloud.empty()) throw Error("The photos agree on nothing but the sky.");
            made.pairs = dense.pairs;
            cloud = std::move(dense.cloud);
        } catch (const Cancelled&) {
            throw;
        } catch (const Error& error) {
            made.warnings.push_back(std::string(error.what()) +
                                    " The cloud has the few points that placed the cameras.");
        }
    }
    made.points = cloud.size();
    write_cloud(out, cloud);
    return made;
}

}  // namespace treerec
