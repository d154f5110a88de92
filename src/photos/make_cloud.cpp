#include "photos/make_cloud.h"

#include "error.h"
#include "geometry/parallel.h"
#include "photos/quiet_progress.h"
#include "photos/sky_mask.h"
#include "photos/sparse_points.h"
#include "photos/thin_points.h"
#include "scan/read_cloud.h"

namespace treerec {

namespace {

constexpr double kSkyBegin = 0.35;  // of the progress
constexpr double kThinBegin = 0.4;

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

// Leaves out the points that the photos show the sky at: what matching makes of the sky beside a twig.
void carve(PointCloud& cloud, const SkyCarver& sky) {
    std::vector<uint8_t> drop(cloud.size(), 0);
    parallel_for(cloud.size(), 1024, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; i++)
            drop[i] = sky.is_sky(cloud.frame.origin + DVec3(cloud.positions[i]));
    });
    size_t kept = 0;
    for (size_t i = 0; i < cloud.size(); i++) {
        if (drop[i]) continue;
        cloud.positions[kept] = cloud.positions[i];
        cloud.colors[kept++] = cloud.colors[i];
    }
    cloud.positions.resize(kept);
    cloud.colors.resize(kept);
}

std::vector<DVec3> places_of(const PointCloud& cloud) {
    std::vector<DVec3> places;
    places.reserve(cloud.size());
    for (const Vec3& p : cloud.positions)
        places.push_back(cloud.frame.origin + DVec3(p));
    return places;
}

}  // namespace

MadeCloud make_cloud(const std::string& model_folder, const std::string& photos, const std::string& out,
                     const MakeCloudOptions& options, Progress* progress) {
    QuietProgress quiet(progress);
    MadeCloud made;
    PointCloud cloud = sure_points(read_sparse_points(model_folder, &quiet), options, made);
    if (options.dense) {
        const PhotoModel model = read_photo_model(model_folder, &quiet);
        const std::vector<DVec3> sparse = places_of(cloud);
        try {
            SubProgress matching(progress, 0.0, kSkyBegin), looking(progress, kThinBegin, 1.0);
            Densified dense = densify(model, sparse, photos, options.densify, &matching);
            made.pairs = dense.pairs;
            made.warnings.insert(made.warnings.end(), dense.warnings.begin(), dense.warnings.end());
            made.cell = dense.cell;
            cloud = std::move(dense.cloud);
            SubProgress carving(progress, kSkyBegin, kThinBegin);
            const SkyCarver sky(model, sparse, photos, options.carve, &carving);
            carve(cloud, sky);
            if (options.thin) {
                ThinPoints thin = find_thin_points(model, sparse, photos, options.thin_wood, &looking);
                thin.remove_if([&](const ThinPlace& place) { return sky.is_sky(place.position); });
                thin.before_sky.resize(thin.places.size());
                parallel_for(thin.places.size(), 256, [&](size_t first, size_t last) {
                    for (size_t i = first; i < last; i++)
                        thin.before_sky[i] = sky.is_before_sky(thin.places[i].position, thin.places[i].way,
                                                               thin.places[i].radius);
                });
                made.thin = add_thin_points(cloud, dense.cell, thin, progress);
            }
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
