// Random trees for tests: plausible ones, and ones that break code.
#pragma once

#include <algorithm>
#include <vector>

#include "geometry/random.h"
#include "tree/tree.h"
#include "tree/trunk.h"

namespace treerec::test {

// A tree of about `nodes` nodes and `height` metres, grown from the ground up, with radii by the pipe model
// (Shinozaki et al. 1964): a node's cross-section is the sum of those above it. Marked trunk.
inline Tree random_tree(uint64_t seed, int nodes, double height = 12.0) {
    struct Bud {
        int node;
        DVec3 direction;
        double length;  // of its next segment
        int order;
    };
    Random random(seed);
    std::vector<DVec3> positions{DVec3(0.0)};
    std::vector<NodeId> parents{kNoNode};
    // Buds open generation by generation; about so many fit into that many nodes.
    const double step = height / (2.0 + 2.6 * std::log(static_cast<double>(std::max(nodes, 2))));
    std::vector<Bud> buds{{0, DVec3(0.0, 1.0, 0.0), step, 0}};
    size_t next = 0;
    while (static_cast<int>(positions.size()) < nodes && next < buds.size()) {
        const Bud bud = buds[next++];
        const DVec3 up(0.0, 1.0, 0.0);
        const double lift = bud.order == 0 ? 0.3 : 0.06;
        const DVec3 direction =
            glm::normalize(bud.direction + lift * up + (bud.order == 0 ? 0.15 : 0.3) * random.direction());
        positions.push_back(positions[bud.node] + direction * bud.length * random.uniform(0.7, 1.3));
        parents.push_back(bud.node);
        const int node = static_cast<int>(positions.size()) - 1;
        if (positions[node].y > height || positions[node].y < 0.05 * height) {
            if (bud.order > 0) continue;
        }
        const bool on = bud.length > 0.02 * step;
        if (on) buds.push_back({node, direction, bud.length * (bud.order == 0 ? 0.985 : 0.93), bud.order});
        const bool bare = bud.order == 0 && positions[node].y < 0.25 * height;
        const int sides = bare             ? 0
                          : bud.order == 0 ? 1 + static_cast<int>(random.below(2))
                                           : static_cast<int>(random.below(10) < 4);
        for (int i = 0; i < sides && on; i++) {
            const DVec3 across = random.direction();
            const DVec3 out = normalized_or(across - direction * glm::dot(across, direction), up);
            buds.push_back({node, glm::normalize(direction * 0.6 + out), bud.length * 0.75, bud.order + 1});
        }
    }
    std::vector<double> area(positions.size(), 0.0), radii(positions.size());
    const double twig = 0.0035 * height / 12.0;
    for (size_t i = positions.size(); i-- > 0;) {
        area[i] = std::max(area[i], twig * twig);
        radii[i] = std::sqrt(area[i]);
        if (parents[i] >= 0) area[parents[i]] += area[i];
    }
    Tree tree = Tree::from_arrays(parents, positions, radii, std::vector<uint8_t>(positions.size(), 0));
    mark_trunk(tree);
    return tree;
}

// Any shape at all: coincident nodes, hairpins, radii that differ a thousandfold and grow outward.
inline Tree wild_tree(uint64_t seed, int nodes) {
    Random random(seed);
    Tree tree;
    std::vector<NodeId> ids{tree.add_root(random.direction(), std::pow(10.0, random.uniform(-3.0, 0.0)))};
    while (static_cast<int>(ids.size()) < nodes) {
        const NodeId parent =
            random.below(3) ? ids.back() : ids[random.below(static_cast<uint32_t>(ids.size()))];
        const double reach = random.below(5) ? std::pow(10.0, random.uniform(-3.0, 0.5)) : 0.0;
        ids.push_back(tree.add_child(parent, tree.node(parent).position + reach * random.direction(),
                                     std::pow(10.0, random.uniform(-3.0, 0.0))));
    }
    mark_trunk(tree);
    return tree;
}

}  // namespace treerec::test
