#include "sketch/lift.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "sketch/simplify_line.h"

namespace treerec {

namespace {

// Pixels: what a line may lose of its shape; the front view is to be true within 2.
constexpr double kTrueness = 0.7;
constexpr double kLongestStep = 40.0;  // pixels between nodes, so that tapers and bends are round
constexpr double kMostTurn = 60.0;     // degrees (Ma and Liu 2020, 3.1)
constexpr double kLeastApart = 10.0;
// Of the depth that the crown has at a branch's tip: leaves are beyond it.
constexpr double kShallowest = 0.45, kDeepest = 0.85;
// A branch that is drawn short because it comes towards us: of its drawn length at most.
constexpr double kMostDepth = 1.2;

// A branch's share of the trunk's thickness there, whatever its length.
constexpr double kThinnestBranch = 0.25, kThickestBranch = 0.75;

// Of a tree's height, half its crown's width: beside the usual trunk a more slender crown's twigs would be as
// snags, which bear no leaves.
constexpr double kSlender = 0.12;

// Metres, at the base, where none was drawn.
double usual_radius(const CrownSections& crown, double stem_base) {
    const double height = crown.top() - stem_base;
    const double slender = std::min(crown.reach() / (kSlender * height), 1.0);
    return height / 40.0 * slender * slender;
}

// Where each branch grows: the place of a point of the trunk's line.
std::vector<size_t> joints_of(const DrawnTree& drawn) {
    std::vector<size_t> joints;
    const std::vector<DVec2>& line = drawn.trunk.points;
    for (const DrawnLine& branch : drawn.branches) {
        const auto off = [&](const DVec2& p) { return glm::length(p - branch.points[0]); };
        const auto nearest = std::min_element(
            line.begin(), line.end(), [&](const DVec2& p, const DVec2& q) { return off(p) < off(q); });
        joints.push_back(static_cast<size_t>(nearest - line.begin()));
    }
    return joints;
}

// Gives each point of the branch its depth: its base's, and more in proportion to the way along it, `tip` at
// the tip.
void deepen(SketchAxis& branch, double tip) {
    const double length = length_of(branch.points);
    double along = 0.0;
    DVec3 before = branch.points[0];
    for (size_t i = 1; i < branch.points.size(); i++) {
        along += glm::length(branch.points[i] - before);
        before = branch.points[i];
        branch.points[i].z = branch.points[0].z + tip * along / length;
    }
}

// How deep the tip may lie so that no point of the branch leaves the crown. Where it is outside anyway, as
// below the crown, nothing bounds it.
double deepest_tip(const SketchAxis& branch, const CrownSections& crown) {
    const double length = length_of(branch.points);
    double most = kMostDepth * length;
    double along = 0.0;
    for (size_t i = 1; i < branch.points.size(); i++) {
        along += glm::length(branch.points[i] - branch.points[i - 1]);
        const double depth = crown.half_depth(branch.points[i].x, branch.points[i].y);
        // Whichever side it goes to.
        const double room = depth - std::abs(branch.points[0].z);
        if (depth >= 0.0 && along > 0.0) most = std::min(most, std::max(room, 0.0) * length / along);
    }
    return most;
}

void lift_truly(SketchAxis& branch, const CrownSections& crown) {
    Random random(branch.seed);
    const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
    deepen(branch, side * random.uniform(kShallowest, kDeepest) * deepest_tip(branch, crown));
}

// v' = v R_y(angle), a row times the printed matrix, about `base`.
void turn(std::vector<DVec3>& points, const DVec3& base, double degrees) {
    const double c = portable::cos(degrees * kPi / 180.0), s = portable::sin(degrees * kPi / 180.0);
    for (DVec3& p : points) {
        const DVec3 v = p - base;
        p = base + DVec3(v.x * c + v.z * s, v.y, -v.x * s + v.z * c);
    }
}

// Degrees for each of so many branches.
std::vector<double> printed_turns(size_t count, uint64_t seed, std::vector<std::string>& remarks) {
    if (count == 0) return {};
    const double room = 2.0 * kMostTurn;
    double apart = kLeastApart;
    if (static_cast<double>(count - 1) * apart > room) {
        apart = room / static_cast<double>(count - 1);
        remarks.push_back("There are " + std::to_string(count) +
                          " branches, too many to be turned 10 degrees apart within 60 degrees to either "
                          "side; they stand closer together.");
    }
    // As many chance angles in what the gaps leave, in order, and the gaps between them again.
    Random random(hash_seed(seed, 3));
    std::vector<double> angles(count);
    for (double& angle : angles)
        angle = random.uniform(0.0, room - static_cast<double>(count - 1) * apart);
    std::sort(angles.begin(), angles.end());
    for (size_t i = 0; i < count; i++)
        angles[i] += static_cast<double>(i) * apart - kMostTurn;
    for (size_t i = count; i-- > 1;)
        std::swap(angles[i], angles[random.below(static_cast<uint32_t>(i + 1))]);
    return angles;
}

// The line with few points, in the plane z = 0.
SketchAxis flat_branch(const DrawnLine& line, const Sketch& sketch, const CanvasPlace& place) {
    const std::vector<size_t> own =
        split_long_steps(line.points, simplify_line(line.points, {}, kTrueness), kLongestStep);
    SketchAxis axis;
    for (const size_t i : own)
        axis.points.emplace_back(place.metres(line.points[i]), 0.0);
    axis.stroke = static_cast<int32_t>(line.stroke);
    axis.seed = hash_seed(sketch.seed, sketch.strokes[line.stroke].id);
    return axis;
}

}  // namespace

std::vector<double> radii_of(const SketchAxis& branch, const SketchAxes& axes) {
    const SketchAxis& host =
        branch.parent < 0 ? axes.trunk : axes.branches[static_cast<size_t>(branch.parent)];
    const double there = value_along(host.points, host.radii, branch.along);
    if (axes.taper)
        return axes.taper->branches.radii_along(branch.points, 1.0,
                                                std::max(kThickestBranch * there, kLeastRadius));
    const double fair = axes.trunk.radii[0] * length_of(branch.points) / length_of(axes.trunk.points);
    return tapered(branch.points, std::clamp(fair, kThinnestBranch * there, kThickestBranch * there),
                   kLeastRadius);
}

SketchAxes lift(const DrawnTree& drawn, const Sketch& sketch, const CanvasPlace& place,
                const CrownSections& crown, const SketchOptions& options,
                const std::optional<WoodTaper>& taper, std::vector<std::string>& remarks) {
    SketchAxes axes;
    axes.taper = taper;
    const std::vector<DVec2>& line = drawn.trunk.points;
    const std::vector<double>& radii = drawn.trunk.radii;
    const std::vector<size_t> joints = joints_of(drawn);
    const std::vector<size_t> kept =
        split_long_steps(line, simplify_line(line, joints, kTrueness), kLongestStep);
    for (const size_t i : kept)
        axes.trunk.points.emplace_back(place.metres(line[i]), 0.0);
    axes.trunk.stroke = static_cast<int32_t>(drawn.trunk.stroke);
    axes.trunk.seed = hash_seed(sketch.seed, 0);
    const double stem_base = options.trunk_radius > 0.0 ? options.trunk_radius
                             : !radii.empty()           ? radii[0] * place.scale
                             : taper                    ? taper->stem_base
                                                        : usual_radius(crown, axes.trunk.points[0].y);
    const double least = std::max(stem_base / 10.0, kLeastRadius);
    axes.trunk.radii = taper ? taper->trunk_radii(axes.trunk.points, stem_base, kLeastRadius)
                             : tapered(axes.trunk.points, stem_base, least);
    if (!radii.empty()) {
        // As drawn, in proportion to the base's, and no thicker above.
        double before = stem_base;
        for (size_t i = 0; i < kept.size(); i++) {
            const double own = radii[kept[i]] / radii[0] * stem_base;
            before = axes.trunk.radii[i] = std::clamp(own, least, std::max(before, least));
        }
    }

    for (size_t b = 0; b < drawn.branches.size(); b++) {
        SketchAxis branch = flat_branch(drawn.branches[b], sketch, place);
        branch.points[0] = DVec3(place.metres(line[joints[b]]), 0.0);
        for (size_t i = 0; i + 1 < kept.size() && kept[i] < joints[b]; i++)
            branch.along += glm::length(axes.trunk.points[i + 1] - axes.trunk.points[i]);
        axes.branches.push_back(std::move(branch));
    }
    // Of the second order: while their parents are flat, too, one finds where they grow. What lifts a branch
    // leaves the shares of its length as they are.
    const size_t first_order = axes.branches.size();
    std::vector<double> shares;
    for (const DrawnLine& side : drawn.side_branches) {
        SketchAxis branch = flat_branch(side, sketch, place);
        branch.parent = static_cast<int32_t>(*side.parent);
        const std::vector<DVec3>& on = axes.branches[*side.parent].points;
        branch.along = nearest_along(on, branch.points[0]);
        shares.push_back(branch.along / length_of(on));
        branch.points[0] = place_along(on, branch.along);
        axes.branches.push_back(std::move(branch));
    }
    const bool printed = options.depth == SketchDepth::kPaper;
    const std::vector<double> turns =
        printed ? printed_turns(first_order, sketch.seed, remarks) : std::vector<double>();
    for (size_t i = 0; i < axes.branches.size(); i++) {
        SketchAxis& branch = axes.branches[i];
        if (i >= first_order) {
            const auto parent = static_cast<size_t>(branch.parent);
            const std::vector<DVec3>& on = axes.branches[parent].points;
            branch.along = shares[i - first_order] * length_of(on);
            if (printed)  // with what it grows from
                turn(branch.points, on[0], turns[parent]);
            else
                branch.points[0].z = place_along(on, branch.along).z;
        } else if (printed) {
            turn(branch.points, DVec3(branch.points[0]), turns[i]);
        }
        if (!printed) lift_truly(branch, crown);
        branch.radii = radii_of(branch, axes);
    }
    return axes;
}

}  // namespace treerec
