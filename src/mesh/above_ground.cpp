#include "mesh/above_ground.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace treerec {

namespace {

constexpr double kFoot = 6.0;    // of the root's radius: how far from it its foot lies
constexpr float kSlack = 1e-3f;  // metres

template <typename Values>
void keep(Values& values, const std::vector<uint32_t>& kept) {
    if (values.empty()) return;
    for (size_t i = 0; i < kept.size(); i++)
        values[i] = values[kept[i]];
    values.resize(kept.size());
}

}  // namespace

Mesh above_ground(const Mesh& bark, const Tree& tree) {
    if (tree.empty() || !tree.node(tree.root()).is_trunk()) return bark;
    const Node& root = tree.node(tree.root());
    const auto ground = static_cast<float>(root.position.y) + kSlack;
    const auto hidden = [&](uint32_t i) {
        const Vec3& p = bark.positions[i];
        return p.y <= ground &&
               glm::length(DVec2(p.x, p.z) - DVec2(root.position.x, root.position.z)) <= kFoot * root.radius;
    };
    Mesh seen = bark;
    seen.indices.clear();
    std::vector<uint32_t> kept, place(bark.positions.size(), UINT32_MAX);
    std::vector<uint8_t> used(bark.positions.size(), 0);
    for (size_t i = 0; i + 2 < bark.indices.size(); i += 3) {
        const std::array<uint32_t, 3> corners{bark.indices[i], bark.indices[i + 1], bark.indices[i + 2]};
        if (std::all_of(corners.begin(), corners.end(), hidden)) continue;
        for (const uint32_t corner : corners) {
            used[corner] = 1;
            seen.indices.push_back(corner);
        }
    }
    for (uint32_t i = 0; i < used.size(); i++) {
        if (!used[i]) continue;
        place[i] = static_cast<uint32_t>(kept.size());
        kept.push_back(i);
    }
    for (uint32_t& index : seen.indices)
        index = place[index];
    keep(seen.positions, kept);
    keep(seen.normals, kept);
    keep(seen.tangents, kept);
    keep(seen.uvs, kept);
    keep(seen.colors, kept);
    keep(seen.custom0, kept);
    keep(seen.radii, kept);
    keep(seen.wind, kept);
    return seen;
}

}  // namespace treerec
