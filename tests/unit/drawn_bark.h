// Bark for photos that tests take themselves.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "geometry/vec.h"
#include "textures/texture_noise.h"

namespace treerec::test {

// Rough at all scales, as bark is, with cracks up and down: the colour, 0 to 1, of a place on an upright
// stem, y to the sky.
inline DVec3 bark_at(const DVec3& place) {
    const DVec2 p(std::atan2(place.z, place.x) / (2.0 * std::numbers::pi) + 0.5, 0.25 * place.y + 0.1);
    double tone = 0.0, strength = 0.22;
    for (int i = 0; i < 6; i++, strength *= 0.72)
        tone += strength * texture::noise(p, 24 << i, 32 << i, 7 + static_cast<uint64_t>(i));
    const double crack = std::abs(texture::noise(p, 40, 16, 99)) < 0.08 ? 0.5 : 1.0;
    return glm::clamp(crack * (0.45 + 0.8 * tone) * DVec3(1.0, 0.85, 0.7), 0.0, 1.0);
}

}  // namespace treerec::test
