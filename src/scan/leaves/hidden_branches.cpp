#include "scan/leaves/hidden_branches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/quantile.h"

namespace treerec {

namespace {

// A branch that leaves hide is followed where paths go on for this much further; a lone piece of wood must be
// as large as that many cells.
constexpr double kHiddenShare = 0.15;  // of the crown's extent,
constexpr double kHiddenWidth = 0.5;   // and no more than that of its half width: spruces have short branches
constexpr float kHiddenCells = 8.0F;
constexpr uint32_t kLeastPiece = 8;
constexpr double kCrownBase = 0.1;    // of the leaves are lower
constexpr double kFootGap = 0.15;     // of the crown's height, below its base
constexpr double kLeastClump = 0.02;  // of the leaves: smaller clumps well below the crown are bark

// A palm. Broad-leaved crowns have 0.17 to 0.25 of the planarity, palms 0.35 and more.
constexpr double kMostCrownWood = 0.12;  // cells of wood above the hub, per cell of leaf
constexpr double kHubQuantile = 0.8;  // of the leaves: some of a blurred stem's points are taken for leaves
constexpr double kHubShare = 0.1;     // of the height: the ways of leaves meet wood as near to the hub
constexpr double kLeastPlanarity = 0.27;
// Where blur has made fronds as thick as other leaves: a tuft that hangs around the end of a tall bare stem.
// Of real scans, turned and thinned, nearly all of a palm's leaves meet their stem within 0.18 of the crown's
// extent of the hub, broad leaves above a stem as tall within 0.23 and more.
constexpr double kTuftHub = 0.75;      // of the height: the hub is higher
constexpr double kTuftQuantile = 0.9;  // of the leaves
constexpr double kTuftSpread = 0.2;    // of the crown's extent
constexpr double kTuftHanging = 0.1;   // of the leaves: more hang below the hub
// A palm's stem is stout: at its thinnest, 0.017 of the crown's extent and more of real scans. A sapling that
// is all leaves has 0.005.
constexpr double kLeastStem = 0.01;
constexpr double kThinnest = 0.25;       // of the stem's slices
constexpr double kRibCells = 3.0;        // wood that far from the stem, above the hub, is a rib of a frond
constexpr double kSliceCells = 4.0;      // height of the slices in which the stem is walked up
constexpr double kStemBulge = 1.5;       // times the stem's usual radius: what lies further out is not of it
constexpr double kReachSlack = 1.1;      // the stem ends a little below or beside the crown's middle
constexpr double kReachQuantile = 0.98;  // of the leaves: some of the stem's points are taken for leaves
constexpr double kStemCells = 0.8;       // radius of the stem that is followed through the fronds
constexpr double kMostLean = 0.36;       // sideways per metre up: palms grow upright
// Fronds spring from one place, and hang from there: around the stem's line, leaves are nowhere denser.
constexpr double kNearStem = 0.1;      // of the crown's width, from that line
constexpr double kSpringShare = 0.06;  // of the height from the hub to the top, to either side
constexpr size_t kLeastSpring = 12;    // cells

struct Crown {
    double base = 0.0;    // height
    double foot = 0.0;    // height: well below the crown
    double extent = 0.0;  // the longest side
    double width = 0.0;   // the shorter level one
    DVec3 middle{0.0};
    DVec3 top{0.0};  // the highest leaf
    size_t cells = 0;
};

Crown measure_crown(const Cells& cells, const std::vector<uint8_t>& leaf) {
    Crown crown;
    std::array<std::vector<float>, 3> values;
    crown.top.y = -1e30;
    for (size_t v = 0; v < cells.count(); v++) {
        if (!leaf[v]) continue;
        crown.cells++;
        for (int axis = 0; axis < 3; axis++)
            values[static_cast<size_t>(axis)].push_back(cells.centres[v][axis]);
        if (cells.centres[v].y > crown.top.y) crown.top = DVec3(cells.centres[v]);
    }
    if (crown.cells == 0) return crown;
    crown.base = quantile(values[1], kCrownBase);
    crown.foot = crown.base - kFootGap * (crown.top.y - crown.base);
    for (int axis = 0; axis < 3; axis++) {
        std::vector<float>& v = values[static_cast<size_t>(axis)];
        const double side = quantile(v, 0.99) - quantile(v, 0.01);
        crown.extent = std::max(crown.extent, side);
        if (axis != 1) crown.width = axis == 0 ? side : std::min(crown.width, side);
        crown.middle[axis] = quantile(v, 0.5);
    }
    return crown;
}

// Small clumps of leaf below the crown are rough bark.
void clear_foot(const Cells& cells, const Crown& crown, std::vector<uint8_t>& leaf) {
    const size_t least = static_cast<size_t>(kLeastClump * static_cast<double>(crown.cells)) + 1;
    std::vector<uint8_t> seen(cells.count(), 0);
    std::vector<uint32_t> clump;
    for (uint32_t seed = 0; seed < cells.count(); seed++) {
        if (!leaf[seed] || seen[seed] || cells.centres[seed].y >= crown.foot) continue;
        clump.assign(1, seed);
        seen[seed] = 1;
        bool low = true;
        for (size_t i = 0; i < clump.size(); i++)
            for (uint32_t e = cells.near_begin[clump[i]]; e < cells.near_begin[clump[i] + 1]; e++) {
                const uint32_t u = cells.near[e];
                if (!leaf[u] || seen[u]) continue;
                seen[u] = 1;
                low = low && cells.centres[u].y < crown.foot;
                clump.push_back(u);
            }
        if (low && clump.size() < least)
            for (const uint32_t v : clump)
                leaf[v] = 0;
    }
}

float middle_of(std::vector<float> values) {
    return quantile(values, 0.5);
}

// Where the ways of leaves to the ground meet wood.
struct Hub {
    DVec3 at{0.0};
    double height = 0.0;  // metres, up or down: most are as near
    double spread = 0.0;  // metres, up, down or aside: nearly all are as near
    double share = 0.0;   // of the leaves: those that meet wood at all
};

Hub find_hub(const Cells& cells, const CellPaths& tree, const std::vector<uint8_t>& leaf, size_t leaves) {
    std::vector<uint32_t> from(cells.count());
    std::array<std::vector<float>, 3> met;
    for (const uint32_t v : tree.order) {
        const uint32_t p = tree.parent[v];
        from[v] = leaf[v] && p != v ? from[p] : v;
        if (!leaf[v] || leaf[from[v]]) continue;
        for (int axis = 0; axis < 3; axis++)
            met[static_cast<size_t>(axis)].push_back(cells.centres[from[v]][axis]);
    }
    Hub hub;
    if (met[0].empty()) return hub;
    hub.share = static_cast<double>(met[0].size()) / static_cast<double>(leaves);
    for (int axis = 0; axis < 3; axis++)
        hub.at[axis] = middle_of(met[static_cast<size_t>(axis)]);
    std::vector<float> aside(met[0].size());
    for (size_t i = 0; i < aside.size(); i++) {
        aside[i] = static_cast<float>(std::hypot(met[0][i] - hub.at.x, met[2][i] - hub.at.z));
        met[1][i] = std::abs(met[1][i] - static_cast<float>(hub.at.y));
    }
    hub.height = quantile(met[1], kHubQuantile);
    hub.spread = std::max(quantile(met[1], kTuftQuantile), quantile(aside, kTuftQuantile));
    return hub;
}

// Metres: of the wood between two heights, where it is thin.
double stem_radius(const Cells& cells, const std::vector<uint8_t>& leaf, double low, double high) {
    const double height = kSliceCells * cells.size;
    std::vector<std::array<std::vector<float>, 2>> slices(
        static_cast<size_t>(std::max(high - low, 0.0) / height) + 1);
    for (size_t v = 0; v < cells.count(); v++) {
        const Vec3& p = cells.centres[v];
        if (leaf[v] || p.y > high) continue;
        auto& slice = slices[static_cast<size_t>(std::max(p.y - low, 0.0) / height)];
        slice[0].push_back(p.x);
        slice[1].push_back(p.z);
    }
    std::vector<float> radii;
    for (const auto& [x, z] : slices) {
        if (x.empty()) continue;
        const float at_x = middle_of(x), at_z = middle_of(z);
        std::vector<float> offs;
        for (size_t i = 0; i < x.size(); i++)
            offs.push_back(std::hypot(x[i] - at_x, z[i] - at_z));
        radii.push_back(middle_of(std::move(offs)));
    }
    return radii.empty() ? 0.0 : quantile(radii, kThinnest);
}

bool has_fronds(const Cells& cells, const CellShapes& shapes, const CellPaths& tree,
                const std::vector<uint8_t>& leaf, const Crown& crown, DVec3& where) {
    double planarity = 0.0;
    float low = cells.centres[0].y;
    for (size_t v = 0; v < cells.count(); v++) {
        low = std::min(low, cells.centres[v].y);
        if (leaf[v]) planarity += shapes[v * kShapeScales + 1].planarity;
    }
    const auto leaves = static_cast<double>(crown.cells);
    const double height = crown.top.y - low;
    const Hub hub = find_hub(cells, tree, leaf, crown.cells);
    where = hub.at;
    if (hub.share < 0.5) return false;
    // Fronds hang down around their stem, but nothing of it stands above them.
    double above = 0.0, hanging = 0.0;
    for (size_t v = 0; v < cells.count(); v++) {
        const double y = cells.centres[v].y;
        if (!leaf[v] && y > hub.at.y + hub.height + kRibCells * cells.size) above += 1.0;
        if (leaf[v] && y < hub.at.y) hanging += 1.0;
    }
    if (above > kMostCrownWood * leaves) return false;
    const bool sheets = planarity >= kLeastPlanarity * leaves && hub.height < kHubShare * height;
    const bool tuft = hub.at.y - low > kTuftHub * height && hub.spread < kTuftSpread * crown.extent &&
                      hanging > kTuftHanging * leaves;
    return (sheets || tuft) && stem_radius(cells, leaf, low, hub.at.y) > kLeastStem * crown.extent;
}

double distance_to(const DVec3& p, const DVec3& from, const DVec3& to) {
    const DVec3 along = to - from;
    const double length = glm::dot(along, along);
    const double t = length > 0.0 ? std::clamp(glm::dot(p - from, along) / length, 0.0, 1.0) : 0.0;
    return glm::distance(p, from + t * along);
}

// Walks up the stem slice by slice. Wood beside it, above its lower half, is of fronds that hang down.
void clear_stem(const Cells& cells, std::vector<uint8_t>& leaf, double low, const DVec3& hub) {
    const double height = kSliceCells * cells.size;
    const auto slice_of = [&](double y) { return static_cast<ptrdiff_t>(std::floor((y - low) / height)); };
    const ptrdiff_t count = slice_of(hub.y) + 1;
    std::vector<std::vector<uint32_t>> slices(static_cast<size_t>(std::max<ptrdiff_t>(count, 0)));
    for (uint32_t v = 0; v < cells.count(); v++) {
        const ptrdiff_t slice = slice_of(cells.centres[v].y);
        if (!leaf[v] && slice >= 0 && slice < count) slices[static_cast<size_t>(slice)].push_back(v);
    }
    DVec2 centre(0.0);
    double radius = std::numeric_limits<double>::max();  // of the stem, flared at first
    for (size_t i = 0; i < slices.size(); i++) {
        const auto off = [&](uint32_t v) {
            return glm::distance(DVec2(cells.centres[v].x, cells.centres[v].z), centre);
        };
        const double most = kStemBulge * radius + kRibCells * cells.size;
        std::vector<float> x, z;
        for (const uint32_t v : slices[i]) {
            if (off(v) > most) {
                if (2 * i > slices.size()) leaf[v] = 1;
                continue;
            }
            x.push_back(cells.centres[v].x);
            z.push_back(cells.centres[v].z);
        }
        if (x.empty()) continue;
        centre = {quantile(x, 0.5), quantile(z, 0.5)};
        std::vector<float> offs;
        for (const uint32_t v : slices[i])
            offs.push_back(static_cast<float>(off(v)));
        radius = std::min<double>(radius, quantile(offs, 0.5));
    }
}

// Where the fronds spring from; the crown's middle where too few leaves are seen there.
DVec3 spring_of(const Cells& cells, const std::vector<uint8_t>& leaf, const Crown& crown, const DVec3& hub) {
    // Fronds that the scan shows on one side only pull the crown's middle there; palms grow upright.
    const DVec3 off = crown.middle - hub;
    if (off.y <= 0.0) return hub;
    const double aside = std::hypot(off.x, off.z);
    const double share = std::min(1.0, kMostLean * off.y / std::max(aside, 1e-9));
    const DVec3 up(share * off.x / off.y, 1.0, share * off.z / off.y);
    std::vector<std::pair<float, uint32_t>> near;  // heights, and cells
    for (uint32_t v = 0; v < cells.count(); v++) {
        const DVec3 way = DVec3(cells.centres[v]) - hub;
        const DVec3 beside = way - way.y * up;
        if (leaf[v] && way.y > 0.0 && std::hypot(beside.x, beside.z) < kNearStem * crown.width)
            near.emplace_back(cells.centres[v].y, v);
    }
    std::sort(near.begin(), near.end());
    const auto window = static_cast<float>(2.0 * kSpringShare * (crown.top.y - hub.y));
    size_t first = 0, count = 0;
    for (size_t begin = 0, end = 0; begin < near.size(); begin++) {
        while (end < near.size() && near[end].first - near[begin].first <= window)
            end++;
        if (end - begin <= count) continue;
        first = begin;
        count = end - begin;
    }
    if (count < kLeastSpring) return hub + off.y * up;
    std::array<std::vector<float>, 3> places;
    for (size_t i = first; i < first + count; i++)
        for (int axis = 0; axis < 3; axis++)
            places[static_cast<size_t>(axis)].push_back(cells.centres[near[i].second][axis]);
    return {middle_of(std::move(places[0])), middle_of(std::move(places[1])),
            middle_of(std::move(places[2]))};
}

// The stem of a palm: all wood, and on from the hub, where fronds begin to hide it, to where they spring
// from.
void follow_stem(const Cells& cells, std::vector<uint8_t>& leaf, const Crown& crown, const DVec3& hub,
                 FollowedBranches& branches) {
    float low = cells.centres[0].y;
    for (const Vec3& p : cells.centres)
        low = std::min(low, p.y);
    clear_stem(cells, leaf, low, hub);
    const DVec3 end = spring_of(cells, leaf, crown, hub);
    const double radius = kStemCells * cells.size;
    std::vector<float> reaches;
    for (size_t v = 0; v < cells.count(); v++) {
        const DVec3 p(cells.centres[v]);
        const double off = distance_to(p, hub, end);
        // Wood off the stem is a frond's rib.
        if (!leaf[v] && p.y > hub.y && off > kRibCells * cells.size) leaf[v] = 1;
        branches.path[v] = !leaf[v] || off < radius;
        if (leaf[v]) reaches.push_back(static_cast<float>(off));
    }
    branches.reach = kReachSlack * quantile(reaches, kReachQuantile);
}

}  // namespace

FollowedBranches follow_branches(const Cells& cells, const CellShapes& shapes, const CellPaths& tree,
                                 std::vector<uint8_t>& leaf, bool palms, const Progress& progress) {
    const size_t count = cells.count();
    FollowedBranches branches;
    branches.path.assign(count, 0);
    const Crown crown = measure_crown(cells, leaf);
    if (crown.cells == 0) {
        branches.path.assign(count, 1);
        return branches;
    }
    clear_foot(cells, crown, leaf);
    progress.check();
    DVec3 hub(0.0);
    branches.fronds = palms && has_fronds(cells, shapes, tree, leaf, crown, hub);
    if (branches.fronds) {
        follow_stem(cells, leaf, crown, hub, branches);
        return branches;
    }
    const auto scale = static_cast<float>(1.0 / cells.size);
    const double hidden_length = std::min(kHiddenShare * crown.extent, kHiddenWidth * 0.5 * crown.width);
    const float least = std::max(kHiddenCells, static_cast<float>(hidden_length) * scale);
    std::vector<uint32_t> wood(count, 0);     // wood cells from here on
    std::vector<float> through(count, 0.0F);  // the longest way onward through leaves alone
    for (auto v = tree.order.rbegin(); v != tree.order.rend(); ++v) {
        wood[*v] += leaf[*v] ? 0 : 1;
        const uint32_t p = tree.parent[*v];
        if (p == *v) continue;
        wood[p] += wood[*v];
        if (!leaf[*v]) continue;
        const float step = scale * glm::distance(cells.centres[p], cells.centres[*v]);
        through[p] = std::max(through[p], through[*v] + step);
    }
    progress.check();
    for (const uint32_t v : tree.order) {
        const uint32_t p = tree.parent[v];
        const bool hangs = p != v && !branches.path[p];
        if (!leaf[v] && hangs && wood[v] < kLeastPiece) leaf[v] = 1;
        branches.path[v] = !leaf[v] || wood[v] >= kLeastPiece || through[v] >= least;
    }
    // Up to the very top, so that the tree keeps its height.
    uint32_t top = 0;
    for (uint32_t v = 1; v < count; v++)
        if (cells.centres[v].y > cells.centres[top].y) top = v;
    for (; !branches.path[top]; top = tree.parent[top])
        branches.path[top] = 1;
    double hidden = 0.0, seen = 0.0;
    for (size_t v = 0; v < count; v++)
        if (branches.path[v] && cells.centres[v].y >= crown.base) (leaf[v] ? hidden : seen) += 1.0;
    branches.hidden_share = hidden + seen > 0.0 ? hidden / (hidden + seen) : 0.0;
    return branches;
}

}  // namespace treerec
