#include "scan/point_cloud.h"

namespace treerec {

namespace {

template <typename T>
void compact(std::vector<T>& values, const std::vector<uint8_t>& keep) {
    if (values.empty()) return;
    size_t kept = 0;
    for (size_t i = 0; i < values.size(); i++)
        if (keep[i]) values[kept++] = values[i];
    values.resize(kept);
}

}  // namespace

void PointCloud::keep_only(const std::vector<uint8_t>& keep) {
    compact(positions, keep);
    compact(colors, keep);
    compact(normals, keep);
    compact(radii, keep);
    compact(labels.values, keep);
}

}  // namespace treerec
