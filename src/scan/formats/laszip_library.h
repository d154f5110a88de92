// The LASzip library of this machine, loaded at run time: M. Isenburg, "LASzip: lossless compression of LiDAR
// data", 2013; its C interface, version 3. Internal to scan/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace treerec {

// A point as LASzip gives it: laszip_point_struct of laszip_api.h, version 3, up to the extra bytes.
struct LaszipPoint {
    int32_t x, y, z;
    uint16_t intensity;
    uint8_t returns;
    uint8_t classification;  // bit 7: withheld, of point formats 0 to 5
    int8_t scan_angle_rank;
    uint8_t user_data;
    uint16_t source;
    int16_t extended_scan_angle;
    uint8_t extended_flags;  // bit 6: withheld, of point formats 6 to 10
    uint8_t extended_classification;
    uint8_t extended_returns;
    uint8_t padding[7];
    double gps_time;
    uint16_t rgb[4];
    uint8_t wave_packet[29];
    int32_t extra_count;
    const uint8_t* extra_bytes;
};
static_assert(offsetof(LaszipPoint, extended_flags) == 22 && offsetof(LaszipPoint, rgb) == 40 &&
              offsetof(LaszipPoint, extra_count) == 80);

// The functions in use; every one returns 0 for success.
struct LaszipLibrary {
    int32_t (*get_version)(uint8_t* major, uint8_t* minor, uint16_t* revision, uint32_t* build) = nullptr;
    int32_t (*create)(void** reader) = nullptr;
    int32_t (*destroy)(void* reader) = nullptr;
    int32_t (*get_error)(void* reader, char** error) = nullptr;
    int32_t (*decompress_selective)(void* reader, uint32_t parts) = nullptr;
    int32_t (*open_reader)(void* reader, const char* path, int* is_compressed) = nullptr;
    int32_t (*get_point_pointer)(void* reader, LaszipPoint** point) = nullptr;
    int32_t (*read_point)(void* reader) = nullptr;
    int32_t (*close_reader)(void* reader) = nullptr;
};

// The library that the environment variable TREEREC_LASZIP names (a file), or else the system's. It is
// looked for once, and stays loaded. Throws Error with a sentence that begins "LASzip" and says what to
// install.
const LaszipLibrary& laszip_library();

}  // namespace treerec
