// The records of LAS files beside their points: how long a unit is, and what extra bytes a point has. ASPRS,
// "LAS Specification 1.4 - R15", sections 2.5, 2.7 and 3. Internal to scan/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ply_header.h"
#include "scan/point_cloud.h"

namespace treerec {

// A record: whose it is, its number, and its bytes.
struct LasRecord {
    std::string_view user;
    uint16_t id = 0;
    std::string_view bytes;
};

// Those between the header and the points, and in LAS 1.4 those behind the points. Ends at the first one that
// is cut off. bytes: of the whole file, at least 227.
std::vector<LasRecord> las_records(std::string_view bytes);

struct LasUnits {
    ScanUnit unit;               // of x and y; metres where the file is silent
    std::string name;            // "US survey feet"; empty where the file is silent
    double height_factor = 1.0;  // of z, to the same unit
    std::string height_name;     // where the factor is not 1
    bool degrees = false;        // x and y are longitude and latitude
};

// By the coordinate system that the records name, in WKT (1 or 2) or in GeoTIFF's keys. A system that is
// named by its EPSG number alone is taken for metres, with a doubt unless it is a zone of UTM.
LasUnits las_units(std::string_view bytes);

// A field of the extra bytes, from the start of these.
struct LasExtraField {
    std::string name;
    PlyType type = PlyType::kUint8;
    size_t offset = 0;
};

// Those that are single numbers.
std::vector<LasExtraField> las_extra_fields(std::string_view bytes);

}  // namespace treerec
