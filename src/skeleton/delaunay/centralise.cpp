#include "skeleton/delaunay/centralise.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "geometry/parallel.h"
#include "geometry/point_tree.h"
#include "skeleton/sampling/thin.h"

namespace treerec {

namespace {

constexpr double kOwn = 2.2;        // radii that a point of the bark lies at most from the path up its branch
constexpr double kBall = 1.8;       // radii: the ball that the mean is taken over,
constexpr double kLeastBall = 1.5;  // and spacings, at least
constexpr int kShifts = 3;
constexpr size_t kGrain = 256;
constexpr double kFine = 0.15;  // of the radius: points that are nearer to each other count as one

// By point: the radius of the wood that it lies on. Most points of the bark end a path of their own, so it is
// that of the stoutest path that passes no farther away than it is wide.
std::vector<double> wood_radii(const std::vector<Vec3>& points, const InitialSkeleton& skeleton,
                               const TrunkCylinder& trunk, double spacing, const Progress& progress) {
    std::vector<double> radius(points.size());
    std::map<int, std::vector<uint32_t>, std::greater<>> octaves;
    for (uint32_t v = 0; v < points.size(); v++) {
        radius[v] = std::min(trunk.radius, allometric_radius(trunk, skeleton.reach[v]));
        if (radius[v] > spacing) octaves[std::ilogb(radius[v])].push_back(v);
    }
    const std::vector<double> own = radius;
    std::vector<uint8_t> claimed(points.size(), 0);
    for (const auto& [octave, stout] : octaves) {
        std::vector<Vec3> places;
        for (const uint32_t v : stout)
            places.push_back(points[v]);
        const PointTree tree(places, &progress);
        const double farthest = kOwn * std::ldexp(2.0, octave);
        // By name: Clang before 16 captures no structured binding.
        parallel_for(points.size(), kGrain, [&, &stout = stout](size_t begin, size_t end) {
            progress.check();
            for (size_t v = begin; v < end; v++) {
                if (claimed[v]) continue;
                uint32_t index[2];
                float squared[2];
                if (tree.nearest(points[v], 1, index, squared) == 0) continue;
                const double thick = own[stout[index[0]]];
                if (squared[0] > farthest * farthest || squared[0] > kOwn * kOwn * thick * thick) continue;
                radius[v] = std::max(radius[v], thick);
                claimed[v] = 1;
            }
        });
    }
    return radius;
}

struct MeanWithin {
    const std::vector<Vec3>& places;
    float square;
    DVec3 sum{0.0};
    size_t count = 0;

    float limit() const { return square; }
    void add(float, uint32_t index) {
        sum += DVec3(places[index]);
        count++;
    }
};

}  // namespace

std::vector<Vec3> centralise_points(const std::vector<Vec3>& points, const InitialSkeleton& skeleton,
                                    const TrunkCylinder& trunk, double spacing, Progress& progress) {
    const std::vector<double> radius = wood_radii(points, skeleton, trunk, spacing, progress);
    // Wood of about the same thickness is looked at together, thinned to what a mean needs: by octave.
    std::map<int, std::vector<uint32_t>> octaves;
    for (uint32_t v = 0; v < points.size(); v++)
        octaves[std::ilogb(std::max(radius[v], spacing))].push_back(v);
    std::vector<Vec3> moved = points;
    for (const auto& [octave, own] : octaves) {
        std::vector<Vec3> around;
        for (auto it = octaves.find(octave); it != octaves.end() && it->first <= octave + 1; ++it)
            for (const uint32_t v : it->second)
                around.push_back(points[v]);
        if (const auto thinner = octaves.find(octave - 1); thinner != octaves.end())
            for (const uint32_t v : thinner->second)
                around.push_back(points[v]);
        around = thin_points(around, std::max(spacing, kFine * std::ldexp(1.0, octave)), progress);
        const PointTree tree(around, &progress);
        parallel_for(own.size(), kGrain, [&, &own = own](size_t begin, size_t end) {
            progress.check();
            for (size_t i = begin; i < end; i++) {
                const double ball = std::max(kBall * radius[own[i]], kLeastBall * spacing);
                Vec3& place = moved[own[i]];
                for (int shift = 0; shift < kShifts; shift++) {
                    MeanWithin mean{around, static_cast<float>(ball * ball)};
                    tree.search(place, mean);
                    if (mean.count > 0) place = Vec3(mean.sum / static_cast<double>(mean.count));
                }
            }
        });
    }
    return moved;
}

}  // namespace treerec
