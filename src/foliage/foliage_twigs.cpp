#include "foliage/foliage_twigs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <queue>
#include <vector>

#include "foliage/crown.h"
#include "foliage/near_wood.h"

namespace treerec {

namespace {

constexpr double kReach = 1.2;            // metres between a leaf and its branch, on a tree of full height
constexpr double kFullHeight = 6.0;       // metres; smaller trees have shorter twigs
constexpr double kLeastReachCells = 4.0;  // or that many cells, if that is more
constexpr double kSpacingCells = 3.0;     // between the ends of twigs
constexpr double kNear = 0.5;             // of the spacing: foliage that near to wood needs no twig
constexpr double kStep = 2.2;             // of the spacing: from one end to the next
constexpr double kSlant = 0.6;            // of a twig's length: how much farther down its host it starts
constexpr double kThinnest = 0.0015, kThickest = 0.006;  // metres, on a tree of full height
constexpr double kThinning = 0.8;                        // of the host's radius
constexpr double kSlender = 0.03;  // metres: thicker wood is a host against its will, see NearWood
constexpr int kNeighbours = 3;     // coarse cells to each side that a twig may go on to

using Place = std::array<int, 3>;

// A part of the foliage that wants a twig.
struct End {
    DVec3 position{0.0};
    double points = 0.0;
    double distance = 1e300;  // to the wood it would grow from
    NodeId host = kNoNode;
    bool reached = false;
};

std::map<Place, End> gather_ends(const Foliage& foliage, double spacing) {
    std::map<Place, End> ends;
    for (const FoliageCell& cell : foliage.cells) {
        const DVec3 p = foliage.centre(cell);
        const DVec3 at = glm::floor((p - foliage.origin) / spacing);
        End& end = ends[{static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)}];
        end.position += p * static_cast<double>(cell.points);
        end.points += cell.points;
    }
    for (auto& [place, end] : ends)
        end.position /= end.points;
    return ends;
}

// The branch's node that lies nearest to p.
NodeId nearest_node(const Tree& tree, const BranchList& list, uint32_t branch, const DVec3& p) {
    NodeId best = kNoNode;
    double distance = 1e300;
    for (const NodeId id : list.nodes_of(list.branches[branch])) {
        const double own = glm::distance(tree.node(id).position, p);
        if (own >= distance) continue;
        distance = own;
        best = id;
    }
    return best;
}

// Twigs leave their host at a slant: from farther down, as long as that is no turn back.
NodeId slanted(const Tree& tree, NodeId host, double length) {
    double down = 0.0;
    const NodeId first = host;
    while (tree.node(host).parent != kNoNode) {
        const Node& node = tree.node(host);
        const Node& below = tree.node(node.parent);
        down += glm::distance(node.position, below.position);
        if (down > kSlant * length || below.radius > 3.0 * tree.node(first).radius) break;
        host = node.parent;
    }
    return host;
}

}  // namespace

double foliage_reach(const Foliage& foliage, double height) {
    const double scale = std::min(1.0, std::sqrt(height / kFullHeight));
    return std::max({kReach * scale, kLeastReachCells * foliage.edge, foliage.reach});
}

double foliage_twig_spacing(const Foliage& foliage) {
    return kSpacingCells * foliage.edge;
}

Tree leafy_tree(const Tree& tree, const LeafRules& rules, const Foliage& foliage) {
    Tree grown = tree;
    if (!rules.enabled || !(rules.follow_density > 0.0) || foliage.empty() || tree.size() < 2) return grown;
    const Crown crown = measure_crown(tree);
    const double scale = std::min(1.0, std::sqrt(crown.height / kFullHeight));
    const double spacing = foliage_twig_spacing(foliage);
    const BranchList list = list_branches(tree);
    const NearWood wood(tree, list, foliage_reach(foliage, crown.height), kSlender * scale,
                        2e-5 * crown.coordinate);
    std::map<Place, End> ends = gather_ends(foliage, spacing);

    // The nearest first, each from what is nearest to it then (Prim 1957); of two as near, the first place.
    struct Growth {
        double distance;
        Place place;
        bool operator<(const Growth& other) const {
            return distance != other.distance ? distance > other.distance : place > other.place;
        }
    };
    std::priority_queue<Growth> next;
    for (auto& [place, end] : ends) {
        const WoodSample* host = wood.nearest(end.position);
        if (!host) {
            end.reached = true;  // Too far: leaves there would belong to another tree.
            continue;
        }
        end.distance = glm::distance(host->at.position, end.position);
        end.host = nearest_node(tree, list, host->branch, host->at.position);
        next.push({end.distance, place});
    }
    while (!next.empty()) {
        const Growth growth = next.top();
        next.pop();
        End& end = ends.at(growth.place);
        if (end.reached || growth.distance != end.distance) continue;
        end.reached = true;
        NodeId tip = end.host;
        if (end.distance > kNear * spacing) {
            const NodeId from = slanted(grown, end.host, end.distance);
            const double radius =
                std::clamp(kThinning * grown.node(from).radius, kThinnest * scale, kThickest * scale);
            tip = grown.add_child(from, end.position, radius, kGuessFlag);
        }
        const auto [x, y, z] = growth.place;
        for (int i = x - kNeighbours; i <= x + kNeighbours; i++)
            for (int j = y - kNeighbours; j <= y + kNeighbours; j++)
                for (int k = z - kNeighbours; k <= z + kNeighbours; k++) {
                    const auto found = ends.find({i, j, k});
                    if (found == ends.end() || found->second.reached) continue;
                    End& other = found->second;
                    const double distance = glm::distance(other.position, grown.node(tip).position);
                    if (distance >= other.distance || distance > kStep * spacing) continue;
                    other.distance = distance;
                    other.host = tip;
                    next.push({distance, found->first});
                }
    }
    return grown;
}

}  // namespace treerec
