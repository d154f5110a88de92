#include "mesh/leaf_cards.h"

#include <algorithm>
#include <cmath>

#include "error.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr size_t kFloatsPerLeaf = 20;
constexpr float kRoundness = 0.65f;  // how far the normals of baked leaves follow the crown
constexpr float kMiddle = 0.5f;      // of a card, over its length
constexpr double kKept = 0.42;       // of the leaves of one level, by the next
constexpr double kFewest = 64.0;     // leaves: fewer are not thinned,
constexpr double kLastWhole = 4.0;   // up to this level

double leaf_share(double level) {
    return portable::pow(kKept, std::clamp(level, 0.0, 16.0));
}

// A crown of few large leaves, as a palm's, is drawn by each of them: it would lose its outline, and a
// handful of fronds several times as long as the others would stand for it.
double kept_share(double level, size_t count) {
    const double few = std::min(1.0, kFewest / static_cast<double>(std::max(count, size_t{1})));
    return std::max(leaf_share(level), few * leaf_share(level - kLastWhole));
}

}  // namespace

Mesh bake_leaves(const std::vector<LeafPlacement>& leaves, int level, const Progress* progress) {
    return bake_leaves(leaves, build_leaf_card(level), progress);
}

Mesh bake_leaves(const std::vector<LeafPlacement>& leaves, const Mesh& card, const Progress* progress) {
    const size_t corners = card.positions.size(), card_indices = card.indices.size();
    if (leaves.size() * corners > UINT32_MAX) throw Error("There are too many leaves for one mesh.");
    Mesh mesh;
    const size_t vertices = leaves.size() * corners;
    mesh.positions.resize(vertices);
    mesh.normals.resize(vertices);
    mesh.tangents.resize(vertices);
    mesh.uvs.resize(vertices);
    mesh.colors.resize(vertices);
    mesh.indices.resize(leaves.size() * card_indices);
    std::vector<uint8_t> turned_alike(corners, 0);  // by corner: it faces as the one before it does
    for (size_t k = 1; k < corners; k++)
        turned_alike[k] = card.normals[k] == card.normals[k - 1] && card.tangents[k] == card.tangents[k - 1];
    parallel_for(leaves.size(), 1024, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        for (size_t i = begin; i < end; i++) {
            const LeafPlacement& leaf = leaves[i];
            const glm::mat3 turn(leaf.x, leaf.y, leaf.z);
            for (size_t k = 0; k < corners; k++) {
                const size_t v = i * corners + k;
                mesh.positions[v] = leaf.position + turn * card.positions[k] * leaf.size;
                mesh.uvs[v] = card.uvs[k];
                mesh.colors[v] = {leaf.sway, card.colors[k].y, leaf.phase, leaf.occlusion};
                if (turned_alike[k]) {
                    mesh.normals[v] = mesh.normals[v - 1];
                    mesh.tangents[v] = mesh.tangents[v - 1];
                    continue;
                }
                const Vec3 flat = turn * card.normals[k];
                const Vec3 normal = flat * (1.0f - kRoundness) + leaf.outward * kRoundness;
                const float length = glm::length(normal);
                mesh.normals[v] = length > 1e-3f ? normal / length : flat;
                const Vec3 across = turn * Vec3(card.tangents[k]);
                const Vec3 tangent = across - mesh.normals[v] * glm::dot(across, mesh.normals[v]);
                const float tangent_length = glm::length(tangent);
                // Where the rounded normal runs along the card's x, its y axis still gives a direction.
                mesh.tangents[v] =
                    Vec4(tangent_length > 1e-3f ? tangent / tangent_length
                                                : glm::normalize(glm::cross(leaf.y, mesh.normals[v])),
                         1.0f);
            }
            for (size_t k = 0; k < card_indices; k++)
                mesh.indices[i * card_indices + k] = static_cast<uint32_t>(i * corners) + card.indices[k];
        }
    });
    return mesh;
}

std::vector<LeafPlacement> thin_leaves(const std::vector<LeafPlacement>& leaves, double level) {
    if (!(level > 0.0)) return leaves;
    const double share = kept_share(level, leaves.size());
    const auto growth = static_cast<float>(1.0 / std::sqrt(share));
    std::vector<LeafPlacement> kept;
    kept.reserve(static_cast<size_t>(static_cast<double>(leaves.size()) * share) + 2);
    for (size_t i = 0; i < leaves.size(); i++) {
        // The golden ratio's multiples spread evenly, so each level is a subset of the finer one and every
        // stretch of twig keeps its share.
        const double turn = static_cast<double>(i) * 0.61803398874989485;
        if (turn - std::floor(turn) >= share) continue;
        LeafPlacement& leaf = kept.emplace_back(leaves[i]);
        leaf.position -= leaf.y * (kMiddle * leaf.size * (growth - 1.0f));
        leaf.size *= growth;
    }
    return kept;
}

float leaf_growth(double level) {
    return static_cast<float>(1.0 / std::sqrt(leaf_share(level)));
}

std::vector<float> leaf_buffer(const std::vector<LeafPlacement>& leaves) {
    std::vector<float> buffer(leaves.size() * kFloatsPerLeaf);
    float* out = buffer.data();
    for (const LeafPlacement& leaf : leaves) {
        for (int row = 0; row < 3; row++) {
            *out++ = leaf.x[row] * leaf.size;
            *out++ = leaf.y[row] * leaf.size;
            *out++ = leaf.z[row] * leaf.size;
            *out++ = leaf.position[row];
        }
        const Vec3 outward(glm::dot(leaf.outward, leaf.x), glm::dot(leaf.outward, leaf.y),
                           glm::dot(leaf.outward, leaf.z));
        for (int axis = 0; axis < 3; axis++)
            *out++ = 0.5f + 0.5f * outward[axis];
        *out++ = leaf.occlusion;
        *out++ = leaf.phase;
        *out++ = leaf.wind.x;
        *out++ = leaf.hue;
        *out++ = leaf.wind.y;
    }
    return buffer;
}

}  // namespace treerec
