#include "edit/vary/sag.h"

#include <algorithm>
#include <cmath>

#include "edit/node_sets.h"
#include "geometry/portable_math.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr double kGravity = 9.81;       // m/s^2
constexpr double kMostTurn = 0.1;       // radians, of any wood in one step
constexpr int kMostSteps = 20;          // times as many as asked for
constexpr double kLargestWeight = 1e6;  // times its own
constexpr double kHeaviestLoad = 1e6;   // kg/m

void require_sag(const SagOptions& options) {
    if (!(std::abs(options.weight) <= kLargestWeight)) throw Error("The weight is out of range.");
    if (!(options.load >= 0.0 && options.load <= kHeaviestLoad)) throw Error("The load is out of range.");
    if (!(options.density > 0.0) || !std::isfinite(options.density) || !(options.stiffness > 0.0) ||
        !std::isfinite(options.stiffness))
        throw Error("Density and stiffness of wood must be positive and finite.");
    if (options.steps < 1 || options.steps > 100) throw Error("Bend in 1 to 100 steps.");
}

}  // namespace

std::vector<NodeId> sag(Tree& tree, const std::vector<NodeId>& nodes, const SagOptions& options) {
    require_sag(options);
    const std::vector<uint8_t> chosen = mask_of(tree, nodes);
    const std::vector<NodeId> order = tree.depth_first();
    const BranchList list = list_branches(tree);
    const size_t ids = static_cast<size_t>(tree.id_end());
    std::vector<DVec3> places(ids, DVec3(0.0)), next = places;
    std::vector<double> radius(ids, 0.0), mass(ids, 0.0);  // of the segment that ends in a node
    for (const NodeId id : order) {
        const Node& node = tree.node(id);
        places[id] = node.position;
        if (node.parent == kNoNode) continue;
        // A side branch's first segment is as thick as the branch, not as the wood it grows from.
        const bool starts = list.branch_of[node.parent] != list.branch_of[id];
        radius[id] = starts ? node.radius : 0.5 * (node.radius + tree.node(node.parent).radius);
        const double wood = options.weight * options.density * kPi * radius[id] * radius[id];
        const double load = options.weight < 0.0 ? -options.load : options.load;
        mass[id] = (wood + load) * segment_length(tree, id);
    }
    std::vector<double> borne(ids), angle(ids), turned_by(ids);
    std::vector<DVec3> moment(ids), axis(ids);  // moment: mass times place
    std::vector<DMat3> turn(ids);
    double left_of_weight = 1.0;
    for (int step = 0; left_of_weight > 0.0 && step < kMostSteps * options.steps; step++) {
        const double part = std::min(1.0 / options.steps, left_of_weight);
        std::fill(borne.begin(), borne.end(), 0.0);
        std::fill(moment.begin(), moment.end(), DVec3(0.0));
        for (auto at = order.rbegin(); at != order.rend(); ++at) {
            const NodeId id = *at, parent = tree.node(id).parent;
            if (parent == kNoNode) continue;
            borne[parent] += borne[id] + mass[id];
            moment[parent] += moment[id] + (places[id] + places[parent]) * (0.5 * mass[id]);
        }
        double most = 0.0;
        for (const NodeId id : order) {
            const NodeId parent = tree.node(id).parent;
            angle[id] = turned_by[id] = 0.0;
            if (parent == kNoNode) continue;
            const DVec3 segment = places[id] - places[parent];
            const double length = glm::length(segment);
            if (chosen[id] && length > 0.0) {
                const DVec3 way = segment / length;
                const DVec3 middle = 0.5 * (places[id] + places[parent]);
                // Of what is above the middle: half of the segment, and all from its end on.
                const double above = borne[id] + 0.5 * mass[id];
                const DVec3 lever = moment[id] + (places[id] + middle) * (0.25 * mass[id]) - middle * above;
                const DVec3 torque = glm::cross(lever, DVec3(0.0, -kGravity * part, 0.0));
                // What twists it does not bend it.
                const DVec3 bending = torque - way * glm::dot(torque, way);
                const double strength = glm::length(bending);
                const double square = radius[id] * radius[id];
                const double inertia = kPi / 4.0 * square * square;
                // Not past where the weight pulls it.
                const DVec3 end(0.0, options.weight < 0.0 ? 1.0 : -1.0, 0.0);
                const double room = portable::atan2(glm::length(glm::cross(way, end)), glm::dot(way, end));
                angle[id] = std::min(strength * length / (options.stiffness * inertia), room);
                if (strength > 0.0) axis[id] = bending / strength;
                if (!(strength > 0.0)) angle[id] = 0.0;
            }
            turned_by[id] = turned_by[parent] + angle[id];
            most = std::max(most, turned_by[id]);
        }
        // The leverage changes as wood turns: a little at a time.
        const double share = most > kMostTurn ? kMostTurn / most : 1.0;
        left_of_weight = share < 1.0 || part < left_of_weight ? left_of_weight - part * share : 0.0;
        for (const NodeId id : order) {
            const NodeId parent = tree.node(id).parent;
            if (parent == kNoNode) {
                next[id] = places[id];
                turn[id] = DMat3(1.0);
                continue;
            }
            turn[id] = turn[parent];
            if (angle[id] > 0.0) {
                const double by = angle[id] * share;
                turn[id] = turn[id] * DMat3(turned({1, 0, 0}, axis[id], by), turned({0, 1, 0}, axis[id], by),
                                            turned({0, 0, 1}, axis[id], by));
            }
            next[id] = next[parent] + turn[id] * (places[id] - places[parent]);
        }
        places.swap(next);
    }
    require_places(places);
    std::vector<NodeId> moved;
    for (const NodeId id : order) {
        if (tree.node(id).position == places[id]) continue;
        tree.set_position(id, places[id]);
        moved.push_back(id);
    }
    return moved;
}

}  // namespace treerec
