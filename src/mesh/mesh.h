// Triangle meshes in Godot's frame: metres, Y up, counter-clockwise front faces seen from outside (as in
// glTF; the engine side turns the winding, since Godot's front faces are clockwise).
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/bounds.h"
#include "geometry/vec.h"

namespace treerec {

// All attributes have one entry per vertex, or are empty.
struct Mesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;   // unit
    std::vector<Vec4> tangents;  // xyz unit, along +u; w = +1 or -1: the bitangent's sign as glTF defines it
    std::vector<Vec2> uvs;       // v downwards in the picture (glTF and Godot)
    std::vector<Vec4> colors;    // wind channels (design.md): sway, along, phase, ambient occlusion; 0..1
    std::vector<Vec4> custom0;   // pivot of the branch xyz, branch level w
    std::vector<uint32_t> indices;

    size_t triangle_count() const { return indices.size() / 3; }
};

}  // namespace treerec
