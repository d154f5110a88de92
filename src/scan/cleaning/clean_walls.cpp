#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "geometry/bounds.h"
#include "geometry/cell_grid.h"
#include "geometry/covariance.h"
#include "geometry/groups.h"
#include "geometry/quantile.h"
#include "geometry/random.h"
#include "scan/check_shape.h"
#include "scan/cleaning/clean_steps.h"
#include "scan/cleaning/samples.h"
#include "scan/robust.h"

namespace treerec {

namespace {

// Shares of the cloud's extent.
constexpr double kNear = 0.01;  // from a plane, to be looked at as one of its points
constexpr double kSquare =
    0.0125;  // one point of each cube so wide tries planes: wide things count, dense don't
constexpr double kLeastLong = 0.2;  // sides of a wall,
constexpr double kLeastShort = 0.08;
constexpr double kTouching = 0.025;  // what hangs on a wall: a gap in it, or between it and the wall,
constexpr double kHangsOut = 0.15;   // and how far it reaches out
constexpr double kThinnest = 0.001;  // what lies so far off it is of the wall, however even that is
// Others.
constexpr int kTrials = 500;
constexpr size_t kMostTried = 4096;
constexpr double kLeastShare = 0.05;  // of the cubes with points: on a wall
constexpr double kSteepest = 0.2;     // run over rise of what still counts as upright
constexpr int kRefinements = 4;
constexpr double kSharp = 0.5;  // of kNear: a wall's standard deviation; spread evenly, it would be .74
constexpr double kThick = 4.0;  // standard deviations that a wall is thick, to either side
constexpr double kPointsPerCell = 6.0;  // of a wall, whose cells are as wide as that needs
constexpr int kFewestCells = 4;         // along the shorter side
constexpr double kLeastFilled = 0.5;    // share of the wall's cells that hold points
constexpr double kClear = 0.5;       // of a cell's points: as many may lie right before the wall, or behind,
constexpr double kLeastClear = 0.6;  // in so many of its cells; before a crown's or hedge's face lie as many
constexpr size_t kMostWalls = 3;     // more are a room or a house
constexpr double kMostFlat = 0.5;    // share of the rest on flat surfaces
constexpr size_t kLookedAt = 2048;   // points, for that
constexpr double kLeastRest = 0.1;   // of the points

// A plane: all p with dot(p, normal) = offset.
struct Plane {
    DVec3 normal{1.0, 0.0, 0.0};
    double offset = 0.0;

    double off(const Vec3& p) const { return glm::dot(DVec3(p), normal) - offset; }
};

// The upright plane near most of the points (Fischler and Bolles 1981); each two of them tell one.
Plane best_plane(const std::vector<Vec3>& points, const std::vector<uint32_t>& left, double near,
                 Random& random) {
    Plane best;
    size_t most = 0;
    const size_t stride = left.size() / kMostTried + 1;
    const uint32_t count = static_cast<uint32_t>(left.size());
    for (int trial = 0; trial < kTrials; trial++) {
        const DVec3 a(points[left[random.below(count)]]);
        const DVec3 b(points[left[random.below(count)]]);
        const DVec3 across(b.z - a.z, 0.0, a.x - b.x);
        const double length = glm::length(across);
        if (length < 10.0 * near) continue;
        const Plane plane{across / length, glm::dot(a, across / length)};
        size_t hits = 0;
        for (size_t i = 0; i < left.size(); i += stride)
            hits += std::abs(plane.off(points[left[i]])) <= near;
        if (hits <= most) continue;
        most = hits;
        best = plane;
    }
    return best;
}

// Least squares through the points near it; what is not upright then stays as it was.
Plane refined(const Plane& plane, const std::vector<Vec3>& points, const std::vector<uint32_t>& left,
              double near) {
    std::vector<Vec3> on;
    for (const uint32_t i : left)
        if (std::abs(plane.off(points[i])) <= near) on.push_back(points[i]);
    if (on.size() < 3) return plane;
    const DMat3 covariance = covariance_of(on);
    // The least axis, by power iteration on what is left of the trace.
    const double trace = covariance[0][0] + covariance[1][1] + covariance[2][2];
    const DMat3 turned = DMat3(trace) - covariance;
    DVec3 normal = plane.normal;
    for (int i = 0; i < 64; i++)
        normal = normalized_or(turned * normal, normal);
    if (std::abs(normal.y) > kSteepest) return plane;
    DVec3 mean(0.0);
    for (const Vec3& p : on)
        mean += DVec3(p) / static_cast<double>(on.size());
    return {normal, glm::dot(mean, normal)};
}

// The cells of a plane, along the wall and up.
struct Cells {
    DVec3 along{1.0, 0.0, 0.0};
    DVec3 up{0.0, 1.0, 0.0};
    DVec2 low{0.0};
    double size = 1.0;
    int width = 0;
    int height = 0;

