#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/covariance.h"
#include "geometry/groups.h"
#include "geometry/point_tree.h"
#include "scan/stems/separate_trees.h"
#include "scan/stems/stem_rules.h"

namespace treerec {

namespace {

constexpr double kHighestFork = 0.6;  // of the height: where a branch that touches the ground meets its trunk
constexpr double kAlike = 0.1;        // of the thicker stem's radius: two culms, or a bundle and one
constexpr double kLook = 4.0;         // of a branch's thickness: how far it is looked along, to both sides
// Variance along a branch over that across: of a ball it is .5, of a sheet 1.
constexpr double kSlender = 2.0;
constexpr double kThick = 0.5;  // of the thinner stem's radius: a branch that may bear it
// Of the trunk's radius: as thick as its root or branch gets.
constexpr double kMostAlike = 0.4;
constexpr double kBothSides = 0.5;   // of the look: the branch goes on that far to either side
constexpr double kReach = 2.5;       // voxels: what is no further away is beside, as the scan has gaps
constexpr size_t kFewestAcross = 8;  // voxels where a branch is cut through
// Of the thinner stem's radius: larger voxels do not tell branches from twigs.
constexpr double kCoarse = 2.2;
constexpr size_t kFewest = 12;   // voxels of a branch
constexpr double kWidest = 8.0;  // of the thicker stem's radius: what is wider is no branch

// Voxels next to each other that grew from different stems.
struct Border {
    std::vector<uint32_t> voxels;
    uint32_t a = 0;
    uint32_t b = 0;
};

struct Within {
    float square = 0.0F;
    std::vector<uint32_t> points;

