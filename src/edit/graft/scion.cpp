#include "edit/graft/scion.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "edit/turn_sections.h"
#include "error.h"
#include "geometry/portable_math.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr double kUpright = 0.9396926207859084;  // cos 20 degrees
constexpr double kClearShare = 0.02;             // of the scion's length: nearer nodes show no direction

}  // namespace

DMat3 frame_about(const DVec3& forward) {
    const DVec3 side = std::abs(forward.y) > kUpright ? DVec3(0, 0, 1) : DVec3(0, 1, 0);
    const DVec3 up = glm::normalize(side - forward * glm::dot(side, forward));
    return DMat3(glm::cross(forward, up), forward, up);
}

DVec3 direction_at(const Tree& tree, NodeId joint) {
    for (NodeId at = joint; tree.node(at).parent != kNoNode; at = tree.node(at).parent) {
        const DVec3 way = tree.node(at).position - tree.node(tree.node(at).parent).position;
        if (glm::length(way) > 1e-12) return glm::normalize(way);
    }
    return DVec3(0.0, 1.0, 0.0);
}

DMat3 turn_about(const DVec3& axis, double radians) {
    // Rodrigues' formula, a column at a time.
    const double c = portable::cos(radians);
    const double s = portable::sin(radians);
    const auto turned = [&](const DVec3& v) {
        return v * c + glm::cross(axis, v) * s + axis * (glm::dot(axis, v) * (1.0 - c));
    };
    return DMat3(turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1}));
}

DMat3 turn_between(const DVec3& from, const DVec3& to) {
    const DVec3 axis = glm::cross(from, to);
    const double sine = glm::length(axis);
    const double cosine = glm::dot(from, to);
    if (sine < 1e-12) return cosine > 0.0 ? DMat3(1.0) : turn_about(any_perpendicular(from), kPi);
    return turn_about(axis / sine, portable::atan2(sine, cosine));
}

Tree take_scion(const Tree& tree, NodeId joint_child) {
    if (!tree.contains(joint_child))
        throw Error("There is no node " + std::to_string(joint_child) + " in this tree.");
    const NodeId joint = tree.node(joint_child).parent;
    Tree scion;
    for (const std::string& rule : tree.leaf_rules())
        scion.name_leaf_rule(rule);
    std::vector<NodeId> moved(static_cast<size_t>(tree.id_end()), kNoNode);
    DVec3 origin(0.0);
    DMat3 into(1.0);
    if (joint == kNoNode) {
        const Node& root = tree.node(joint_child);
        if (root.child_count == 0)
            throw Error("The tree is a single node: there is no branch on it to take.");
        origin = root.position;
        moved[joint_child] = scion.add_root(DVec3(0.0), root.radius, root.flags);
    } else {
        // What goes on from the joint is as thick there as the joint; what leaves it starts with its own.
        const double first = tree.node(joint_child).radius;
        const double whole = tree.node(joint).radius;
        const bool on = main_child(tree, joint, subtree_lengths(tree)) == joint_child;
        origin = tree.node(joint).position;
        into = glm::transpose(frame_about(direction_at(tree, joint)));
        scion.add_root(DVec3(0.0), on ? whole : std::min(first, whole), tree.node(joint_child).flags);
    }
    scion.set_leaf_rule(scion.root(), tree.node(joint_child).leaf_rule);
    scion.set_section_table(tree.section_table());
    if (joint == kNoNode) scion.set_section(scion.root(), tree.node(joint_child).section);
    for (NodeId id : tree.depth_first(joint_child)) {
        if (moved[id] != kNoNode) continue;
        const Node& node = tree.node(id);
        const NodeId parent = id == joint_child ? scion.root() : moved[node.parent];
        moved[id] = scion.add_child(parent, into * (node.position - origin), node.radius, node.flags);
        scion.set_leaf_rule(moved[id], node.leaf_rule);
        scion.set_section(moved[id], node.section);
    }
    scion.drop_unused_sections();
    turn_sections(scion, scion.depth_first(), into);
    return scion;
}

