#include "photos/make_cloud.h"

#include "error.h"
#include "photos/quiet_progress.h"
#include "photos/sparse_points.h"
#include "scan/read_cloud.h"

namespace treerec {

namespace {

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
            Densified dense = densify(model, sparse, photos, options.densify, progress);
            made.pairs = dense.pairs;
            made.warnings.insert(made.warnings.end(), dense.warnings.begin(), dense.warnings.end());
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
