// A point cloud as Python has it.
#pragma once

#include <nanobind/nanobind.h>

#include <string>

#include "scan/formats/read_cloud.h"
#include "scan/point_cloud.h"

namespace treerec {

// As it was read. path: of its file; empty for one of arrays.
struct ScannedCloud {
    PointCloud cloud;
    ReadCloudReport read;
    std::string path;
};

void bind_cloud(nanobind::module_& module);

}  // namespace treerec
