#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "geometry/quantile.h"
#include "geometry/random.h"
#include "scan/cleaning/clean_steps.h"
#include "scan/cleaning/samples.h"
#include "scan/robust.h"

namespace treerec {

namespace {

constexpr double kBelow = 0.05;       // of a layer that lies below a surface along its lowest points, at most
constexpr double kSteepest = 0.7;     // rise over run of the ground, 35 degrees
constexpr double kLowPart = 0.3;      // of the height: where ground may lie
constexpr double kLeastFilled = 0.4;  // share of the squares around that hold ground
constexpr size_t kFewestColumns = 30;  // with ground
constexpr double kPlant = 0.1;         // of the tree's height: what ends lower is none of it
constexpr double kGrass = 0.04;        // likewise: as high as it may be
constexpr size_t kBlades = 4;          // points: fewer, above the grass of a column or alone, are of blades,
constexpr double kBladeShare = 0.2;    // if they are no more than that share of the column's lower ones
constexpr int kTrials = 300;           // planes tried
constexpr size_t kMostTried = 4096;    // low points that they are tried on
constexpr int kWindow = 4;             // columns to each side that foretell how the ground runs on
constexpr double kMostAcross = 512.0;  // columns along an axis
constexpr double kFewestAcross = 24.0;

// Square columns over the XZ plane, with the lowest point of each.
class Columns {
  public:
    Columns(const std::vector<Vec3>& points, const std::array<Range, 3>& ranges, double cell)
        : x_(ranges[0]), z_(ranges[2]), cell_(cell) {
        width_ = static_cast<int>(x_.size() / cell_) + 1;
        depth_ = static_cast<int>(z_.size() / cell_) + 1;
        lowest_.assign(static_cast<size_t>(width_) * static_cast<size_t>(depth_), -1);
        for (size_t i = 0; i < points.size(); i++) {
            const int c = column_of(points[i]);
            if (c < 0 || !ranges[1].contains(points[i].y)) continue;
            int32_t& low = lowest_[static_cast<size_t>(c)];
            if (low < 0 || points[i].y < points[static_cast<size_t>(low)].y) low = static_cast<int32_t>(i);
        }
    }

    // -1 outside.
    int column_of(const Vec3& p) const {
        if (!x_.contains(p.x) || !z_.contains(p.z)) return -1;
        return static_cast<int>((p.z - z_.low) / cell_) * width_ + static_cast<int>((p.x - x_.low) / cell_);
    }
    const std::vector<int32_t>& lowest() const { return lowest_; }
    int width() const { return width_; }
    int depth() const { return depth_; }

