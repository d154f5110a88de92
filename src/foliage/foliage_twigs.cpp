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
#include "foliage/own_twigs.h"

namespace treerec {

namespace {

constexpr double kReach = 1.2;            // metres between a leaf and its branch, on a tree of full height
constexpr double kFullHeight = 6.0;       // metres; smaller trees have shorter twigs
constexpr double kLeastReachCells = 4.0;  // or that many cells, if that is more
constexpr double kSpacingCells = 3.0;     // between the ends of twigs
constexpr double kNear = 0.5;             // of the spacing: foliage that near to wood needs no twig
constexpr double kStep = 2.2;             // of the spacing: from one end to the next
constexpr double kSlant = 0.8;            // of a twig's length: how much farther down its host it starts
constexpr double kWinding = 0.7;          // what the way so far counts beside a twig's own length
constexpr double kStouter = 3.0;          // times the radius of the nearest wood
constexpr double kSlender = 0.03;         // metres: thicker wood is a host against its will, see NearWood
constexpr int kNeighbours = 3;            // coarse cells to each side that a twig may go on to

using Place = std::array<int, 3>;

// A part of the foliage that wants a twig.
struct End {
    DVec3 position{0.0};
    double points = 0.0;
    double distance = 0.0;  // to the wood it would grow from
    double along = 0.0;     // that wood's own way from the tree's
    NodeId host = kNoNode;
    double cost = 1e300;
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

// A twig grows the sooner the shorter it is, and by a short way rather than by a winding one.
double cost_of(double distance, double along) {
    return distance + kWinding * along;
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

// Twigs leave their host at a slant: from the first node on the way down that looks towards `end`, unless it
// is far or on thick wood.
NodeId slanted(const Tree& tree, NodeId host, const DVec3& end, double length, double agreement) {
    double down = 0.0;
    for (NodeId at = host; tree.node(at).parent != kNoNode; at = tree.node(at).parent) {
        const Node& node = tree.node(at);
        const Node& below = tree.node(node.parent);
        const DVec3 ahead = normalized_or(node.position - below.position, DVec3(0.0));
        if (glm::dot(ahead, normalized_or(end - node.position, DVec3(0.0))) > agreement) return at;
        down += glm::distance(node.position, below.position);
        if (down > kSlant * length || below.radius > kStouter * tree.node(host).radius) break;
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
    if (!follows(rules, foliage) || tree.size() < 2) return grown;
    const Crown crown = measure_crown(tree);
    const double scale = std::min(1.0, std::sqrt(crown.height / kFullHeight));
    const double spacing = foliage_twig_spacing(foliage);
    const BranchList list = list_branches(tree);
    const NearWood wood(tree, list, foliage_reach(foliage, crown.height), kSlender * scale,
                        2e-5 * crown.coordinate);
    const OwnTwigs own = measure_twigs(tree, kSlender * scale, scale);
    std::map<Place, End> ends = gather_ends(foliage, spacing);

    // The cheapest first, from what is cheapest for it then (between Prim's tree and Dijkstra's); of two as
    // cheap, the first place.
    struct Growth {
        double cost;
        Place place;
        bool operator<(const Growth& other) const {
            return cost != other.cost ? cost > other.cost : place > other.place;
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
        end.cost = cost_of(end.distance, 0.0);
        next.push({end.cost, place});
    }
    while (!next.empty()) {
        const Growth growth = next.top();
        next.pop();
        End& end = ends.at(growth.place);
        if (end.reached || growth.cost != end.cost) continue;
        end.reached = true;
        NodeId tip = end.host;
        if (end.distance > kNear * spacing) {
            const NodeId from = slanted(grown, end.host, end.position, end.distance, own.agreement);
            const double below = grown.node(from).radius;
            const double radius =
                std::min(below, std::clamp(own.thinning * below, own.thinnest, own.thickest));
            tip = grown.add_child(from, end.position, radius, kGuessFlag);
        }
        const double along = tip == end.host ? end.along : end.along + end.distance;
        const auto [x, y, z] = growth.place;
        for (int i = x - kNeighbours; i <= x + kNeighbours; i++)
            for (int j = y - kNeighbours; j <= y + kNeighbours; j++)
                for (auto found = ends.lower_bound({i, j, z - kNeighbours});
                     found != ends.end() && found->first <= Place{i, j, z + kNeighbours}; ++found) {
                    End& other = found->second;
                    if (other.reached) continue;
                    const double distance = glm::distance(other.position, grown.node(tip).position);
                    const double cost = cost_of(distance, along);
                    if (cost >= other.cost || distance > kStep * spacing) continue;
                    other.distance = distance;
                    other.along = along;
                    other.host = tip;
                    other.cost = cost;
                    next.push({cost, found->first});
                }
    }
    return grown;
}

Tree leafy_tree(const Tree& tree, const std::vector<LeafKind>& kinds, const Foliage& foliage) {
    const auto leading = std::find_if(kinds.begin(), kinds.end(),
                                      [&](const LeafKind& kind) { return follows(kind.rules, foliage); });
    if (leading == kinds.end()) return tree;
    Tree grown = leafy_tree(tree, leading->rules, foliage);
    // A twig has the rule of the wood that it grew from.
    for (NodeId id = tree.id_end(); id < grown.id_end(); id++)
        if (grown.contains(id) && !follows(kinds.at(grown.node(id).leaf_rule).rules, foliage))
            grown.remove_subtree(id);
    return grown;
}

bool follows(const LeafRules& rules, const Foliage& foliage) {
    return rules.enabled && rules.follow_density > 0.0 && !foliage.empty();
}

}  // namespace treerec
