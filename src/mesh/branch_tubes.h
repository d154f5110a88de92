// Bark: one tube per branch by parallel-transport frames (Chen 2025, algorithm 9, as meant: once per
// branch).
#pragma once

#include "mesh/grown_bark.h"
#include "mesh/mesh.h"
#include "progress.h"
#include "tree/tree.h"

namespace treerec {

// What tells a cut face from bark: its UV is metres across it from its middle, and v so much less. No bark
// begins so far below its branch's start.
inline constexpr double kCutMark = 64.0;

struct TubeOptions {
    int level = 0;  // level of detail: 0 the finest; each level halves sides, drops rings and thins out twigs
    double twig_level = -1.0;  // of the twigs, where it is another one: between the levels, too
    // Where there would be more, fewer twigs are drawn and stand for the others; 0: any number. What can't be
    // left out may still be more.
    size_t most_triangles = 0;
    double side_length = 0.02;  // metres of circumference per side aimed at, at level 0
    int minimum_sides = 5;      // one less on branches under 24 mm of diameter, two less under 12 mm
    int maximum_sides = 24;
    double bark_width = 0.6;  // metres of circumference per texture repeat
    // For materials that know nothing of the bark's seam: each branch takes a whole number of repeats,
    // whatever their width, instead of as many as fit around it and a seam that the bark's shader blends
    // over.
    bool whole_repeats = false;
    bool pivots = true;  // custom0, radii and wind are filled; files have no place for them
    // Drawn instead of the tubes that it covers; null: tubes alone. It must outlive the call.
    const GrownBark* grown = nullptr;
    bool grown_alone = false;  // without any tube
};

// Vertices carry normals, tangents, UVs (u around in repeats, v along in metres), wind channels.
// At level 0 stout branches have collars: their first vertices lie on their parent's bark, with its normal,
// light and UVs, and a curved web leads up from there; u goes on beyond a round there, below 0 or above it.
// Thinner branches start within their parents. A trunk that stands goes on below the
// root (foot_depth()) and is cut level there, so that slopes hide the cut. It is given a flare where it does
// not widen by itself, and, unless it has no branch, runs out into four to seven surface roots, which the
// tree's place in its scan tells apart from another's. A branch without a trunk is cut across. An empty tree
// or a lone root gives an empty mesh. Deterministic. Throws Error for a tree that reaches beyond 1000 km or
// has too much bark, or Cancelled.
Mesh build_branch_tubes(const Tree& tree, const TubeOptions& options = {},
                        const Progress* progress = nullptr);

}  // namespace treerec
