#include "scan/check_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "geometry/cell_grid.h"
#include "geometry/covariance.h"
#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "geometry/symmetric_eigen.h"
#include "scan/robust.h"

namespace treerec {

namespace {

constexpr size_t kFewestPoints = 10;
constexpr double kFlat = 1e-4;           // of the extent
constexpr size_t kLookedAt = 2048;       // points
constexpr double kSurface = 0.01;        // of the extent: how near a surface its points are
constexpr int kSurfaces = 6;             // a room has as many
constexpr double kBeside = 0.7;          // of the points on a surface: as many may lie right beside it
constexpr double kMostOnSurfaces = 0.6;  // share of the points on flat surfaces
constexpr double kEven = 0.7;            // share of the box that holds points
constexpr double kMostCells = 30000.0;   // in the box
constexpr double kShell = 0.06;          // of its radius: how thick the surface of a ball is

std::array<double, 3> spreads(const std::vector<Vec3>& points) {
    const DMat3 covariance = covariance_of(points);
    SquareMatrix<3> matrix;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            matrix[i][j] = covariance[i][j];
    std::array<double, 3> values = symmetric_eigen(matrix).values;
    std::sort(values.begin(), values.end());
    for (double& v : values)
        v = std::sqrt(std::max(0.0, v));
    return values;
}

struct Flat {
    DVec3 normal{0.0, 1.0, 0.0};
    double offset = 0.0;
    size_t beside = 0;  // points up to three times as far away
    std::vector<uint32_t> points;
};

// The plane near most points (Fischler and Bolles 1981).
Flat best_flat(const std::vector<Vec3>& points, const std::vector<uint32_t>& left, double near,
               Random& random) {
    Flat best;
    size_t most = 0;
    const uint32_t count = static_cast<uint32_t>(left.size());
    const size_t stride = std::max<size_t>(1, left.size() / 256);
    for (int trial = 0; trial < 400; trial++) {
        const DVec3 a(points[left[random.below(count)]]);
        const DVec3 b(points[left[random.below(count)]]);
        const DVec3 c(points[left[random.below(count)]]);
        const DVec3 normal = glm::cross(b - a, c - a);
        const double length = glm::length(normal);
        if (!(length > 100.0 * near * near)) continue;
        const DVec3 unit = normal / length;
        size_t hits = 0;
        for (size_t i = 0; i < left.size(); i += stride)
            hits += std::abs(glm::dot(DVec3(points[left[i]]) - a, unit)) <= near;
        if (hits <= most) continue;
        most = hits;
        best.normal = unit;
        best.offset = glm::dot(a, unit);
    }
    for (const uint32_t i : left) {
        const double distance = std::abs(glm::dot(DVec3(points[i]), best.normal) - best.offset);
        if (distance <= near)
            best.points.push_back(i);
        else if (distance <= 3.0 * near)
            best.beside++;
    }
    return best;
}

// Whether the points fill a part of their plane that is wide both ways and have little beside it, as a wall
// does and a slice through a tree does not.
bool is_surface(const std::vector<Vec3>& points, const Flat& flat, double extent) {
    if (static_cast<double>(flat.beside) > kBeside * static_cast<double>(flat.points.size())) return false;
    const DVec3 u = any_perpendicular(flat.normal);
    const DVec3 v = glm::cross(flat.normal, u);
    constexpr int kGrid = 24;
    std::vector<float> us;
    std::vector<float> vs;
    for (const uint32_t i : flat.points) {
        us.push_back(static_cast<float>(glm::dot(DVec3(points[i]), u)));
        vs.push_back(static_cast<float>(glm::dot(DVec3(points[i]), v)));
    }
    std::vector<float> sorted = us;
    const double u_low = quantile(sorted, 0.02);
    const double u_size = quantile(sorted, 0.98) - u_low;
    sorted = vs;
    const double v_low = quantile(sorted, 0.02);
    const double v_size = quantile(sorted, 0.98) - v_low;
    if (std::min(u_size, v_size) < 0.2 * extent) return false;
    std::array<uint8_t, kGrid * kGrid> filled{};
    // Few points cannot fill many squares.
    const int grid =
        std::clamp(static_cast<int>(std::sqrt(static_cast<double>(flat.points.size()) / 4.0)), 3, kGrid);
    for (size_t i = 0; i < us.size(); i++) {
        const int x = static_cast<int>(std::floor((us[i] - u_low) / u_size * grid));
        const int y = static_cast<int>(std::floor((vs[i] - v_low) / v_size * grid));
        if (x >= 0 && y >= 0 && x < grid && y < grid) filled[static_cast<size_t>(y * grid + x)] = 1;
    }
    const auto count = std::count(filled.begin(), filled.end(), uint8_t{1});
    // The plane's own axes are not the wall's: a turned square fills half of its box.
    return static_cast<double>(count) >= 0.45 * grid * grid;
}

// The share of the box that holds points, in cells for two points each: 86 % where they are spread at random.
double evenness(std::span<const Vec3> points, const std::array<Range, 3>& ranges, const Progress* progress) {
    const double volume = ranges[0].size() * ranges[1].size() * ranges[2].size();
    const double wanted = std::min(0.5 * static_cast<double>(points.size()), kMostCells);
    const double cell = portable::cbrt(volume / wanted);
    if (!(cell > 0.0)) return 0.0;
    double cells = 1.0;
    for (const Range& range : ranges)
        cells *= std::max(1.0, range.size() / cell);
    const CellLayout layout{{ranges[0].low, ranges[1].low, ranges[2].low}, cell};
    return static_cast<double>(count_cells(points, layout, points.size(), progress)) / cells;
}

bool is_ball(const std::vector<Vec3>& points, const std::array<Range, 3>& ranges) {
    const DVec3 centre(0.5 * (ranges[0].low + ranges[0].high), 0.5 * (ranges[1].low + ranges[1].high),
                       0.5 * (ranges[2].low + ranges[2].high));
    std::vector<double> radii;
    for (const Vec3& p : points)
        radii.push_back(glm::distance(DVec3(p), centre));
    const double low = quantile(radii, 0.1);
    const double high = quantile(radii, 0.9);
    return high - low < 2.0 * kShell * high;
}

}  // namespace

double share_on_surfaces(const std::vector<Vec3>& points, const Progress* progress) {
    if (points.empty()) return 0.0;
    const std::array<Range, 3> ranges = robust_ranges(points, progress);
    const double extent = std::max({ranges[0].size(), ranges[1].size(), ranges[2].size()});
    Random random(1);
    std::vector<uint32_t> left(points.size());
    for (uint32_t i = 0; i < left.size(); i++)
        left[i] = i;
    size_t on_surfaces = 0;
    for (int round = 0; round < kSurfaces && left.size() > 50; round++) {
        if (progress) progress->check();
        const Flat flat = best_flat(points, left, kSurface * extent, random);
        if (flat.points.size() * 20 < points.size()) break;
        if (is_surface(points, flat, extent)) on_surfaces += flat.points.size();
        // The largest surfaces come first.
        if (round == 1 && on_surfaces == 0) break;
        std::vector<uint32_t> rest;
        std::set_difference(left.begin(), left.end(), flat.points.begin(), flat.points.end(),
                            std::back_inserter(rest));
        left.swap(rest);
    }
    return static_cast<double>(on_surfaces) / static_cast<double>(points.size());
}

std::vector<std::string> check_shape(const PointCloud& cloud, const Progress* progress) {
    std::vector<Vec3> points = some_of(cloud.positions, kLookedAt, progress);
    // In an order of their own.
    std::sort(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) {
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    });
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < kFewestPoints)
        throw Error("The cloud has points in only " + std::to_string(points.size()) +
                    (points.size() == 1 ? " place" : " places") +
                    ", and a tree needs at least 10. Check that the file is complete.");
    const std::array<double, 3> spread = spreads(points);
    if (spread[1] <= kFlat * spread[2])
        throw Error(
            "All points lie on one straight line, so there is no tree in the cloud. Check that it is "
            "the right file and that its columns are read as meant.");
    if (spread[0] <= kFlat * spread[2])
        throw Error(
            "All points lie on one plane, so there is no tree in the cloud. Check that the file is the right "
            "one and its columns are read as meant.");
    std::vector<std::string> warnings;
    if (points.size() < 200) return warnings;
    const std::array<Range, 3> ranges = robust_ranges(points, progress);
    const double flat = share_on_surfaces(points, progress);
    if (flat > kMostOnSurfaces)
        warnings.push_back(
            std::to_string(std::lround(100.0 * flat)) +
            " % of the points lie on flat surfaces, as on walls or on the ground; what is made "
            "of them is hardly a tree.");
    else if (is_ball(points, ranges))
        warnings.emplace_back(
            "The points lie on the surface of a ball; what is made of them is hardly a tree.");
    else if (evenness(cloud.positions, ranges, progress) > kEven)
        warnings.emplace_back(
            "The points are spread evenly, as noise is; what is made of them is hardly a tree.");
    return warnings;
}

}  // namespace treerec
