#include "scan/stems/separate_trees.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

#include "geometry/cell_grid.h"
#include "geometry/point_tree.h"
#include "geometry/portable_math.h"
#include "scan/cleaning/samples.h"
#include "scan/stems/lone_trunk.h"

namespace treerec {

namespace {

constexpr double kVoxel = 0.006;       // of the height
constexpr double kSideways = 2.0;      // what a metre sideways costs more than one upwards
constexpr double kWidestCrown = 0.45;  // of the height: further from its foot nothing belongs to a tree
constexpr double kLowTop = 0.4;        // of the height: what stands on the ground and ends below is clutter
constexpr double kStands = 0.04;       // of the height: above the ground
constexpr double kLeastTree = 0.25;    // of the height: lower ones are clutter
constexpr double kLeastInBranches = 0.6;  // the same, of what has low branches all around its stem
constexpr double kLeastShare = 0.02;      // of the largest tree's voxels, likewise
constexpr double kFarWider = 2.5;         // than high: where tops count instead of stems

// The occupied voxels, and which touch.
struct Voxels {
    Voxels(const std::vector<Vec3>& points, double size, const Progress* progress)
        : grid(points, layout_for(points, size, progress), progress), centre(grid.size()) {
        for (size_t c = 0; c < grid.size(); c++) {
            DVec3 sum(0.0);
            for (const uint32_t i : grid.in_cell(c))
                sum += DVec3(points[i]);
            centre[c] = Vec3(sum / static_cast<double>(grid.in_cell(c).size()));
        }
        begin.assign(grid.size() + 1, 0);
        grid.for_neighbour_runs([&](size_t c, size_t first, size_t last) {
            begin[c + 1] += static_cast<uint32_t>(last - first);
        });
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        neighbour.resize(begin.back());
        std::vector<uint32_t> at(begin.begin(), begin.end() - 1);
        grid.for_neighbour_runs([&](size_t c, size_t first, size_t last) {
            for (size_t other = first; other < last; other++)
                neighbour[at[c]++] = static_cast<uint32_t>(other);
        });
    }

    static CellLayout layout_for(const std::vector<Vec3>& points, double size, const Progress* progress) {
        const std::array<Range, 3> ranges = robust_ranges(points, progress);
        return {{ranges[0].low, ranges[1].low, ranges[2].low}, size};
    }

