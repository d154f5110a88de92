#include "geometry/scan_frame.h"

#include <string>

#include "error.h"

namespace treerec {

DVec3 ScanFrame::turn_to_tree(const DVec3& v) const {
    switch (up) {
        case UpAxis::kX:
            return {v.z, v.x, v.y};
        case UpAxis::kY:
            return v;
        case UpAxis::kZ:
            return {v.x, v.z, -v.y};
        case UpAxis::kNegX:
            return {-v.z, -v.x, v.y};
        case UpAxis::kNegY:
            return {v.x, -v.y, -v.z};
        case UpAxis::kNegZ:
            return {v.x, -v.z, v.y};
    }
    return v;
}

DVec3 ScanFrame::turn_to_scan(const DVec3& v) const {
    switch (up) {
        case UpAxis::kX:
            return {v.y, v.z, v.x};
        case UpAxis::kY:
            return v;
        case UpAxis::kZ:
            return {v.x, -v.z, v.y};
        case UpAxis::kNegX:
            return {-v.y, v.z, -v.x};
        case UpAxis::kNegY:
            return {v.x, -v.y, -v.z};
        case UpAxis::kNegZ:
            return {v.x, v.z, -v.y};
    }
    return v;
}

UpAxis parse_up_axis(std::string_view text) {
    for (UpAxis up : {UpAxis::kX, UpAxis::kY, UpAxis::kZ, UpAxis::kNegX, UpAxis::kNegY, UpAxis::kNegZ})
        if (text == up_axis_name(up)) return up;
    throw Error(quote_word(text) + " is no up axis; use x, y, z, -x, -y or -z.");
}

const char* up_axis_name(UpAxis up) {
    switch (up) {
        case UpAxis::kX:
            return "x";
        case UpAxis::kY:
            return "y";
        case UpAxis::kZ:
            return "z";
        case UpAxis::kNegX:
            return "-x";
        case UpAxis::kNegY:
            return "-y";
        case UpAxis::kNegZ:
            return "-z";
    }
    return "y";
}

}  // namespace treerec
