// A scanned cloud: what the scan readers write and the cleaners and skeletonizers read.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/scan_frame.h"
#include "geometry/vec.h"

namespace treerec {

using Color8 = std::array<uint8_t, 3>;

// How long a unit of the scan is, as far as its file tells.
struct ScanUnit {
    double metres = 0.0;   // 0: it does not tell
    bool assumed = false;  // by the kind of file, not by its words
    std::string doubt;     // a sentence for the user where it may be another one; else empty
};

// What a column of the scan's file says of leaves and wood.
struct PointLabels {
    std::string column;           // its name
    bool leaf_is_one = false;     // else there may be two values, and which is which is still to be found out
    std::vector<uint8_t> values;  // by point; empty where there are no labels
    // They tell what has not the colour of the stem's bark in photos: a hint beside all others, for what is
    // hidden among leaves has their colour.
    bool by_colour = false;

    bool empty() const { return values.empty(); }
};

// positions: relative to frame.origin, in the axes and units that the frame says (fresh from a file: the
// scan's own; after orient_cloud(): tree space, metres and Y up). float is exact to 2 micrometres at 30 m.
// colors, normals: empty, or one per point. radii: likewise, of the wood that a point lies on, where the
// cloud's maker knows it better than its points tell (a line in photos, some pixels wide), else 0; in the
// unit of positions.
struct PointCloud {
    ScanFrame frame;
    std::vector<Vec3> positions;
    std::vector<Color8> colors;
    std::vector<Vec3> normals;
    std::vector<float> radii;
    ScanUnit unit;
    PointLabels labels;
    // In the scan's unit: points nearer to each other tell no more of the shape. 0: its file does not tell.
    double spacing = 0.0;

    size_t size() const { return positions.size(); }
    bool empty() const { return positions.empty(); }
    bool has_colors() const { return !colors.empty(); }
    bool has_normals() const { return !normals.empty(); }

    // Keeps the points whose keep[i] is not 0, in order. keep: one entry per point.
    void keep_only(const std::vector<uint8_t>& keep);
};

}  // namespace treerec
