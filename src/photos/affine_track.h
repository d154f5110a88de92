// Where a point of one photo is in another one, and how its surroundings are turned, sheared and scaled
// there: the pyramidal method of Lucas and Kanade with an affine motion (Zhang 2013, 4.3.1, equations 4.5
// to 4.8 and algorithm 2).
#pragma once

#include <optional>

#include "geometry/vec.h"
#include "photos/grey_pyramid.h"
#include "photos/lucas_kanade.h"

namespace treerec {

using DMat2 = glm::dmat2;

// Takes what lies `offset` beside a point of one picture to `place` + turn * offset of the other; pixels.
struct AffineMotion {
    DVec2 place{0.0};
    DMat2 turn{1.0};
};

struct AffineTrack {
    AffineMotion motion;
    double similarity =
        0.0;  // -1 to 1: the normalized correlation (4.8) of both windows, one warped by `turn`
};

struct AffineTrackOptions {
    LucasKanadeOptions window;
    size_t levels = 5;          // that are asked, at most: fewer where the guess is a good one
    double most_stretch = 2.5;  // a motion that stretches or shrinks more is none
};

// Solves (4.6) by least squares level by level, with the slopes of `from` at the window's own offsets, where
// (4.7) prints the motion; its brightness and contrast may differ (the correlation does not mind them
// either). The whole motion travels from level to level: `place` doubles, `turn` stays as it is. guess: the
// pair's coarse motion there. Nothing where the window has no texture, leaves a picture, or finds no place.
std::optional<AffineTrack> track_affine(const GreyPyramid& from, const GreyPyramid& to, const DVec2& place,
                                        const AffineMotion& guess, const AffineTrackOptions& options = {});

}  // namespace treerec
