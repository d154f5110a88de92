#include "pipeline/cleaned_cloud.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <span>
#include <system_error>
#include <vector>

#include "error.h"
#include "file_bytes.h"
#include "scan/formats/read_cloud.h"

namespace treerec {

namespace {

constexpr double kLoaded = 0.9;  // of the whole, when the scan is there

std::string_view cleaned_comment() {
    std::string_view line = kCleanedMark;
    line.remove_prefix(std::string_view("comment ").size());
    line.remove_suffix(1);
    return line;
}

// Points in the foliage's cells are leaves.
void label_foliage(PointCloud& cloud, const Foliage& foliage, const Progress& progress) {
    constexpr size_t kAtOnce = 65536;
    cloud.labels = {"leaf", true, std::vector<uint8_t>(cloud.size(), 1)};
    const std::span<const Vec3> points(cloud.positions);
    for (size_t begin = 0; begin < points.size(); begin += kAtOnce) {
        progress.check();
        const size_t count = std::min(kAtOnce, points.size() - begin);
        for (const int32_t i : points_outside(foliage, points.subspan(begin, count)))
            cloud.labels.values[begin + static_cast<size_t>(i)] = 0;
    }
}

}  // namespace

void label_found_leaves(Reconstruction& result) {
    if (result.wood.empty()) return;
    PointLabels& labels = result.cloud.labels;
    labels = {"leaf", true, std::vector<uint8_t>(result.wood.size())};
    for (size_t i = 0; i < result.wood.size(); i++)
        labels.values[i] = result.wood[i] ? 0 : 1;
}

void write_cleaned_cloud(const std::string& path, const PointCloud& cloud, const Progress* progress) {
    write_cloud(path, cloud, cleaned_comment(), progress);
}

void save_cleaned_scan(const std::string& path, const std::string& scan, const ReconstructOptions& options,
                       const ScanFrame& frame, const Foliage& foliage, Progress* progress,
                       ReconstructCache* cache) {
    require_cloud_extension(path);
    require_writable(path);
    std::error_code failure;
    if (std::filesystem::equivalent(path_of(path), path_of(cloud_file_of(scan)), failure))
        throw Error("'" + path + "' is the scan itself, which would be overwritten; choose another name.");
    SubProgress loading(progress, 0.0, kLoaded), writing(progress, kLoaded, 1.0);
    PointCloud cloud = load_scan(scan, options, frame, std::numeric_limits<size_t>::max(), &loading, cache);
    if (!foliage.empty() && (!cloud.labels.leaf_is_one || cloud.labels.by_colour))
        label_foliage(cloud, foliage, writing);
    writing.update(0.0, "Writing");
    write_cleaned_cloud(path, cloud, &writing);
    writing.update(1.0, "Writing");
}

}  // namespace treerec