    CellGrid grid;
    std::vector<Vec3> centre;
    std::vector<uint32_t> begin;  // of each voxel's neighbours, itself among them
    std::vector<uint32_t> neighbour;
};

// Dijkstra's shortest paths from all stems at once; ties go to the voxel of the smaller index.
std::vector<uint32_t> grow(const Voxels& voxels, const std::vector<Vec3>& points,
                           const std::vector<Stem>& stems, double height, const Progress* progress) {
    std::vector<uint32_t> tree(voxels.centre.size(), Separation::kNone);
    std::vector<float> cost(voxels.centre.size(), std::numeric_limits<float>::max());
    using Entry = std::pair<float, uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    for (size_t s = 0; s < stems.size(); s++) {
        for (const uint32_t i : stems[s].seed) {
            const uint64_t key = voxels.grid.layout.key(points[i]);
            const auto [c, next] = voxels.grid.cells_between(key, key);
            if (cost[c] == 0.0F || c == next) continue;
            cost[c] = 0.0F;
            tree[c] = static_cast<uint32_t>(s);
            open.emplace(0.0F, static_cast<uint32_t>(c));
        }
    }
    // The thicker stem has the larger crown, by the 2/3 power of its diameter (West, Brown and Enquist 1999).
    double thickest = 0.0;
    for (const Stem& stem : stems)
        thickest = std::max(thickest, stem.radius);
    std::vector<float> slowness;
    for (const Stem& stem : stems)
        slowness.push_back(thickest > 0.0 ? static_cast<float>(portable::pow(
                                                thickest / std::max(stem.radius, 0.05 * thickest), 2.0 / 3.0))
                                          : 1.0F);
    const float widest = static_cast<float>(kWidestCrown * height);
    size_t steps = 0;
    while (!open.empty()) {
        const auto [reached, c] = open.top();
        open.pop();
        if (progress && (++steps & 0xFFFF) == 0) progress->check();
        if (reached > cost[c]) continue;
        const DVec3& foot = stems[tree[c]].foot;
        for (uint32_t n = voxels.begin[c]; n < voxels.begin[c + 1]; n++) {
            const uint32_t other = voxels.neighbour[n];
            const Vec3 way = voxels.centre[other] - voxels.centre[c];
            const float side = static_cast<float>(kSideways) * portable::hypot(way.x, way.z);
            const float total = reached + slowness[tree[c]] * std::sqrt(way.y * way.y + side * side);
            if (total >= cost[other]) continue;
            if (portable::hypot(voxels.centre[other].x - static_cast<float>(foot.x),
                                voxels.centre[other].z - static_cast<float>(foot.z)) > widest)
                continue;
            cost[other] = total;
            tree[other] = tree[c];
            open.emplace(total, other);
        }
    }
    return tree;
}

// What no stem reached: hanging parts go to the nearest tree, what stands low on the ground is clutter.
void take_in_the_rest(const Voxels& voxels, const std::vector<float>& low_above, double height,
                      bool on_ground, std::vector<uint32_t>& tree, const Progress* progress) {
    std::vector<Vec3> reached;
    std::vector<uint32_t> label;
    for (size_t c = 0; c < tree.size(); c++) {
        if (tree[c] == Separation::kNone) continue;
        reached.push_back(voxels.centre[c]);
        label.push_back(tree[c]);
    }
    const PointTree nearest(reached);
    std::vector<uint8_t> seen(tree.size());
    const std::vector<uint32_t> grown = tree;
    std::vector<uint32_t> part;
    for (size_t start = 0; start < tree.size(); start++) {
        if (grown[start] != Separation::kNone || seen[start]) continue;
        if (progress) progress->check();
        part.assign(1, static_cast<uint32_t>(start));
        seen[start] = 1;
        float lowest = std::numeric_limits<float>::max();
        float highest = std::numeric_limits<float>::lowest();
        float best = std::numeric_limits<float>::max();
        uint32_t owner = Separation::kNone;
        for (size_t k = 0; k < part.size(); k++) {
            const uint32_t c = part[k];
            lowest = std::min(lowest, low_above[c]);
            highest = std::max(highest, low_above[c]);
            uint32_t found = 0;
            float square = 0.0F;
            nearest.nearest(voxels.centre[c], 1, &found, &square);
            if (square < best) {
                best = square;
                owner = label[found];
            }
            for (uint32_t n = voxels.begin[c]; n < voxels.begin[c + 1]; n++) {
                const uint32_t other = voxels.neighbour[n];
                if (grown[other] != Separation::kNone || seen[other]) continue;
                seen[other] = 1;
                part.push_back(other);
            }
        }
        const bool clutter = on_ground && static_cast<double>(lowest) < kStands * height &&
                             static_cast<double>(highest) < kLowTop * height;
        const bool far = std::sqrt(static_cast<double>(best)) > 0.1 * height;
        if (clutter || far) continue;
        for (const uint32_t c : part)
            tree[c] = owner;
    }
}

struct Size {
    uint32_t stem = 0;
    size_t voxels = 0;
    float top = 0.0F;
};

// Largest first, by the room that they fill, whatever their distance from the scanner.
std::vector<Size> measure_trees(const std::vector<uint32_t>& tree, const std::vector<float>& low_above,
                                size_t stems) {
    std::vector<Size> sizes(stems);
    for (uint32_t s = 0; s < stems; s++)
        sizes[s].stem = s;
    for (size_t c = 0; c < tree.size(); c++) {
        if (tree[c] == Separation::kNone) continue;
        sizes[tree[c]].voxels++;
        sizes[tree[c]].top = std::max(sizes[tree[c]].top, low_above[c]);
    }
    std::stable_sort(sizes.begin(), sizes.end(),
                     [](const Size& a, const Size& b) { return a.voxels > b.voxels; });
    return sizes;
}

}  // namespace

Separation separate_trees(const std::vector<Vec3>& points, const Ground& ground, double spacing,
                          const Progress* progress) {
    Separation result;
    if (points.size() < 200) return result;
    const std::array<Range, 3> ranges = robust_ranges(points, progress);
    std::vector<float> above(points.size());
    for (size_t i = 0; i < points.size(); i++)
        above[i] = static_cast<float>(ground.found ? ground.above(points[i]) : points[i].y - ranges[1].low);
    std::vector<float> heights = above;
    const double height = quantile(heights, 0.999);
    if (!(height > 0.0)) return result;

    // Its bark is wide enough to seem several stems.
    if (!stump_rings(points, progress).empty()) return result;
    std::vector<Stem> stems = find_stems(points, above, height, spacing, ground.found, progress);
    std::vector<Vec3> canopy;
    for (size_t i = 0; i < points.size(); i++)
        if (static_cast<double>(above[i]) > 0.3 * height) canopy.push_back(points[i]);
    const std::array<Range, 3> crowns = robust_ranges(canopy, progress);
    const bool wide = std::min(crowns[0].size(), crowns[2].size()) > kFarWider * height;
    const bool by_tops = stems.size() < 2 && ground.found && wide;
    if (by_tops) stems = find_tops(points, above, height, spacing, progress);
    if (!by_tops && stems.size() > 1) add_round_stems(points, above, height, stems, progress);
    if (stems.size() < 2) return result;

    const Voxels voxels(points, std::max(kVoxel * height, 1.2 * spacing), progress);
    std::vector<float> low_above(voxels.centre.size(), std::numeric_limits<float>::max());
    for (size_t c = 0; c < low_above.size(); c++)
        for (const uint32_t i : voxels.grid.in_cell(c))
            low_above[c] = std::min(low_above[c], above[i]);
    std::vector<uint32_t> tree;
    std::vector<Size> sizes;
    for (;;) {
        tree = grow(voxels, points, stems, height, progress);
        take_in_the_rest(voxels, low_above, height, ground.found && !by_tops, tree, progress);
        sizes = measure_trees(tree, low_above, stems.size());
        const double least = kLeastShare * static_cast<double>(sizes.front().voxels);
        std::vector<uint8_t> stays(stems.size(), 1);
        for (const Size& s : sizes) {
            const double lowest = stems[s.stem].in_branches ? kLeastInBranches : kLeastTree;
            stays[s.stem] =
                static_cast<double>(s.top) >= lowest * height && static_cast<double>(s.voxels) >= least;
        }
        // What was no tree belongs to the trees around it.
        size_t kept = 0;
        for (size_t s = 0; s < stems.size(); s++) {
            if (!stays[s]) continue;
            if (kept != s) stems[kept] = std::move(stems[s]);
            kept++;
        }
        if (kept < 2) return result;
        if (kept < stems.size()) {
            stems.resize(kept);
            continue;
        }
        if (by_tops) break;
        const std::vector<uint32_t> joined =
            joined_by_wood(stems, voxels.centre, tree, voxels.grid.layout.cell, progress);
        std::vector<Stem> apart;
        std::vector<size_t> place(stems.size());
        for (size_t s = 0; s < stems.size(); s++) {
            if (joined[s] != s) continue;
            place[s] = apart.size();
            apart.push_back(stems[s]);
        }
        if (apart.size() == stems.size()) break;
        for (size_t s = 0; s < stems.size(); s++)
            if (joined[s] != s) {
                std::vector<uint32_t>& seed = apart[place[joined[s]]].seed;
                seed.insert(seed.end(), stems[s].seed.begin(), stems[s].seed.end());
            }
        if (apart.size() < 2) return result;
        // What grew from any of its stems is the tree's.
        for (uint32_t& owner : tree)
            if (owner != Separation::kNone) owner = static_cast<uint32_t>(place[joined[owner]]);
        stems = std::move(apart);
        sizes = measure_trees(tree, low_above, stems.size());
        break;
    }
    std::vector<uint32_t> rank(stems.size());
    for (uint32_t r = 0; r < sizes.size(); r++) {
        rank[sizes[r].stem] = r;
        result.stems.push_back(std::move(stems[sizes[r].stem]));
    }
    result.of_point.assign(points.size(), Separation::kNone);
    for (size_t c = 0; c < tree.size(); c++) {
        if (tree[c] == Separation::kNone) continue;
        for (const uint32_t i : voxels.grid.in_cell(c))
            result.of_point[i] = rank[tree[c]];
    }
    return result;
}

}  // namespace treerec
