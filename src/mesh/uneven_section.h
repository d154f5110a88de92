// No wood is quite round: what a section has where nothing better is known. Internal to mesh/.
#pragma once

#include <array>
#include <cstdint>

namespace treerec {

// A sum of low harmonics of the angle, whose phases drift along the wood. Its mean radius is the wood's.
struct UnevenSection {
    // Metres along: it is round at both ends, and uneven between them. Nothing where they are equal.
    double from = 0.0;
    double until = 0.0;
    double radius = 1.0;                       // metres, about that of the wood
    std::array<double, 3> phases = {0, 0, 0};  // of the second to the fourth harmonic, where it begins,
    std::array<double, 3> drifts = {0, 0, 0};  // and radians per metre

    // The radius at an angle, over the wood's.
    double factor(double along, double angle) const { return 1.0 + at(along, angle, false); }
    // How that changes with the angle, per radian.
    double turn(double along, double angle) const { return at(along, angle, true); }

  private:
    double at(double along, double angle, bool derivative) const;
};

// seed: tells branches apart.
UnevenSection uneven_section(uint64_t seed, double radius, double from, double until);

}  // namespace treerec
