#include "edit/graft/graft.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "edit/graft/scion.h"
#include "edit/turn_sections.h"
#include "error.h"
#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kLeastBranching = 20.0;  // degrees: a scion that leans less has no branching angle
constexpr double kUsualLean = 45.0;       // degrees
constexpr double kSideRatio = 0.8;        // algorithm 5
constexpr double kLeastRadius = 1e-9;     // metres: what scaling to a length may leave of the thinnest twig
constexpr int kMostTries = 1000;

void require_options(const GraftOptions& options) {
    require_variation(options.variation);
    const auto require = [](bool right, const char* sentence) {
        if (!right) throw Error(sentence);
    };
    require(options.lean >= 0.0 && options.lean <= 180.0, "The lean must be 0 to 180 degrees.");
    require(std::isfinite(options.roll), "The roll must be a finite number of degrees.");
    require(is_finite(options.direction) &&
                (options.aim != GraftAim::kDirection || glm::length(options.direction) > 1e-12),
            "The direction must be three finite numbers that are not all zero.");
    require(options.length > 0.0 && std::isfinite(options.length), "The length must be positive metres.");
    require(options.factor > 0.0 && std::isfinite(options.factor), "The scale factor must be positive.");
    require(options.joint_ratio >= 0.0 && options.joint_ratio <= 1.0,
            "The joint's ratio of radii must be 0 to 1.");
    require(options.thinning >= 0.0 && options.thinning <= 1.0, "The thinning must be a ratio from 0 to 1.");
    require(options.clearance >= 0.0 && std::isfinite(options.clearance),
            "The clearance must be a length in metres that is not negative.");
    require(options.tries >= 1 && options.tries <= kMostTries, "The number of tries must be 1 to 1000.");
}

// The direction (tree space) `lean` radians off the host's, into the widest gap between what leaves it.
DVec3 into_gap(const Tree& tree, NodeId host, double lean, uint64_t seed) {
    const DMat3 frame = frame_about(direction_at(tree, host));
    std::vector<double> taken;
    for (NodeId child : tree.children(host)) {
        const DVec3 way = glm::transpose(frame) * (tree.node(child).position - tree.node(host).position);
        const double across = portable::hypot(way.x, way.z);
        if (across > 0.17 * glm::length(way)) taken.push_back(portable::atan2(way.x, way.z));
    }
    double azimuth = Random(hash_seed(seed, 77)).uniform(0.0, 2.0 * kPi);
    if (!taken.empty()) {
        std::sort(taken.begin(), taken.end());
        double widest = -1.0;
        for (size_t i = 0; i < taken.size(); i++) {
            const double next = i + 1 < taken.size() ? taken[i + 1] : taken[0] + 2.0 * kPi;
            if (next - taken[i] <= widest) continue;
            widest = next - taken[i];
            azimuth = taken[i] + 0.5 * widest;
        }
    }
    const DVec3 way(portable::sin(lean) * portable::sin(azimuth), portable::cos(lean),
                    portable::sin(lean) * portable::cos(azimuth));
    return glm::normalize(frame * way);
}

// What is the same for all tries at one host.
struct Joint {
    const Tree& tree;
    NodeId host;
    const Tree& scion;
    const GraftOptions& options;
    bool tip;
    double ratio;
    double scale;
    DVec3 own;  // the scion's direction, in its frame
    GraftAim aim;
    double lean;  // radians
};

Joint plan_joint(const Tree& tree, NodeId host, const Tree& scion, const GraftOptions& options) {
    const Node& node = tree.node(host);
    const bool tip = node.child_count == 0;
    Joint joint{tree,        host,
                scion,       options,
                tip,         options.joint_ratio,
                1.0,         scion_direction(scion),
                options.aim, options.lean * kDegree};
    if (joint.ratio == 0.0) joint.ratio = tip ? 1.0 : kSideRatio;
    if (joint.aim == GraftAim::kAuto) {
        const bool leans = joint.own.y < portable::cos(kLeastBranching * kDegree);
        joint.aim = tip ? GraftAim::kOnward : leans ? GraftAim::kOwn : GraftAim::kLean;
        joint.lean = kUsualLean * kDegree;
    }
    const double root = scion.node(scion.root()).radius;
    const double most = joint.ratio * node.radius;
    GraftScale scale = options.scale;
    if (scale == GraftScale::kAuto) scale = tip ? GraftScale::kRadius : GraftScale::kFit;
    switch (scale) {
        case GraftScale::kAuto:
        case GraftScale::kRadius:
            joint.scale = most / root;
            break;
        case GraftScale::kFit:
            joint.scale = std::min(1.0, most / root);
            break;
        case GraftScale::kLength: {
            const double length = scion_length(scion);
            if (!(length > 0.0))
                throw Error("The branch to graft has no length, so that it cannot be scaled to one.");
            joint.scale = options.length / length;
            break;
        }
        case GraftScale::kFactor:
            joint.scale = options.factor;
            break;
    }
    if (!(joint.scale > 0.0) || !std::isfinite(joint.scale))
        throw Error("The branch to graft cannot be scaled to its host: its radius or length is too extreme.");
    return joint;
}

