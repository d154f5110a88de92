#include "edit/graft/graft_vary.h"

#include <algorithm>
#include <cmath>

#include "edit/graft/scion.h"
#include "error.h"
#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "tree/branches.h"

namespace treerec {

namespace {

DVec3 some_perpendicular(const DVec3& direction, double turn) {
    const DVec3 across = any_perpendicular(direction);
    return across * portable::cos(turn) + glm::cross(direction, across) * portable::sin(turn);
}

Tree vary_segments(const Tree& scion, const Variation& variation, uint64_t seed) {
    Tree varied = scion;
    Random random(seed);
    for (const NodeId id : scion.depth_first()) {
        const NodeId parent = scion.node(id).parent;
        if (parent == kNoNode) continue;
        const DVec3 way = scion.node(id).position - scion.node(parent).position;
        const double spread = variation.angle * kPi / 180.0;
        const double yaw = portable::atan2(way.z, way.x) + random.uniform(-spread, spread);
        const double pitch =
            portable::atan2(way.y, portable::hypot(way.x, way.z)) + random.uniform(-spread, spread);
        const double length = glm::length(way) * (1.0 + random.uniform(-variation.length, variation.length));
        varied.set_position(
            id, varied.node(parent).position + length * DVec3(portable::cos(pitch) * portable::cos(yaw),
                                                              portable::sin(pitch),
                                                              portable::cos(pitch) * portable::sin(yaw)));
    }
    return varied;
}

}  // namespace

void require_variation(const Variation& variation) {
    if (!(variation.angle >= 0.0 && variation.angle <= 180.0))
        throw Error("The variation of angles must be 0 to 180 degrees.");
    if (!(variation.length >= 0.0 && variation.length <= 0.9))
        throw Error("The variation of lengths must be 0 to 0.9, a share of the length.");
}

Tree vary_scion(const Tree& scion, const Variation& variation, uint64_t seed) {
    require_variation(variation);
    Tree varied = scion;
    if (variation.none() || scion.empty()) return varied;
    if (variation.by_segment) return vary_segments(scion, variation, seed);
    const double most = variation.angle * kPi / 180.0;
    const BranchList list = list_branches(scion);
    // By node: how the wood there is turned from where it stood.
    std::vector<DMat3> turned(static_cast<size_t>(scion.id_end()), DMat3(1.0));
    for (size_t b = 0; b < list.branches.size(); b++) {
        const Branch& branch = list.branches[b];
        const std::span<const NodeId> nodes = list.nodes_of(branch);
        Random random(hash_seed(seed, b));
        const DVec3 start = scion.node(branch.attach == kNoNode ? scion.root() : branch.attach).position;
        const DVec3 way = normalized_or(scion.node(nodes.back()).position - start, DVec3(0.0, 1.0, 0.0));
        const DVec3 fork_axis = some_perpendicular(way, random.uniform(0.0, 2.0 * kPi));
        const double fork = random.uniform(-most, most);
        const DVec3 arc_axis = some_perpendicular(way, random.uniform(0.0, 2.0 * kPi));
        const double arc = random.uniform(-most, most);
        const DVec3 wave_axis = some_perpendicular(way, random.uniform(0.0, 2.0 * kPi));
        const double wave = 0.5 * random.uniform(-most, most);
        const double stretch = random.uniform(1.0 - variation.length, 1.0 + variation.length);
        DMat3 base(1.0);
        if (branch.attach != kNoNode) base = turned[branch.attach] * turn_about(fork_axis, fork);
        const auto turn_at = [&](double along) {
            const double share = branch.length > 0.0 ? along / branch.length : 0.0;
            return base * turn_about(wave_axis, wave * portable::sin(2.0 * kPi * share)) *
                   turn_about(arc_axis, arc * share);
        };
        double along = 0.0;
        for (NodeId id : nodes) {
            const NodeId parent = scion.node(id).parent;
            if (parent == kNoNode) continue;
            const DVec3 step = scion.node(id).position - scion.node(parent).position;
            const double length = glm::length(step);
            // The first segment of all says where the scion goes.
            const double middle = branch.attach == kNoNode && along == 0.0 ? 0.0 : along + 0.5 * length;
            varied.set_position(id, varied.node(parent).position + turn_at(middle) * (step * stretch));
            along += length;
            turned[id] = turn_at(along);
        }
    }
    return varied;
}

}  // namespace treerec
