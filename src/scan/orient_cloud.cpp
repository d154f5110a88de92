#include <array>
#include <cmath>
#include <optional>

#include "geometry/parallel.h"
#include "scan/clean_cloud.h"
#include "scan/robust.h"
#include "scan/scale.h"

namespace treerec {

namespace {

constexpr int kSlices = 40;
constexpr size_t kPointsPerTask = size_t{1} << 17;
constexpr size_t kLookedAt = 8192;  // points
// How much more an upside-down stem must look like one. Both ends of a pruned tree look like stems.
constexpr double kFlipMargin = 1.3;
// Coordinates this large are a map's (UTM and the like), and maps are Z up.
constexpr double kMapCoordinates = 1e5;

// How the cloud looks from one end of an axis: the stem that a tree standing on that end would have.
struct EndView {
    double slenderness = 0.0;  // length / diameter of the compact part
    double score = 0.0;        // of the stem
};

struct AxisView {
    EndView low_end;   // as the base
    EndView high_end;  // as the base
    double elongation_score = 0.0;
};

struct Slice {
    bool occupied = false;  // by more than stray points
    DVec2 centre{0.0};
    double radius = 0.0;  // holds 80 % of the slice's points
};

std::vector<Slice> slice_up(const std::vector<std::vector<Vec2>>& points) {
    size_t total = 0;
    for (const std::vector<Vec2>& slice : points)
        total += slice.size();
    const size_t fewest = std::max<size_t>(3, total / 20000);
    std::vector<Slice> slices(points.size());
    std::vector<float> values;
    for (size_t s = 0; s < points.size(); s++) {
        Slice& slice = slices[s];
        slice.occupied = points[s].size() >= fewest;
        if (!slice.occupied) continue;
        for (int axis = 0; axis < 2; axis++) {
            values.clear();
            for (const Vec2& p : points[s])
                values.push_back(p[axis]);
            slice.centre[axis] = quantile(values, 0.5);
        }
        values.clear();
        for (const Vec2& p : points[s])
            values.push_back(static_cast<float>(glm::length(DVec2(p) - slice.centre)));
        slice.radius = quantile(values, 0.8);
    }
    return slices;
}

// Looks for a run of compact slices that begins in the first quarter. slices: from the end onwards.
EndView view_end(const std::vector<Slice>& slices, const DVec2& centre, double crown_radius, double height) {
    auto compact = [&](const Slice& s) { return s.occupied && s.radius < 0.3 * crown_radius; };
    size_t first = 0;
    while (first < slices.size() / 4 && !compact(slices[first]))
        first++;
    EndView view;
    if (first == slices.size() / 4) return view;
    size_t last = first;
    for (size_t s = first; s < slices.size() && (compact(slices[s]) || !slices[s].occupied); s++)
        if (compact(slices[s])) last = s;
    std::vector<double> radii;
    DVec2 foot(0.0);
    for (size_t s = first; s <= last; s++) {
        if (!compact(slices[s])) continue;
        radii.push_back(slices[s].radius);
        foot += slices[s].centre;
    }
    foot /= static_cast<double>(radii.size());
    const double length = height * static_cast<double>(last - first + 1) / kSlices;
    view.slenderness = length / (2.0 * std::max(quantile(radii, 0.5), 0.01 * height));
    // A twig tip is thin as well, but off the middle of the crown.
    const double offset = glm::length(foot - centre) / crown_radius;
    view.score = std::log2(1.0 + std::min(view.slenderness, 8.0)) * (1.0 - std::min(offset, 1.0));
    return view;
}

AxisView view_axis(const std::vector<Vec3>& points, const std::array<Range, 3>& ranges, size_t axis) {
    const size_t u = (axis + 1) % 3;
    const size_t v = (axis + 2) % 3;
    AxisView view;
    const double height = ranges[axis].size();
    if (!(height > 0.0)) return view;
    std::vector<std::vector<Vec2>> sliced(kSlices);
    std::vector<float> us;
    std::vector<float> vs;
    auto at = [](const Vec3& p, size_t k) { return p[static_cast<int>(k)]; };
    for (const Vec3& p : points) {
        if (!ranges[0].contains(p.x) || !ranges[1].contains(p.y) || !ranges[2].contains(p.z)) continue;
        const double h = (at(p, axis) - ranges[axis].low) / height;
        const size_t s = std::min<size_t>(kSlices - 1, static_cast<size_t>(h * kSlices));
        sliced[s].emplace_back(at(p, u), at(p, v));
        us.push_back(at(p, u));
        vs.push_back(at(p, v));
    }
    if (us.size() < 10) return view;
    const DVec2 centre(quantile(us, 0.5), quantile(vs, 0.5));
    std::vector<double> distances;
    distances.reserve(us.size());
    for (const std::vector<Vec2>& slice : sliced)
        for (const Vec2& p : slice)
            distances.push_back(glm::length(DVec2(p) - centre));
    const double crown_radius = std::max(quantile(distances, 0.9), 1e-9 * height);
    const double middle_radius = std::max(quantile(distances, 0.5), 1e-3 * height);
    view.elongation_score = 2.0 * std::max(0.0, std::log2(0.15 * height / middle_radius));

    std::vector<Slice> slices = slice_up(sliced);
    view.low_end = view_end(slices, centre, crown_radius, height);
    std::reverse(slices.begin(), slices.end());
    view.high_end = view_end(slices, centre, crown_radius, height);
    return view;
}

bool is_on_map(const DVec3& origin) {
    return std::max(std::abs(origin.x), std::abs(origin.y)) > kMapCoordinates;
}

// Laser scans are Z up, photogrammetry is Y up, or Y down where it keeps the camera's axes; no program puts
// the sky along X or -Z. So Z is taken unless Y has a better stem, and more than that is asked of a cloud
// without colours, which photos would have given it.
UpAxis detect_up(const PointCloud& cloud, const std::array<Range, 3>& ranges, bool& sure,
                 const Progress* progress) {
    sure = true;
    if (is_on_map(cloud.frame.origin)) return UpAxis::kZ;

    const std::vector<Vec3> points = some_of(cloud.positions, kLookedAt, progress);
    const AxisView y = view_axis(points, ranges, 1);
    const AxisView z = view_axis(points, ranges, 2);
    const double y_score = std::max(y.low_end.score, y.high_end.score) + y.elongation_score;
    const double z_score = z.low_end.score + z.elongation_score;
    const double margin = cloud.has_colors() ? 0.2 : 0.4;
    const double least_slenderness = cloud.has_colors() ? 1.5 : 4.0;
    sure = std::max(y_score, z_score) > 1.0 && std::abs(y_score - z_score) > margin;
    if (y_score <= z_score + margin) return UpAxis::kZ;
    if (std::max(y.low_end.slenderness, y.high_end.slenderness) <= least_slenderness) {
        sure = false;
        return UpAxis::kZ;
    }
    return y.high_end.score > y.low_end.score + kFlipMargin ? UpAxis::kNegY : UpAxis::kY;
}

size_t axis_of(UpAxis up) {
    if (up == UpAxis::kX || up == UpAxis::kNegX) return 0;
    return up == UpAxis::kY || up == UpAxis::kNegY ? 1 : 2;
}

}  // namespace

OrientReport orient_cloud(PointCloud& cloud, const OrientOptions& options, Progress* progress) {
    OrientReport report;
    if (cloud.empty()) throw Error("The cloud has no points.");
    if (progress) progress->check();
    const std::array<Range, 3> ranges = robust_ranges(cloud.positions, progress);
    const bool on_map = is_on_map(cloud.frame.origin);
    if (options.up) {
        report.up = *options.up;
    } else {
        bool sure = false;
        report.up = detect_up(cloud, ranges, sure, progress);
        report.up_detected = true;
        if (!sure)
            report.warnings.push_back("The shape does not tell which way is up; " +
                                      std::string(up_axis_name(report.up)) +
                                      " was taken. If the tree lies or hangs, set the up axis by hand.");
    }
    set_scale(ranges[axis_of(report.up)].size(), on_map, options, report);

    cloud.frame.up = report.up;
    cloud.frame.metres_per_unit = report.metres_per_unit;
    parallel_for(cloud.size(), kPointsPerTask, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        for (size_t i = begin; i < end; i++)
            cloud.positions[i] = cloud.frame.turn_to_tree(DVec3(cloud.positions[i]) * report.metres_per_unit);
        for (size_t i = begin; i < std::min(end, cloud.normals.size()); i++)
            cloud.normals[i] = cloud.frame.turn_to_tree(DVec3(cloud.normals[i]));
    });
    return report;
}

}  // namespace treerec