DMat3 aim_scion(const Joint& joint, uint64_t seed) {
    const DVec3 ahead(0.0, 1.0, 0.0);
    DMat3 mirror(1.0);
    if (joint.options.mirror) mirror[0][0] = -1.0;
    const DMat3 roll = turn_about(ahead, joint.options.roll * kDegree);
    const DVec3 forward = direction_at(joint.tree, joint.host);
    if (joint.aim == GraftAim::kOwn) return frame_about(forward) * roll * mirror;
    DVec3 to = forward;
    if (joint.aim == GraftAim::kDirection) to = glm::normalize(joint.options.direction);
    if (joint.aim == GraftAim::kLean) to = into_gap(joint.tree, joint.host, joint.lean, seed);
    return frame_about(to) * roll * mirror * turn_between(joint.own, ahead);
}

struct Attempt {
    Tree wood;  // its root on the joint, in the axes of the tree
    uint64_t seed = 0;
    double spin = 0.0;
    std::vector<Collision> collisions;
    double depth = 0.0;

    bool better_than(const Attempt& other) const {
        if (collisions.size() != other.collisions.size()) return collisions.size() < other.collisions.size();
        return depth < other.depth;
    }
};

// most: collisions beyond which the try is not wanted.
Attempt attempt(const Joint& joint, const StandingWood& standing, uint64_t seed, int number, size_t most,
                const Progress* progress) {
    Attempt made;
    made.seed = number == 0 ? seed : hash_seed(seed, static_cast<uint64_t>(number));
    if (number > 0) made.spin = Random(made.seed, 1).uniform(0.0, 360.0);
    made.wood = vary_scion(joint.scion, joint.options.variation, made.seed);
    // The gap is the first seed's at every try, so that only the scion changes.
    const DMat3 axes = aim_scion(joint, seed) * turn_about(joint.own, made.spin * kDegree);
    const DVec3 base = joint.scion.node(joint.scion.root()).position;
    for (NodeId id : made.wood.depth_first()) {
        const Node& node = made.wood.node(id);
        const double radius = node.radius * joint.scale;
        made.wood.set_position(id, axes * (joint.scale * (node.position - base)));
        made.wood.set_radius(id, std::max(radius, std::min(node.radius, kLeastRadius)));
    }
    turn_sections(made.wood, made.wood.depth_first(), axes);
    const Node& host = joint.tree.node(joint.host);
    if (joint.options.thinning > 0.0)
        smooth_by_depth(made.wood, host.radius, joint.options.thinning);
    else if (joint.options.smooth)
        smooth_joint(made.wood, host.radius, joint.ratio, joint.tip);
    Tree there = made.wood;
    for (NodeId id : there.depth_first())
        there.set_position(id, there.node(id).position + host.position);
    CollisionOptions collision;
    collision.clearance = joint.options.clearance;
    collision.joint = host.position;
    collision.most = most;
    const double own = std::min(there.node(there.root()).radius, host.radius);
    const DVec3 away = normalized_or(axes * joint.own, DVec3(0.0, 1.0, 0.0));
    collision.joint_reach = joint_reach(joint.tree, joint.host, kNoNode, own, away, joint.options.clearance);
    made.collisions = find_collisions(standing, there, collision, progress);
    for (const Collision& one : made.collisions)
        made.depth += one.depth;
    return made;
}

void require_host(const Tree& tree, NodeId host) {
    if (!tree.contains(host))
        throw Error("There is no node " + std::to_string(host) + " in this tree to graft onto.");
}

std::string too_many(size_t nodes, const GraftOptions& options, bool several) {
    return std::string(several ? "These grafts" : "This graft") + " would add " + std::to_string(nodes) +
           " nodes, more than the " + std::to_string(options.most_nodes) + " that are allowed: graft " +
           (several ? "onto fewer nodes, graft smaller branches" : "a smaller branch") + ", or allow more.";
}

Joint plan_graft(const Tree& tree, NodeId host, const Tree& scion, const GraftOptions& options) {
    require_host(tree, host);
    require_scion(scion);
    require_options(options);
    // Before the work, which grows with the branch.
    require_room(tree, scion.size() - 1);
    return plan_joint(tree, host, scion, options);
}

// Whatever the seed, the scion stays within this.
Bounds reach_of(const Joint& joint) {
    double thickest = 0.0;
    for (const NodeId id : joint.scion.depth_first())
        thickest = std::max(thickest, joint.scion.node(id).radius);
    const double longest = scion_length(joint.scion) * (1.0 + joint.options.variation.length);
    const Node& host = joint.tree.node(joint.host);
    Bounds box;
    box.add(host.position,
            1.001 * joint.scale * (longest + thickest) + host.radius + joint.options.clearance);
    return box;
}

