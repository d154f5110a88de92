// The header of LAS and LAZ files: ASPRS, "LAS Specification 1.4 - R15", section 2.4. Internal to scan/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "geometry/vec.h"
#include "scan/readers.h"

namespace treerec {

struct LasHeader {
    std::string version;  // "1.2"
    int format = 0;       // of a point: 0..10
    bool compressed = false;
    size_t data = 0;    // where the points begin
    size_t stride = 0;  // bytes per point
    uint64_t count = 0;
    DVec3 scale{1.0};
    DVec3 offset{0.0};

    // Where the colours are in a point; 0: there are none.
    size_t rgb() const;
};

// Whether a point's flags say "withheld": to be treated as deleted. record: as the specification has it.
bool is_withheld(const char* record, int format);

// One cloud from what has been decoded, whichever way: leaves out and counts the withheld points, and finds
// out how many bits the colours have. Errors if nothing is left.
void settle_las(const ReadJob& job, const std::vector<uint8_t>& withheld, RawCloud& raw);

// Unpacks LAZ with the LASzip library of this machine. Throws Error with the names of its packages where it
// is not installed.
RawCloud read_laz(const ReadJob& job, const LasHeader& header);

}  // namespace treerec
