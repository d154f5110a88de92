#include "scan/leaves/leaf_paths.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "geometry/parallel.h"
#include "geometry/point_tree.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr uint32_t kNone = UINT32_MAX;
constexpr double kFootShare = 0.005;  // of the height: cells as low as this are the ground's
constexpr size_t kGrain = 512;

struct Bridge {
    uint32_t from;
    uint32_t to;
};

// From every part that touches nothing to the nearest cell of the largest part.
std::vector<Bridge> bridge_parts(const Cells& cells, const Progress& progress) {
    const size_t count = cells.count();
    std::vector<uint32_t> part(count, kNone);
    std::vector<uint32_t> sizes;
    std::vector<uint32_t> stack;
    for (uint32_t seed = 0; seed < count; seed++) {
        if (part[seed] != kNone) continue;
        const uint32_t label = static_cast<uint32_t>(sizes.size());
        sizes.push_back(0);
        stack.push_back(seed);
        part[seed] = label;
        while (!stack.empty()) {
            const uint32_t v = stack.back();
            stack.pop_back();
            sizes[label]++;
            for (uint32_t e = cells.near_begin[v]; e < cells.near_begin[v + 1]; e++) {
                const uint32_t u = cells.near[e];
                if (part[u] != kNone) continue;
                part[u] = label;
                stack.push_back(u);
            }
        }
    }
    std::vector<Bridge> bridges;
    if (sizes.size() < 2) return bridges;
    const uint32_t largest =
        static_cast<uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    std::vector<Vec3> main;
    std::vector<uint32_t> main_cell;
    std::vector<uint32_t> others;
    for (uint32_t v = 0; v < count; v++) {
        if (part[v] == largest) {
            main.push_back(cells.centres[v]);
            main_cell.push_back(v);
        } else {
            others.push_back(v);
        }
    }
    progress.check();
    const PointTree tree(main);
    std::vector<std::pair<float, uint32_t>> nearest(others.size());
    parallel_for(others.size(), kGrain, [&](size_t begin, size_t end) {
        progress.check();
        for (size_t i = begin; i < end; i++) {
            uint32_t found = 0;
            float square = 0.0F;
            tree.nearest(cells.centres[others[i]], 1, &found, &square);
            nearest[i] = {square, main_cell[found]};
        }
    });
    std::vector<uint32_t> best(sizes.size(), kNone);
    for (uint32_t i = 0; i < others.size(); i++) {
        uint32_t& b = best[part[others[i]]];
        if (b == kNone || nearest[i].first < nearest[b].first) b = i;
    }
    for (const uint32_t b : best)
        if (b != kNone) bridges.push_back({others[b], nearest[b].second});
    return bridges;
}

float distance(const Cells& cells, uint32_t a, uint32_t b) {
    return glm::distance(cells.centres[a], cells.centres[b]);
}

void find_paths(const Cells& cells, const std::vector<Bridge>& bridges, CellPaths& result,
                const Progress& progress) {
    const size_t count = cells.count();
    std::vector<uint32_t> bridge_begin(count + 1, 0);
    for (const Bridge& b : bridges) {
        bridge_begin[b.from + 1]++;
        bridge_begin[b.to + 1]++;
    }
    for (size_t i = 0; i < count; i++)
        bridge_begin[i + 1] += bridge_begin[i];
    std::vector<uint32_t> bridge(2 * bridges.size());
    std::vector<uint32_t> fill(bridge_begin.begin(), bridge_begin.end() - 1);
    for (const Bridge& b : bridges) {
        bridge[fill[b.from]++] = b.to;
        bridge[fill[b.to]++] = b.from;
    }

    std::vector<double> cost(count, std::numeric_limits<double>::infinity());
    std::vector<uint8_t> done(count, 0);
    result.parent.resize(count);
    result.order.reserve(count);
    using Entry = std::pair<double, uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    float low = std::numeric_limits<float>::max();
    float high = std::numeric_limits<float>::lowest();
    for (const Vec3& c : cells.centres) {
        low = std::min(low, c.y);
        high = std::max(high, c.y);
    }
    const float foot = low + static_cast<float>(cells.size + kFootShare * (high - low));
    for (uint32_t v = 0; v < count; v++) {
        result.parent[v] = v;
        if (cells.centres[v].y > foot) continue;
        cost[v] = 0.0;
        queue.push({0.0, v});
    }
    while (!queue.empty()) {
        const double c = queue.top().first;
        const uint32_t v = queue.top().second;
        queue.pop();
        if (done[v]) continue;
        done[v] = 1;
        if (result.order.size() % 16384 == 0) progress.check();
        result.order.push_back(v);
        auto relax = [&](uint32_t u) {
            if (done[u]) return;
            const Vec3 d = cells.centres[u] - cells.centres[v];
            const double through = c + static_cast<double>(glm::dot(d, d));
            if (through >= cost[u]) return;
            cost[u] = through;
            result.parent[u] = v;
            queue.push({through, u});
        };
        for (uint32_t e = cells.near_begin[v]; e < cells.near_begin[v + 1]; e++)
            relax(cells.near[e]);
        for (uint32_t e = bridge_begin[v]; e < bridge_begin[v + 1]; e++)
            relax(bridge[e]);
    }
}

