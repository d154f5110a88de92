#include "edit/move.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "edit/node_sets.h"
#include "edit/turn_sections.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr double kGoldenAngle = 2.39996322972865332;  // radians: no two of many sides come close
constexpr double kSideAngle = 0.9;                    // radians between new wood and what it grows from
constexpr double kTaper = 0.85;                       // of the radius of what it grows from
constexpr double kRadii = 10.0;                       // how long wood is that has nothing to go by

// Applies a change to the places of a branch, or of the whole tree for its root; returns what moved.
template <typename F>
std::vector<NodeId> transform(Tree& tree, NodeId id, const F& place_of) {
    const std::vector<NodeId> order = tree.depth_first(id);
    std::vector<DVec3> places;
    places.reserve(order.size());
    for (const NodeId node : order)
        places.push_back(place_of(tree.node(node).position));
    require_places(places);
    std::vector<NodeId> moved;
    for (size_t i = 0; i < order.size(); i++) {
        if (tree.node(order[i]).position == places[i]) continue;
        tree.set_position(order[i], places[i]);
        moved.push_back(order[i]);
    }
    return moved;
}

DVec3 joint_of(const Tree& tree, NodeId id) {
    const NodeId parent = tree.node(id).parent;
    return tree.node(parent != kNoNode ? parent : id).position;
}

DVec3 require_direction(const DVec3& v, const char* what) {
    const DVec3 unit = normalized_or(v, DVec3(0.0));
    if (!is_finite(unit) || unit == DVec3(0.0)) throw Error(std::string(what) + " must not be zero.");
    return unit;
}

}  // namespace

std::vector<NodeId> move_nodes(Tree& tree, const std::vector<NodeId>& nodes, const DVec3& by,
                               const MoveOptions& options) {
    const std::vector<uint8_t> chosen = mask_of(tree, nodes);
    if (!is_finite(by)) throw Error("How far to move must be finite numbers.");
    if (!(options.falloff >= 0.0)) throw Error("The falloff must be zero or more metres.");
    const std::vector<NodeId> order = tree.depth_first();
    // Metres along the wood to the nearest node that moves wholly: once down the tree, once up.
    constexpr double kFar = std::numeric_limits<double>::infinity();
    std::vector<double> distance(static_cast<size_t>(tree.id_end()), kFar);
    std::vector<uint8_t> whole = chosen;
    for (const NodeId id : order) {
        const NodeId parent = tree.node(id).parent;
        if (options.subtree && parent != kNoNode && whole[parent]) whole[id] = 1;
        if (whole[id]) distance[id] = 0.0;
    }
    for (auto at = order.rbegin(); at != order.rend(); ++at) {
        const NodeId parent = tree.node(*at).parent;
        if (parent != kNoNode)
            distance[parent] = std::min(distance[parent], distance[*at] + segment_length(tree, *at));
    }
    for (const NodeId id : order) {
        const NodeId parent = tree.node(id).parent;
        if (parent != kNoNode)
            distance[id] = std::min(distance[id], distance[parent] + segment_length(tree, id));
    }
    std::vector<DVec3> places;
    std::vector<NodeId> moved;
    for (const NodeId id : order) {
        double share = whole[id] ? 1.0 : 0.0;
        if (!whole[id] && distance[id] < options.falloff)
            share = 1.0 - glm::smoothstep(0.0, 1.0, distance[id] / options.falloff);
        if (share <= 0.0) continue;
        const DVec3 place = tree.node(id).position + by * share;
        if (place == tree.node(id).position) continue;
        places.push_back(place);
        moved.push_back(id);
    }
    require_places(places);
    for (size_t i = 0; i < moved.size(); i++)
        tree.set_position(moved[i], places[i]);
    return moved;
}

std::vector<NodeId> turn_branch(Tree& tree, NodeId id, const DVec3& axis, double degrees) {
    require_node(tree, id);
    const DVec3 unit = require_direction(axis, "The axis to turn about");
    if (!std::isfinite(degrees)) throw Error("The angle must be a finite number of degrees.");
    const DVec3 joint = joint_of(tree, id);
    const double angle = glm::radians(degrees);
    const DMat3 turn(turned({1, 0, 0}, unit, angle), turned({0, 1, 0}, unit, angle),
                     turned({0, 0, 1}, unit, angle));
    const std::vector<NodeId> moved =
        transform(tree, id, [&](const DVec3& p) { return joint + turned(p - joint, unit, angle); });
    turn_sections(tree, moved, turn);
    return moved;
}

