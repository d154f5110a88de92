// Lighter levels of grown bark. Its vertices come in the order in which they are worth keeping, and each
// knows which one takes its place (Hoppe, "Progressive Meshes", 1996, section 3, with half-edge collapses):
// a level is a prefix of them.
#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"
#include "mesh/grown_bark.h"

namespace treerec {

namespace {

// Twice its area, along its normal; square metres.
DVec3 doubled_area(const GrownBark& bark, const uint32_t* corner) {
    const DVec3 a(bark.vertices[corner[0]].position);
    return glm::cross(DVec3(bark.vertices[corner[1]].position) - a,
                      DVec3(bark.vertices[corner[2]].position) - a);
}

// Six times the volume in it about `middle`, cubic metres.
double volume_of(const GrownBark& bark, const DVec3& middle) {
    double volume = 0.0;
    for (size_t i = 0; i + 2 < bark.indices.size(); i += 3)
        volume += glm::dot(doubled_area(bark, &bark.indices[i]),
                           DVec3(bark.vertices[bark.indices[i]].position) - middle);
    return volume;
}

}  // namespace

GrownBark lighter_bark(const GrownBark& bark, double level) {
    const size_t all = bark.vertices.size();
    const double wanted = static_cast<double>(all) * portable::pow(4.0, -std::max(level, 0.0));
    size_t kept = std::clamp(static_cast<size_t>(wanted), size_t{0}, all);
    for (size_t i = all; i-- > kept;)
        if (bark.parents[i] == i) kept = i + 1;
    if (kept == all) return bark;

    GrownBark lighter;
    lighter.branches = bark.branches;
    lighter.digest = bark.digest;
    lighter.vertices.assign(bark.vertices.begin(), bark.vertices.begin() + static_cast<std::ptrdiff_t>(kept));
    std::vector<DVec3> normals(all, DVec3(0.0));
    for (size_t i = 0; i + 2 < bark.indices.size(); i += 3) {
        const double area = glm::length(doubled_area(bark, &bark.indices[i]));
        for (size_t k = 0; k < 3; k++)
            normals[bark.indices[i + k]] += area * DVec3(bark.vertices[bark.indices[i + k]].normal);
    }
    for (size_t i = all; i-- > kept;)
        normals[bark.parents[i]] += normals[i];
    for (size_t i = 0; i < kept; i++)
        lighter.vertices[i].normal = Vec3(normalized_or(normals[i], DVec3(bark.vertices[i].normal)));

    std::vector<uint32_t> part_of(all);
    for (size_t i = 0; i < all; i++)
        part_of[i] = i < kept ? static_cast<uint32_t>(i) : part_of[bark.parents[i]];
    for (size_t i = 0; i + 2 < bark.indices.size(); i += 3) {
        const uint32_t a = part_of[bark.indices[i]], b = part_of[bark.indices[i + 1]],
                       c = part_of[bark.indices[i + 2]];
        if (a == b || b == c || c == a) continue;
        for (const uint32_t corner : {a, b, c})
            lighter.indices.push_back(corner);
    }

    // Chords cut off what is round.
    const DVec3 middle(bark.vertices.front().position);
    const double missing = volume_of(bark, middle) - volume_of(lighter, middle);
    double by = 0.0;  // of six times the volume for each metre that all move outwards
    for (size_t i = 0; i + 2 < lighter.indices.size(); i += 3)
        for (size_t k = 0; k < 3; k++)
            by += glm::dot(doubled_area(lighter, &lighter.indices[i]),
                           DVec3(lighter.vertices[lighter.indices[i + k]].normal));
    const double swell = by > 0.0 ? std::max(missing / by, 0.0) : 0.0;
    for (GrownBark::Vertex& vertex : lighter.vertices)
        vertex.position +=
            vertex.normal * std::min(static_cast<float>(swell), kMostSwell * std::max(vertex.radius, 0.0f));
    return lighter;
}

const GrownBark* bark_of_level(const GrownBark* grown, double level, GrownBark& lighter) {
    if (!grown || level <= 0.0) return grown;
    if (grown->parents.empty() || level > kCoarsestBark) return nullptr;
    lighter = lighter_bark(*grown, level);
    return &lighter;
}

}  // namespace treerec
