#include "skeleton/thin.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "geometry/bounds.h"
#include "geometry/cell_grid.h"
#include "geometry/parallel.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr size_t kCellsPerTask = 1024;

bool finite(const Vec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

bool before(const Vec3& a, const Vec3& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

Bounds finite_bounds(const std::vector<Vec3>& points, size_t& count) {
    Bounds bounds;
    Vec3 low(std::numeric_limits<float>::max());
    Vec3 high(std::numeric_limits<float>::lowest());
    count = 0;
    for (const Vec3& p : points) {
        if (!finite(p)) continue;
        low = glm::min(low, p);
        high = glm::max(high, p);
        count++;
    }
    if (count == 0) return bounds;
    bounds.add(DVec3(low));
    bounds.add(DVec3(high));
    return bounds;
}

// Never so small that the cells of one axis would outgrow their bits.
CellLayout safe_layout(const Bounds& bounds, double spacing) {
    const DVec3 size = bounds.size();
    const double least = std::max({size.x, size.y, size.z}) / (CellLayout::kMostCells - 2.0);
    // A cloud that is one place has one cell of any size.
    return {bounds.min, std::max({spacing, least, std::numeric_limits<double>::min()})};
}

// The one of `members` nearest to the mean of the distinct ones. members: gets reordered.
Vec3 middle_of(std::vector<Vec3>& members) {
    if (members.size() == 1) return members.front();
    std::sort(members.begin(), members.end(), before);
    members.erase(std::unique(members.begin(), members.end()), members.end());
    DVec3 mean(0.0);
    for (const Vec3& p : members)
        mean += DVec3(p);
    mean /= static_cast<double>(members.size());
    size_t best = 0;
    double best_distance = std::numeric_limits<double>::max();
    for (size_t i = 0; i < members.size(); i++) {
        const DVec3 offset = DVec3(members[i]) - mean;
        const double distance = glm::dot(offset, offset);
        if (distance < best_distance) {
            best_distance = distance;
            best = i;
        }
    }
    return members[best];
}

}  // namespace

std::vector<Vec3> thin_points(const std::vector<Vec3>& points, double spacing, Progress& progress) {
    progress.check();
    size_t count = 0;
    const Bounds bounds = finite_bounds(points, count);
    if (count == 0) return {};
    if (count < points.size()) {
        std::vector<Vec3> good;
        good.reserve(count);
        std::copy_if(points.begin(), points.end(), std::back_inserter(good), finite);
        return thin_points(good, spacing, progress);
    }
    const CellGrid grid(points, safe_layout(bounds, spacing), &progress);
    std::vector<Vec3> thinned(grid.size());
    parallel_for(grid.size(), kCellsPerTask, [&](size_t begin, size_t end) {
        progress.check();
        std::vector<Vec3> members;
        for (size_t c = begin; c < end; c++) {
            members.clear();
            for (const uint32_t i : grid.in_cell(c))
                members.push_back(points[i]);
            thinned[c] = middle_of(members);
        }
    });
    return thinned;
}

double automatic_spacing(const std::vector<Vec3>& points, const Progress* progress) {
    size_t finite_count = 0;
    const Bounds bounds = finite_bounds(points, finite_count);
    double spacing = std::max(std::clamp(bounds.diagonal() / 2000.0, 0.001, 0.02), bounds.diagonal() * 1e-5);
    if (finite_count <= kMostPoints) return spacing;
    std::vector<Vec3> good;
    if (finite_count < points.size())
        std::copy_if(points.begin(), points.end(), std::back_inserter(good), finite);
    const std::vector<Vec3>& counted = good.empty() ? points : good;
    // The count falls with some power of the spacing: 2 for a dense surface, next to 0 where the points are
    // far apart already. Two counts tell the power.
    constexpr double kWanted = 0.99 * kMostPoints;
    double power = 2.0;
    double last_spacing = 0.0;
    double last_count = 0.0;
    for (;;) {
        const double count =
            static_cast<double>(guess_cells(counted, safe_layout(bounds, spacing), progress));
        if (count <= kWanted) break;
        if (last_count > count)
            power = portable::log(last_count / count) / portable::log(spacing / last_spacing);
        last_spacing = spacing;
        last_count = count;
        const double excess = count / kWanted;
        spacing *= std::clamp(portable::pow(excess, 1.0 / std::clamp(power, 0.2, 3.0)), 1.01,
                              excess > 4.0 ? 2.0 : 1.3);
    }
    while (count_cells(counted, safe_layout(bounds, spacing), kMostPoints, progress) > kMostPoints)
        spacing *= 1.02;
    return spacing;
}

}  // namespace treerec
