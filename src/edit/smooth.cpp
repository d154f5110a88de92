#include "edit/smooth.h"

#include <algorithm>
#include <cmath>

#include "edit/node_sets.h"
#include "geometry/portable_math.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr double kMostNodes = 1e6;

void require_smoothing(const SmoothOptions& options) {
    if (!(options.strength >= 0.0 && options.strength <= 1.0))
        throw Error("The strength of smoothing must be from 0 to 1.");
    if (options.rounds < 0 || options.rounds > 1000) throw Error("Smooth 0 to 1000 times.");
}

// Where a value lies between its neighbours', linearly by the distances to them.
template <typename T>
T between(const T& before, const T& after, double to_before, double to_after) {
    const double sum = to_before + to_after;
    return before + (after - before) * (sum > 0.0 ? to_before / sum : 0.5);
}

NodeId next_on_branch(const Tree& tree, const BranchList& list, NodeId id) {
    for (const NodeId child : tree.children(id))
        if (list.branch_of[child] == list.branch_of[id]) return child;
    return kNoNode;
}

// Sets the positions that differ; the nodes that moved, in depth-first order.
std::vector<NodeId> place_nodes(Tree& tree, const std::vector<NodeId>& order,
                                const std::vector<DVec3>& places) {
    require_places(places);
    std::vector<NodeId> moved;
    for (const NodeId id : order) {
        if (tree.node(id).position == places[id]) continue;
        tree.set_position(id, places[id]);
        moved.push_back(id);
    }
    return moved;
}

std::vector<DVec3> places_of(const Tree& tree) {
    std::vector<DVec3> places(static_cast<size_t>(tree.id_end()), DVec3(0.0));
    for (NodeId id = 0; id < tree.id_end(); id++)
        if (tree.contains(id)) places[id] = tree.node(id).position;
    return places;
}

double turn_at(const DVec3& before, const DVec3& at, const DVec3& after) {
    const DVec3 in = at - before, out = after - at;
    return portable::atan2(glm::length(glm::cross(in, out)), glm::dot(in, out));
}

uint8_t flags_between(const Node& lower, const Node& upper) {
    return lower.is_measured() ? upper.flags : static_cast<uint8_t>(upper.flags & ~kMeasuredRadiusFlag);
}

// Barry and Goldman's evaluation of a Catmull-Rom segment from p1 to p2, knots by the square root of the
// distances.
DVec3 catmull_rom(const DVec3& p0, const DVec3& p1, const DVec3& p2, const DVec3& p3, double share) {
    const double t1 = std::sqrt(glm::distance(p0, p1)), t2 = t1 + std::sqrt(glm::distance(p1, p2)),
                 t3 = t2 + std::sqrt(glm::distance(p2, p3));
    const double t = t1 + (t2 - t1) * share;
    const auto mix = [t](const DVec3& a, const DVec3& b, double from, double to) {
        return to > from ? a + (b - a) * ((t - from) / (to - from)) : b;
    };
    const DVec3 a1 = mix(p0, p1, 0.0, t1), a2 = mix(p1, p2, t1, t2), a3 = mix(p2, p3, t2, t3);
    return mix(mix(a1, a2, 0.0, t2), mix(a2, a3, t1, t3), t1, t2);
}

}  // namespace

std::vector<NodeId> smooth_radii(Tree& tree, const std::vector<NodeId>& nodes, const SmoothOptions& options,
                                 bool keep_measured, bool taper) {
    require_smoothing(options);
    const std::vector<uint8_t> chosen = mask_of(tree, nodes);
    const BranchList list = list_branches(tree);
    std::vector<double> radii(static_cast<size_t>(tree.id_end()), 0.0);
    for (const NodeId id : list.nodes)
        radii[id] = tree.node(id).radius;
    const auto free = [&](NodeId id) {
        return chosen[id] && !(keep_measured && tree.node(id).is_measured());
    };
    std::vector<double> next;
    for (const Branch& branch : list.branches) {
        const std::span<const NodeId> chain = list.nodes_of(branch);
        if (chain.size() < 3) continue;
        next.assign(chain.size(), 0.0);
        for (int round = 0; round < options.rounds; round++) {
            for (size_t i = 1; i + 1 < chain.size(); i++) {
                const double target =
                    between(radii[chain[i - 1]], radii[chain[i + 1]], segment_length(tree, chain[i]),
                            segment_length(tree, chain[i + 1]));
                next[i] = radii[chain[i]] + (target - radii[chain[i]]) * options.strength;
            }
            for (size_t i = 1; i + 1 < chain.size(); i++)
                if (free(chain[i])) radii[chain[i]] = next[i];
        }
    }
    std::vector<NodeId> changed;
    for (const NodeId id : tree.depth_first()) {
        const NodeId parent = tree.node(id).parent;
        if (taper && parent != kNoNode && free(id)) radii[id] = std::min(radii[id], radii[parent]);
        if (radii[id] == tree.node(id).radius) continue;
        tree.set_radius(id, radii[id]);
        changed.push_back(id);
    }
    return changed;
}

