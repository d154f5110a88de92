// How long nothing can come into a vertex's way, by how things lie now. Internal to growth/.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "growth/face_grid.h"
#include "growth/obstacles.h"
#include "growth/surface.h"

namespace treerec::growth {

// Cosine to a patch's mean normal from which on it can't fold over.
inline constexpr double kGraph = 0.2;
inline constexpr double kFold = -0.9976;  // cosine between the normals of two faces 4 degrees apart
inline constexpr double kTouch = 1e-9;    // metres between faces that share a corner

// Changes nothing, so that several threads may ask at once, each with a Scratch of its own.
class Outlook {
  public:
    struct Scratch {
        std::vector<uint32_t> stamps;  // by face
        uint32_t stamp = 0;
        std::vector<Face> ring, near, found, sheet;
        std::vector<double> distances;  // metres, of those found
        struct Triangle {
            Vertex vertices[3];
            DVec3 corners[3];
            DVec3 normal;   // unit
            double area;    // doubled, square metres
            double around;  // metres: two sides together
        };
        std::vector<Triangle> triangles;                   // of the ring, then of those near
        std::vector<std::pair<uint32_t, uint32_t>> pairs;  // of them, without a common corner
    };

    // reach: metres, what lies farther is not looked at; least: twice the area of the least face, square
    // metres. obstacles may be null.
    Outlook(const Surface& surface, const FaceGrid& grid, const Obstacles* obstacles, double reach,
            double least)
        : surface_(surface), grid_(grid), obstacles_(obstacles), reach_(reach), least_(least) {}

    // Metres that all vertices may move, each its own way, until the faces around this one, and those that
    // touch them, may fold over; negative where they may now.
    // step: metres that each moves in the next one at most; more than a few of those need not be exact.
    double flat(Vertex vertex, double step, Scratch& scratch) const;
    // Metres to what is nearest to the faces around it without being their own sheet; at most reach.
    double clear(Vertex vertex, double step, Scratch& scratch) const;

  private:
    double apart(const Scratch& scratch, Face face, double enough, double most) const;
    Scratch::Triangle triangle(Face face) const;
    DVec3 gather(Vertex vertex, Scratch& scratch) const;
    double flat_by_pairs(double step, Scratch& scratch) const;

    const Surface& surface_;
    const FaceGrid& grid_;
    const Obstacles* obstacles_;
    const double reach_, least_;
};

}  // namespace treerec::growth
