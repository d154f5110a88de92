// Bark that grew (Mizoguchi and Miyata 2014): a surface that grows around a tree, with burls.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "growth/recipe.h"
#include "growth/recording.h"
#include "mesh/grown_bark.h"
#include "progress.h"
#include "tree/tree.h"

namespace treerec {

// Of one step, for who wants to judge it.
struct GrowthStep {
    int step = 0;
    size_t vertices = 0, edges = 0, faces = 0;
    long chi = 0;  // V - E + F
    size_t components = 0;
    size_t above_longest = 0;                                                          // edges
    size_t apical = 0, parting = 0, link = 0, fold = 0, contact = 0, unexplained = 0;  // edges under T_m
    size_t intersections = 0;                                                          // pairs of faces
    size_t frozen = 0;       // vertices that could not move,
    size_t frozen_free = 0;  // and of them those away from other parts of the surface and obstacles
    bool closed = false, outward = false;
};

struct GrowBarkOptions {
    // Every so many steps, and after the last, the surface is judged by CGAL; 0: never.
    int check_every = 0;
    // A folder that each step's moves are written to (growth/trace.h); empty: none.
    std::string trace{};
    // Sees the surface on its way; null: nobody. It must outlive the call.
    GrowthWatcher* watcher = nullptr;
};

struct GrownTree {
    GrownBark bark;
    int steps = 0;
    size_t fused = 0;  // places where surfaces became one
    long chi = 0;      // of the last step: V - E + F
    std::vector<GrowthStep> checks;
    std::vector<std::string> remarks;  // sentences for the user
};

// The same tree and recipe give the same bytes. Throws Error for a tree without wood that is thick enough,
// and in a build without CGAL; Cancelled.
GrownTree grow_bark(const Tree& tree, const GrowthRecipe& recipe, const GrowBarkOptions& options = {},
                    Progress* progress = nullptr);

// How far a lighter level is from the full surface.
struct LevelError {
    size_t triangles = 0;
    // Metres from the full surface's vertices to the nearest place of the level that faces the same way:
    double mean = 0.0, most = 0.0;
    double out = 0.0;   // and the mean of how far outside of the full surface that lies (under 0: inside)
    double turn = 0.0;  // degrees between the normals there, root of the mean square
};

// level: see lighter_bark(); bark without lighter levels is compared with itself. Throws Error in a build
// without CGAL.
LevelError measure_level(const GrownBark& bark, double level);

}  // namespace treerec
