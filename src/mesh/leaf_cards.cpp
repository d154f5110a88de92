#include "mesh/leaf_cards.h"

#include <algorithm>
#include <cmath>

#include "error.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr size_t kFloatsPerLeaf = 20;
constexpr float kRoundness = 0.65f;     // how far the normals of baked leaves follow the crown
constexpr float kSky = 0.35f;           // and how far they lean to where light comes from even below a crown
constexpr float kLeastTowards = 0.05f;  // how far a face's normal goes the way that the face looks, at least
constexpr float kHalfThickness = 0.0005f;  // of a leaf with two faces, over its length
constexpr float kMiddle = 0.5f;            // of a card, over its length
constexpr float kLeafReach = 0.75f;        // of a card from its middle, over its length, at any turn
constexpr double kKept = 0.42;             // of the leaves of one level, by the next
constexpr double kFewest = 64.0;           // leaves: fewer are not thinned,
constexpr double kLastWhole = 4.0;         // up to this level

// As leaf.gdshader has it: the crown is shaded as one round volume, from whichever side a leaf is seen.
Vec3 crown_normal(const Vec3& flat, const Vec3& outward) {
    const Vec3 lit = outward * kRoundness + Vec3(0.0f, kSky, 0.0f);
    const float side = glm::dot(flat, lit) < 0.0f ? -1.0f : 1.0f;
    const Vec3 normal = flat * (side * (1.0f - kRoundness)) + lit;
    const float length = glm::length(normal);
    return length > 1e-3f ? normal / length : flat * side;
}

// The crown's normal for a face of a leaf, bent so far to whoever sees that face as programs need that follow
// rays of light: with a normal that looks away from them all is black.
Vec3 face_normal(const Vec3& face, const Vec3& crown) {
    const float towards = glm::dot(face, crown);
    if (towards >= kLeastTowards) return crown;
    return glm::normalize(crown + face * (kLeastTowards - towards));
}

// Of a picture that runs across and along a card: both stay where they are when the normal has turned away.
Vec4 tangent_at(const Vec3& normal, const Vec3& across, const Vec3& along) {
    const Vec3 flat = across - normal * glm::dot(across, normal);
    const float length = glm::length(flat);
    // Where the normal runs across the card, its other axis still gives a direction.
    const Vec3 tangent = length > 1e-3f ? flat / length : glm::normalize(glm::cross(along, normal));
    return {tangent, glm::dot(glm::cross(normal, tangent), along) < 0.0f ? -1.0f : 1.0f};
}

}  // namespace

bool shows_mirrored(const LeafPlacement& leaf) {
    const float turn = leaf.phase * 43.19f;
    return turn - std::floor(turn) < 0.5f;
}

Mesh bake_leaves(const std::vector<LeafPlacement>& leaves, int level, const Progress* progress) {
    return bake_leaves(leaves, build_leaf_card(level), progress);
}

Mesh bake_leaves(const std::vector<LeafPlacement>& leaves, const Mesh& card, const Progress* progress) {
    const size_t corners = card.positions.size(), card_indices = card.indices.size();
    if (leaves.size() * corners * 2 > UINT32_MAX) throw Error("There are too many leaves for one mesh.");
    Mesh mesh;
    const size_t vertices = leaves.size() * corners * 2;
    mesh.positions.resize(vertices);
    mesh.normals.resize(vertices);
    mesh.tangents.resize(vertices);
    mesh.uvs.resize(vertices);
    mesh.colors.resize(vertices);
    mesh.indices.resize(leaves.size() * card_indices * 2);
    std::vector<uint8_t> turned_alike(corners, 0);  // by corner: it faces as the one before it does
    for (size_t k = 1; k < corners; k++)
        turned_alike[k] = card.normals[k] == card.normals[k - 1] && card.tangents[k] == card.tangents[k - 1];
    parallel_for(leaves.size(), 1024, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        for (size_t i = begin; i < end; i++) {
            const LeafPlacement& leaf = leaves[i];
            const glm::mat3 turn(leaf.x, leaf.y, leaf.z);
            const bool mirrored = shows_mirrored(leaf);
            for (size_t k = 0; k < corners; k++) {
                const size_t upper = 2 * i * corners + k, lower = upper + corners;
                const Vec3 flat = turn * card.normals[k];
                const Vec3 place = leaf.position + turn * card.positions[k] * leaf.size;
                const Vec3 apart = flat * (kHalfThickness * leaf.size);
                mesh.positions[upper] = place + apart;
                mesh.positions[lower] = place - apart;
                const Vec2 uv = card.uvs[k];
                mesh.uvs[upper] = mesh.uvs[lower] = mirrored ? Vec2(1.0f - uv.x, uv.y) : uv;
                mesh.colors[upper] =
                    mesh.colors[lower] = {leaf.sway, card.colors[k].y, leaf.phase, leaf.occlusion};
                if (turned_alike[k]) {
                    for (const size_t v : {upper, lower}) {
                        mesh.normals[v] = mesh.normals[v - 1];
                        mesh.tangents[v] = mesh.tangents[v - 1];
                    }
                    continue;
                }
                const Vec3 crown = crown_normal(flat, leaf.outward);
                const Vec3 rightwards = turn * Vec3(card.tangents[k]);
                const Vec3 along = glm::cross(flat, rightwards) * card.tangents[k].w;
                const Vec3 across = mirrored ? -rightwards : rightwards;
                mesh.normals[upper] = face_normal(flat, crown);
                mesh.normals[lower] = face_normal(-flat, crown);
                for (const size_t v : {upper, lower})
                    mesh.tangents[v] = tangent_at(mesh.normals[v], across, along);
            }
            const auto first = static_cast<uint32_t>(2 * i * corners);
            const auto under = first + static_cast<uint32_t>(corners);
            uint32_t* to = &mesh.indices[2 * i * card_indices];
            for (size_t k = 0; k < card_indices; k++)
                to[k] = first + card.indices[k];
            for (size_t k = 0; k < card_indices; k += 3) {
                to[card_indices + k] = under + card.indices[k];
                to[card_indices + k + 1] = under + card.indices[k + 2];
                to[card_indices + k + 2] = under + card.indices[k + 1];
            }
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

double leaf_share(double level) {
    return portable::pow(kKept, std::clamp(level, 0.0, 16.0));
}

// A crown of few large leaves, as a palm's, is drawn by each of them: it would lose its outline, and a
// handful of fronds several times as long as the others would stand for it.
double kept_share(double level, size_t count) {
    const double few = std::min(1.0, kFewest / static_cast<double>(std::max(count, size_t{1})));
    return std::max(leaf_share(level), few * leaf_share(level - kLastWhole));
}

float leaf_growth(double level) {
    return static_cast<float>(1.0 / std::sqrt(leaf_share(level)));
}

void add_leaves(Bounds& bounds, const std::vector<LeafPlacement>& leaves, float growth) {
    for (const LeafPlacement& leaf : leaves)
        bounds.add(DVec3(leaf.position + leaf.y * (0.5f * leaf.size)), kLeafReach * growth * leaf.size);
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