std::vector<NodeId> scale_branch(Tree& tree, NodeId id, double factor, double thickness) {
    require_node(tree, id);
    if (!(factor > 0.0) || !std::isfinite(factor) || !(thickness > 0.0) || !std::isfinite(thickness))
        throw Error("What a branch is scaled by must be positive and finite.");
    const std::vector<NodeId> order = tree.depth_first(id);
    for (const NodeId node : order) {
        const double radius = tree.node(node).radius * thickness;
        if (!(radius > 0.0) || !std::isfinite(radius)) throw Error("Radii must stay positive and finite.");
    }
    const DVec3 joint = joint_of(tree, id);
    transform(tree, id, [&](const DVec3& p) { return joint + (p - joint) * factor; });
    for (const NodeId node : order)
        tree.set_radius(node, tree.node(node).radius * thickness);
    return order;
}

std::vector<NodeId> mirror_branch(Tree& tree, NodeId id, const DVec3& normal) {
    require_node(tree, id);
    const DVec3 unit = require_direction(normal, "The mirror's normal");
    const DVec3 joint = joint_of(tree, id);
    const std::vector<NodeId> moved =
        transform(tree, id, [&](const DVec3& p) { return p - unit * (2.0 * glm::dot(p - joint, unit)); });
    turn_sections(tree, moved, DMat3(1.0) - 2.0 * glm::outerProduct(unit, unit));
    return moved;
}

std::vector<NodeId> grow_node(Tree& tree, NodeId id, const GrowNodeOptions& options) {
    require_node(tree, id);
    const Node host = tree.node(id);
    if (!(options.length >= 0.0) || !std::isfinite(options.length) || !(options.radius >= 0.0) ||
        !std::isfinite(options.radius))
        throw Error("Length and radius of new wood must be zero or more metres.");
    if (options.nodes < 1 || options.nodes > 1000) throw Error("New wood has 1 to 1000 nodes.");
    DVec3 ahead(0.0, 1.0, 0.0);
    if (host.parent != kNoNode) ahead = normalized_or(host.position - tree.node(host.parent).position, ahead);
    DVec3 direction = ahead;
    if (options.direction) {
        direction = require_direction(*options.direction, "The direction of new wood");
    } else if (host.child_count > 0) {
        const DVec3 side = turned(any_perpendicular(ahead), ahead, kGoldenAngle * host.child_count);
        direction = ahead * portable::cos(kSideAngle) + side * portable::sin(kSideAngle);
    }
    double length = options.length > 0.0 ? options.length : segment_length(tree, id);
    if (!(length > 0.0)) length = kRadii * host.radius;
    const double radius = options.radius > 0.0 ? options.radius : kTaper * host.radius;
    std::vector<DVec3> places;
    for (int i = 1; i <= options.nodes; i++)
        places.push_back(host.position + direction * (length * i / options.nodes));
    require_places(places);
    std::vector<NodeId> added;
    for (const DVec3& place : places)
        added.push_back(tree.add_child(added.empty() ? id : added.back(), place, radius));
    return added;
}

std::vector<NodeId> attach_branch(Tree& tree, NodeId id, NodeId to, bool bring) {
    require_node(tree, id);
    require_node(tree, to);
    if (id == tree.root()) throw Misfit("The root hangs on nothing, so it cannot be attached elsewhere.");
    for (NodeId at = to; at != kNoNode; at = tree.node(at).parent)
        if (at == id) throw Misfit("A branch cannot be attached to wood that grows from it.");
    std::vector<NodeId> changed{id};
    if (bring) {
        const DVec3 by = tree.node(to).position - joint_of(tree, id);
        changed = transform(tree, id, [&](const DVec3& p) { return p + by; });
    }
    if (tree.node(id).parent != to) tree.reparent(id, to);
    return changed;
}

std::vector<NodeId> scale_radii(Tree& tree, const std::vector<NodeId>& nodes, double factor) {
    if (!(factor > 0.0) || !std::isfinite(factor)) throw Error("The factor must be positive and finite.");
    for (const NodeId id : nodes) {
        require_node(tree, id);
        const double radius = tree.node(id).radius * factor;
        if (!(radius > 0.0) || !std::isfinite(radius)) throw Error("Radii must stay positive and finite.");
    }
    for (const NodeId id : nodes) {
        tree.set_radius(id, tree.node(id).radius * factor);
        tree.set_flag(id, kMeasuredRadiusFlag, false);
    }
    return nodes;
}

std::vector<NodeId> set_radii(Tree& tree, const std::vector<NodeId>& nodes, double radius) {
    if (!(radius > 0.0) || !std::isfinite(radius)) throw Error("A radius must be positive and finite.");
    for (const NodeId id : nodes)
        require_node(tree, id);
    for (const NodeId id : nodes) {
        tree.set_radius(id, radius);
        tree.set_flag(id, kMeasuredRadiusFlag, false);
    }
    return nodes;
}

}  // namespace treerec
