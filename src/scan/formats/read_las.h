// The header of LAS and LAZ files: ASPRS, "LAS Specification 1.4 - R15", section 2.4. Internal to scan/.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/vec.h"
#include "scan/formats/las_records.h"
#include "scan/formats/readers.h"

namespace treerec {

struct LasHeader {
    std::string version;  // "1.2"
    int format = 0;       // of a point: 0..10
    bool compressed = false;
    size_t data = 0;    // where the points begin
    size_t stride = 0;  // bytes per point
    uint64_t count = 0;
    DVec3 scale{1.0};
    DVec3 offset{0.0};  // both in one unit, whatever the file's heights are in
    ScanUnit unit;
    std::optional<LasExtraField> label;  // of leaf and wood, among the extra bytes

    // Where the extra bytes are in a point.
    size_t extra() const;
    // Where the colours are in a point; 0: there are none.
    size_t rgb() const;
};

// Why points are left out.
enum class LasPoint : uint8_t { kKept, kWithheld, kNoise, kUnwanted };

// Which classes are read.
class LasClasses {
  public:
    explicit LasClasses(const ReadCloudOptions& options);
    // withheld: to be treated as deleted.
    LasPoint judge(uint8_t point_class, bool withheld) const {
        return withheld ? LasPoint::kWithheld : verdicts_[point_class];
    }

  private:
    std::array<LasPoint, 256> verdicts_{};
};

// What else has been decoded of each point.
struct LasPoints {
    std::vector<LasPoint> verdicts;
    std::vector<uint8_t> classes;
};

// One cloud from what has been decoded, whichever way: leaves out and counts the points that are none of it,
// takes classes for labels where no extra bytes are, and finds out how many bits the colours have. Errors if
// nothing is left.
void settle_las(const ReadJob& job, const LasHeader& header, const LasPoints& points, RawCloud& raw);

// Unpacks LAZ with the LASzip library of this machine. Throws Error with the names of its packages where it
// is not installed.
RawCloud read_laz(const ReadJob& job, const LasHeader& header);

}  // namespace treerec