std::vector<NodeId> smooth_paths(Tree& tree, const std::vector<NodeId>& nodes, const SmoothOptions& options) {
    require_smoothing(options);
    const std::vector<uint8_t> chosen = mask_of(tree, nodes);
    const std::vector<NodeId> order = tree.depth_first();
    std::vector<NodeId> free;
    for (const NodeId id : order)
        if (chosen[id] && tree.node(id).parent != kNoNode && tree.node(id).child_count == 1)
            free.push_back(id);
    std::vector<DVec3> places = places_of(tree);
    std::vector<DVec3> next(free.size());
    for (int round = 0; round < options.rounds; round++) {
        for (size_t i = 0; i < free.size(); i++) {
            const Node& node = tree.node(free[i]);
            const DVec3 &before = places[node.parent], &here = places[free[i]],
                        &after = places[node.first_child];
            const DVec3 target =
                between(before, after, glm::distance(before, here), glm::distance(here, after));
            next[i] = here + (target - here) * options.strength;
        }
        for (size_t i = 0; i < free.size(); i++)
            places[free[i]] = next[i];
    }
    return place_nodes(tree, order, places);
}

std::vector<NodeId> relax_kinks(Tree& tree, const std::vector<NodeId>& nodes, double angle, int rounds) {
    if (!(angle > 0.0 && angle < 180.0)) throw Error("A kink's angle must be between 0 and 180 degrees.");
    const std::vector<uint8_t> chosen = mask_of(tree, nodes);
    const BranchList list = list_branches(tree);
    const std::vector<NodeId> order = tree.depth_first();
    const double limit = glm::radians(angle);
    std::vector<DVec3> places = places_of(tree);
    for (int round = 0; round < rounds; round++) {
        bool any = false;
        for (const NodeId id : order) {
            const NodeId parent = tree.node(id).parent, next = next_on_branch(tree, list, id);
            if (!chosen[id] || parent == kNoNode || next == kNoNode) continue;
            const DVec3 before = places[parent], here = places[id], after = places[next];
            const double in = glm::distance(before, here), out = glm::distance(here, after);
            const double chord = glm::distance(before, after);
            // Wood that turns right back has no straight way to go.
            if (chord < 1e-6 * (in + out) || turn_at(before, here, after) <= limit * (1.0 + 1e-9)) continue;
            const DVec3 target = between(before, after, in, out);
            double low = 0.0, high = 1.0;
            for (int i = 0; i < 50; i++) {
                const double middle = 0.5 * (low + high);
                (turn_at(before, glm::mix(here, target, middle), after) > limit ? low : high) = middle;
            }
            const DVec3 offset = (target - here) * high;
            places[id] += offset;
            any = true;
            for (const NodeId child : tree.children(id)) {
                if (child == next) continue;
                for (const NodeId carried : tree.depth_first(child))
                    places[carried] += offset;
            }
        }
        if (!any) break;
    }
    return place_nodes(tree, order, places);
}

