#include "pipeline/reconstruct_cache.h"

#include <system_error>

#include "file_bytes.h"

namespace treerec {

namespace {

size_t bytes_of(const PointCloud& cloud) {
    return cloud.positions.size() * sizeof(Vec3) + cloud.colors.size() * sizeof(Color8) +
           cloud.normals.size() * sizeof(Vec3) + cloud.radii.size() * sizeof(float) +
           cloud.labels.values.size();
}

}  // namespace

std::optional<FileStamp> FileStamp::of(const std::string& path) {
    const std::filesystem::path file = path_of(path);
    std::error_code failed;
    FileStamp stamp;
    stamp.path = path;
    stamp.size = std::filesystem::file_size(file, failed);
    if (failed) return std::nullopt;
    stamp.written = std::filesystem::last_write_time(file, failed);
    if (failed) return std::nullopt;
    return stamp;
}

size_t ReconstructCache::bytes() const {
    size_t sum = 0;
    if (read) sum += bytes_of(read->cloud);
    if (clean) sum += bytes_of(clean->cloud);
    if (leaves)
        sum += leaves->leaf.size() + leaves->wood_path.size() + leaves->leafiness.size() * sizeof(float);
    return sum;
}

}  // namespace treerec
