// The points of a COLMAP model, with what COLMAP tells of how well each is known.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec {

struct SparsePoint {
    DVec3 position{0.0};  // in the model's coordinates
    Color8 color{};
    double error = 0.0;  // pixels: the mean distance of what the photos saw of it from where it falls
    size_t track = 0;    // photos that saw it
    std::vector<uint32_t> photos{};  // these, by Photo::number
};

// points3D.bin, or else points3D.txt, of a model's folder, in the file's order. Throws Error, or Cancelled.
std::vector<SparsePoint> read_sparse_points(const std::string& folder, Progress* progress = nullptr);

// The same from the file's contents. path: what sentences call it.
std::vector<SparsePoint> parse_sparse_points(std::string_view bytes, bool text, const std::string& path);

}  // namespace treerec
