// What the surroundings of corners look like from afar: small pictures that say which corner of one photo may
// be which of another, to begin tracking from (M. Brown, R. Szeliski and S. Winder, "Multi-image matching
// using multi-scale oriented patches", 2005, section 4; here they stand upright, as people hold cameras).
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "photos/affine_track.h"
#include "photos/grey_pyramid.h"
#include "photos/harris.h"

namespace treerec {

// How one photo is turned and scaled in another one, as a whole.
struct PairTurn {
    double degrees = 0.0;
    double scale = 1.0;

    DMat2 matrix() const;
};

struct CornerPatches {
    static constexpr size_t kSide = 8;
    static constexpr size_t kSize = kSide * kSide;  // grey levels, 5 pixels of the picture apart

    std::vector<DVec2> places;      // of those that have one: not too near the border
    std::vector<uint32_t> corners;  // their numbers
    std::vector<float> values;      // kSize rows of places.size(): mean 0, length 1 for each patch
};

// corners: the first `most` of them. turn: of the patch in the picture.
CornerPatches patches_of(const GreyPyramid& pyramid, const std::vector<Corner>& corners, size_t most,
                         const PairTurn& turn = {});

// The patches of the first corners alone.
CornerPatches strongest_of(const CornerPatches& patches, size_t most);

// Two corners that look alike.
struct CoarseMatch {
    uint32_t one = 0;  // number of the corner
    uint32_t other = 0;
    DVec2 from{0.0};  // their places in both pictures, pixels
    DVec2 to{0.0};
};

// The patches of `other` that are most like the one of a corner, the likest first, none of them near another
// or near `but`: what a match may have been taken for. Numbers of places; none where the corner has no patch.
std::vector<size_t> rivals_of(const CornerPatches& one, uint32_t corner, const CornerPatches& other,
                              const DVec2& but, size_t most);

// Each the other's most similar one, clearly more similar than any other, and moved as those around it. turn:
// that the patches of `other` were made with.
std::vector<CoarseMatch> match_patches(const CornerPatches& one, const CornerPatches& other,
                                       const PairTurn& turn = {});

}  // namespace treerec
