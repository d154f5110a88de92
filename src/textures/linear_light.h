// Colours as they are stored (sRGB) and as light.
#pragma once

#include <cstdint>

#include "geometry/vec.h"

namespace treerec {

// What light of each primary adds to the luminance (IEC 61966-2-1, after ITU-R BT.709).
inline const DVec3 kLuminance{0.2126, 0.7152, 0.0722};

inline double luminance_of(const DVec3& light) {
    return glm::dot(kLuminance, light);
}

// 0..1 each (IEC 61966-2-1); the same to the last bit everywhere.
double linear_of(double stored);
double stored_of(double light);

// The first three levels of a pixel.
DVec3 linear_of(const uint8_t* pixel);

}  // namespace treerec