  private:
    Range x_;
    Range z_;
    double cell_;
    int width_ = 0;
    int depth_ = 0;
    std::vector<int32_t> lowest_;  // by column; -1 where it is empty
};

bool plane_through(const Vec3& a, const Vec3& b, const Vec3& c, Ground& plane) {
    const DVec3 normal = glm::cross(DVec3(b) - DVec3(a), DVec3(c) - DVec3(a));
    if (std::abs(normal.y) < 1e-9 || !is_finite(normal)) return false;
    plane.centre = DVec2(a.x, a.z);
    plane.height = a.y;
    plane.slope = DVec2(-normal.x / normal.y, -normal.z / normal.y);
    return glm::length(plane.slope) <= kSteepest;
}

// Least squares through the points within `tolerance` of `plane`.
Ground refine(const std::vector<Vec3>& points, const Ground& plane, double tolerance) {
    DVec3 mean(0.0);
    double count = 0.0;
    for (const Vec3& p : points) {
        if (std::abs(plane.above_plane(p)) > tolerance) continue;
        mean += DVec3(p);
        count += 1.0;
    }
    if (count < 3.0) return plane;
    mean /= count;
    double xx = 0.0, xz = 0.0, zz = 0.0, xy = 0.0, zy = 0.0;
    for (const Vec3& p : points) {
        if (std::abs(plane.above_plane(p)) > tolerance) continue;
        const DVec3 d = DVec3(p) - mean;
        xx += d.x * d.x;
        xz += d.x * d.z;
        zz += d.z * d.z;
        xy += d.x * d.y;
        zy += d.z * d.y;
    }
    const double determinant = xx * zz - xz * xz;
    if (determinant < 1e-9 * xx * zz || !(xx * zz > 0.0)) return plane;
    Ground better;
    better.centre = DVec2(mean.x, mean.z);
    better.height = mean.y;
    better.slope = DVec2(xy * zz - zy * xz, zy * xx - xy * xz) / determinant;
    return glm::length(better.slope) <= kSteepest ? better : plane;
}

// The plane near most of the low points (Fischler and Bolles 1981), refined; inliers: how many are near it.
Ground best_plane(const std::vector<Vec3>& all, double tolerance, size_t& inliers, const Progress* progress) {
    // Every n-th column tells as much as all of them.
    const size_t stride = (all.size() + kMostTried - 1) / kMostTried;
    std::vector<Vec3> low;
    for (size_t i = 0; i < all.size(); i += stride)
        low.push_back(all[i]);
    if (progress) progress->check();
    Random random(1);
    Ground best;
    inliers = 0;
    auto count_near = [&](const Ground& plane) {
        return static_cast<size_t>(std::count_if(low.begin(), low.end(), [&](const Vec3& p) {
            return std::abs(plane.above_plane(p)) <= tolerance;
        }));
    };
    const uint32_t size = static_cast<uint32_t>(low.size());
    for (int trial = 0; trial < kTrials; trial++) {
        Ground plane;
        const Vec3& a = low[random.below(size)];
        const Vec3& b = low[random.below(size)];
        if (!plane_through(a, b, low[random.below(size)], plane)) continue;
        const size_t near = count_near(plane);
        if (near <= inliers) continue;
        inliers = near;
        best = plane;
    }
    for (int round = 0; round < 3; round++)
        best = refine(all, best, tolerance);
    inliers = static_cast<size_t>(std::count_if(
        all.begin(), all.end(), [&](const Vec3& p) { return std::abs(best.above_plane(p)) <= tolerance; }));
    return best;
}

// Whether the columns with ground are a filled area, not a stem's foot or the rim of a crown. Looked at in
// squares of 2 x 2 columns, so that a sparse ground is filled as well.
bool is_wide_and_filled(const Columns& columns, const std::vector<uint8_t>& has_ground) {
    const int width = (columns.width() + 1) / 2;
    const int depth = (columns.depth() + 1) / 2;
    std::vector<uint8_t> filled(static_cast<size_t>(width) * static_cast<size_t>(depth));
    for (int z = 0; z < columns.depth(); z++)
        for (int x = 0; x < columns.width(); x++)
            filled[static_cast<size_t>(z / 2 * width + x / 2)] |=
                has_ground[static_cast<size_t>(z * columns.width() + x)];
    size_t count = 0;
    DVec2 mean(0.0);
    auto each = [&](const auto& body) {
        for (int z = 0; z < depth; z++)
            for (int x = 0; x < width; x++)
                if (filled[static_cast<size_t>(z * width + x)]) body(DVec2(x, z));
    };
    each([&](const DVec2& c) {
        mean += c;
        count++;
    });
    if (count < kFewestColumns / 2) return false;
    mean /= static_cast<double>(count);
    double xx = 0.0, xz = 0.0, zz = 0.0;
    each([&](const DVec2& c) {
        const DVec2 d = c - mean;
        xx += d.x * d.x;
        xz += d.x * d.y;
        zz += d.y * d.y;
    });
    const double n = static_cast<double>(count);
    xx /= n, xz /= n, zz /= n;
    const double middle = 0.5 * (xx + zz);
    const double split = std::sqrt(0.25 * (xx - zz) * (xx - zz) + xz * xz);
    // A filled ellipse with these second moments has the area 4 pi sqrt(det), here in columns.
    const double area = 4.0 * kPi * std::sqrt(std::max(0.0, (middle - split) * (middle + split)));
    return middle - split > 0.8 && n > kLeastFilled * area;
}

// How the ground runs at column (x, z), above the plane, by the columns with ground around it; not finite
// where these are too few.
double foretell(const Columns& columns, const std::vector<uint8_t>& has_ground,
                const std::vector<float>& relief, int x, int z) {
    double n = 0.0, xx = 0.0, xz = 0.0, zz = 0.0, mean = 0.0, xr = 0.0, zr = 0.0, mx = 0.0, mz = 0.0;
    for (int dz = std::max(-kWindow, -z); dz <= std::min(kWindow, columns.depth() - 1 - z); dz++) {
        for (int dx = std::max(-kWindow, -x); dx <= std::min(kWindow, columns.width() - 1 - x); dx++) {
            const size_t c = static_cast<size_t>((z + dz) * columns.width() + x + dx);
            if (!has_ground[c]) continue;
            const double r = static_cast<double>(relief[c]);
            n += 1.0, mean += r, mx += dx, mz += dz;
            xx += dx * dx, xz += dx * dz, zz += dz * dz, xr += dx * r, zr += dz * r;
        }
    }
    if (n < 6.0) return std::numeric_limits<double>::quiet_NaN();
    mean /= n, mx /= n, mz /= n;
    xx -= n * mx * mx, xz -= n * mx * mz, zz -= n * mz * mz, xr -= n * mx * mean, zr -= n * mz * mean;
    const double determinant = xx * zz - xz * xz;
    // A slope from a narrow strip of columns would be a guess.
    if (determinant < 0.05 * (xx + zz) * (xx + zz)) return mean;
    return mean - mx * (xr * zz - zr * xz) / determinant - mz * (zr * xx - xr * xz) / determinant;
}

// Lets the ground grow from the columns on the plane over those next to it, as far as it runs on smoothly,
// and writes its relief: in every column the height of the nearest columns with ground.
void follow_relief(const std::vector<Vec3>& points, const Columns& columns, Ground& ground,
                   std::vector<uint8_t>& has_ground, const Progress* progress) {
    const int width = columns.width();
    const int depth = columns.depth();
    ground.relief.assign(has_ground.size(), 0.0F);
    std::vector<int> front;
    std::vector<uint8_t> waiting(has_ground.size());
    auto each_neighbour = [&](int c, const auto& body) {
        for (int z = std::max(0, c / width - 1); z <= std::min(depth - 1, c / width + 1); z++)
            for (int x = std::max(0, c % width - 1); x <= std::min(width - 1, c % width + 1); x++)
                body(z * width + x);
    };
    auto height_of = [&](int c) {
        return ground.above_plane(points[static_cast<size_t>(columns.lowest()[static_cast<size_t>(c)])]);
    };
    auto push_around = [&](int from, std::vector<int>& into) {
        each_neighbour(from, [&](int c) {
            const size_t k = static_cast<size_t>(c);
            if (has_ground[k] || waiting[k] || columns.lowest()[k] < 0) return;
            waiting[k] = 1;
            into.push_back(c);
        });
    };
    for (int c = 0; c < width * depth; c++)
        if (has_ground[static_cast<size_t>(c)])
            ground.relief[static_cast<size_t>(c)] = static_cast<float>(height_of(c));
    for (int c = 0; c < width * depth; c++)
        if (has_ground[static_cast<size_t>(c)]) push_around(c, front);
    while (!front.empty()) {
        if (progress) progress->check();
        // All of a front are judged before any joins, so that their order does not matter.
        std::vector<int> joined;
        for (const int c : front) {
            waiting[static_cast<size_t>(c)] = 0;
            const double told = foretell(columns, has_ground, ground.relief, c % width, c / width);
            if (std::abs(height_of(c) - told) <= ground.tolerance) joined.push_back(c);
        }
        std::vector<int> next;
        for (const int c : joined) {
            has_ground[static_cast<size_t>(c)] = 1;
            ground.relief[static_cast<size_t>(c)] = static_cast<float>(height_of(c));
        }
        for (const int c : joined)
            push_around(c, next);
        front.swap(next);
    }
    // Smooth where there is ground, then spread from there over the rest.
    std::vector<uint8_t> known = has_ground;
    std::vector<float> smooth = ground.relief;
    for (int c = 0; c < width * depth; c++) {
        if (!has_ground[static_cast<size_t>(c)]) continue;
        const double told = foretell(columns, has_ground, ground.relief, c % width, c / width);
        if (std::isfinite(told)) smooth[static_cast<size_t>(c)] = static_cast<float>(told);
    }
    std::vector<int> ring;
    for (int c = 0; c < width * depth; c++)
        if (known[static_cast<size_t>(c)]) ring.push_back(c);
    while (!ring.empty()) {
        if (progress) progress->check();
        std::vector<int> next;
        for (const int from : ring)
            each_neighbour(from, [&](int c) {
                if (known[static_cast<size_t>(c)] != 0) return;
                known[static_cast<size_t>(c)] = 2;
                next.push_back(c);
            });
        for (const int c : next) {
            double sum = 0.0;
            double n = 0.0;
            each_neighbour(c, [&](int other) {
                if (known[static_cast<size_t>(other)] != 1) return;
                sum += static_cast<double>(smooth[static_cast<size_t>(other)]);
                n += 1.0;
            });
            smooth[static_cast<size_t>(c)] = static_cast<float>(sum / n);
        }
        for (const int c : next)
            known[static_cast<size_t>(c)] = 1;
        ring.swap(next);
    }
    ground.relief.swap(smooth);
}

// Whether the ground is no steeper around a column than ground is: the underside of a crown may be.
bool is_walkable(const Ground& ground, int column) {
    const int x = column % ground.width, z = column / ground.width;
    const auto relief = [&](int at_x, int at_z) {
        const int c =
            std::clamp(at_z, 0, ground.depth - 1) * ground.width + std::clamp(at_x, 0, ground.width - 1);
        return static_cast<double>(ground.relief[static_cast<size_t>(c)]);
    };
    const DVec2 slope =
        ground.slope +
        DVec2(relief(x + 1, z) - relief(x - 1, z), relief(x, z + 1) - relief(x, z - 1)) / (2.0 * ground.cell);
    return glm::length(slope) <= kSteepest;
}

// How far the ground's surface lies above the lowest points that it was found by. Those of photos scatter to
// both sides, and nearly all lie above the lowest; a scanner's, with grass or without, lie on both sides of
// what was found, which is the surface then.
double surface_above(const std::vector<Vec3>& points, const Columns& columns, const Ground& ground,
                     const std::vector<uint8_t>& open) {
    std::vector<double> heights;
    for (const Vec3& p : points) {
        const int c = columns.column_of(p);
        if (c < 0 || !open[static_cast<size_t>(c)]) continue;
        if (const double above = ground.above(p); std::abs(above) <= ground.tolerance)
            heights.push_back(above);
    }
    return heights.empty() || quantile(heights, kBelow) <= 0.0 ? 0.0 : quantile(heights, 0.5);
}

// Marks what grows out of the ground and ends low, and the tips of blades.
void find_low_plants(const std::vector<Vec3>& points, const std::array<Range, 3>& ranges,
                     const Ground& ground, double height, const std::vector<uint8_t>& open,
                     std::vector<uint8_t>& goes) {
    const double tolerance = ground.tolerance;
    std::vector<Vec3> low;
    std::vector<size_t> index;
    for (size_t i = 0; i < points.size(); i++) {
        const double above = ground.above(points[i]);
        if (goes[i] || above < -ground.tolerance || above > kPlant * height) continue;
        low.push_back(points[i]);
        index.push_back(i);
    }
    if (low.empty()) return;
    const std::vector<uint32_t> label = connected_components(low, ranges, tolerance);
    struct Plant {
        double foot = std::numeric_limits<double>::max();
        double top = std::numeric_limits<double>::lowest();
        size_t points = 0;
        bool open = true;
    };
    std::vector<Plant> plants(*std::max_element(label.begin(), label.end()) + size_t{1});
    for (size_t i = 0; i < low.size(); i++) {
        Plant& plant = plants[label[i]];
        plant.foot = std::min(plant.foot, ground.above(low[i]));
        plant.top = std::max(plant.top, ground.above(low[i]));
        plant.points++;
        plant.open = plant.open && open[index[i]];
    }
    for (size_t i = 0; i < low.size(); i++) {
        const Plant& plant = plants[label[i]];
        const bool blades =
            plant.open && (plant.points < kBlades || plant.foot < kGrass * height + tolerance);
        const bool grows = plant.foot < 2.0 * tolerance || blades;
        if (grows && plant.top < kPlant * height - tolerance) goes[index[i]] = 1;
    }
}

}  // namespace

std::vector<uint8_t> find_ground(const std::vector<Vec3>& points, Ground& ground, const Progress* progress) {
    std::vector<uint8_t> goes(points.size());
    ground = {};
    if (points.size() < 100) return goes;
    const std::array<Range, 3> ranges = robust_ranges(points, progress);
    const double height = ranges[1].size();
    const double across = std::max(ranges[0].size(), ranges[2].size());
    if (!(height > 0.0) || !(across > 0.0)) return goes;
    const double size = std::max(height, 0.4 * across);
    const double cell = std::max(across / kMostAcross, std::min(0.025 * size, across / kFewestAcross));
    const double tolerance = 0.01 * size;
    const Columns columns(points, ranges, cell);

    std::vector<Vec3> low;
    for (const int32_t i : columns.lowest())
        if (i >= 0 &&
            points[static_cast<size_t>(i)].y < ranges[1].low + kLowPart * height + 0.5 * kSteepest * across)
            low.push_back(points[static_cast<size_t>(i)]);
    if (low.size() < kFewestColumns) return goes;
    size_t inliers = 0;
    Ground found = best_plane(low, tolerance, inliers, progress);
    if (inliers < kFewestColumns) return goes;
    found.x = ranges[0];
    found.z = ranges[2];
    found.cell = cell;
    found.width = columns.width();
    found.depth = columns.depth();
    found.tolerance = tolerance;

    std::vector<uint8_t> has_ground(columns.lowest().size());
    for (size_t c = 0; c < has_ground.size(); c++) {
        const int32_t i = columns.lowest()[c];
        has_ground[c] = i >= 0 && std::abs(found.above_plane(points[static_cast<size_t>(i)])) <= tolerance;
    }
    if (!is_wide_and_filled(columns, has_ground)) return goes;
    follow_relief(points, columns, found, has_ground, progress);

    // Next to nothing may lie below the ground: a crown has its stem below it.
    size_t below = 0;
    for (const Vec3& p : points)
        below += found.above(p) < -3.0 * tolerance && ranges[1].contains(p.y);
    if (below * 500 > points.size()) return goes;
    ground = std::move(found);
    ground.found = true;

    // What stands on the ground is seen in the layers right above it, all of them.
    constexpr int kLayers = 4;
    std::vector<uint8_t> layers(has_ground.size());
    for (const Vec3& p : points) {
        const int c = columns.column_of(p);
        const double layer = (ground.above(p) - tolerance) / tolerance;
        if (c >= 0 && layer >= 0.0 && layer < kLayers)
            layers[static_cast<size_t>(c)] |= static_cast<uint8_t>(1 << static_cast<int>(layer));
    }
    constexpr uint8_t kAllLayers = (1 << kLayers) - 1;
    // Grass is thicker than the ground that was found, at its lowest points: where nothing stands above it,
    // all of it goes.
    const double grass = std::max(tolerance, kGrass * height);
    std::vector<uint32_t> lying(has_ground.size()), standing(has_ground.size()), higher(has_ground.size());
    for (const Vec3& p : points) {
        const int c = columns.column_of(p);
        const double above = ground.above(p);
        if (c >= 0 && above < 2.0 * kPlant * height)
            (above < grass ? lying : above < kPlant * height ? standing : higher)[static_cast<size_t>(c)]++;
    }
    const auto is_open = [&](int c) {
        const size_t k = static_cast<size_t>(c);
        // A stem that is seen by a few points goes on.
        const bool blades = standing[k] < kBlades && standing[k] <= kBladeShare * lying[k] && higher[k] == 0;
        return (standing[k] == 0 || blades) && is_walkable(ground, c);
    };
    std::vector<uint8_t> open_columns(has_ground.size());
    for (size_t c = 0; c < open_columns.size(); c++)
        open_columns[c] = grass > tolerance && is_open(static_cast<int>(c));
    ground.surface = surface_above(points, columns, ground, open_columns);
    std::vector<uint8_t> open(points.size());  // by point: nothing stands in its column
    for (size_t i = 0; i < points.size(); i++) {
        const int c = columns.column_of(points[i]);
        open[i] = c >= 0 && open_columns[static_cast<size_t>(c)];
        const double above = ground.above(points[i]);
        if (std::abs(above) > (open[i] ? grass : tolerance)) continue;
        goes[i] = c < 0 || open[i] || layers[static_cast<size_t>(c)] != kAllLayers;
    }
    find_low_plants(points, ranges, ground, height, open, goes);
    return goes;
}

}  // namespace treerec
