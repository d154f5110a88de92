// What a user wants grown, as text: a command a line (edit/commands/command_text.h), so that it is edited,
// undone and replayed as text is.
//
//     edges longest=0.035 shortest=0.015
//     burl along=1.3 around=90 radius=0.3 inner=0.16 growth=0.5
//     hollow along=0.9 width=0.2 height=0.5 depth=0.15
//     section along=0.2 radii=1.3,0.8,1.3,0.8,1.3,0.8
//     obstacle shape=post around=180 gap=-0.02 radius=0.05
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "edit/commands/arguments.h"
#include "tree/tree.h"

namespace treerec {

// Where on the bark something is.
struct GrowthPlace {
    NodeId node = kNoNode;  // on whose branch
    double along = 0.0;     // metres from that node along its branch; of the trunk: from the ground
    double around = 0.0;    // degrees about the axis, from +X by way of -Z, seen from above
};

// What bark does beside decayed wood and obstacles: metres, and k, A and B of Mizoguchi and Miyata 2014.
struct GrowthLip {
    double radius = 0.0, inner = 0.0, growth = 0.0;  // of the swelling
    double wrap = 0.0;                               // how it turns there
    double band = 0.0;                               // within which it does
};

struct GrowthFeature : GrowthPlace {
    enum class Kind : uint8_t { kBurl, kHollow };
    Kind kind = Kind::kBurl;
    double radius = 0.3;  // R, metres
    double inner = 0.16;  // R', metres
    double growth = 0.5;  // k: how much faster than S_c
    double from = 0.0;    // share of its wood's age after which it begins,
    // Of a burl along the grain, metres: how long, and from sphere to sphere; 0: one sphere.
    double length = 0.0, every = 0.0;
    // Of a hollow:
    double until = 1.0;                // share of that age up to which bark decays there
    double width = 0.0, height = 0.0;  // metres, of its mouth
    double depth = 0.0;                // metres below the bark of the end
    double wall = 0.0;                 // metres of sound wood that are left towards other sides
    std::string region;                // a mesh in which bark decays, a file; else width and height tell
    GrowthLip lip;
};

struct GrowthObstacle : GrowthPlace {
    enum class Shape : uint8_t { kPost, kBox, kSheet, kWire, kTorus, kMesh };
    Shape shape = Shape::kPost;
    double gap = 0.0;                // metres from the bark of the end to its middle; under 0: inside
    std::optional<DVec3> at;         // instead: where its middle is, metres, tree space
    std::optional<DVec3> direction;  // unit, tree space: along a post or wire, across a sheet, a ring's axis
    double length = 0.0, radius = 0.0, width = 0.0, thickness = 0.0;  // metres
    std::string file;                                                 // of a mesh
    // Instead of a file: the name of a mesh that is kept beside the recipe, and its triangles, metres, in its
    // own space, which whoever keeps it fills in.
    std::string mesh;
    std::vector<std::array<DVec3, 3>> triangles;
    std::optional<DVec3> x, y, z;  // of a mesh: where its axes point, tree space, of any length but 0
    GrowthLip lip;
};

// Where branches end as thick as cut ones do.
struct GrowthCuts {
    double least = 0.0;  // metres: of the radius there
    double from = 0.0;   // share of the branch's age there after which it was cut
    double depth = 0.0;  // metres that the wood sinks in
    GrowthLip lip;
};

// What the wood's outline is there.
struct GrowthSection : GrowthPlace {
    std::vector<double> radii;  // shares of the axis's radius in equal directions, the first at `around`
};

struct GrowthRecipe {
    double longest = 0.035;   // T_s, metres
    double shortest = 0.015;  // T_m, metres
    int steps = 0;            // 0: as many as the tree needs
    double twist = 0.0;       // theta_p, radians a metre
    std::vector<GrowthFeature> features;
    std::vector<GrowthObstacle> obstacles;
    std::string seed;                // a closed mesh that it starts from, a file; none: a small prism
    bool fuse = false;               // surfaces that meet become one
    std::optional<GrowthCuts> cuts;  // that heal
    std::vector<GrowthSection> sections;
    std::string text;  // its lines as found on this tree
};

// How a written recipe begins, before the number of its version.
inline constexpr char kGrowthRecipeMark[] = "# treerec growth recipe ";

struct GrowthCommand {
    std::string name;
    std::string summary;  // one sentence
    std::vector<Parameter> parameters;
    void (*take)(GrowthRecipe& recipe, const EditArguments& arguments);
};
const std::vector<GrowthCommand>& growth_commands();

// Throws CommandError with the line's number for what makes no command, Misfit for a node that is not there.
GrowthRecipe read_growth_recipe(const Tree& tree, std::string_view text);

}  // namespace treerec
