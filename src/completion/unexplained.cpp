#include "completion/unexplained.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "error.h"
#include "geometry/bounds.h"
#include "geometry/cell_grid.h"
#include "geometry/groups.h"
#include "geometry/parallel.h"
#include "geometry/point_tree.h"
#include "geometry/quantile.h"

namespace treerec {

namespace {

constexpr size_t kSpacingSamples = 2000;
constexpr int kSpacingNeighbours = 5;
constexpr double kSpacingFactor = 3.0;
constexpr double kLeastGap = 0.01;  // metres
constexpr double kMostGap = 0.3;
// Within so many tolerances, a point is the fringe of wood that is there.
constexpr double kFringe = 2.0;

bool before(const Vec3& a, const Vec3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

// How far apart points that belong together lie: a few times the median distance to the fifth neighbour.
double found_gap(const std::vector<Vec3>& points) {
    if (points.size() <= static_cast<size_t>(kSpacingNeighbours)) return kMostGap;
    const PointTree tree(points);
    const size_t step = std::max<size_t>(1, points.size() / kSpacingSamples);
    std::vector<double> distances;
    for (size_t i = 0; i < points.size(); i += step) {
        std::array<uint32_t, kSpacingNeighbours + 1> found{};
        std::array<float, kSpacingNeighbours + 1> squares{};
        tree.nearest(points[i], found.size(), found.data(), squares.data());
        distances.push_back(std::sqrt(static_cast<double>(squares.back())));
    }
    return std::clamp(kSpacingFactor * quantile(distances, 0.5), kLeastGap, kMostGap);
}

// Points in touching cells of half the gap's diagonal are joined where one of a pair is within the gap.
std::vector<uint32_t> components(const std::vector<Vec3>& points, double gap, const Progress* progress) {
    Bounds box;
    for (const Vec3& p : points)
        box.add(DVec3(p));
    // Cells so small that all points of one belong together.
    const double cell = std::max(gap / std::sqrt(3.0), box.diagonal() / CellLayout::kMostCells * 2.0);
    const CellGrid grid(points, {box.min, cell}, progress);
    Groups groups(points.size());
    for (size_t c = 0; c < grid.size(); c++)
        for (uint32_t i : grid.in_cell(c))
            groups.join(grid.in_cell(c)[0], i);
    const double square = gap * gap;
    const auto near = [&](size_t a, size_t b) {
        for (uint32_t i : grid.in_cell(a))
            for (uint32_t k : grid.in_cell(b)) {
                const DVec3 d = DVec3(points[i]) - DVec3(points[k]);
                if (glm::dot(d, d) <= square) return true;
            }
        return false;
    };
    // A gap reaches two cells far.
    for (size_t c = 0; c < grid.size(); c++) {
        if (progress && c % 1024 == 0) progress->check();
        for (int dy = 0; dy <= 2; dy++)
            for (int dx = dy == 0 ? 0 : -2; dx <= 2; dx++) {
                const uint64_t middle = grid.keys[c] + (static_cast<uint64_t>(dy) << 42) +
                                        (static_cast<uint64_t>(static_cast<int64_t>(dx)) << 21);
                const auto [first, last] = grid.cells_between(middle - 2, middle + 2);
                for (size_t other = first; other < last; other++) {
                    if (other <= c) continue;
                    const uint32_t a = grid.in_cell(c)[0], b = grid.in_cell(other)[0];
                    if (groups.find(a) != groups.find(b) && near(c, other)) groups.join(a, b);
                }
            }
    }
    return groups.names();
}

// Where a branch through the points would begin, and which way it would go.
void suggest_joint(const Tree& tree, const std::vector<NodeId>& ids, const PointTree& nodes,
                   const std::vector<Vec3>& points, UnexplainedCluster& cluster) {
    // The node that the cluster comes nearest to, of equals the one with the smaller id.
    double least = std::numeric_limits<double>::max();
    for (uint32_t i : cluster.points) {
        uint32_t found = 0;
        float square = 0.0F;
        nodes.nearest(points[i], 1, &found, &square);
        const double distance = glm::distance(DVec3(points[i]), tree.node(ids[found]).position);
        if (distance > least || (distance == least && ids[found] >= cluster.joint)) continue;
        least = distance;
        cluster.joint = ids[found];
    }
    cluster.gap = least;
    // The nearer half of the points says where the branch sets out; all of a bent one would mislead.
    const DVec3 from = tree.node(cluster.joint).position;
    std::vector<std::pair<double, uint32_t>> by_distance;
    for (uint32_t i : cluster.points)
        by_distance.emplace_back(glm::distance(DVec3(points[i]), from), i);
    std::sort(by_distance.begin(), by_distance.end(), [&](const auto& a, const auto& b) {
        return a.first != b.first ? a.first < b.first : before(points[a.second], points[b.second]);
    });
    by_distance.resize((by_distance.size() + 1) / 2);
    DVec3 mean(0.0);
    for (const auto& [distance, i] : by_distance)
        mean += DVec3(points[i]) / static_cast<double>(by_distance.size());
    cluster.direction = normalized_or(mean - from, DVec3(0.0, 1.0, 0.0));
}

}  // namespace

std::vector<UnexplainedCluster> find_unexplained(const Tree& tree, const PointCloud& cloud,
                                                 const Fidelity& fidelity, const std::vector<uint8_t>& wood,
                                                 const UnexplainedOptions& options,
                                                 const Progress* progress) {
    if (fidelity.point_error.size() != cloud.size())
        throw Error("The fidelity was measured with another cloud.");
    if (!wood.empty() && wood.size() != cloud.size())
        throw Error("There must be one mark for wood per point of the cloud.");
    if (!(options.gap >= 0.0 && options.gap <= 100.0))
        throw Error("The gap between clusters is 0 to 100 metres.");
    std::vector<uint32_t> chosen;
    for (uint32_t i = 0; i < cloud.size(); i++)
        // What lies deep inside the wood is no branch that is missing.
        if ((wood.empty() || wood[i] != 0) && fidelity.point_error[i] > kFringe * fidelity.tolerance)
            chosen.push_back(i);
    if (chosen.empty()) return {};

    // In an order of their own, so that sums do not depend on the cloud's.
    const bool as_it_is = cloud.frame == tree.frame();
    const auto place = [&](uint32_t i) {
        const DVec3 p(cloud.positions[i]);
        return as_it_is ? cloud.positions[i] : Vec3(tree.frame().to_tree(cloud.frame.to_scan(p)));
    };
    std::vector<std::pair<Vec3, uint32_t>> sorted;
    for (uint32_t i : chosen)
        sorted.emplace_back(place(i), i);
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
        return before(a.first, b.first) || (a.first == b.first && a.second < b.second);
    });
    std::vector<Vec3> points;
    for (const auto& [p, i] : sorted)
        points.push_back(p);
    if (progress) progress->check();
    const std::vector<uint32_t> label =
        components(points, options.gap > 0.0 ? options.gap : found_gap(points), progress);

