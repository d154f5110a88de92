// Triangle meshes in Godot's frame: metres, Y up, counter-clockwise front faces seen from outside (as in
// glTF; the engine side turns the winding, since Godot's front faces are clockwise).
#pragma once

#include <cstdint>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "geometry/bounds.h"
#include "geometry/vec.h"

namespace treerec {

// Leaves what resize() adds unset: builders size a mesh once and fill it on several threads.
template <typename T>
struct UnsetAllocator : std::allocator<T> {
    template <typename U>
    struct rebind {
        using other = UnsetAllocator<U>;
    };
    template <typename U>
    void construct(U* at) {
        ::new (static_cast<void*>(at)) U;
    }
    template <typename U, typename... Values>
    void construct(U* at, Values&&... values) {
        ::new (static_cast<void*>(at)) U(std::forward<Values>(values)...);
    }
};
template <typename T>
using MeshArray = std::vector<T, UnsetAllocator<T>>;

// All attributes have one entry per vertex, or are empty.
struct Mesh {
    MeshArray<Vec3> positions;
    MeshArray<Vec3> normals;   // unit
    MeshArray<Vec4> tangents;  // xyz unit, along +u; w = +1 or -1: the bitangent's sign as glTF defines it
    MeshArray<Vec2> uvs;       // v downwards in the picture (glTF and Godot); across cuts: see kCutMark
    MeshArray<Vec4> colors;    // wind channels (design.md): sway, along, phase, ambient occlusion; 0..1
    MeshArray<Vec4> custom0;   // pivot of the branch xyz, branch level w
    MeshArray<float> radii;    // of the wood, metres; below 0 where two branches' pictures meet on a collar
    MeshArray<Vec2> wind;      // WindGroups::codes() of primary and secondary branch
    MeshArray<uint32_t> indices;

    size_t triangle_count() const { return indices.size() / 3; }
};

}  // namespace treerec
