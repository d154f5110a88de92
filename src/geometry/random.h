// Random numbers that are the same on every platform and standard library.
#pragma once

#include <cmath>
#include <cstdint>

#include "geometry/portable_math.h"
#include "geometry/vec.h"

namespace treerec {

// PCG32 (XSH-RR): O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms
// for Random Number Generation", 2014. Distinct `stream` values give independent sequences for one seed.
class Random {
  public:
    explicit Random(uint64_t seed, uint64_t stream = 0) : increment_((stream << 1) | 1) {
        next();
        state_ += seed;
        next();
    }

    uint32_t next() {
        const uint64_t old = state_;
        state_ = old * 6364136223846793005ULL + increment_;
        const uint32_t shifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
        const uint32_t rotation = static_cast<uint32_t>(old >> 59);
        return (shifted >> rotation) | (shifted << ((32 - rotation) & 31));
    }

    // In [0, 1).
    double uniform() { return next() * 0x1p-32; }
    // In [low, high).
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    // In 0..count-1; count > 0.
    uint32_t below(uint32_t count) {
        return static_cast<uint32_t>((static_cast<uint64_t>(next()) * count) >> 32);
    }
    // Normal deviate with mean 0 and standard deviation 1 (Box and Muller 1958).
    double normal() {
        const double u = 1.0 - uniform();
        const double v = uniform();
        return std::sqrt(-2.0 * portable::log(u)) * portable::cos(2.0 * kPi * v);
    }
    // Uniform on the unit sphere.
    DVec3 direction() {
        const double z = uniform(-1.0, 1.0);
        const double angle = uniform(0.0, 2.0 * kPi);
        const double r = std::sqrt(1.0 - z * z);
        const SineCosine turn = portable_sine_cosine(angle);
        return {r * turn.cosine, r * turn.sine, z};
    }

  private:
    uint64_t state_ = 0;
    uint64_t increment_;
};

// One well-mixed value per (seed, key), without a sequence: for a random number that belongs to a thing,
// so that adding another thing does not change it. SplitMix64 (Steele, Lea and Flood 2014).
inline uint64_t hash_seed(uint64_t seed, uint64_t key) {
    uint64_t z = seed + 0x9E3779B97F4A7C15ULL * (key + 1);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
}

}  // namespace treerec