    std::vector<int32_t> cluster_of(points.size(), -1);
    std::vector<UnexplainedCluster> clusters;
    for (uint32_t i = 0; i < points.size(); i++) {
        int32_t& cluster = cluster_of[label[i]];
        if (cluster < 0) {
            cluster = static_cast<int32_t>(clusters.size());
            clusters.emplace_back();
        }
        clusters[static_cast<size_t>(cluster)].points.push_back(i);
    }
    std::erase_if(clusters, [&](const UnexplainedCluster& cluster) {
        return cluster.points.size() < std::max<size_t>(options.least_points, 1);
    });
    const std::vector<NodeId> ids = tree.depth_first();
    std::vector<Vec3> node_points;
    for (NodeId id : ids)
        node_points.emplace_back(tree.node(id).position);
    const PointTree nodes(node_points);
    parallel_for(clusters.size(), 1, [&](size_t begin, size_t end) {
        for (size_t c = begin; c < end; c++) {
            if (progress) progress->check();
            UnexplainedCluster& cluster = clusters[c];
            Bounds box;
            for (uint32_t i : cluster.points) {
                cluster.centre += DVec3(points[i]);
                box.add(DVec3(points[i]));
            }
            cluster.centre /= static_cast<double>(cluster.points.size());
            cluster.size = box.diagonal();
            suggest_joint(tree, ids, nodes, points, cluster);
            for (uint32_t& i : cluster.points)
                i = sorted[i].second;
            std::sort(cluster.points.begin(), cluster.points.end());
        }
    });
    // They are in the order of their first points' places.
    std::stable_sort(clusters.begin(), clusters.end(),
                     [](const UnexplainedCluster& a, const UnexplainedCluster& b) {
                         return a.points.size() > b.points.size();
                     });
    return clusters;
}

}  // namespace treerec
