#include "skeleton/flood/flood_branches.h"

#include <algorithm>
#include <cmath>

namespace treerec {

namespace {

constexpr double kStrayGap = 5.0;     // gaps longer than so many times the wood behind them lead to strays
constexpr double kLeapVoxels = 4.0;   // shorter gaps are only sparse wood
constexpr double kStepVoxels = 2.0;   // between stations, at least,
constexpr double kStepRadii = 0.7;    // and of the radius
constexpr double kMostBetween = 3.0;  // stations between two nodes: refinement looks so far for a point's own

// The flooded nodes, seen from the tips.
struct Wood {
    std::vector<double> length;  // metres of wood behind each node, its own way left out
    std::vector<double> bulk;    // metres times radius, its own way counted
    std::vector<uint8_t> kept;
    std::vector<int32_t> heir;  // the child that continues the branch; -1 at a tip
};

Wood look_back(const std::vector<FloodNode>& nodes, double voxel) {
    Wood wood{std::vector<double>(nodes.size(), 0.0), std::vector<double>(nodes.size(), 0.0),
              std::vector<uint8_t>(nodes.size(), 1), std::vector<int32_t>(nodes.size(), -1)};
    std::vector<double> best(nodes.size(), -1.0);
    for (size_t n = nodes.size(); n-- > 1;) {
        const FloodNode& node = nodes[n];
        const double way = glm::distance(node.position, nodes[node.parent].position);
        const bool leap = node.bridged && way > kLeapVoxels * voxel;
        if (leap && way > kStrayGap * wood.length[n]) {
            wood.kept[n] = 0;
            continue;
        }
        wood.bulk[n] += node.bridged ? 0.0 : way * (node.radius + voxel);
        wood.length[node.parent] += wood.length[n] + (leap ? 0.0 : way);
        wood.bulk[node.parent] += wood.bulk[n];
        if (wood.bulk[n] >= best[node.parent]) {
            best[node.parent] = wood.bulk[n];
            wood.heir[node.parent] = static_cast<int32_t>(n);
        }
    }
    for (size_t n = 1; n < nodes.size(); n++)
        wood.kept[n] = wood.kept[n] & wood.kept[nodes[n].parent];
    return wood;
}

// The first neighbourhood starts on the rim of a slanting stem's end, and goes up one side of it. What the
// circles farther on say is the axis goes back straight to there.
void straighten_start(std::vector<FloodNode>& nodes, const std::vector<int32_t>& heir) {
    const int32_t first = heir[0];
    const int32_t second = first < 0 ? -1 : heir[first];
    const int32_t third = second < 0 ? -1 : heir[second];
    if (third < 0 || !nodes[second].measured || !nodes[third].measured) return;
    const DVec3 on = nodes[second].position;
    const DVec3 along = normalized_or(nodes[third].position - on, DVec3(0.0, 1.0, 0.0));
    const DVec3 place = on + glm::dot(nodes[first].position - on, along) * along;
    if (glm::distance(place, nodes[first].position) < nodes[second].radius) nodes[first].position = place;
}

Station station_of(const FloodNode& node) {
    Station station;
    station.position = node.position;
    station.radius = node.radius;
    station.scatter = node.scatter;
    station.measured = node.measured;
    station.bridged = node.bridged;
    return station;
}

}  // namespace

FloodBranches flood_branches(const FloodResult& flooded, const FloodGrid& grid, size_t point_count) {
    std::vector<FloodNode> nodes = flooded.nodes;
    const double voxel = grid.cells.layout.cell;
    const Wood wood = look_back(nodes, voxel);
    straighten_start(nodes, wood.heir);
    FloodBranches made;
    std::vector<int32_t> branch_of(nodes.size(), -1);
    std::vector<int32_t> station_at(nodes.size(), -1);    // of the node itself
    std::vector<int32_t> station_near(nodes.size(), -1);  // of the points on the way to it
    for (size_t first = 0; first < nodes.size(); first++) {
        if (wood.kept[first] == 0 || branch_of[first] >= 0) continue;
        const int32_t l = static_cast<int32_t>(made.branches.size());
        SkeletonBranch branch;
        std::vector<Station> line;
        if (first > 0) {
            branch.parent = branch_of[nodes[first].parent];
            branch.attach = station_at[nodes[first].parent];
        }
        for (int32_t n = static_cast<int32_t>(first); n >= 0; n = wood.heir[n]) {
            const Station next = station_of(nodes[n]);
            const int32_t before = static_cast<int32_t>(line.size());
            if (!line.empty() && !next.bridged) {
                const Station last = line.back();
                const double way = glm::distance(last.position, next.position);
                const double step = std::max(kStepVoxels * voxel, kStepRadii * next.radius);
                const int between = static_cast<int>(std::clamp(way / step - 0.5, 0.0, kMostBetween));
                for (int i = 1; i <= between; i++) {
                    Station middle = next;
                    middle.position += static_cast<double>(between + 1 - i) / (between + 1) *
                                       (last.position - next.position);
                    line.push_back(middle);
                }
            }
            line.push_back(next);
            branch_of[n] = l;
            station_at[n] = static_cast<int32_t>(line.size()) - 1;
            station_near[n] = (before + station_at[n]) / 2;
        }
        made.branches.push_back(std::move(branch));
        made.axes.push_back(std::move(line));
    }
    for (size_t l = 1; l < made.branches.size(); l++)
        move_attach(made.branches[l], made.axes[l], made.axes[made.branches[l].parent]);
    // The root has no way of its own: it is as thick as what grows from it.
    std::vector<Station>& stem = made.axes.front();
    if (stem.size() > 1) stem[0].radius = stem[1].radius;

    made.places.branch.assign(point_count, -1);
    made.places.station.assign(point_count, 0);
    for (size_t v = 0; v < grid.size(); v++) {
        const int32_t node = flooded.owner[v];
        if (node < 0 || branch_of[node] < 0) continue;
        for (const uint32_t p : grid.cells.in_cell(v)) {
            made.places.branch[p] = branch_of[node];
            made.places.station[p] = station_near[node];
        }
    }
    return made;
}

std::vector<int32_t> drop_branches(FloodBranches& made, const std::vector<uint8_t>& goes) {
    std::vector<int32_t> now(made.branches.size(), -1);
    size_t kept = 0;
    for (size_t l = 0; l < made.branches.size(); l++) {
        if (goes[l] != 0) continue;
        now[l] = static_cast<int32_t>(kept);
        if (made.branches[l].parent >= 0) made.branches[l].parent = now[made.branches[l].parent];
        if (kept != l) {
            made.branches[kept] = std::move(made.branches[l]);
            made.axes[kept] = std::move(made.axes[l]);
        }
        kept++;
    }
    made.branches.resize(kept);
    made.axes.resize(kept);
    return now;
}

void drop_short(FloodBranches& made, double least) {
    std::vector<uint32_t> bears(made.branches.size(), 0);
    for (const SkeletonBranch& branch : made.branches)
        if (branch.parent >= 0) bears[branch.parent]++;
    std::vector<uint8_t> goes(made.branches.size(), 0);
    for (size_t l = made.branches.size(); l-- > 1;) {
        if (bears[l] > 0) continue;
        const std::vector<Station>& line = made.axes[l];
        const Station& fork = made.axes[made.branches[l].parent][made.branches[l].attach];
        double length = glm::distance(fork.position, line[0].position) - fork.radius;
        for (size_t i = 0; i + 1 < line.size(); i++)
            length += glm::distance(line[i].position, line[i + 1].position);
        if (length >= least) continue;
        goes[l] = 1;
        bears[made.branches[l].parent]--;
    }
    drop_branches(made, goes);
}

}  // namespace treerec
