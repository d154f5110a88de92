#include "mesh/wood_mass.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "error.h"
#include "geometry/symmetric_eigen.h"
#include "tree/branches.h"

namespace treerec {

namespace {

// One segment's.
struct Frustum {
    double mass;
    DVec3 centre;
    DVec3 way;              // unit
    double long_inertia;    // around its axis
    double across_inertia;  // and across it, about its centre
};

std::vector<Frustum> frusta_of(const Tree& tree, double density) {
    std::vector<Frustum> frusta;
    const BranchList list = list_branches(tree);
    for (const Branch& branch : list.branches) {
        for (const NodeId id : list.nodes_of(branch)) {
            const Node& node = tree.node(id);
            if (node.parent == kNoNode) continue;
            const Node& parent = tree.node(node.parent);
            const DVec3 way = node.position - parent.position;
            const double length = glm::length(way);
            const double a = node.parent == branch.attach ? node.radius : parent.radius, b = node.radius;
            const double square = (a * a + a * b + b * b) / 3.0;
            if (!(length > 0.0)) continue;
            Frustum frustum;
            frustum.mass = density * kPi * length * square;
            frustum.centre = parent.position + way * ((a * a + 2.0 * a * b + 3.0 * b * b) / (12.0 * square));
            frustum.way = way / length;
            frustum.long_inertia = 0.5 * frustum.mass * square;
            frustum.across_inertia = frustum.mass * (3.0 * square + length * length) / 12.0;
            frusta.push_back(frustum);
        }
    }
    return frusta;
}

}  // namespace

WoodMass weigh_wood(const Tree& tree, double density) {
    if (!(density > 0.0) || !std::isfinite(density))
        throw Error("Wood weighs more than 0 kg per cubic metre; green wood about 800.");
    WoodMass wood;
    if (tree.empty()) return wood;
    wood.centre = tree.node(tree.root()).position;
    const std::vector<Frustum> frusta = frusta_of(tree, density);
    DVec3 moment(0.0);
    for (const Frustum& part : frusta) {
        wood.mass += part.mass;
        moment += part.mass * (part.centre - wood.centre);
    }
    if (!(wood.mass > 0.0)) return wood;
    wood.centre += moment / wood.mass;
    SquareMatrix<3> tensor{};
    for (const Frustum& part : frusta) {
        const DVec3 from = part.centre - wood.centre;
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                const double same = i == j ? 1.0 : 0.0;
                tensor[i][j] += same * part.across_inertia +
                                (part.long_inertia - part.across_inertia) * part.way[i] * part.way[j] +
                                part.mass * (same * glm::dot(from, from) - from[i] * from[j]);
            }
        }
    }
    const SymmetricEigen<3> eigen = symmetric_eigen(tensor);
    const SquareMatrix<3>& axes = eigen.vectors;
    // Of the six orders the one that turns least.
    size_t order[3] = {0, 1, 2}, best[3] = {0, 1, 2};
    double most = -1.0;
    do {
        double sum = 0.0;
        for (int i = 0; i < 3; i++)
            sum += std::abs(axes[i][order[i]]);
        if (sum > most + 1e-12) {
            most = sum;
            std::copy(order, order + 3, best);
        }
    } while (std::next_permutation(order, order + 3));
    for (int i = 0; i < 3; i++) {
        const size_t k = best[i];
        const double sign = axes[i][k] < 0.0 ? -1.0 : 1.0;
        wood.axes[i] = DVec3(axes[0][k], axes[1][k], axes[2][k]) * sign;
        wood.inertia[i] = eigen.values[k];
    }
    wood.axes[2] = glm::cross(wood.axes[0], wood.axes[1]);
    return wood;
}

}  // namespace treerec
