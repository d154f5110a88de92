// What the matches of two photos have in common: the epipolar geometry of the two cameras.
#pragma once

#include <span>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"

namespace treerec {

// Two places, in pixels of their photos.
struct PlacePair {
    DVec2 one{0.0};
    DVec2 other{0.0};
};

struct PairGeometryOptions {
    double tolerance = 2.0;  // pixels from the epipolar line (Sampson's distance)
    size_t least = 15;       // matches that agree, as COLMAP asks, and of them all
    double least_share = 0.25;
    // The places are ways (x, y, 1) in the cameras' own coordinates, and the tolerance is in these: asked is
    // an essential matrix, which has two equal singular values (Huang and Faugeras 1989).
    bool calibrated = false;
};

// The square of how far a match is from the epipolar lines of `f`, in the places' unit (Sampson's distance;
// Hartley and Zisserman, "Multiple View Geometry", 2004, 11.4.3). f: other' f one = 0.
double squared_sampson(const DMat3& f, const PlacePair& match);

// Which of the matches agree on one epipolar geometry: for each 1 or 0. All 0 where too few do: then the
// photos don't show the same thing. The fundamental matrix is that of most agreement among random samples of
// eight (Fischler and Bolles 1981; Hartley, "In defense of the eight-point algorithm", 1997), each of them
// better than the last one fitted to all that agree (Chum, Matas and Kittler, "Locally optimized RANSAC",
// 2003). The lens is taken for straight: the tolerance has to cover how far it bends.
std::vector<uint8_t> agreeing_on_geometry(std::span<const PlacePair> matches,
                                          const PairGeometryOptions& options = {},
                                          const Progress* progress = nullptr);

}  // namespace treerec