// Cells per length of the whole end piece that each cell lies in, where that is no longer than `limit` cells.
void measure_bushes(const CellPaths& tree, const std::vector<float>& height,
                    const std::vector<uint32_t>& mass, float limit, float CellPath::*member,
                    std::vector<CellPath>& paths) {
    for (const uint32_t v : tree.order) {
        if (height[v] >= limit) continue;
        const uint32_t p = tree.parent[v];
        paths[v].*member = p != v && height[p] < limit
                               ? paths[p].*member
                               : portable::log1p(static_cast<float>(mass[v]) / (height[v] + 1.0F));
    }
}

}  // namespace

CellPaths trace_paths(const Cells& cells, const Progress& progress) {
    CellPaths result;
    find_paths(cells, bridge_parts(cells, progress), result, progress);
    const size_t count = cells.count();
    const float scale = static_cast<float>(1.0 / cells.size);
    std::vector<float> step(count, 0.0F);  // to the parent, in cells
    std::vector<float> height(count, 0.0F);
    std::vector<uint32_t> mass(count, 1);
    std::vector<uint32_t> onward(count, kNone);  // the child with the longest path
    for (auto v = result.order.rbegin(); v != result.order.rend(); ++v) {
        const uint32_t p = result.parent[*v];
        if (p == *v) continue;
        step[*v] = scale * distance(cells, p, *v);
        mass[p] += mass[*v];
        const float through = height[*v] + step[*v];
        if (onward[p] == kNone || through > height[p]) {
            height[p] = through;
            onward[p] = *v;
        }
    }
    progress.check();
    result.paths.resize(count);
    std::vector<uint32_t> base(count);
    for (const uint32_t v : result.order) {
        const uint32_t p = result.parent[v];
        base[v] = p != v && onward[p] == v ? base[p] : v;
    }
    parallel_for(count, kGrain, [&](size_t begin, size_t end) {
        progress.check();
        for (size_t v = begin; v < end; v++) {
            CellPath& path = result.paths[v];
            const uint32_t b = base[v];
            path.height = portable::log1p(height[v]);
            path.mass = portable::log(static_cast<float>(mass[v]));
            path.chain = portable::log1p(height[b]);
            path.chain_mass = portable::log(static_cast<float>(mass[b]) / (height[b] + 1.0F));
            path.straight_short = path.straight_long = 1.0F;
            float arc = 0.0F;
            uint32_t u = static_cast<uint32_t>(v);
            for (int k = 1; k <= 32 && result.parent[u] != u; k++) {
                arc += step[u];
                u = result.parent[u];
                const float straight = scale * distance(cells, static_cast<uint32_t>(v), u) / arc;
                if (k <= 6) path.straight_short = straight;
                path.straight_long = straight;
                if (k <= 16) path.gap = arc / static_cast<float>(k);
            }
        }
    });
    measure_bushes(result, height, mass, 8.0F, &CellPath::bush_8, result.paths);
    measure_bushes(result, height, mass, 16.0F, &CellPath::bush_16, result.paths);
    measure_bushes(result, height, mass, 32.0F, &CellPath::bush_32, result.paths);
    return result;
}

}  // namespace treerec
