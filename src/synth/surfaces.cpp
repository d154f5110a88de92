#include "synth/surfaces.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"
#include "geometry/random.h"

namespace treerec {

namespace {

constexpr double kGoldenAngle = 2.399963229728653;  // radians

void add_disc(const DVec3& centre, const DVec3& normal, double radius, NodeId node,
              std::vector<Surface>& surfaces) {
    surfaces.push_back({centre, normal, radius, radius, node, Shape::kDisc, true});
}

// Strips of discs to both sides of a piece of rachis, drooping outwards.
void add_leaflets(const DVec3& at, const DVec3& along, double reach, NodeId node, Random& random,
                  std::vector<Surface>& surfaces) {
    constexpr double kHalfWidth = 0.018;
    const DVec3 aside = normalized_or(glm::cross(along, DVec3(0.0, 1.0, 0.0)), any_perpendicular(along));
    for (double sign : {-1.0, 1.0}) {
        DVec3 direction = glm::normalize(sign * aside + 0.5 * along + 0.15 * random.direction());
        DVec3 p = at;
        for (double way = 0.0; way < reach; way += 1.6 * kHalfWidth) {
            direction = glm::normalize(direction - DVec3(0.0, 0.05, 0.0));
            p += 1.6 * kHalfWidth * direction;
            const DVec3 normal = normalized_or(glm::cross(direction, along), DVec3(0.0, 1.0, 0.0));
            add_disc(p, normal, kHalfWidth, node, surfaces);
        }
    }
}

}  // namespace

std::vector<Surface> wood_surfaces(const Tree& tree) {
    std::vector<Surface> surfaces;
    surfaces.reserve(tree.size());
    for (NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode) continue;
        const Node& parent = tree.node(node.parent);
        if (glm::distance(parent.position, node.position) < 1e-9) continue;
        // A side branch starts as thick as it is, not as thick as the wood it grows from.
        const double start = std::min(parent.radius, 1.15 * node.radius);
        surfaces.push_back({parent.position, node.position, start, node.radius, id});
    }
    return surfaces;
}

void add_leaves(const Tree& tree, double share, uint64_t seed, std::vector<Surface>& surfaces) {
    if (share <= 0.0) return;
    constexpr double kThinWood = 0.008;
    constexpr double kFullSpacing = 0.015;
    const double spacing = kFullSpacing / share;
    Random random(seed, 21);
    double until_next = spacing * random.uniform();
    for (NodeId id : tree.depth_first()) {
        const Node& node = tree.node(id);
        if (node.parent == kNoNode || node.radius > kThinWood) continue;
        const DVec3 from = tree.node(node.parent).position;
        const double length = glm::distance(from, node.position);
        for (; until_next < length; until_next += spacing * random.uniform(0.6, 1.4)) {
            const DVec3 out = random.direction();
            const DVec3 normal = glm::normalize(DVec3(0.0, 0.9, 0.0) + 0.8 * random.direction());
            const double radius = random.uniform(0.025, 0.05);
            add_disc(glm::mix(from, node.position, until_next / length) + 0.06 * out, normal, radius, id,
                     surfaces);
        }
        until_next -= length;
    }
}

void add_fronds(const Tree& tree, int count, uint64_t seed, std::vector<Surface>& surfaces) {
    NodeId top = tree.root();
    for (NodeId id : tree.depth_first())
        if (tree.node(id).position.y > tree.node(top).position.y) top = id;
    const DVec3 base = tree.node(top).position;
    constexpr int kPieces = 28;
    for (int i = 0; i < count; i++) {
        Random random(hash_seed(seed, static_cast<uint64_t>(i)), 23);
        // The youngest stands upright, the oldest hangs.
        const double age = (i + 0.5) / count;
        const double elevation = 1.35 - 1.9 * age + random.uniform(-0.1, 0.1);
        const double azimuth = kGoldenAngle * i + random.uniform(-0.15, 0.15);
        const double piece = random.uniform(1.8, 2.6) / kPieces;
        DVec3 heading(portable::cos(elevation) * portable::cos(azimuth), portable::sin(elevation),
                      portable::cos(elevation) * portable::sin(azimuth));
        DVec3 p = base;
        for (int k = 0; k < kPieces; k++) {
            const double along = static_cast<double>(k) / kPieces;
            heading = glm::normalize(heading - DVec3(0.0, 0.5 * piece + 0.9 * piece * along, 0.0));
            const DVec3 next = p + piece * heading;
            const double radius = 0.022 * (1.0 - 0.85 * along);
            surfaces.push_back({p, next, radius, 0.97 * radius, top, Shape::kCone, true});
            if (along > 0.15)
                add_leaflets(next, heading, 0.5 * portable::sin(kPi * std::min(1.0, along + 0.1)), top,
                             random, surfaces);
            p = next;
        }
    }
}

void add_buttresses(const Tree& tree, int count, uint64_t seed, std::vector<Surface>& surfaces) {
    const Node& root = tree.node(tree.root());
    constexpr int kRays = 24;  // thin cones that make up one plank
    Random random(seed, 24);
    const double turn = random.uniform(0.0, 2.0 * kPi);
    for (int i = 0; i < count; i++) {
        const double azimuth = turn + 2.0 * kPi * (i + random.uniform(-0.2, 0.2)) / count;
        const double height = random.uniform(0.8, 1.2);
        const double reach = root.radius * random.uniform(2.2, 3.2);
        const DVec3 outwards(portable::cos(azimuth), 0.0, portable::sin(azimuth));
        for (int k = 1; k <= kRays; k++) {
            const double share = static_cast<double>(k) / kRays;
            const DVec3 up = root.position + share * height * DVec3(0.0, 1.0, 0.0);
            const DVec3 middle = root.position + share * reach * outwards;
            surfaces.push_back({up, middle, 0.03, 0.03, tree.root()});
        }
    }
}

}  // namespace treerec
