#include "pipeline/ask_photos.h"

#include <array>
#include <cmath>
#include <filesystem>

#include "error.h"
#include "file_bytes.h"
#include "geometry/point_tree.h"
#include "geometry/quantile.h"
#include "photos/cameras_tell.h"
#include "photos/colmap_model.h"
#include "photos/quiet_progress.h"
#include "scan/formats/read_cloud.h"
#include "scan/robust.h"

namespace treerec {

namespace {

constexpr size_t kAsked = 4096;       // points of a cloud or a model
constexpr size_t kSearched = 200000;  // points of the cloud that these are looked for among
constexpr size_t kLeastShared = 50;   // points of the model that lie in the cloud's box
constexpr double kNear = 0.01;        // of the box's diagonal: how far half of them may be from the cloud

// The model's own points, or none.
std::string points_of(const std::string& folder) {
    for (const char* name : {"points3D.bin", "points3D.txt"}) {
        const std::filesystem::path path = path_of(folder) / name;
        std::error_code failure;
        if (std::filesystem::is_regular_file(path, failure)) return utf8_of(path);
    }
    return "";
}

// Whether the cloud lies where the model's points do.
bool shares_places(const PointCloud& cloud, const std::string& model_points, Progress& progress) {
    const std::array<Range, 3> box = robust_ranges(cloud.positions, &progress);
    const double diagonal = glm::length(DVec3(box[0].size(), box[1].size(), box[2].size()));
    QuietProgress reading(&progress);
    const PointCloud model = read_cloud(model_points, {}, nullptr, &reading);
    std::vector<Vec3> shared;
    for (const Vec3& p : some_of(model.positions, kAsked, &progress)) {
        const Vec3 at(cloud.frame.to_tree(model.frame.to_scan(DVec3(p))));
        if (box[0].contains(at.x) && box[1].contains(at.y) && box[2].contains(at.z)) shared.push_back(at);
    }
    if (shared.size() < kLeastShared) return false;
    const PointTree tree(some_of(cloud.positions, kSearched, &progress), &progress);
    std::vector<double> distances;
    for (const Vec3& p : shared) {
        uint32_t index = 0;
        float squared = 0.0F;
        if (tree.nearest(p, 1, &index, &squared) == 1) distances.push_back(std::sqrt(squared));
    }
    return !distances.empty() && quantile(distances, 0.5) < kNear * diagonal;
}

}  // namespace

PhotosTell ask_photos(const std::string& path, const PointCloud& cloud, Progress& progress) {
    PhotosTell told;
    QuietProgress reading(&progress);
    for (const std::string& folder : photo_models_beside(path)) {
        progress.check();
        try {
            const std::string points = points_of(folder);
            std::error_code failure;
            const bool own =
                !points.empty() && std::filesystem::equivalent(path_of(points), path_of(path), failure);
            if (!own && (points.empty() || !shares_places(cloud, points, progress))) continue;
            const PhotoModel model = read_photo_model(folder, &reading);
            std::vector<DVec3> seen;
            for (const Vec3& p : some_of(cloud.positions, kAsked, &progress))
                seen.push_back(cloud.frame.to_scan(DVec3(p)));
            const std::optional<DVec3> sky = sky_of(model, seen);
            told.subject = subject_of(model);
            told.one_sided = one_sided_arc(model, seen);
            if (!sky) continue;
            told.photos = model.photos.size();
            told.sky = *sky;
            if (told.subject) {
                const double reach = subject_reach(model, *told.subject, *sky);
                std::vector<DVec3> places;
                for (const Vec3& p : some_of(cloud.positions, kSearched, &progress)) {
                    const DVec3 place = cloud.frame.to_scan(DVec3(p));
                    if (away_from_line(place, *told.subject, *sky) < reach) places.push_back(place);
                }
                told.stem = find_subject_stem(places, *told.subject, *sky, &progress);
            }
            return told;
        } catch (const Cancelled&) {
            throw;
        } catch (const Error& error) {
            told.warnings.push_back("The photos' cameras were not asked for the way up: " +
                                    std::string(error.what()));
        }
    }
    return told;
}

}  // namespace treerec
