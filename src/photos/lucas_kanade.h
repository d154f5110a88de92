// Where points of one photo are in the next one, by the pyramidal method of Lucas and Kanade (Zhang 2013,
// 4.2, equations 4.1 to 4.4; J.-Y. Bouguet, "Pyramidal implementation of the Lucas Kanade feature tracker",
// 2000): every window only moves.
#pragma once

#include <array>
#include <optional>

#include "geometry/vec.h"
#include "photos/grey_pyramid.h"

namespace treerec {

inline constexpr int kMostReach = 15;  // pixels from a window's middle to its edge

struct LucasKanadeOptions {
    int reach = 10;            // pixels: omega; the window is 2 omega + 1 wide
    int iterations = 20;       // per level, at most
    double still = 0.01;       // pixels: a step that ends them
    double least_eigen = 1.0;  // grey levels per pixel, squared: of a window that has texture both ways
};

// A window of a picture with its slopes, row by row.
struct TrackWindow {
    static constexpr size_t kMost = (2 * kMostReach + 1) * (2 * kMostReach + 1);
    int reach = 0;
    std::array<float, kMost> grey;
    std::array<float, kMost> dx;  // grey levels per pixel
    std::array<float, kMost> dy;

    size_t count() const { return static_cast<size_t>(2 * reach + 1) * static_cast<size_t>(2 * reach + 1); }
    // False where it leaves the picture; then nothing is filled in.
    bool take(const GreyPicture& picture, const DVec2& middle, int reach);
};

// place: in the picture, pixels. guess: where it may be in the other one. Nothing where the window has no
// texture, or leaves one of the pictures at their own size. Levels that it leaves are not asked.
std::optional<DVec2> track_lucas_kanade(const GreyPyramid& from, const GreyPyramid& to, const DVec2& place,
                                        const DVec2& guess, const LucasKanadeOptions& options = {});

}  // namespace treerec