    float limit() const { return square; }
    void add(float distance, uint32_t i) {
        if (distance < square) points.push_back(i);
    }
};

std::vector<uint32_t> beside(const PointTree& places, const Vec3& centre, double reach) {
    Within around{static_cast<float>(reach * reach), {}};
    places.search(centre, around);
    std::sort(around.points.begin(), around.points.end());
    return std::move(around.points);
}

std::vector<Border> find_borders(const std::vector<Vec3>& centres, const PointTree& places,
                                 const std::vector<uint32_t>& tree, double reach, const Progress* progress) {
    // By pair of stems: which voxels lie at the border, and the parts that these are.
    std::map<std::pair<uint32_t, uint32_t>, std::vector<uint32_t>> pairs;
    for (uint32_t c = 0; c < tree.size(); c++) {
        if (progress && c % 1024 == 0) progress->check();
        if (tree[c] == Separation::kNone) continue;
        for (const uint32_t n : beside(places, centres[c], reach)) {
            if (tree[n] == Separation::kNone || tree[n] == tree[c]) continue;
            std::vector<uint32_t>& at = pairs[std::minmax(tree[c], tree[n])];
            if (at.empty() || at.back() != c) at.push_back(c);
        }
    }
    std::vector<Border> borders;
    for (const auto& [pair, at] : pairs) {
        if (progress) progress->check();
        Groups groups(at.size());
        for (uint32_t k = 0; k < at.size(); k++)
            for (const uint32_t n : beside(places, centres[at[k]], reach)) {
                const auto found = std::lower_bound(at.begin(), at.end(), n);
                if (found != at.end() && *found == n)
                    groups.join(k, static_cast<uint32_t>(found - at.begin()));
            }
        const std::vector<uint32_t> names = groups.names();
        std::vector<std::vector<uint32_t>> parts(at.size());
        for (uint32_t k = 0; k < at.size(); k++)
            parts[names[k]].push_back(at[k]);
        for (std::vector<uint32_t>& part : parts)
            if (!part.empty()) borders.push_back({std::move(part), pair.first, pair.second});
    }
    return borders;
}

}  // namespace

bool stand_together(const Stem& a, const Stem& b, double closest, double height) {
    const double least =
        std::max({3.0 * (a.radius + b.radius), closest * height, std::min(kClosestMetres, 0.15 * height)});
    return glm::length(DVec2(b.foot.x - a.foot.x, b.foot.z - a.foot.z)) < least;
}

bool lean_together(const Stem& a, const Stem& b, double height) {
    const DVec2 apart(b.foot.x - a.foot.x, b.foot.z - a.foot.z);
    const DVec2 at_foot = apart - (b.foot.y - a.foot.y) * b.lean;
    const DVec2 drift = b.lean - a.lean;
    const double speed = glm::dot(drift, drift);
    const double at =
        speed > 1e-9 ? std::clamp(-glm::dot(at_foot, drift) / speed, 0.0, kHighestFork * height) : 0.0;
    return glm::length(at_foot + at * drift) < 2.0 * (a.radius + b.radius) + 0.01 * height;
}

void take_in(Stem& stem, const Stem& other) {
    stem.seed.insert(stem.seed.end(), other.seed.begin(), other.seed.end());
    stem.feet.insert(stem.feet.end(), other.feet.begin(), other.feet.end());
}

void join_clumps(std::vector<Stem>& stems, double height) {
    const double least = std::min(kClosestMetres, 0.15 * height);
    const auto chained = [&](const Stem& a, const Stem& b) {
        if (std::min(a.radius, b.radius) < kAlike * std::max(a.radius, b.radius)) return false;
        return std::any_of(a.feet.begin(), a.feet.end(), [&](const DVec2& foot) {
            return std::any_of(b.feet.begin(), b.feet.end(),
                               [&](const DVec2& other) { return glm::distance(foot, other) < least; });
        });
    };
    for (size_t a = 0; a < stems.size(); a++)
        for (size_t b = a + 1; b < stems.size();) {
            if (!chained(stems[a], stems[b])) {
                b++;
                continue;
            }
            take_in(stems[a], stems[b]);
            stems.erase(stems.begin() + static_cast<ptrdiff_t>(b));
            b = a + 1;  // its feet may lead on to those that were too far away
        }
}

std::vector<uint32_t> joined_by_wood(const std::vector<Stem>& stems, const std::vector<Vec3>& centres,
                                     const std::vector<uint32_t>& tree, double voxel,
                                     const Progress* progress) {
    std::vector<uint32_t> by_radius(stems.size());
    for (uint32_t s = 0; s < stems.size(); s++)
        by_radius[s] = s;
    std::stable_sort(by_radius.begin(), by_radius.end(),
                     [&](uint32_t a, uint32_t b) { return stems[a].radius > stems[b].radius; });
    const PointTree places(centres, progress);
    std::vector<std::vector<uint32_t>> leads_to(stems.size());
    for (const Border& border : find_borders(centres, places, tree, kReach * voxel, progress)) {
        if (progress) progress->check();
        const double thinner = std::min(stems[border.a].radius, stems[border.b].radius);
        const double thicker = std::max(stems[border.a].radius, stems[border.b].radius);
        if (border.voxels.size() < kFewestAcross || voxel > kCoarse * thinner) continue;
        DVec3 middle(0.0);
        for (const uint32_t c : border.voxels)
            middle += DVec3(centres[c]) / static_cast<double>(border.voxels.size());
        double square = 0.0;
        for (const uint32_t c : border.voxels) {
            const DVec3 d = DVec3(centres[c]) - middle;
            square += glm::dot(d, d) / static_cast<double>(border.voxels.size());
        }
        const double width = std::max({std::sqrt(square), thinner, voxel});
        if (width > kWidest * thicker) continue;
        const double look = kLook * width;
        // What grew from these two alone: others may cross.
        std::vector<Vec3> branch;
        for (const uint32_t c : beside(places, Vec3(middle), look))
            if (tree[c] == border.a || tree[c] == border.b) branch.push_back(centres[c]);
        if (branch.size() < kFewest) continue;
        const DMat3 covariance = covariance_of(branch);
        DVec3 axis(1.0, 1.0, 1.0);
        for (int i = 0; i < 32; i++)
            axis = normalized_or(covariance * axis, axis);
        const double along = glm::dot(axis, covariance * axis);
        const double across = covariance[0][0] + covariance[1][1] + covariance[2][2] - along;
        double ahead = 0.0, behind = 0.0;
        for (const Vec3& p : branch) {
            const double t = glm::dot(DVec3(p) - middle, axis);
            ahead = std::max(ahead, t);
            behind = std::max(behind, -t);
        }
        if (along > kSlender * across && std::sqrt(across) > kThick * thinner &&
            std::min(ahead, behind) > kBothSides * look) {
            leads_to[border.a].push_back(border.b);
            leads_to[border.b].push_back(border.a);
        }
    }
    // From the thickest on: what is reached by way of roots alone.
    std::vector<uint32_t> joined(stems.size(), Separation::kNone);
    for (const uint32_t trunk : by_radius) {
        if (joined[trunk] != Separation::kNone) continue;
        joined[trunk] = trunk;
        std::vector<uint32_t> members{trunk};
        for (size_t m = 0; m < members.size(); m++)
            for (const uint32_t other : leads_to[members[m]]) {
                if (joined[other] != Separation::kNone ||
                    stems[other].radius > kMostAlike * stems[trunk].radius)
                    continue;
                joined[other] = trunk;
                members.push_back(other);
            }
    }
    return joined;
}

}  // namespace treerec
