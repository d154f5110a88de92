// What makes bark grow unevenly (Mizoguchi and Miyata 2014, 6 to 8). Internal to growth/.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "growth/surface.h"

namespace treerec::growth {

// A sphere within which cambium grows faster (Mizoguchi and Miyata 2014, figures 13 and 14).
struct BurlSphere {
    Vertex centre;        // rides on it
    double radius = 0.0;  // R, metres
    double inner = 0.0;   // R', metres: up to there k is constant
    double growth = 0.0;  // k
};

// Figure 14: k up to R', from there smoothly to 0 at R. distance: metres from the centre.
double burl_growth(double radius, double inner, double growth, double distance);

// What cambium does beside decayed wood or an obstacle (Mizoguchi and Miyata 2014, 7.2, 7.3 and 8).
struct Lip {
    double radius = 0.0, inner = 0.0, growth = 0.0;  // of the burl spheres there
    double wrap = 0.0;                               // A of equation 9, B of equation 10
    double band = 0.0;                               // metres within which it turns there
};

// A closed mesh, metres, tree space.
class Region {
  public:
    // Counter-clockwise from outside.
    void add(const DVec3& a, const DVec3& b, const DVec3& c);
    // Whether the point is inside: by the winding number (van Oosterom and Strackee 1983).
    bool holds(const DVec3& point) const;

  private:
    std::vector<std::array<DVec3, 3>> triangles_;
    Box box_;
};

struct Feature {
    enum class Kind : uint8_t { kBurl, kHollow };
    Kind kind = Kind::kBurl;
    int32_t branch = 0;                              // of the plan
    double along = 0.0;                              // metres of its axis
    DVec3 direction{0.0};                            // unit, from the axis to where on the bark it is
    double first_step = 0.0;                         // from when on; it waits until there is bark
    double radius = 0.0, inner = 0.0, growth = 0.0;  // as of its spheres
    double length = 0.0, every = 0.0;  // of a burl along the grain: metres of sap link, and between spheres
    std::vector<BurlSphere> spheres;
    Box reach;  // of the spheres, in this step

    // Of a hollow.
    Region region;
    double last_step = 0.0;  // after which no more cambium decays
    double rate = 0.0;       // S_h of equation 8, metres a step
    double deepest = 0.0;    // metres that wood sinks at most
    double wall = 0.0;       // metres of sound wood that are left between it and the bark on other sides
    bool cut = false;        // the branch's end, whose tip dies, too
    Lip lip;
    bool placed = false;
};

}  // namespace treerec::growth
