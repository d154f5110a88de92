// The bark as it is drawn, to measure distances from.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "geometry/vec.h"
#include "mesh/branch_tubes.h"
#include "tree/tree.h"

namespace treerec::test {

// Squared distance from p to the triangle a b c (Ericson, Real-Time Collision Detection, 5.1.5).
inline double square_to_triangle(const DVec3& p, const DVec3& a, const DVec3& b, const DVec3& c) {
    const DVec3 normal = glm::cross(b - a, c - a);
    const double area = glm::dot(normal, normal);
    const auto to_edge = [&](const DVec3& u, const DVec3& v) {
        const DVec3 along = v - u;
        const double square = glm::dot(along, along);
        const double t = square > 0.0 ? std::clamp(glm::dot(p - u, along) / square, 0.0, 1.0) : 0.0;
        const DVec3 off = p - u - along * t;
        return glm::dot(off, off);
    };
    if (area > 0.0) {
        const double u = glm::dot(glm::cross(c - b, p - b), normal),
                     v = glm::dot(glm::cross(a - c, p - c), normal),
                     w = glm::dot(glm::cross(b - a, p - a), normal);
        if (u >= 0.0 && v >= 0.0 && w >= 0.0) {
            const double height = glm::dot(p - a, normal);
            return height * height / area;
        }
    }
    return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

class BarkSurface {
  public:
    explicit BarkSurface(const Tree& tree) : mesh_(build_branch_tubes(tree)) {
        for (size_t i = 0; i < mesh_.indices.size(); i += 3) {
            DVec3 low(1e9), high(-1e9);
            for (size_t k = 0; k < 3; k++) {
                const DVec3 p(mesh_.positions[mesh_.indices[i + k]]);
                low = glm::min(low, p);
                high = glm::max(high, p);
            }
            const glm::ivec3 first(glm::floor(low / kCell)), last(glm::floor(high / kCell));
            for (int x = first.x; x <= last.x; x++)
                for (int y = first.y; y <= last.y; y++)
                    for (int z = first.z; z <= last.z; z++)
                        cells_[{x, y, z}].push_back(i);
        }
    }

    // Metres from p to the nearest triangle, at most kCell.
    double distance(const DVec3& p) const {
        const glm::ivec3 at(glm::floor(p / kCell));
        double best = kCell * kCell;
        for (int x = at.x - 1; x <= at.x + 1; x++)
            for (int y = at.y - 1; y <= at.y + 1; y++)
                for (int z = at.z - 1; z <= at.z + 1; z++) {
                    const auto found = cells_.find({x, y, z});
                    if (found == cells_.end()) continue;
                    for (const size_t i : found->second)
                        best = std::min(best, square_to_triangle(p, corner(i), corner(i + 1), corner(i + 2)));
                }
        return std::sqrt(best);
    }

  private:
    static constexpr double kCell = 0.25;
    DVec3 corner(size_t i) const { return DVec3(mesh_.positions[mesh_.indices[i]]); }

    Mesh mesh_;
    std::map<std::array<int, 3>, std::vector<size_t>> cells_;
};

}  // namespace treerec::test
