// Which frames of a film of a walk around a tree are photos that COLMAP and the matching can use.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "mesh/image.h"

namespace treerec {

// How far a picture moved since the one before, in shares of its width, to the right: what moved farthest to
// the left and to the right. On a walk around a tree what stands behind it moves to one side and what lies
// before it to the other; a hand that turns moves both to the same.
struct SideMotion {
    double left = 0.0;
    double right = 0.0;
};

// What is known of one of the frames, which are equally far apart in time.
struct FrameLook {
    SideMotion moved;
    double sharpness = 0.0;  // mean squared slope of the grey levels
};

struct FrameChoice {
    // Of the picture's width. The background turns by as much as the camera walks around, less what it is
    // near; a phone sees 50 (upright) to 65 degrees of its width, so this is 3 to 5 degrees of the walk: what
    // tracking wants (Zhang 2013, 4.4: 3 to 8).
    double step = 0.06;
    size_t least = 48;    // of a film in which that much moves at all: a circle in steps of 7.5 degrees
    size_t most = 120;    // in steps of 3 degrees
    double still = 0.5;   // of the picture's width in the whole film: less is no walk
    size_t smoothed = 5;  // frames before and after: what comes back within them is a shake
};

// How the picture moved between two frames (grey, of the same size): of blocks with texture, found by least
// differences to a part of a pixel, the one that fifteen of a hundred are beyond, to either side, so that
// what stays in the middle of the picture does not count, nor what is found wrongly. 0 where nothing has
// texture.
SideMotion motion_between(const Image& before, const Image& after);

// (Of grey pictures) 0 for an even one.
double sharpness_of(const Image& picture);

// The indices of the frames that are taken, ascending: one in each step of the way, the sharpest. Shakes that
// come back, and standing still, are no way. Empty where the film is of no walk.
std::vector<size_t> choose_frames(std::span<const FrameLook> frames, const FrameChoice& choice = {});

}  // namespace treerec