DVec3 scion_direction(const Tree& scion) {
    const DVec3 up(0.0, 1.0, 0.0);
    if (scion.empty()) return up;
    const std::vector<double> lengths = subtree_lengths(scion);
    const Node& root = scion.node(scion.root());
    const double clear = std::max(root.radius, kClearShare * scion_length(scion));
    DVec3 way(0.0);
    for (NodeId at = main_child(scion, scion.root(), lengths); at != kNoNode;
         at = main_child(scion, at, lengths)) {
        way = scion.node(at).position - root.position;
        if (glm::length(way) > clear) break;
    }
    return normalized_or(way, up);
}

double scion_length(const Tree& scion) {
    return scion.empty() ? 0.0 : longest_paths(scion)[scion.root()];
}

void require_scion(const Tree& scion) {
    if (scion.empty()) throw Error("The branch to graft is empty.");
    if (scion.size() < 2) throw Error("The branch to graft is a single node: it has no wood to graft.");
}

void require_room(const Tree& tree, size_t nodes) {
    if (static_cast<int64_t>(tree.id_end()) + static_cast<int64_t>(nodes) > int64_t{kLargestId} + 1)
        throw Error("The tree would have more than " + std::to_string(kLargestId) +
                    " nodes, which no file could hold: graft less, or lighten the tree first.");
}

std::vector<NodeId> place_scion(Tree& tree, NodeId joint, const Tree& scion,
                                const ScionPlacement& placement) {
    if (!tree.contains(joint)) throw Error("There is no node " + std::to_string(joint) + " in this tree.");
    require_scion(scion);
    require_room(tree, scion.size() - 1);
    const DVec3 base = scion.node(scion.root()).position;
    const DVec3 place = tree.node(joint).position;
    const std::vector<NodeId> order = scion.depth_first();
    std::vector<DVec3> positions(order.size());
    std::vector<double> radii(order.size());
    for (size_t i = 1; i < order.size(); i++) {
        const Node& node = scion.node(order[i]);
        positions[i] = place + placement.axes * (placement.scale * (node.position - base));
        radii[i] = placement.scale * node.radius;
        if (!is_finite(positions[i]) || !(radii[i] > 0.0) || !std::isfinite(radii[i]))
            throw Error("The branch to graft is too large or too small at a scale of " +
                        std::to_string(placement.scale) + ": its numbers overflow.");
    }
    // A scion may be the very tree that it is put on.
    std::vector<NodeId> parents(order.size(), kNoNode);
    std::vector<uint8_t> flags(order.size()), rules(order.size());
    std::vector<SectionShape> sections;
    std::vector<size_t> section_of(order.size(), 0);  // from 1 among `sections`
    const bool keeps_rules = !scion.leaf_rules().empty();
    for (size_t i = 0; i < order.size(); i++) {
        parents[i] = scion.node(order[i]).parent;
        flags[i] = static_cast<uint8_t>(scion.node(order[i]).flags & kGuessFlag);
        rules[i] = scion.node(order[i]).leaf_rule;
        if (i == 0) continue;  // the joint stands for it
        if (const SectionShape* const section = scion.section_of(order[i])) {
            sections.push_back(*section);
            section_of[i] = sections.size();
        }
    }
    std::vector<NodeId> moved(static_cast<size_t>(scion.id_end()), kNoNode);
    moved[order[0]] = joint;
    const std::vector<std::string> names = scion.leaf_rules();
    for (uint8_t& rule : rules)
        if (rule > 0) rule = tree.name_leaf_rule(names[rule - 1u]);
    const size_t sections_before = tree.add_sections(sections);
    std::vector<NodeId> added;
    added.reserve(order.size() - 1);
    for (size_t i = 1; i < order.size(); i++) {
        moved[order[i]] = tree.add_child(moved[parents[i]], positions[i], radii[i], flags[i]);
        if (keeps_rules) tree.set_leaf_rule(moved[order[i]], rules[i]);
        if (section_of[i] > 0) tree.set_section(moved[order[i]], sections_before + section_of[i]);
        added.push_back(moved[order[i]]);
    }
    if (!sections.empty()) turn_sections(tree, added, placement.axes);
    return added;
}

}  // namespace treerec
