// How much of a tree's outline changed: two meshes as black shapes, seen from four sides.
#pragma once

#include <array>

#include "mesh/mesh.h"
#include "progress.h"

namespace treerec {

// Orthographic, level, from azimuths 0, 45, 90 and 135 degrees about the up axis: what is seen from the
// opposite side is the mirror image. Amounts are pixels, of which each counts by the share of it that is
// covered (16 samples), as a smoothed picture shows it: else twigs thinner than a pixel would come and go
// with the smallest move.
struct SilhouetteView {
    double pixels = 0.0;     // of the picture, which just holds both
    double before = 0.0;     // covered by the first mesh
    double after = 0.0;      // by the second
    double differing = 0.0;  // the sum of the differences

    // Of what either covers; 0 where both are empty.
    double share_of_silhouette() const;
    // Of the whole picture.
    double share_of_picture() const;
};

struct SilhouetteChange {
    std::array<SilhouetteView, 4> views;

    SilhouetteView all() const;  // the sums
};

// pixels: of the longer side of the largest picture, 16..4096; all four have one scale. Meshes are in metres,
// Y up. Deterministic, on several threads. Throws Error for pixels out of range, or Cancelled.
SilhouetteChange compare_silhouettes(const Mesh& before, const Mesh& after, int pixels = 1024,
                                     const Progress* progress = nullptr);

}  // namespace treerec