GraftResult graft_beside(Tree& tree, StandingWood& standing, const Joint& joint, const Progress* progress) {
    const NodeId host = joint.host;
    const GraftOptions& options = joint.options;
    Attempt best;
    int tries = 0;
    while (tries < options.tries && (tries == 0 || !best.collisions.empty())) {
        if (progress) progress->check();
        const size_t most = tries == 0 ? std::numeric_limits<size_t>::max() : best.collisions.size();
        Attempt made = attempt(joint, standing, options.seed, tries, most, progress);
        if (tries++ == 0 || made.better_than(best)) best = std::move(made);
    }
    GraftResult result;
    result.host = host;
    result.scale = joint.scale;
    result.seed = best.seed;
    result.spin = best.spin;
    result.tries = tries;
    result.added = place_scion(tree, host, best.wood, {});
    // Ids of the wood become ids of the tree.
    std::vector<NodeId> moved(static_cast<size_t>(best.wood.id_end()), kNoNode);
    const std::vector<NodeId> order = best.wood.depth_first();
    for (size_t i = 1; i < order.size(); i++)
        moved[order[i]] = result.added[i - 1];
    standing.add(tree, result.added);
    result.collisions = std::move(best.collisions);
    for (Collision& one : result.collisions)
        one.grafted = moved[one.grafted];
    return result;
}

}  // namespace

void smooth_joint(Tree& wood, double host_radius, double ratio, bool blend) {
    if (wood.empty()) return;
    const NodeId root = wood.root();
    const double most = ratio * host_radius;
    const double own = wood.node(root).radius;
    if (own > most) {
        for (NodeId id : wood.depth_first())
            wood.set_radius(id, std::max(wood.node(id).radius * (most / own), 1e-300));
    } else if (blend && own < most) {
        // Over several radii, so that no funnel shows, but not over most of a short twig.
        const double until = std::min(8.0 * host_radius, 0.5 * scion_length(wood));
        const std::vector<double> lengths = subtree_lengths(wood);
        double along = 0.0;
        for (NodeId at = root; at != kNoNode && along <= until;) {
            const double share = until > 0.0 ? glm::smoothstep(0.0, until, along) : 0.0;
            const double radius = wood.node(at).radius;
            wood.set_radius(at, radius * (1.0 + (most / own - 1.0) * (1.0 - share)));
            const NodeId next = main_child(wood, at, lengths);
            if (next != kNoNode) along += glm::distance(wood.node(next).position, wood.node(at).position);
            at = next;
        }
    }
    for (NodeId id : wood.depth_first()) {
        const NodeId parent = wood.node(id).parent;
        const double limit = parent == kNoNode ? host_radius : wood.node(parent).radius;
        if (wood.node(id).radius > limit) wood.set_radius(id, limit);
    }
}

void smooth_by_depth(Tree& wood, double host_radius, double ratio) {
    if (wood.empty()) return;
    const int first = wood.node(wood.root()).depth;
    for (const NodeId id : wood.depth_first()) {
        const double share = portable::pow(ratio, wood.node(id).depth - first);
        wood.set_radius(id, std::max(host_radius * share, std::min(host_radius, kLeastRadius)));
    }
}

GraftResult graft(Tree& tree, NodeId host, const Tree& scion, const GraftOptions& options,
                  const Progress* progress) {
    const Joint joint = plan_graft(tree, host, scion, options);
    if (scion.size() - 1 > options.most_nodes) throw Error(too_many(scion.size() - 1, options, false));
    StandingWood standing(tree, reach_of(joint));
    return graft_beside(tree, standing, joint, progress);
}

std::vector<GraftResult> graft_many(Tree& tree, std::span<const NodeId> hosts, std::span<const Tree> scions,
                                    const GraftOptions& options, const Progress* progress) {
    for (NodeId host : hosts)
        require_host(tree, host);
    if (scions.empty()) throw Error("There is no branch to graft.");
    for (const Tree& scion : scions)
        require_scion(scion);
    std::vector<uint64_t> seeds;
    std::vector<const Tree*> chosen;
    size_t nodes = 0;
    for (size_t i = 0; i < hosts.size(); i++) {
        seeds.push_back(hash_seed(options.seed, i));
        const uint32_t which = Random(seeds[i], 2).below(static_cast<uint32_t>(scions.size()));
        chosen.push_back(&scions[which]);
        nodes += scions[which].size() - 1;
    }
    if (nodes > options.most_nodes) throw Error(too_many(nodes, options, true));
    require_room(tree, nodes);
    const Tree before = tree;
    StandingWood standing(tree);
    std::vector<GraftResult> results;
    try {
        GraftOptions own = options;
        for (size_t i = 0; i < hosts.size(); i++) {
            own.seed = seeds[i];
            const Joint joint = plan_graft(tree, hosts[i], *chosen[i], own);
            results.push_back(graft_beside(tree, standing, joint, progress));
        }
    } catch (...) {
        tree = before;
        throw;
    }
    return results;
}

}  // namespace treerec
