#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "scan/cleaning/clean_cloud.h"
#include "scan/cleaning/clean_steps.h"
#include "scan/robust.h"
#include "scan/scale.h"
#include "scan/stems/check_slab.h"

namespace treerec {

namespace {

constexpr int kSlices = 40;
constexpr size_t kPointsPerTask = size_t{1} << 17;
constexpr size_t kLookedAt = 8192;  // points
// How much more an upside-down stem must look like one. Both ends of a pruned tree look like stems.
constexpr double kFlipMargin = 1.3;
// How much better a rival axis must look before it is named.
constexpr double kRivalMargin = 0.8;
// The same for the other end of the axis that was taken.
constexpr double kHeadMargin = 0.6;
// A pruned tree is a pole: with so little crown around the middle, and a stem at either end, neither end
// tells.
constexpr double kPoleElongation = 2.0;
constexpr double kPoleEnd = 2.0;  // slenderness
// Times the extent: further out there is no tree, and no float either.
constexpr double kFarthest = 1000.0;
constexpr double kStemSlenderness = 4.0;
// Coordinates this large are a map's (UTM and the like), and maps are Z up.
constexpr double kMapCoordinates = 1e5;
constexpr double kLeastGround = 0.1;  // of the points, on ground that tells the way up

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

double square_of(const DVec2& v) {
    return glm::dot(v, v);
}

std::vector<Slice> slice_up(const std::vector<std::vector<Vec2>>& points) {
    size_t total = 0;
    for (const std::vector<Vec2>& slice : points)
        total += slice.size();
    const size_t fewest = std::max<size_t>(3, total / 20000);
    std::vector<Slice> slices(points.size());
    std::vector<float> values;
    std::vector<double> squares;
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
        squares.clear();
        for (const Vec2& p : points[s])
            squares.push_back(square_of(DVec2(p) - slice.centre));
        slice.radius = static_cast<float>(std::sqrt(quantile(squares, 0.8)));
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
    view.score = portable::log2(1.0 + std::min(view.slenderness, 8.0)) * (1.0 - std::min(offset, 1.0));
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
    us.reserve(points.size());
    vs.reserve(points.size());
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
    std::vector<double> squares;
    squares.reserve(us.size());
    for (const std::vector<Vec2>& slice : sliced)
        for (const Vec2& p : slice)
            squares.push_back(square_of(DVec2(p) - centre));
    const double crown_radius = std::max(std::sqrt(quantile(squares, 0.9)), 1e-9 * height);
    const double middle_radius = std::max(std::sqrt(quantile(squares, 0.5)), 1e-3 * height);
    view.elongation_score = 2.0 * std::max(0.0, portable::log2(0.15 * height / middle_radius));

    std::vector<Slice> slices = slice_up(sliced);
    view.low_end = view_end(slices, centre, crown_radius, height);
    std::reverse(slices.begin(), slices.end());
    view.high_end = view_end(slices, centre, crown_radius, height);
    return view;
}

bool is_on_map(const DVec3& origin) {
    return std::max(std::abs(origin.x), std::abs(origin.y)) > kMapCoordinates;
}

struct UpGuess {
    UpAxis up = UpAxis::kZ;
    bool sure = true;
    UpAxis rival = UpAxis::kZ;  // another axis along which the tree would stand better; else the same
    UpAxis usual = UpAxis::kZ;  // what is taken where no rival is

