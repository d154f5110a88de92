#include "growth/blended_normals.h"

#include <algorithm>
#include <cmath>

#include "geometry/parallel.h"
#include "geometry/triangle.h"
#include "growth/face_grid.h"

namespace treerec::growth {

namespace {

constexpr double kSame = 0.7;    // cosine between normals from which on two places are one smooth bark
constexpr double kAside = 0.15;  // sine by which what lies before a face may lie behind its plane
constexpr double kLeast = 0.05;  // of two unit normals' sum: below it they have no common direction
constexpr int kPasses = 2;
constexpr double kEvenness = 0.6;  // of a vertex whose bark touches other bark: how far it goes a pass
constexpr size_t kTogether = 512;  // vertices

}  // namespace

void blend_normals(GrownBark& bark, double within) {
    FaceGrid grid(2.0 * within);
    const size_t faces = bark.indices.size() / 3;
    const auto place = [&](size_t face, size_t k) {
        return DVec3(bark.vertices[bark.indices[3 * face + k]].position);
    };
    const auto decayed = [&](size_t face) {
        for (size_t k = 0; k < 3; k++)
            if (bark.vertices[bark.indices[3 * face + k]].decayed) return true;
        return false;
    };
    for (size_t f = 0; f < faces; f++) {
        if (decayed(f)) continue;
        const DVec3 middle = (place(f, 0) + place(f, 1) + place(f, 2)) / 3.0;
        double round = 0.0;
        for (size_t k = 0; k < 3; k++)
            round = std::max(round, glm::distance(middle, place(f, k)));
        grid.add(static_cast<uint32_t>(f), middle, round);
    }
    std::vector<DVec3> blended(bark.vertices.size());
    std::vector<double> shares(bark.vertices.size(), 0.0);  // 0..1: how near other bark is
    parallel_for(bark.vertices.size(), kTogether, [&](size_t begin, size_t end) {
        for (size_t v = begin; v < end; v++) {
            const GrownBark::Vertex& vertex = bark.vertices[v];
            const DVec3 p(vertex.position), own(vertex.normal);
            blended[v] = own;
            if (vertex.decayed) continue;
            DVec3 sum(0.0);
            double nearest = 0.0;
            grid.visit(p, within, [&](uint32_t f) {
                const uint32_t* const corner = &bark.indices[3 * f];
                if (corner[0] == v || corner[1] == v || corner[2] == v) return;
                const DVec3 a = place(f, 0), b = place(f, 1), c = place(f, 2);
                const DVec3 at = nearest_in_triangle(p, a, b, c);
                const DVec3 way = at.x * a + at.y * b + at.z * c - p;
                const double far = glm::length(way);
                if (far >= within) return;
                const DVec3 other = normalized_or(at.x * DVec3(bark.vertices[corner[0]].normal) +
                                                      at.y * DVec3(bark.vertices[corner[1]].normal) +
                                                      at.z * DVec3(bark.vertices[corner[2]].normal),
                                                  own);
                if (glm::dot(own, other) > kSame) return;
                // Behind thin bark is its own other side.
                if (glm::dot(way, own) < -kAside * far || glm::dot(way, other) > kAside * far) return;
                const double weight = 1.0 - glm::smoothstep(0.0, within, far);
                sum += weight * glm::length(glm::cross(b - a, c - a)) * other;
                nearest = std::max(nearest, weight);
            });
            const DVec3 both = own + nearest * normalized_or(sum, DVec3(0.0));
            if (glm::length(both) <= kLeast) continue;
            blended[v] = glm::normalize(both);
            shares[v] = nearest;
        }
    });
    // Triangles on both sides differ: along the crease it is made even.
    for (int pass = 0; pass < kPasses; pass++) {
        std::vector<DVec3> sums(blended.size(), DVec3(0.0));
        for (size_t f = 0; f < faces; f++)
            for (size_t k = 0; k < 3; k++) {
                const uint32_t one = bark.indices[3 * f + k], next = bark.indices[3 * f + (k + 1) % 3];
                if (shares[one] <= 0.0 || shares[next] <= 0.0) continue;
                sums[one] += blended[next];
                sums[next] += blended[one];
            }
        for (size_t v = 0; v < blended.size(); v++)
            if (shares[v] > 0.0)
                blended[v] = normalized_or(
                    glm::mix(blended[v], normalized_or(sums[v], blended[v]), kEvenness * shares[v]),
                    blended[v]);
    }
    for (size_t v = 0; v < blended.size(); v++)
        if (shares[v] > 0.0) bark.vertices[v].normal = Vec3(blended[v]);
}

}  // namespace treerec::growth