std::vector<NodeId> subdivide(Tree& tree, const std::vector<NodeId>& nodes, double length, bool curved) {
    if (!(length > 0.0)) throw Error("The length of a segment must be positive.");
    const std::vector<uint8_t> chosen = mask_of(tree, nodes);
    const BranchList list = list_branches(tree);
    const std::vector<DVec3> places = places_of(tree);
    double wanted = 0.0;
    for (const NodeId id : nodes)
        wanted += std::max(std::ceil(segment_length(tree, id) / length) - 1.0, 0.0);
    if (!(wanted <= kMostNodes)) throw Error("Segments that short would take more than a million nodes.");
    if (static_cast<double>(tree.id_end()) + wanted > kLargestId)
        throw Error("The tree would have more than " + std::to_string(kLargestId) +
                    " nodes, which no file could hold: choose longer segments.");
    // What comes into the segment below a node, from its begin to its end.
    std::vector<size_t> begin(static_cast<size_t>(tree.id_end()), 0), end = begin;
    std::vector<DVec3> new_places;
    std::vector<double> new_radii;
    std::vector<uint8_t> new_flags;
    for (const Branch& branch : list.branches) {
        const std::span<const NodeId> chain = list.nodes_of(branch);
        for (size_t i = 0; i < chain.size(); i++) {
            const NodeId id = chain[i], lower = i > 0 ? chain[i - 1] : branch.attach;
            if (!chosen[id] || lower == kNoNode) continue;
            const DVec3 from = places[lower], to = places[id];
            const int parts = static_cast<int>(std::ceil(glm::distance(from, to) / length));
            // Beyond the branch's ends the curve goes straight on.
            const NodeId lowest = i > 1 ? chain[i - 2] : i == 1 ? branch.attach : kNoNode;
            const DVec3 before = lowest != kNoNode ? places[lowest] : from - (to - from);
            const DVec3 after = i + 1 < chain.size() ? places[chain[i + 1]] : to + (to - from);
            const Node &first = tree.node(lower), &last = tree.node(id);
            begin[id] = new_places.size();
            for (int part = 1; part < parts; part++) {
                const double share = static_cast<double>(part) / parts;
                new_places.push_back(curved ? catmull_rom(before, from, to, after, share)
                                            : glm::mix(from, to, share));
                // A side branch starts with its own thickness, not with that of the wood it grows from.
                new_radii.push_back(i == 0 ? last.radius : glm::mix(first.radius, last.radius, share));
                new_flags.push_back(flags_between(first, last));
            }
            end[id] = new_places.size();
        }
    }
    std::vector<NodeId> added;
    if (new_places.empty()) return added;
    // All at once: one after the other, each would change the depth of all above it.
    const size_t count = tree.size() + new_places.size();
    std::vector<NodeId> ids, parents, index(static_cast<size_t>(tree.id_end()), kNoNode);
    std::vector<DVec3> positions;
    std::vector<double> radii;
    std::vector<uint8_t> flags;
    ids.reserve(count), parents.reserve(count), positions.reserve(count), radii.reserve(count);
    flags.reserve(count);
    const auto add = [&](NodeId id, NodeId parent, const DVec3& place, double radius, uint8_t marks) {
        ids.push_back(id), parents.push_back(parent), positions.push_back(place), radii.push_back(radius);
        flags.push_back(marks);
        return static_cast<NodeId>(ids.size() - 1);
    };
    for (const NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        NodeId below = node.parent == kNoNode ? kNoNode : index[node.parent];
        for (size_t i = begin[id]; i < end[id]; i++)
            below =
                add(tree.id_end() + static_cast<NodeId>(i), below, new_places[i], new_radii[i], new_flags[i]);
        index[id] = add(id, below, node.position, node.radius, node.flags);
    }
    for (size_t i = 0; i < new_places.size(); i++)
        added.push_back(tree.id_end() + static_cast<NodeId>(i));
    Tree finer = Tree::from_arrays(parents, positions, radii, flags, &ids);
    finer.set_frame(tree.frame());
    for (const std::string& rule : tree.leaf_rules())
        finer.name_leaf_rule(rule);
    finer.set_section_table(tree.section_table());
    for (const NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        const auto mark = [&](NodeId like) {
            finer.set_leaf_rule(like, node.leaf_rule);
            finer.set_section(like, node.section);
        };
        mark(id);
        for (size_t i = begin[id]; i < end[id]; i++)
            mark(tree.id_end() + static_cast<NodeId>(i));
    }
    tree = std::move(finer);
    return added;
}

NodeId insert_node(Tree& tree, NodeId id, double share) {
    require_node(tree, id);
    if (!(share > 0.0 && share < 1.0)) throw Error("A share of a segment lies between 0 and 1.");
    if (id == tree.root()) throw Misfit("Nothing grows below the root, so no node can be put there.");
    const Node last = tree.node(id), first = tree.node(last.parent);
    return tree.insert_before(id, glm::mix(first.position, last.position, share),
                              glm::mix(first.radius, last.radius, share), flags_between(first, last));
}

std::vector<NodeId> straighten(Tree& tree, NodeId id, double strength) {
    require_node(tree, id);
    if (!(strength >= 0.0 && strength <= 1.0)) throw Error("The strength must be from 0 to 1.");
    const BranchList list = list_branches(tree);
    const Branch& branch = list.branches[list.branch_of[id]];
    const std::span<const NodeId> chain = list.nodes_of(branch);
    const NodeId start = branch.attach != kNoNode ? branch.attach : chain.front();
    const DVec3 from = tree.node(start).position, way = tree.node(chain.back()).position - from;
    std::vector<DVec3> offsets(static_cast<size_t>(tree.id_end()), DVec3(0.0));
    double along = 0.0;
    for (const NodeId node : chain) {
        if (node != start) along += segment_length(tree, node);
        const double share = branch.length > 0.0 ? along / branch.length : 0.0;
        offsets[node] = (from + way * share - tree.node(node).position) * strength;
    }
    const std::vector<NodeId> order = tree.depth_first(chain.front());
    std::vector<DVec3> places = places_of(tree);
    for (const NodeId node : order) {
        if (list.branch_of[node] != list.branch_of[id]) offsets[node] = offsets[tree.node(node).parent];
        places[node] += offsets[node];
    }
    return place_nodes(tree, order, places);
}

}  // namespace treerec
