#include "geometry/scan_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "error.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr std::array kUpAxes{UpAxis::kX, UpAxis::kY, UpAxis::kZ, UpAxis::kNegX, UpAxis::kNegY, UpAxis::kNegZ};

DVec3 turn_by_axis(UpAxis up, const DVec3& v) {
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

DVec3 turn_back_by_axis(UpAxis up, const DVec3& v) {
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

// By the unit quaternion with this vector part.
DVec3 turn_by(const DVec3& vector, const DVec3& v) {
    const double real = std::sqrt(std::max(0.0, 1.0 - glm::dot(vector, vector)));
    const DVec3 twice = 2.0 * glm::cross(vector, v);
    return v + real * twice + glm::cross(vector, twice);
}

}  // namespace

DVec3 ScanFrame::turn_to_tree(const DVec3& v) const {
    const DVec3 turned = turn_by_axis(up, v);
    return tilt == DVec3(0.0) ? turned : turn_by(tilt, turned);
}

DVec3 ScanFrame::turn_to_scan(const DVec3& v) const {
    return turn_back_by_axis(up, tilt == DVec3(0.0) ? v : turn_by(-tilt, v));
}

void ScanFrame::set_sky(const DVec3& sky) {
    for (const UpAxis axis : kUpAxes)
        if (turn_by_axis(axis, sky).y > turn_by_axis(up, sky).y) up = axis;
    const DVec3 turned = normalized_or(turn_by_axis(up, sky), DVec3(0.0, 1.0, 0.0));
    // Half the way from it to Y.
    const DVec3 half = glm::normalize(turned + DVec3(0.0, 1.0, 0.0));
    tilt = glm::cross(turned, half);
}

double ScanFrame::tilt_degrees() const {
    const double sine = std::min(1.0, glm::length(tilt));
    return glm::degrees(2.0 * portable::atan2(sine, std::sqrt(1.0 - sine * sine)));
}

bool is_tilt(const DVec3& v) {
    return is_finite(v) && glm::dot(v, v) < 1.0;
}

UpAxis parse_up_axis(std::string_view text) {
    for (const UpAxis up : kUpAxes)
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
