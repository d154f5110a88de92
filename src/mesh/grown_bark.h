// Bark that was grown as one surface (growth/), as plain data: what shows it needs nothing of how it came to
// be.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec.h"
#include "tree/tree.h"

namespace treerec {

// A closed surface about some of a tree's branches; their tubes are not drawn as far as it covers them.
// Metres, tree space; counter-clockwise from outside.
struct GrownBark {
    struct Branch {
        NodeId first = kNoNode;  // the branch's first own node (tree/branches.h): the root, of the trunk
        double until = 0.0;      // metres along the branch's axis that are covered; infinite: all
    };
    struct Vertex {
        Vec3 position{0.0f};
        Vec3 normal{0.0f};   // unit
        float along = 0.0f;  // metres of its branch's axis,
        float around =
            0.0f;  // and 0..1 of a round about it, where the bark's picture has it (grain turns it)
        float radius = 0.0f;   // metres: of the axis there
        int32_t branch = 0;    // in `branches`
        bool decayed = false;  // wood without bark
    };
    std::vector<Branch> branches;
    std::vector<Vertex> vertices;
    std::vector<uint32_t> indices;
    // By vertex: the one that it becomes part of in levels without it, which comes before it in `vertices`;
    // itself, if it is in all. Each level is of the first so many vertices. Empty: there is no lighter level.
    std::vector<uint32_t> parents;
    uint64_t digest = 0;  // covered_wood_digest() of the tree that it grew on

    bool empty() const { return indices.empty(); }
};

// One number for the wood beneath: the covered branches' nodes, as far as they are covered, with their places
// and radii. Other wood may change. 0 where one of the branches is not there. Linear in the tree's nodes.
uint64_t covered_wood_digest(const Tree& tree, const std::vector<GrownBark::Branch>& branches);

// Whether the wood beneath is still as it was when the bark grew.
bool fits(const GrownBark& bark, const Tree& tree);

// The surface with a quarter of the vertices for each level, down to those that are in all; level 0: as it
// is. Normals are the means of what became one vertex; all move outwards alike, as far as the surface keeps
// its volume and no vertex moves by more than kMostSwell of its branch's radius. The bark must have parents.
// Linear in its vertices.
GrownBark lighter_bark(const GrownBark& bark, double level);
inline constexpr float kMostSwell = 0.3f;

// What is drawn at a level: `grown` itself, or `lighter`, which is then set; null: tubes, as from
// kCoarsestBark on, where a small budget counts for more than the shape.
inline constexpr double kCoarsestBark = 4.0;
const GrownBark* bark_of_level(const GrownBark* grown, double level, GrownBark& lighter);

// Bytes for a file, some 32 a vertex and 5 a triangle; normals are kept to 1e-4. The same bytes on every
// machine.
std::string pack_grown_bark(const GrownBark& bark);

inline constexpr uint32_t kGrownBarkVersion = 2;  // 1: without parents
// Of packed bark: 0 for what is none.
uint32_t packed_bark_version(std::string_view packed);
// Throws Error for what is no such bark, damaged, or of a newer version.
GrownBark unpack_grown_bark(std::string_view packed);

}  // namespace treerec
