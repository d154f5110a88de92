// How tree space (metres, Y up, relative to an origin) maps onto the coordinates of the scan file.
#pragma once

#include <string_view>

#include "geometry/vec.h"

namespace treerec {

// The scan's axis that points to the sky.
enum class UpAxis { kX, kY, kZ, kNegX, kNegY, kNegZ };

struct ScanFrame {
    DVec3 origin{0.0};             // where tree space has its (0,0,0), in scan coordinates and units
    double metres_per_unit = 1.0;  // length of one scan unit
    UpAxis up = UpAxis::kY;        // the scan's up axis; Y means the axes agree
    // Where the sky lies along no axis: the vector part of the unit quaternion, whose real part is positive,
    // that turns the tree further when `up` has turned it. In tree axes.
    DVec3 tilt{0.0};

    // A direction of the scan, turned into tree axes (and back). Proper rotations: no mirroring.
    DVec3 turn_to_tree(const DVec3& v) const;
    DVec3 turn_to_scan(const DVec3& v) const;

    DVec3 to_tree(const DVec3& scan) const { return turn_to_tree((scan - origin) * metres_per_unit); }
    DVec3 to_scan(const DVec3& tree) const { return origin + turn_to_scan(tree) / metres_per_unit; }
    // Sets `up` and `tilt` so that this direction of the scan points to the sky. sky: not zero.
    void set_sky(const DVec3& sky);
    // How far the sky is from the axis `up`, in degrees.
    double tilt_degrees() const;
    // A length in metres in the scan's units (for radii in files).
    double length_to_scan(double metres) const { return metres / metres_per_unit; }

    bool operator==(const ScanFrame&) const = default;
};

// "x", "y", "z", "-x", "-y", "-z". Throws Error for another text.
UpAxis parse_up_axis(std::string_view text);
// Whether it can be the vector part of such a quaternion as ScanFrame::tilt's.
bool is_tilt(const DVec3& v);
const char* up_axis_name(UpAxis up);

}  // namespace treerec
