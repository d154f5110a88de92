#include "edit/graft/twig.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "edit/graft/scion.h"
#include "error.h"

namespace treerec {

namespace {

constexpr double kOnward = 0.3;       // algorithm 5: of the branch's direction beside the side's
constexpr double kLengthShare = 0.6;  // of the segment
constexpr double kRadiusShare = 0.8;  // of the host's radius,
constexpr double kThinRadius = 0.02;  // metres, up to this radius; thicker wood bears thinner twigs
constexpr double kLeastShare = 0.15;
constexpr double kSideways = 0.2;  // sine: a side less to the left or right than this is up or down

DVec3 unit(const DVec3& v, const char* what) {
    if (!is_finite(v) || !(glm::length(v) > 1e-12))
        throw Error(std::string(what) + " must be three finite numbers that are not all zero.");
    return glm::normalize(v);
}

// The way the branch goes on at `node`, and how far to its next node.
std::pair<DVec3, double> way_on(const Tree& tree, NodeId node) {
    const Node& host = tree.node(node);
    for (NodeId child : tree.children(node)) {
        const DVec3 way = tree.node(child).position - host.position;
        const double length = glm::length(way);
        if (length > 1e-12) return {way / length, length};
    }
    const double behind =
        host.parent == kNoNode ? 0.0 : glm::distance(host.position, tree.node(host.parent).position);
    return {direction_at(tree, node), behind};
}

DVec3 side_direction(const DVec3& along, const TwigOptions& options) {
    const DVec3 view = unit(options.view, "The view");
    const DVec3 up = unit(options.up, "The view's up");
    DVec3 screen_right = glm::cross(view, up);
    if (glm::length(screen_right) < 1e-9) throw Error("The view looks along its own up direction.");
    screen_right = glm::normalize(screen_right);
    DVec3 right = glm::cross(view, along);
    // Seen end on, a branch has no sides of its own.
    if (glm::length(right) < 1e-6) {
        right = screen_right - along * glm::dot(screen_right, along);
    } else {
        right = glm::normalize(right);
        if (glm::dot(right, screen_right) < -kSideways) right = -right;
    }
    right = glm::normalize(right);
    return glm::normalize((options.side == TwigSide::kRight ? right : -right) + kOnward * along);
}

}  // namespace

NodeId make_twig(Tree& tree, NodeId node, const TwigOptions& options) {
    if (!tree.contains(node))
        throw Error("There is no node " + std::to_string(node) + " in this tree for a twig.");
    if (!(options.length >= 0.0) || !std::isfinite(options.length))
        throw Error("A twig's length must be positive metres, or 0 for what suits its host.");
    if (!(options.radius >= 0.0) || !std::isfinite(options.radius))
        throw Error("A twig's radius must be positive metres, or 0 for what suits its host.");
    const Node& host = tree.node(node);
    const auto [along, segment] = way_on(tree, node);
    const DVec3 direction =
        options.direction ? unit(*options.direction, "A twig's direction") : side_direction(along, options);
    double radius = options.radius;
    if (options.as_printed && options.length == 0.0 && host.child_count == 0)
        throw Error(
            "A twig's length by algorithm 5 is a share of the way to the node's child, and a tip has none: "
            "give it a length.");
    if (options.as_printed && radius == 0.0) radius = kRadiusShare * host.radius;
    if (radius == 0.0) {
        const double share = kRadiusShare * std::sqrt(std::min(1.0, kThinRadius / host.radius));
        radius = host.radius * std::max(share, kLeastShare);
    }
    radius = std::min(radius, host.radius);
    double length = options.length;
    if (options.as_printed && length == 0.0) length = kLengthShare * segment;
    if (length == 0.0) length = std::max(kLengthShare * segment, host.radius + 4.0 * radius);
    const DVec3 place = host.position + direction * length;
    return tree.add_child(node, place, radius);
}

}  // namespace treerec
