#include "skeleton/branches/slices.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/groups.h"
#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr double kGapFactor = 3.0;  // reaches: a longer step is a gap in the scan and not just thin sampling
constexpr float kBesideReach = 2.0f;  // reaches: slices of one stem that the scan parts are no further apart
constexpr double kThickness = 2.0;    // slice thickness in local point spacings
constexpr size_t kSlicesPerTask = 256;
constexpr size_t kVerticesPerCheck = 65536;

// The level of each vertex: the path length from the root in units of the local slice thickness. An edge
// across a gap always ends on a new level.
std::vector<int32_t> vertex_levels(const PointGraph& graph, const LocalScale& scale, const PathTree& paths,
                                   const Progress& progress) {
    std::vector<double> measure(graph.size(), 0.0);
    std::vector<int32_t> level(graph.size(), 0);
    size_t done = 0;
    for (const uint32_t v : paths.order) {
        if (done++ % kVerticesPerCheck == 0) progress.check();
        const int32_t p = paths.parent[v];
        if (p < 0) {
            measure[v] = paths.along[v] / (kThickness * scale.spacing[v]);
        } else {
            const uint32_t from = static_cast<uint32_t>(p);
            const double length = paths.step[v];
            const double thickness = kThickness * 0.5 * (scale.spacing[v] + scale.spacing[from]);
            measure[v] = measure[from] + length / thickness;
            if (paths.step[v] > edge_reach(scale, v, from))
                measure[v] = std::max(measure[v], std::floor(measure[from]) + 1.0);
        }
        level[v] = static_cast<int32_t>(std::min(measure[v], 1e9));
    }
    return level;
}

// Fills `beside`: a link is an edge not much longer than the local reach. All else is filled.
void find_beside(Slices& slices, const PointGraph& graph, const LocalScale& scale,
                 const std::vector<uint32_t>& slice_of, const Progress& progress) {
    using Pair = std::pair<uint32_t, uint32_t>;
    std::vector<std::vector<Pair>> found((slices.size() + kSlicesPerTask - 1) / kSlicesPerTask);
    parallel_for(slices.size(), kSlicesPerTask, [&](size_t first, size_t last) {
        progress.check();
        std::vector<uint32_t> others;
        for (uint32_t a = static_cast<uint32_t>(first); a < last; a++) {
            others.clear();
            const int32_t parent = slices.parent[a];
            for (const uint32_t v : slices.points_of(a))
                for (uint32_t e = graph.begin[v], end = graph.begin[v + 1]; e < end; e++) {
                    const uint32_t n = graph.neighbour[e];
                    const uint32_t b = slice_of[n];
                    if (a >= b || parent == static_cast<int32_t>(b) ||
                        slices.parent[b] == static_cast<int32_t>(a))
                        continue;
                    if (graph.length[e] <= kBesideReach * edge_reach(scale, v, n)) others.push_back(b);
                }
            std::sort(others.begin(), others.end());
            others.erase(std::unique(others.begin(), others.end()), others.end());
            for (const uint32_t b : others)
                found[first / kSlicesPerTask].emplace_back(a, b);
        }
    });
    std::vector<Pair> pairs;
    for (const std::vector<Pair>& some : found)
        pairs.insert(pairs.end(), some.begin(), some.end());
    progress.check();
    slices.beside_begin.assign(slices.size() + 1, 0);
    for (const auto& [a, b] : pairs) {
        slices.beside_begin[a + 1]++;
        slices.beside_begin[b + 1]++;
    }
    for (size_t s = 0; s < slices.size(); s++)
        slices.beside_begin[s + 1] += slices.beside_begin[s];
    slices.beside.resize(2 * pairs.size());
    std::vector<uint32_t> fill(slices.beside_begin.begin(), slices.beside_begin.end() - 1);
    for (const auto& [a, b] : pairs) {
        slices.beside[fill[a]++] = b;
        slices.beside[fill[b]++] = a;
    }
}

}  // namespace

Slices cut_slices(const std::vector<Vec3>& points, const PointGraph& graph, const LocalScale& scale,
                  const PathTree& paths, const DVec3& root, const Progress& progress) {
    const size_t count = graph.size();
    const std::vector<int32_t> level = vertex_levels(graph, scale, paths, progress);
    Groups groups(count);
    groups.join_all([&](uint32_t v, const auto& link) {
        if (v % kVerticesPerCheck == 0) progress.check();
        for (uint32_t e = graph.begin[v], end = graph.begin[v + 1]; e < end; e++) {
            const uint32_t n = graph.neighbour[e];
            if (n > v) break;  // they ascend
            if (level[n] == level[v] && graph.length[e] <= edge_reach(scale, v, n)) link(n);
        }
    });

    progress.check();
    // Number the groups by level, then by their smallest vertex. Slice 0 is the root itself and has no
    // points.
    std::vector<uint32_t> leaders;
    for (uint32_t v = 0; v < count; v++)
        if (groups.find(v) == v) leaders.push_back(v);
    std::stable_sort(leaders.begin(), leaders.end(),
                     [&](uint32_t a, uint32_t b) { return level[a] < level[b]; });
    progress.check();
    std::vector<uint32_t> slice_of(count);
    for (uint32_t s = 0; s < leaders.size(); s++)
        slice_of[leaders[s]] = s + 1;
    for (uint32_t v = 0; v < count; v++)
        slice_of[v] = slice_of[groups.find(v)];

    progress.check();
    Slices slices;
    const size_t slice_count = leaders.size() + 1;
    slices.begin.assign(slice_count + 1, 0);
    for (uint32_t v = 0; v < count; v++)
        slices.begin[slice_of[v] + 1]++;
    for (size_t s = 0; s < slice_count; s++)
        slices.begin[s + 1] += slices.begin[s];
    slices.vertices.resize(count);
    std::vector<uint32_t> fill(slices.begin.begin(), slices.begin.end() - 1);
    for (uint32_t v = 0; v < count; v++)
        slices.vertices[fill[slice_of[v]]++] = v;

    slices.parent.assign(slice_count, 0);
    slices.parent[0] = -1;
    slices.bridged.assign(slice_count, 0);
    slices.centre.assign(slice_count, root);
    parallel_for(slice_count, kSlicesPerTask, [&](size_t first, size_t last) {
        progress.check();
        std::vector<uint32_t> votes;
        for (size_t s = std::max<size_t>(first, 1); s < last; s++) {
            DVec3 sum(0.0);
            votes.clear();
            bool linked = false;
            for (const uint32_t v : slices.points_of(s)) {
                sum += DVec3(points[v]);
                const int32_t p = paths.parent[v];
                const uint32_t from = p < 0 ? 0 : slice_of[p];
                if (from == s) continue;
                votes.push_back(from);
                linked = linked || p < 0 ||
                         paths.step[v] <= kGapFactor * edge_reach(scale, v, static_cast<uint32_t>(p));
            }
            slices.centre[s] = sum / static_cast<double>(slices.points_of(s).size());
            std::sort(votes.begin(), votes.end());
            size_t best_count = 0;
            for (size_t i = 0, j = 0; i < votes.size(); i = j) {
                while (j < votes.size() && votes[j] == votes[i])
                    j++;
                if (j - i > best_count) {
                    best_count = j - i;
                    slices.parent[s] = static_cast<int32_t>(votes[i]);
                }
            }
            slices.bridged[s] = !linked;
        }
    });
    find_beside(slices, graph, scale, slice_of, progress);
    return slices;
}

}  // namespace treerec
