// What a vertex of a growing surface is (Mizoguchi and Miyata 2014, 4).
#pragma once

#include <cstdint>

namespace treerec {

enum class Tissue : uint8_t {
    kApical,   // AM, apical meristem: lengthens its branch
    kCambium,  // CA: thickens it
    kDecayed,  // XY, decayed wood: sinks in
};

}  // namespace treerec
