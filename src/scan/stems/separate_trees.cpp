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
constexpr size_t kNeighbours = 8;      // of a voxel
constexpr double kTurn = 8.0;          // what a step costs more by one less the cosine that it turns by
constexpr double kMemory = 0.02;       // of the height: so long a path remembers the way that it came
constexpr double kWidestCrown = 0.45;  // of the height: further from its foot nothing belongs to a tree
constexpr double kLowTop = 0.4;        // of the height: what stands on the ground and ends below is clutter
constexpr double kStands = 0.04;       // of the height: above the ground
constexpr double kLeastTree = 0.25;    // of the height: lower ones are clutter
constexpr double kLeastInBranches = 0.6;  // the same, of what has low branches all around its stem
constexpr double kLeastShare = 0.02;      // of the largest tree's voxels, likewise
constexpr double kLowest = 0.0005;        // of the points: dust below all feet
constexpr double kFarWider = 2.5;         // than high: where tops count instead of stems

// The means of the occupied voxels, and which are near to each other.
struct Voxels {
    Voxels(const std::vector<Vec3>& points, double size, const Progress* progress)
        : grid(points, layout_for(points, size, progress), progress), centre(grid.size()) {
        for (size_t c = 0; c < grid.size(); c++) {
            DVec3 sum(0.0);
            for (const uint32_t i : grid.in_cell(c))
                sum += DVec3(points[i]);
            centre[c] = Vec3(sum / static_cast<double>(grid.in_cell(c).size()));
        }
        // Each and its nearest ones, to both sides: what touches leads on, and gaps are bridged.
        if (centre.size() <= kNeighbours) {
            begin.assign(centre.size() + 1, 0);
            return;
        }
        const std::vector<uint32_t> nearest =
            PointTree(centre, progress).nearest_of_all(kNeighbours, progress ? *progress : Progress());
        begin.assign(centre.size() + 1, 0);
        for (size_t k = 0; k < nearest.size(); k++) {
            begin[k / kNeighbours + 1]++;
            begin[nearest[k] + 1]++;
        }
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        neighbour.resize(begin.back());
        std::vector<uint32_t> at(begin.begin(), begin.end() - 1);
        for (size_t k = 0; k < nearest.size(); k++) {
            const auto c = static_cast<uint32_t>(k / kNeighbours);
            neighbour[at[c]++] = nearest[k];
            neighbour[at[nearest[k]]++] = c;
        }
    }

    static CellLayout layout_for(const std::vector<Vec3>& points, double size, const Progress* progress) {
        const std::array<Range, 3> ranges = robust_ranges(points, progress);
        return {{ranges[0].low, ranges[1].low, ranges[2].low}, size};
    }

    CellGrid grid;
    std::vector<Vec3> centre;
    std::vector<uint32_t> begin;  // of each voxel's neighbours; those near to each other stand there twice
    std::vector<uint32_t> neighbour;
};

// Dijkstra's shortest paths from all stems at once; ties go to the voxel of the smaller index. A step costs
// the third power of its length, so that a path follows wood or a spray of leaves and jumps from crown to
// crown only where nothing else leads on; and the more the further it turns off the way that the path came,
// as branches cross. All trees are scaled alike by that.
// down: the seeds are tops.
std::vector<uint32_t> grow(const Voxels& voxels, const std::vector<Vec3>& points,
                           const std::vector<Stem>& stems, double height, bool down,
                           const Progress* progress) {
    std::vector<uint32_t> tree(voxels.centre.size(), Separation::kNone);
    std::vector<float> cost(voxels.centre.size(), std::numeric_limits<float>::max());
    std::vector<Vec3> way(voxels.centre.size(), Vec3(0.0F));  // that the path came, of late
    using Entry = std::pair<float, uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    for (size_t s = 0; s < stems.size(); s++) {
        const DVec2& lean = stems[s].lean;
        const DVec3 up(glm::normalize(DVec3(lean.x, 1.0, lean.y)));
        for (const uint32_t i : stems[s].seed) {
            const uint64_t key = voxels.grid.layout.key(points[i]);
            const auto [c, next] = voxels.grid.cells_between(key, key);
            if (c == next || cost[c] == 0.0F) continue;
            cost[c] = 0.0F;
            tree[c] = static_cast<uint32_t>(s);
            way[c] = Vec3(down ? -up : up);
            open.emplace(0.0F, static_cast<uint32_t>(c));
        }
    }
    const double widest = kWidestCrown * height;
    const auto memory = static_cast<float>(kMemory * height);
    size_t steps = 0;
    while (!open.empty()) {
        const auto [reached, c] = open.top();
        open.pop();
        if (progress && (++steps & 0xFFFF) == 0) progress->check();
        if (reached > cost[c]) continue;
        const Stem& stem = stems[tree[c]];
        for (uint32_t n = voxels.begin[c]; n < voxels.begin[c + 1]; n++) {
            const uint32_t other = voxels.neighbour[n];
            if (reached >= cost[other]) continue;
            const Vec3 step = voxels.centre[other] - voxels.centre[c];
            const float length = glm::length(step);
            const float turn = length - glm::dot(step, way[c]);
            const float total = reached + length * length * (length + static_cast<float>(kTurn) * turn);
            if (total >= cost[other]) continue;
            const DVec3 at = DVec3(voxels.centre[other]) - stem.foot;
            if (glm::length(DVec2(at.x, at.z) - at.y * stem.lean) > widest) continue;
            cost[other] = total;
            tree[other] = tree[c];
            const float kept = memory / (memory + length);
            way[other] =
                Vec3(normalized_or(DVec3(kept * way[c] + (1.0F - kept) / length * step), DVec3(way[c])));
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
    std::vector<float> levels;
    for (const Vec3& p : points)
        levels.push_back(p.y);
    // Dust below the feet is no matter.
    const double low = quantile(levels, kLowest);
    std::vector<float> above(points.size());
    for (size_t i = 0; i < points.size(); i++)
        above[i] = static_cast<float>(ground.found ? ground.above(points[i]) : points[i].y - low);
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
        tree = grow(voxels, points, stems, height, by_tops, progress);
        take_in_the_rest(voxels, low_above, height, ground.found && !by_tops, tree, progress);
        sizes = measure_trees(tree, low_above, stems.size());
        const double least = kLeastShare * static_cast<double>(sizes.front().voxels);
        std::vector<uint8_t> stays(stems.size(), 1);
        for (const Size& s : sizes) {
            const double lowest = stems[s.stem].in_branches ? kLeastInBranches : kLeastTree;
            stays[s.stem] =
                static_cast<double>(s.top) >= lowest * height && static_cast<double>(s.voxels) >= least;
        }
        // Bark is looked at again when what shows none has gone.
        bool doubtful = false;
        for (size_t s = 0; s < stems.size(); s++)
            doubtful = doubtful || (!stays[s] && !stems[s].bark);
        for (size_t s = 0; doubtful && s < stems.size(); s++)
            stays[s] = stays[s] || stems[s].bark;
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
