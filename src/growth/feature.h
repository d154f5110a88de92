// What makes bark grow unevenly (papers/001, 6 to 8).
#pragma once

#include <cstdint>
#include <vector>

#include "growth/surface.h"

namespace treerec::growth {

// A sphere within which cambium grows faster (papers/001, figures 13 and 14).
struct BurlSphere {
    Vertex centre;        // rides on it
    double radius = 0.0;  // R, metres
    double inner = 0.0;   // R', metres: up to there k is constant
    double growth = 0.0;  // k
};

// Figure 14: k up to R', from there smoothly to 0 at R. distance: metres from the centre.
double burl_growth(const BurlSphere& sphere, double distance);

struct Feature {
    enum class Kind : uint8_t { kBurl, kHollow };
    Kind kind = Kind::kBurl;
    int32_t branch = 0;                              // of the plan
    double along = 0.0;                              // metres of its axis
    DVec3 direction{0.0};                            // unit, from the axis to where on the bark it is
    double first_step = 0.0;                         // from when on; it waits until there is bark
    double radius = 0.0, inner = 0.0, growth = 0.0;  // as of its spheres
    double angle = 0.0;
    std::vector<BurlSphere> spheres;
    bool placed = false;
};

}  // namespace treerec::growth
