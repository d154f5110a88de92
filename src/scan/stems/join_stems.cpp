#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "geometry/covariance.h"
#include "geometry/groups.h"
#include "geometry/point_tree.h"
#include "scan/stems/separate_trees.h"

namespace treerec {

namespace {

constexpr double kLook = 4.0;     // of a limb's thickness: how far it is looked along, to both sides
constexpr double kSlender = 2.0;  // variance along a limb over that across: of a ball it is .5, of a sheet 1
constexpr double kThick = 0.5;    // of the thinner stem's radius: a limb that may bear it
constexpr double kBothSides = 0.5;   // of the look: the limb goes on that far to either side
constexpr double kReach = 2.5;       // voxels: what is no further away is beside, as the scan has gaps
constexpr size_t kFewestAcross = 8;  // voxels where a limb is cut through
constexpr double kCoarse = 2.2;  // of the thinner stem's radius: larger voxels do not tell limbs from twigs
constexpr size_t kFewest = 12;   // voxels of a limb
constexpr double kWidest = 8.0;  // of the thicker stem's radius: what is wider is no limb

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

std::vector<uint32_t> joined_by_wood(const std::vector<Stem>& stems, const std::vector<Vec3>& centres,
                                     const std::vector<uint32_t>& tree, double voxel,
                                     const Progress* progress) {
    // Numbered from the thickest, so that a group's name is its thickest stem.
    std::vector<uint32_t> by_radius(stems.size());
    for (uint32_t s = 0; s < stems.size(); s++)
        by_radius[s] = s;
    std::stable_sort(by_radius.begin(), by_radius.end(),
                     [&](uint32_t a, uint32_t b) { return stems[a].radius > stems[b].radius; });
    std::vector<uint32_t> rank(stems.size());
    for (uint32_t r = 0; r < by_radius.size(); r++)
        rank[by_radius[r]] = r;
    const PointTree places(centres, progress);
    Groups trees(stems.size());
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
        std::vector<Vec3> limb;
        for (const uint32_t c : beside(places, Vec3(middle), look))
            if (tree[c] == border.a || tree[c] == border.b) limb.push_back(centres[c]);
        if (limb.size() < kFewest) continue;
        const DMat3 covariance = covariance_of(limb);
        DVec3 axis(1.0, 1.0, 1.0);
        for (int i = 0; i < 32; i++)
            axis = normalized_or(covariance * axis, axis);
        const double along = glm::dot(axis, covariance * axis);
        const double across = covariance[0][0] + covariance[1][1] + covariance[2][2] - along;
        double ahead = 0.0, behind = 0.0;
        for (const Vec3& p : limb) {
            const double t = glm::dot(DVec3(p) - middle, axis);
            ahead = std::max(ahead, t);
            behind = std::max(behind, -t);
        }
        if (along > kSlender * across && std::sqrt(across) > kThick * thinner &&
            std::min(ahead, behind) > kBothSides * look)
            trees.join(rank[border.a], rank[border.b]);
    }
    std::vector<uint32_t> joined(stems.size());
    for (uint32_t s = 0; s < stems.size(); s++)
        joined[s] = by_radius[trees.find(rank[s])];
    return joined;
}

}  // namespace treerec
