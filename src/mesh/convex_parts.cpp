#include "mesh/convex_parts.h"

#include <algorithm>
#include <cmath>

#include "error.h"
#include "geometry/portable_math.h"
#include "mesh/branch_pieces.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr double kThinnest = 0.002;  // metres: flatter hulls are none to a physics engine

void add_ring(std::vector<DVec3>& points, const DVec3& centre, const DVec3& x, const DVec3& y, double radius,
              int sides) {
    for (int j = 0; j < sides; j++) {
        const double angle = 2.0 * kPi * j / sides;
        points.push_back(centre + (x * portable::cos(angle) + y * portable::sin(angle)) * radius);
    }
}

}  // namespace

std::vector<ConvexPart> fit_convex_parts(const Tree& tree, const ConvexOptions& options) {
    if (options.maximum < 1 || options.maximum > 10000)
        throw Error("A tree takes between 1 and 10000 convex parts.");
    if (!(options.minimum_radius >= 0.0) || !(options.tolerance > 0.0))
        throw Error("Convex parts need a minimum radius of 0 or more and a tolerance above 0.");
    if (options.sides < 3 || options.sides > 32) throw Error("A convex part has between 3 and 32 sides.");
    std::vector<ConvexPart> parts;
    const double step = 2.0 * kPi / options.sides;
    const double wider = std::sqrt(step / portable::sin(step));
    const Tree* wood = &tree;
    Tree trunk;
    std::vector<NodeId> ids;  // by id of the trunk alone
    if (options.trunk_only && tree.size() > 0) {
        // The first branch of all is the trunk, whether marked or not.
        NodeId at = tree.root();
        const std::vector<double> lengths = subtree_lengths(tree);
        NodeId below = trunk.add_root(tree.node(at).position, tree.node(at).radius);
        ids.push_back(at);
        while ((at = main_child(tree, at, lengths)) != kNoNode) {
            below = trunk.add_child(below, tree.node(at).position, tree.node(at).radius);
            ids.push_back(at);
        }
        wood = &trunk;
    }
    for (const BranchPiece& piece :
         part_branches(*wood, options.maximum, options.minimum_radius, options.tolerance, true)) {
        const double length = glm::distance(piece.from, piece.to);
        if (length < kThinnest) continue;
        const DVec3 way = (piece.to - piece.from) / length;
        const DVec3 x = any_perpendicular(way), y = glm::cross(way, x);
        ConvexPart part;
        part.node = options.trunk_only ? ids[static_cast<size_t>(piece.node)] : piece.node;
        for (const bool upper : {false, true})
            add_ring(part.points, upper ? piece.to : piece.from, x, y,
                     wider * std::max(upper ? piece.to_radius : piece.from_radius, kThinnest), options.sides);
        parts.push_back(std::move(part));
    }
    return parts;
}

double volume_of(const ConvexPart& part) {
    // A prismatoid's (Simpson's rule is exact for it).
    const size_t sides = part.points.size() / 2;
    const auto area = [&](double share) {
        DVec3 sum(0.0);
        const auto at = [&](size_t j) {
            return glm::mix(part.points[j % sides], part.points[sides + j % sides], share);
        };
        for (size_t j = 1; j + 1 < sides; j++)
            sum += 0.5 * glm::cross(at(j) - at(0), at(j + 1) - at(0));
        return sum;
    };
    DVec3 low(0.0), high(0.0);
    for (size_t j = 0; j < sides; j++) {
        low += part.points[j] / static_cast<double>(sides);
        high += part.points[sides + j] / static_cast<double>(sides);
    }
    const DVec3 way = high - low;
    return std::abs(glm::dot(way, area(0.0) + 4.0 * area(0.5) + area(1.0))) / 6.0;
}

}  // namespace treerec
