// How a tree's outline agrees with masks, as text. Internal to cli/.
#pragma once

#include <cstdio>

#include "fidelity/photo_fidelity.h"
#include "fidelity/photo_judge.h"
#include "fidelity/photo_overlap.h"

namespace treerec {

inline void print_outline(const OutlineOverlap& outline, OutlineSource source = OutlineSource::kMasks) {
    if (source == OutlineSource::kSky) {
        std::printf(
            "outline before the sky in %zu photos: precision at most %.3f; without masks recall is not "
            "known\n",
            outline.photos.size(), outline.mean.precision);
        return;
    }
    std::printf("outline in %zu photos: recall %.3f, precision %.3f, intersection over union %.3f\n",
                outline.photos.size(), outline.mean.recall, outline.mean.precision, outline.mean.iou);
}

// r_s: R_s.
inline void print_fidelity(const PhotoFidelity& photos, double r_s, OutlineSource source) {
    const char* const most = source == OutlineSource::kSky ? "at most " : "";
    std::printf("I %.3f (%zu photos judge), R_3d %s%.3f, R_s %.3f, Q = I R_3d R_s = %s%.3f\n",
                photos.information, photos.photos.size(), most, photos.reconstruction, r_s, most,
                photos.information * photos.reconstruction * r_s);
}

}  // namespace treerec
