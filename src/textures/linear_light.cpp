#include "textures/linear_light.h"

#include <array>

#include "geometry/portable_math.h"

namespace treerec {

double linear_of(double stored) {
    return stored <= 0.04045 ? stored / 12.92 : portable::pow((stored + 0.055) / 1.055, 2.4);
}

double stored_of(double light) {
    return light <= 0.0031308 ? 12.92 * light : 1.055 * portable::pow(light, 1.0 / 2.4) - 0.055;
}

DVec3 linear_of(const uint8_t* pixel) {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> made{};
        for (int i = 0; i < 256; i++)
            made[static_cast<size_t>(i)] = linear_of(i / 255.0);
        return made;
    }();
    return {table[pixel[0]], table[pixel[1]], table[pixel[2]]};
}

}  // namespace treerec
