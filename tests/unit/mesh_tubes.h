// The tubes of a mesh of bark, taken apart again.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "geometry/vec.h"
#include "mesh/mesh.h"

namespace treerec::test {

// Runs of vertices joined by triangles, which follow each other in the buffers.
struct TubeRange {
    uint32_t first_vertex, end_vertex;
    size_t first_index, end_index;
};

inline std::vector<TubeRange> tubes_of(const Mesh& mesh) {
    std::vector<TubeRange> tubes;
    size_t index = 0;
    uint32_t vertex = 0;
    while (index < mesh.indices.size()) {
        uint32_t top = vertex;
        size_t end = index;
        while (end < mesh.indices.size()) {
            const uint32_t least =
                std::min({mesh.indices[end], mesh.indices[end + 1], mesh.indices[end + 2]});
            // A cut face shares no corner with its bark, but is of the same branch.
            if (end > index && least > top && mesh.uvs[least].y > -0.5 * kCutMark) break;
            top = std::max({top, mesh.indices[end], mesh.indices[end + 1], mesh.indices[end + 2]});
            end += 3;
        }
        tubes.push_back({vertex, top + 1, index, end});
        vertex = top + 1;
        index = end;
    }
    return tubes;
}

inline DVec3 corner_of(const Mesh& mesh, size_t index) {
    return DVec3(mesh.positions[mesh.indices[index]]);
}

// Twice the triangle's area long.
inline DVec3 face_normal(const Mesh& mesh, size_t index) {
    const DVec3 a = corner_of(mesh, index);
    return glm::cross(corner_of(mesh, index + 1) - a, corner_of(mesh, index + 2) - a);
}

// By vertex of the tube: the first one at the same place, so that seams and the apex are joined.
inline std::vector<uint32_t> joined_corners(const Mesh& mesh, const TubeRange& tube) {
    std::map<std::tuple<float, float, float>, uint32_t> seen;
    std::vector<uint32_t> corner(tube.end_vertex - tube.first_vertex);
    for (uint32_t v = tube.first_vertex; v < tube.end_vertex; v++) {
        const Vec3 p = mesh.positions[v];
        corner[v - tube.first_vertex] = seen.try_emplace({p.x, p.y, p.z}, v).first->second;
    }
    return corner;
}

// The edges that have a face on one side only, from corner to corner; empty for a closed tube. `twice` counts
// edges that two faces pass the same way: where their windings disagree.
inline std::vector<std::pair<uint32_t, uint32_t>> open_edges(const Mesh& mesh, const TubeRange& tube,
                                                             size_t& twice) {
    const std::vector<uint32_t> corner = joined_corners(mesh, tube);
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (size_t i = tube.first_index; i < tube.end_index; i += 3)
        for (size_t k = 0; k < 3; k++)
            edges[{corner[mesh.indices[i + k] - tube.first_vertex],
                   corner[mesh.indices[i + (k + 1) % 3] - tube.first_vertex]}]++;
    std::vector<std::pair<uint32_t, uint32_t>> open;
    for (const auto& [edge, uses] : edges) {
        twice += uses > 1;
        if (edges.count({edge.second, edge.first}) == 0) open.push_back(edge);
    }
    return open;
}

// With a collar, the first rows of vertices are no rings.
inline bool has_collar(const Mesh& mesh, const TubeRange& tube) {
    uint32_t end = tube.first_vertex;
    while (mesh.colors[end].g == 0.0f)
        end++;
    const uint32_t next = end + (end - tube.first_vertex);
    return next < tube.end_vertex && mesh.positions[end] == mesh.positions[next];
}

// A face that closes the start of a twig that stands for many, at coarser levels.
inline bool is_plug(const Mesh& mesh, size_t face) {
    for (size_t k = 0; k < 3; k++)
        if (mesh.colors[mesh.indices[face + k]].g != 0.0f) return false;
    return true;
}

inline bool has_plug(const Mesh& mesh, const TubeRange& tube) {
    for (size_t i = tube.first_index; i < tube.end_index; i += 3)
        if (is_plug(mesh, i)) return true;
    return false;
}

}  // namespace treerec::test