    bool doubted() const { return !sure || rival != up || up != usual; }
};

// Whether both ends look like stems, and no crown tells which of them is one.
bool is_pole(const AxisView& view) {
    return view.elongation_score > kPoleElongation && view.low_end.slenderness > kPoleEnd &&
           view.high_end.slenderness > kPoleEnd;
}

// Laser scans are Z up, photogrammetry is Y up, or Y down where it keeps the camera's axes; few programs put
// the sky along X or -Z. So Z is taken unless Y has a better stem, and more than that is asked of a cloud
// without colours, which photos would have given it. A branch may lie along any axis: X and -Z are only taken
// for clouds from photos, whose axes may point anywhere, and told to the user otherwise.
UpGuess guess_up(const std::vector<Vec3>& points, const std::array<Range, 3>& ranges, bool has_colors) {
    UpGuess guess;
    std::array<AxisView, 3> views;
    parallel_for(views.size(), 1,
                 [&](size_t axis, size_t) { views[axis] = view_axis(points, ranges, axis); });
    const auto& [x, y, z] = views;
    const double y_score = std::max(y.low_end.score, y.high_end.score) + y.elongation_score;
    const double z_score = z.low_end.score + z.elongation_score;
    const double margin = has_colors ? 0.2 : 0.4;
    const double least_slenderness = has_colors ? 1.5 : kStemSlenderness;
    guess.sure = std::max(y_score, z_score) > 1.0 && std::abs(y_score - z_score) > margin;
    if (y_score > z_score + margin) {
        if (std::max(y.low_end.slenderness, y.high_end.slenderness) > least_slenderness)
            guess.up =
                !is_pole(y) && y.high_end.score > y.low_end.score + kFlipMargin ? UpAxis::kNegY : UpAxis::kY;
        else
            guess.sure = false;
    }
    guess.rival = guess.usual = guess.up;
    const double score = guess.up == UpAxis::kZ ? z_score : y_score;
    double best = score + kRivalMargin;
    const auto consider = [&](UpAxis up, const EndView& end, double elongation) {
        if (end.slenderness < kStemSlenderness || end.score + elongation <= best) return;
        best = end.score + elongation;
        guess.rival = up;
    };
    consider(UpAxis::kX, x.low_end, x.elongation_score);
    consider(UpAxis::kNegX, x.high_end, x.elongation_score);
    // On its head: the same axis, so that the ends alone count.
    if (guess.rival == UpAxis::kZ && !is_pole(z) && z.high_end.score > z.low_end.score + kHeadMargin) {
        guess.rival = UpAxis::kNegZ;
        best = z.high_end.score + z.elongation_score;
    }
    if (guess.rival == UpAxis::kY && !is_pole(y) && y.high_end.score > y.low_end.score + kHeadMargin)
        guess.rival = UpAxis::kNegY;
    if (guess.rival == guess.up) return guess;
    guess.sure = false;
    if (has_colors && best > score + kFlipMargin) guess.up = guess.rival;
    return guess;
}

// What its surroundings say where the shape is in doubt: ground below everything tells which way is up, and
// walls tell nothing.
UpGuess detect_up(const PointCloud& cloud, const std::array<Range, 3>& ranges, const Progress* progress) {
    if (is_on_map(cloud.frame.origin)) return {};
    std::vector<Vec3> points = some_of(cloud.positions, kLookedAt, progress);
    const UpGuess guess = guess_up(points, ranges, cloud.has_colors());
    if (!guess.doubted()) return guess;
    ScanFrame usual;
    usual.up = guess.usual;
    std::vector<Vec3> standing;
    for (const Vec3& p : points)
        standing.emplace_back(usual.turn_to_tree(DVec3(p)));
    Ground ground;
    const std::vector<uint8_t> lying = find_ground(standing, ground, progress);
    // Under a crown that stands on its head there may seem to be a little.
    const auto on_ground = static_cast<double>(std::count(lying.begin(), lying.end(), uint8_t{1}));
    if (ground.found && on_ground >= kLeastGround * static_cast<double>(standing.size()))
        return {guess.usual, true, guess.usual, guess.usual};
    std::vector<DVec2> walls;
    const std::vector<uint8_t> on_wall = find_walls(standing, walls, progress);
    if (walls.empty()) return guess;
    size_t kept = 0;
    for (size_t i = 0; i < points.size(); i++)
        if (!on_wall[i]) points[kept++] = points[i];
    points.resize(kept);
    return guess_up(points, robust_ranges(points, progress), cloud.has_colors());
}

std::string doubt_about_up(const UpGuess& guess) {
    const std::string taken = up_axis_name(guess.up);
    if (guess.rival == guess.up &&
        (guess.up == UpAxis::kZ || guess.up == UpAxis::kY || guess.up == UpAxis::kNegY))
        return "The shape does not tell which way is up; " + taken +
               " was taken. If the tree lies or hangs, set the up axis by hand.";
    if (guess.rival == guess.up)
        return "The tree stands along " + taken +
               ", an unusual axis, which was taken for up. If that is wrong, set the up axis by hand.";
    return std::string(up_axis_name(guess.rival)) + " looks more like the way up than " + taken +
           ", which was taken because it is the usual one. If the tree stands on its head or lies on its "
           "side, "
           "set the up axis by hand.";
}

size_t axis_of(UpAxis up) {
    if (up == UpAxis::kX || up == UpAxis::kNegX) return 0;
    return up == UpAxis::kY || up == UpAxis::kNegY ? 1 : 2;
}

// Points without a place, and points so far away that only a broken file has them: they would make every
// length meaningless. Returns the ranges of the rest.
std::array<Range, 3> drop_impossible_points(PointCloud& cloud, OrientReport& report,
                                            const Progress* progress) {
    if (progress) progress->check();
    std::vector<uint8_t> keep(cloud.size(), 1);
    const auto drop_where = [&](const auto& is_impossible) {
        size_t dropped = 0;
        for (size_t i = 0; i < keep.size(); i++) {
            keep[i] = !is_impossible(cloud.positions[i]);
            dropped += keep[i] == 0;
        }
        if (dropped == keep.size()) throw Error("No point of the cloud has three finite coordinates.");
        if (dropped > 0) cloud.keep_only(keep);
        keep.resize(cloud.size());
        if (progress) progress->check();
        return dropped;
    };
    size_t dropped = drop_where([](const Vec3& p) { return !is_finite(DVec3(p)); });
    const std::array<Range, 3> ranges = robust_ranges(cloud.positions, progress);
    const double reach = kFarthest * std::max({ranges[0].size(), ranges[1].size(), ranges[2].size()});
    if (reach > 0.0)
        dropped += drop_where([&](const Vec3& p) {
            for (int axis = 0; axis < 3; axis++) {
                const Range& range = ranges[static_cast<size_t>(axis)];
                if (p[axis] < range.low - reach || p[axis] > range.high + reach) return true;
            }
            return false;
        });
    if (dropped > 0)
        report.warnings.push_back(std::to_string(dropped) + (dropped == 1 ? " point has" : " points have") +
                                  " no possible place (not a number, or absurdly far away) and " +
                                  (dropped == 1 ? "was" : "were") + " left out.");
    for (Vec3& n : cloud.normals)
        if (!is_finite(DVec3(n))) n = Vec3(0.0F);
    return dropped > 0 ? robust_ranges(cloud.positions, progress) : ranges;
}

}  // namespace

OrientReport orient_cloud(PointCloud& cloud, const OrientOptions& options, Progress* progress) {
    OrientReport report;
    if (cloud.empty()) throw Error("The cloud has no points.");
    const std::array<Range, 3> ranges = drop_impossible_points(cloud, report, progress);
    refuse_slab(cloud, ranges, progress);
    const bool on_map = is_on_map(cloud.frame.origin);
    if (options.up) {
        report.up = *options.up;
        report.up_detected = options.photos > 0;
        report.photos = options.photos;
        cloud.frame.tilt = options.tilt;
    } else {
        const UpGuess guess = detect_up(cloud, ranges, progress);
        report.up = guess.up;
        report.up_detected = true;
        if (!guess.sure) report.warnings.push_back(doubt_about_up(guess));
    }
    set_scale(ranges[axis_of(report.up)].size(), on_map, cloud.unit, options, report);

    cloud.frame.up = report.up;
    cloud.frame.metres_per_unit = report.metres_per_unit;
    parallel_for(cloud.size(), kPointsPerTask, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        for (size_t i = begin; i < end; i++)
            cloud.positions[i] = cloud.frame.turn_to_tree(DVec3(cloud.positions[i]) * report.metres_per_unit);
        for (size_t i = begin; i < std::min(end, cloud.normals.size()); i++)
            cloud.normals[i] = cloud.frame.turn_to_tree(DVec3(cloud.normals[i]));
        for (size_t i = begin; i < std::min(end, cloud.radii.size()); i++)
            cloud.radii[i] *= static_cast<float>(report.metres_per_unit);
    });
    return report;
}

}  // namespace treerec
