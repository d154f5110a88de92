#include "mesh/joined_leaves.h"

#include "error.h"

namespace treerec {

namespace {

constexpr size_t kLeavesBetweenChecks = 4096;

}  // namespace

JoinedLeaves join_leaves(const std::vector<LeafPlacement>& leaves, const Mesh& card,
                         const Progress* progress) {
    JoinedLeaves joined;
    const size_t corners = card.positions.size(), corner_indices = card.indices.size();
    // The engine counts them with 32 bits and a sign.
    if (corners > 0 && leaves.size() > INT32_MAX / corners)
        throw Error("There are too many leaves for one mesh. Choose a coarser level, or fewer leaves.");
    const size_t vertices = leaves.size() * corners;
    Mesh& mesh = joined.mesh;
    mesh.positions.resize(vertices);
    mesh.normals.resize(vertices);
    mesh.tangents.resize(vertices);
    mesh.uvs.resize(vertices);
    mesh.colors.resize(vertices);
    mesh.custom0.resize(vertices);
    mesh.indices.resize(leaves.size() * corner_indices);
    joined.lengthwise.resize(vertices);
    joined.across.resize(vertices);
    joined.secondary.resize(vertices);
    size_t v = 0, index = 0;
    for (size_t i = 0; i < leaves.size(); i++) {
        if (progress && i % kLeavesBetweenChecks == 0) progress->check();
        const LeafPlacement& leaf = leaves[i];
        const glm::mat3 turn(leaf.x, leaf.y, leaf.z);
        const Vec4 outward(0.5f + 0.5f * leaf.outward, leaf.occlusion);
        const Vec4 petiole(leaf.position, leaf.phase);
        const Vec4 lengthwise(leaf.y, leaf.wind.x), across(leaf.x, leaf.hue);
        for (size_t k = 0; k < corner_indices; k++)
            mesh.indices[index++] = static_cast<uint32_t>(v + card.indices[k]);
        for (size_t k = 0; k < corners; k++, v++) {
            mesh.positions[v] = leaf.position + turn * (card.positions[k] * leaf.size);
            mesh.normals[v] = turn * card.normals[k];
            mesh.tangents[v] = Vec4(turn * Vec3(card.tangents[k]), card.tangents[k].w);
            mesh.uvs[v] = card.uvs[k];
            mesh.colors[v] = outward;
            mesh.custom0[v] = petiole;
            joined.lengthwise[v] = lengthwise;
            joined.across[v] = across;
            joined.secondary[v] = leaf.wind.y;
        }
    }
    return joined;
}

}  // namespace treerec
