#include "sketch/unseen.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/portable_math.h"
#include "geometry/random.h"
#include "sketch/lift.h"

namespace treerec {

namespace {

// The trunk is to reach so far up the crown, where nothing drawn does.
constexpr double kReachedShare = 0.55, kExtendedShare = 0.88;
constexpr double kExtensionSteps = 8.0;
constexpr double kLeastExtension = 0.08;  // of the crown's height
// Of the trunk's radius at its base: how thick it may end, and how thick one ends that goes on.
constexpr double kThinEnd = 0.15, kTipShare = 0.05;
// Of the room around it: twigs that reach no farther than twelve radii of what they stand on would be snags,
// which bear no leaves.
constexpr double kThickestInCrown = 0.08;
constexpr double kTaperedEnd = 0.5;  // the last part of a trunk that ends thick, which tapers

// Drawn branches lie within about 50 degrees of the canvas's plane: they fill 200 of the 360 degrees around.
constexpr double kUnseenShare = 0.8;
constexpr size_t kFewestUnseen = 4;
constexpr size_t kWithoutDrawn = 9;  // branches of a crown in which none was drawn
// Where on the trunk's part in the crown these stand.
constexpr double kLowest = 0.05, kHighest = 0.8;
// A branch of the length unit that rises by 50 degrees and straightens up (its profile: out, up).
constexpr double kRise = 50.0;

// Branches' tips end so far inside the crown's surface: leaves reach beyond them.
constexpr double kInside = 0.9;
constexpr double kLongest = 1.5, kShortest = 0.3;  // of the shape's own length
constexpr double kFitStep = 0.94;
constexpr double kSideways = 0.06;  // of its length: how far a branch leaves the plane that it grows in
constexpr size_t kDirections = 48;  // around the trunk, of which the emptiest is taken
// Metres of height that count as much as a radian around, over the crown's height.
constexpr double kHeightWeight = 3.0;

// A branch's shape in the upright plane that it grows in.
struct Profile {
    std::vector<DVec2> points;  // metres out and up from its base
};

struct Stand {
    double azimuth;  // radians about Y
    double height;   // of its base
};

double azimuth_of(const SketchAxis& branch) {
    const DVec3 way = branch.points.back() - branch.points.front();
    return portable::atan2(way.z, way.x);
}

Profile profile_of(const SketchAxis& branch) {
    const DVec3 way = branch.points.back() - branch.points.front();
    const double flat = portable::hypot(way.x, way.z);
    const DVec3 out = flat > 1e-9 ? DVec3(way.x / flat, 0.0, way.z / flat) : DVec3(1.0, 0.0, 0.0);
    Profile profile;
    for (const DVec3& p : branch.points)
        profile.points.emplace_back(glm::dot(p - branch.points[0], out), p.y - branch.points[0].y);
    return profile;
}

Profile risen(double length) {
    Profile profile;
    DVec2 at(0.0);
    profile.points.push_back(at);
    constexpr int kSteps = 7;
    for (int i = 0; i < kSteps; i++) {
        const double rise = (kRise - 12.0 + 24.0 * i / (kSteps - 1)) * kPi / 180.0;
        at += DVec2(portable::cos(rise), portable::sin(rise)) * (length / kSteps);
        profile.points.push_back(at);
    }
    return profile;
}

double between(double a, double b) {
    const double off = std::abs(a - b);
    return std::min(off, 2.0 * kPi - off);
}

std::vector<DVec3> standing(const Profile& profile, const DVec3& base, double azimuth, double scale,
                            double sideways) {
    const DVec3 out(portable::cos(azimuth), 0.0, portable::sin(azimuth));
    const DVec3 side(-out.z, 0.0, out.x);
    const double length = glm::length(profile.points.back());
    std::vector<DVec3> points;
    for (const DVec2& p : profile.points) {
        const double far = length > 0.0 ? glm::length(p) / length : 0.0;
        const double off = sideways * length * portable::sin(kPi * far);
        points.push_back(base + (out * p.x + DVec3(0.0, p.y, 0.0) + side * off) * scale);
    }
    return points;
}

// Whether it stays in the crown once it is in it, and ends there.
bool fits(const std::vector<DVec3>& points, const CrownSections& crown, const DVec3& middle) {
    bool inside = false;
    for (const DVec3& p : points) {
        // A little smaller a crown, about its middle.
        const bool now = crown.contains(middle + (p - middle) / kInside);
        if (inside && !now) return false;
        inside = now;
    }
    return inside;
}

void taper_end(SketchAxes& axes) {
    std::vector<double>& radii = axes.trunk.radii;
    const double length = length_of(axes.trunk.points);
    const double tip = std::max(kTipShare * radii[0], kLeastRadius);
    double along = 0.0;
    for (size_t i = 1; i < radii.size(); i++) {
        along += glm::length(axes.trunk.points[i] - axes.trunk.points[i - 1]);
        const double left = std::clamp((1.0 - along / length) / kTaperedEnd, 0.0, 1.0);
        radii[i] = std::min(radii[i - 1], std::max(radii[i] * left, tip));
    }
    for (SketchAxis& branch : axes.branches)
        branch.radii = radii_of(branch, axes);
}

}  // namespace

void extend_trunk(SketchAxes& axes, const CrownSections& crown, uint64_t seed) {
    const double height = crown.top() - crown.bottom();
    double highest = axes.trunk.points.back().y;
    for (const SketchAxis& branch : axes.branches)
        for (const DVec3& p : branch.points)
            highest = std::max(highest, p.y);
    const bool reaches = highest >= crown.bottom() + kReachedShare * height;
    const double stem_base = axes.trunk.radii[0];
    const double last = axes.trunk.radii.back();
    if (reaches && last <= kThinEnd * stem_base) return;
    const DVec3 from = axes.trunk.points.back();
    const double to_height = crown.bottom() + kExtendedShare * height;
    // What was drawn into the crown's top, two lines wide, has its thickness there; all of it tapers.
    if (from.y > to_height - kLeastExtension * height) {
        if (last > kThinEnd * stem_base) taper_end(axes);
        return;
    }
    const auto sections = crown.at(to_height);
    if (sections.empty()) return;
    // The nearest of the crown's tops.
    double to_x = from.x, nearest = -1.0;
    for (const CrownSections::Section& section : sections) {
        const double middle = 0.5 * (section.left + section.right);
        if (nearest >= 0.0 && std::abs(middle - from.x) >= nearest) continue;
        nearest = std::abs(middle - from.x);
        to_x = middle;
    }
    Random random(hash_seed(seed, 1));
    const double bend = random.uniform(-0.03, 0.03) * (to_height - from.y);
    const size_t drawn = axes.trunk.points.size();
    for (double i = 1.0; i <= kExtensionSteps; i += 1.0) {
        const double part = i / kExtensionSteps;
        axes.trunk.points.emplace_back(from.x + (to_x - from.x) * part, from.y + (to_height - from.y) * part,
                                       bend * portable::sin(kPi * part));
    }
    const double tip = std::max(kTipShare * stem_base, kLeastRadius);
    if (axes.taper) {
        axes.trunk.radii = axes.taper->trunk_radii(axes.trunk.points, stem_base, kLeastRadius);
    } else if (last <= kThinEnd * stem_base) {
        axes.trunk.radii = tapered(axes.trunk.points, stem_base, tip);
    } else {
        // As thick as drawn, and from there on it goes to nothing.
        while (axes.trunk.radii.size() < axes.trunk.points.size()) {
            const double part = static_cast<double>(axes.trunk.radii.size() - drawn + 1) / kExtensionSteps;
            const DVec3& at = axes.trunk.points[axes.trunk.radii.size()];
            const double room = crown.half_depth(at.x, at.y);
            const double own = last * (1.0 - part);
            axes.trunk.radii.push_back(
                std::max(room < 0.0 ? own : std::min(own, kThickestInCrown * room), tip));
        }
    }
    for (SketchAxis& branch : axes.branches)
        branch.radii = radii_of(branch, axes);
}

void add_unseen_branches(SketchAxes& axes, const CrownSections& crown, uint64_t seed) {
    // Those of the second order come last.
    size_t drawn = 0;
    while (drawn < axes.branches.size() && axes.branches[drawn].parent < 0)
        drawn++;
    const double trunk_length = length_of(axes.trunk.points);
    const double height = crown.top() - crown.bottom();
    // The part of the trunk that bears them.
    double lowest = trunk_length, highest = 0.0;
    for (size_t b = 0; b < drawn; b++) {
        lowest = std::min(lowest, axes.branches[b].along);
        highest = std::max(highest, axes.branches[b].along);
    }
    size_t count = std::max(kFewestUnseen, static_cast<size_t>(std::ceil(kUnseenShare * drawn)));
    if (drawn < 2) {
        double in = 0.0;
        for (double along = 0.0; along < trunk_length; along += 0.01 * trunk_length) {
            if (place_along(axes.trunk.points, along).y >= crown.bottom()) break;
            in = along;
        }
        const double begin = in + kLowest * (trunk_length - in), end = in + kHighest * (trunk_length - in);
        lowest = std::min(lowest, begin);
        highest = std::max(highest, end);
        if (drawn == 0) count = kWithoutDrawn;
    }
    const DVec3 middle(0.5 * (crown.left() + crown.right()), 0.5 * (crown.bottom() + crown.top()), 0.0);
    std::vector<Stand> stands;
    for (const SketchAxis& branch : axes.branches)
        stands.push_back({azimuth_of(branch), branch.points[0].y});
    for (size_t i = 0; i < count; i++) {
        const uint64_t own = hash_seed(seed, 1000 + i);
        Random random(own);
        const double share =
            (static_cast<double>(i) + random.uniform(0.25, 0.75)) / static_cast<double>(count);
        SketchAxis branch;
        branch.along = lowest + (highest - lowest) * share;
        branch.seed = hash_seed(own, 1);
        const DVec3 base = place_along(axes.trunk.points, branch.along);
        // To where there is most room and the crown is: beside a leaning trunk it is not all around.
        std::vector<std::pair<double, double>> directions;  // room, azimuth
        const double begin = random.uniform(0.0, 2.0 * kPi / kDirections);
        for (size_t d = 0; d < kDirections; d++) {
            const double angle = begin + 2.0 * kPi * static_cast<double>(d) / kDirections - kPi;
            double room = 1e9;
            for (const Stand& stand : stands) {
                const double off = between(angle, stand.azimuth);
                const double up = kHeightWeight * (base.y - stand.height) / height;
                room = std::min(room, off * off + up * up);
            }
            directions.emplace_back(room, angle);
        }
        std::stable_sort(directions.begin(), directions.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        const SketchAxis* like = nullptr;
        for (size_t b = 0; b < drawn; b++)
            if (!like ||
                std::abs(axes.branches[b].along - branch.along) < std::abs(like->along - branch.along))
                like = &axes.branches[b];
        Profile profile = like ? profile_of(*like) : risen(0.4 * height);
        const double wider = random.uniform(0.88, 1.12), higher = random.uniform(0.92, 1.08);
        for (DVec2& p : profile.points)
            p *= DVec2(wider, higher);
        const double sideways = kSideways * random.uniform(-1.0, 1.0);
        for (size_t d = 0; d < directions.size() && branch.points.empty(); d++) {
            const double azimuth = directions[d].second;
            for (double scale = kLongest; scale >= kShortest && branch.points.empty(); scale *= kFitStep) {
                std::vector<DVec3> points = standing(profile, base, azimuth, scale, sideways);
                if (!fits(points, crown, middle)) continue;
                branch.points = std::move(points);
                stands.push_back({azimuth, base.y});
            }
        }
        if (branch.points.empty()) continue;
        branch.radii = radii_of(branch, axes);
        axes.branches.push_back(std::move(branch));
    }
}

}  // namespace treerec