    Cells(const Plane& plane, const std::vector<Vec3>& points, const std::vector<uint32_t>& on) {
        along = glm::normalize(glm::cross(plane.normal, DVec3(0.0, 1.0, 0.0)));
        up = glm::cross(along, plane.normal);
        std::vector<float> us, vs;
        for (const uint32_t i : on) {
            us.push_back(static_cast<float>(glm::dot(DVec3(points[i]), along)));
            vs.push_back(static_cast<float>(glm::dot(DVec3(points[i]), up)));
        }
        low = {quantile(us, 0.005), quantile(vs, 0.005)};
        const DVec2 span = DVec2(quantile(us, 0.995), quantile(vs, 0.995)) - low;
        if (!(span.x > 0.0) || !(span.y > 0.0)) return;
        size = std::sqrt(span.x * span.y * kPointsPerCell / static_cast<double>(on.size()));
        width = static_cast<int>(std::min(span.x / size, 4096.0)) + 1;
        height = static_cast<int>(std::min(span.y / size, 4096.0)) + 1;
    }
    size_t count() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
    // -1 outside.
    int of(const Vec3& p) const {
        const double u = (glm::dot(DVec3(p), along) - low.x) / size;
        const double v = (glm::dot(DVec3(p), up) - low.y) / size;
        if (!(u >= 0.0 && u < width && v >= 0.0 && v < height)) return -1;
        return static_cast<int>(v) * width + static_cast<int>(u);
    }
    template <typename Body>
    void each_beside(int c, const Body& body) const {
        for (int v = std::max(0, c / width - 1); v <= std::min(height - 1, c / width + 1); v++)
            for (int u = std::max(0, c % width - 1); u <= std::min(width - 1, c % width + 1); u++)
                body(v * width + u);
    }
};

// The largest connected part of the cells that hold points, 1 for its cells; its box in `low` and `high`.
std::vector<uint8_t> largest_part(const Cells& cells, const std::vector<uint32_t>& held, DVec2& low,
                                  DVec2& high, size_t& filled) {
    Groups groups(held.size());
    for (size_t c = 0; c < held.size(); c++)
        if (held[c] > 0)
            cells.each_beside(static_cast<int>(c), [&](int other) {
                if (held[static_cast<size_t>(other)] > 0)
                    groups.join(static_cast<uint32_t>(c), static_cast<uint32_t>(other));
            });
    std::vector<uint32_t> members(held.size());
    for (size_t c = 0; c < held.size(); c++)
        if (held[c] > 0) members[groups.find(static_cast<uint32_t>(c))]++;
    const auto largest =
        static_cast<uint32_t>(std::max_element(members.begin(), members.end()) - members.begin());
    filled = members[largest];
    std::vector<uint8_t> part(held.size());
    low = DVec2(cells.width, cells.height);
    high = DVec2(0.0);
    for (size_t c = 0; c < held.size(); c++) {
        if (held[c] == 0 || groups.find(static_cast<uint32_t>(c)) != largest) continue;
        part[c] = 1;
        const DVec2 at(static_cast<int>(c) % cells.width, static_cast<int>(c) / cells.width);
        low = glm::min(low, at);
        high = glm::max(high, at + 1.0);
    }
    return part;
}

struct Wall {
    std::vector<uint32_t> points;
    double length = 0.0;
    double height = 0.0;
    Plane plane;
    Bounds bounds;  // of its points
    double thick = 0.0;
};

// Which of the points are of the wall in that plane; none where there is none. left: ascending.
std::optional<Wall> wall_in(Plane plane, const std::vector<Vec3>& points, const std::vector<uint32_t>& left,
                            double extent) {
    const double near = kNear * extent;
    for (int round = 0; round < kRefinements; round++)
        plane = refined(plane, points, left, (round == 0 ? 2.0 : 1.0) * near);
    std::vector<uint32_t> on;
    for (const uint32_t i : left)
        if (std::abs(plane.off(points[i])) <= near) on.push_back(i);
    if (on.size() < 64) return std::nullopt;
    std::vector<double> offs;
    for (const uint32_t i : on)
        offs.push_back(std::abs(plane.off(points[i])));
    const double deviation = 1.4826 * quantile(offs, 0.5);
    if (deviation > kSharp * near) return std::nullopt;
    const double thick = std::max(kThick * deviation, kThinnest * extent);
    std::erase_if(on, [&](uint32_t i) { return std::abs(plane.off(points[i])) > thick; });
    const Cells cells(plane, points, on);
    if (cells.count() == 0) return std::nullopt;
    std::vector<uint32_t> held(cells.count());
    for (const uint32_t i : on)
        if (const int c = cells.of(points[i]); c >= 0) held[static_cast<size_t>(c)]++;
    DVec2 low, high;
    size_t filled = 0;
    std::vector<uint8_t> part = largest_part(cells, held, low, high, filled);
    const DVec2 span = high - low;
    const double longer = std::max(span.x, span.y), shorter = std::min(span.x, span.y);
    if (longer * cells.size < kLeastLong * extent || shorter * cells.size < kLeastShort * extent ||
        shorter < kFewestCells || static_cast<double>(filled) < kLeastFilled * span.x * span.y)
        return std::nullopt;
    std::array<std::vector<uint32_t>, 2> beside{std::vector<uint32_t>(cells.count()),
                                                std::vector<uint32_t>(cells.count())};
    for (const uint32_t i : left) {
        const double off = plane.off(points[i]);
        if (std::abs(off) <= thick || std::abs(off) > 3.0 * thick) continue;
        if (const int c = cells.of(points[i]); c >= 0) beside[off < 0.0][static_cast<size_t>(c)]++;
    }
    size_t clear = 0;
    for (size_t c = 0; c < held.size(); c++)
        clear += part[c] && std::max(beside[0][c], beside[1][c]) <= kClear * held[c];
    if (static_cast<double>(clear) < kLeastClear * static_cast<double>(filled)) return std::nullopt;
    // With its edge, where the cells are not whole.
    std::vector<uint8_t> wide = part;
    for (size_t c = 0; c < part.size(); c++)
        if (part[c])
            cells.each_beside(static_cast<int>(c), [&](int other) { wide[static_cast<size_t>(other)] = 1; });
    Wall wall;
    wall.length = span.x * cells.size;
    wall.height = span.y * cells.size;
    wall.plane = plane;
    wall.thick = thick;
    for (const uint32_t i : left) {
        if (std::abs(plane.off(points[i])) > thick) continue;
        // Beyond the cells, what is nearest to an edge of the wall counts as well.
        const double u = (glm::dot(DVec3(points[i]), cells.along) - cells.low.x) / cells.size;
        const double v = (glm::dot(DVec3(points[i]), cells.up) - cells.low.y) / cells.size;
        if (u < -1.0 || v < -1.0 || u > cells.width + 1.0 || v > cells.height + 1.0) continue;
        const int x = std::clamp(static_cast<int>(u), 0, cells.width - 1);
        const int y = std::clamp(static_cast<int>(v), 0, cells.height - 1);
        if (!wide[static_cast<size_t>(y * cells.width + x)]) continue;
        wall.points.push_back(i);
        wall.bounds.add(DVec3(points[i]));
    }
    return wall;
}

// Marks what hangs on the walls: sills, lamps, pipes. It touches nothing else, and does not reach far out.
void find_hangings(const std::vector<Vec3>& points, const std::vector<uint32_t>& left,
                   const std::vector<Wall>& walls, double extent, const std::array<Range, 3>& ranges,
                   std::vector<uint8_t>& goes, const Progress* progress) {
    std::vector<Vec3> rest;
    for (const uint32_t i : left)
        rest.push_back(points[i]);
    if (rest.empty()) return;
    const double cell = kTouching * extent;
    const std::vector<uint32_t> label = connected_components(rest, ranges, cell, progress);
    std::vector<size_t> size(*std::max_element(label.begin(), label.end()) + size_t{1});
    for (const uint32_t l : label)
        size[l]++;
    const auto tree = static_cast<uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
    for (const Wall& wall : walls) {
        std::vector<double> nearest(size.size(), std::numeric_limits<double>::max());
        std::vector<double> farthest(size.size(), 0.0);
        for (size_t k = 0; k < rest.size(); k++) {
            const DVec3 p(rest[k]);
            const double off = std::abs(wall.plane.off(rest[k]));
            const DVec3 beyond = glm::max(wall.bounds.min - p, p - wall.bounds.max);
            const bool before = std::max({beyond.x, beyond.y, beyond.z}) < kHangsOut * extent;
            nearest[label[k]] = std::min(nearest[label[k]], off);
            farthest[label[k]] =
                before ? std::max(farthest[label[k]], off) : std::numeric_limits<double>::max();
        }
        for (size_t k = 0; k < rest.size(); k++)
            if (label[k] != tree && nearest[label[k]] < wall.thick + cell &&
                farthest[label[k]] < kHangsOut * extent)
                goes[left[k]] = 1;
    }
}

}  // namespace

std::vector<uint8_t> find_walls(const std::vector<Vec3>& points, std::vector<DVec2>& walls,
                                const Progress* progress) {
    std::vector<uint8_t> goes(points.size());
    walls.clear();
    if (points.size() < 500) return goes;
    const std::array<Range, 3> ranges = robust_ranges(points, progress);
    const double extent = std::max({ranges[0].size(), ranges[1].size(), ranges[2].size()});
    if (!(extent > 0.0)) return goes;
    const CellGrid grid(points, {{ranges[0].low, ranges[1].low, ranges[2].low}, kSquare * extent}, progress);
    std::vector<uint32_t> left(points.size());
    std::iota(left.begin(), left.end(), 0U);
    std::vector<Wall> found;
    Random random(1);
    for (;;) {
        if (progress) progress->check();
        // A cube that holds a point which is left.
        std::vector<uint32_t> tried;
        for (size_t c = 0; c < grid.size(); c++)
            for (const uint32_t i : grid.in_cell(c))
                if (!goes[i]) {
                    tried.push_back(i);
                    break;
                }
        if (tried.size() < 64) break;
        const Plane plane = best_plane(points, tried, kNear * extent, random);
        size_t near = 0;
        for (const uint32_t i : tried)
            near += std::abs(plane.off(points[i])) <= kNear * extent;
        if (static_cast<double>(near) < kLeastShare * static_cast<double>(tried.size())) break;
        std::optional<Wall> wall = wall_in(plane, points, left, extent);
        if (!wall) break;
        walls.emplace_back(wall->length, wall->height);
        for (const uint32_t i : wall->points)
            goes[i] = 1;
        std::erase_if(left, [&](uint32_t i) { return goes[i] != 0; });
        found.push_back(std::move(*wall));
        if (walls.size() > kMostWalls) break;
    }
    std::vector<Vec3> rest;
    for (const uint32_t i : left)
        rest.push_back(points[i]);
    const bool no_tree =
        walls.size() > kMostWalls ||
        static_cast<double>(rest.size()) < kLeastRest * static_cast<double>(points.size()) ||
        (!walls.empty() && share_on_surfaces(some_of(rest, kLookedAt, progress), progress) > kMostFlat);
    if (no_tree) {
        walls.clear();
        goes.assign(points.size(), 0);
    } else if (!found.empty()) {
        find_hangings(points, left, found, extent, ranges, goes, progress);
    }
    return goes;
}

}  // namespace treerec
