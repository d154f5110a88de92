#include "foliage/leaf_area_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/parallel.h"
#include "geometry/portable_math.h"
#include "geometry/portable_trig.h"

namespace treerec {

namespace {

constexpr double kEdge = 0.4;          // metres
constexpr double kFewestAcross = 8.0;  // cubes along the longest side of a crown
constexpr double kMostCubes = 2e6;
constexpr int64_t kBorder = 3;       // empty cubes around all leaves: smoothing spreads two
constexpr double kParts = 65536.0;   // of a cube's face, in which areas are counted
constexpr double kExtinction = 0.5;  // leaves that face anywhere
constexpr size_t kRays = 16;
constexpr double kDark = 16.0;                 // leaf area that lets nothing through
constexpr double kGolden = 2.399963229728653;  // radians: directions that spread evenly
constexpr double kOpenSky = 0.6;     // what a leaf at the edge of a crown sees beside that: it counts as open
constexpr double kScattered = 0.35;  // of a leaf's light, that comes from other leaves: none is black
constexpr double kCrownShare = 0.5;  // of a leaf's outward, that is the whole crown's
constexpr size_t kLeavesPerChunk = 1024;
constexpr size_t kRowsPerChunk = 16;
constexpr int kMostSamples = 16;  // along one leaf

DVec3 middle_of(const LeafPlacement& leaf) {
    return DVec3(leaf.position) + DVec3(leaf.y) * (0.5 * static_cast<double>(leaf.size));
}

// The cubes that a ray from the middle of one passes, as steps of an index, with how much of it lies in each.
struct Ray {
    std::vector<std::array<int64_t, 3>> cubes;
};

std::array<Ray, kRays> rays_over(const int64_t (&count)[3]) {
    std::array<Ray, kRays> rays;
    const double reach =
        std::sqrt(static_cast<double>(count[0] * count[0] + count[1] * count[1] + count[2] * count[2]));
    for (size_t i = 0; i < kRays; i++) {
        // Evenly over the solid angle: a grey sky.
        const double up = (static_cast<double>(i) + 0.5) / static_cast<double>(kRays);
        const SineCosine turn = portable_sine_cosine(kGolden * static_cast<double>(i));
        const double flat = std::sqrt(1.0 - up * up);
        const DVec3 way(flat * turn.cosine, up, flat * turn.sine);
        for (double along = 1.0; along < reach; along += 1.0) {
            std::array<int64_t, 3> cube{};
            for (int axis = 0; axis < 3; axis++)
                cube[static_cast<size_t>(axis)] = static_cast<int64_t>(std::floor(way[axis] * along + 0.5));
            rays[i].cubes.push_back(cube);
        }
    }
    return rays;
}

}  // namespace

LeafAreaGrid::LeafAreaGrid(const std::vector<LeafGroup>& groups) {
    Bounds box;
    for (const LeafGroup& group : groups)
        for (const LeafPlacement& leaf : *group.leaves) {
            box.add(DVec3(leaf.position));
            box.add(DVec3(leaf.position) + DVec3(leaf.y) * static_cast<double>(leaf.size));
        }
    if (box.empty()) return;
    place(box);
    fill(groups);
    smooth();
    look_up();
}

// Cubes of one lattice, whatever the leaves are, so that what is pruned elsewhere leaves them where they are.
void LeafAreaGrid::place(const Bounds& box) {
    const DVec3 size = box.size();
    const double longest = std::max({size.x, size.y, size.z, 1e-6});
    edge_ = kEdge;
    while (edge_ * kFewestAcross > longest)
        edge_ *= 0.5;
    const auto cubes = [&] {
        const DVec3 n = glm::floor(size / edge_) + 2.0 + 2.0 * static_cast<double>(kBorder);
        return n.x * n.y * n.z;
    };
    while (cubes() > kMostCubes)
        edge_ *= 2.0;
    const DVec3 first = glm::floor(box.min / edge_) - static_cast<double>(kBorder);
    const DVec3 last = glm::floor(box.max / edge_) + static_cast<double>(kBorder);
    low_ = first * edge_;
    for (int axis = 0; axis < 3; axis++)
        count_[axis] = static_cast<int64_t>(last[axis] - first[axis]) + 1;
}

size_t LeafAreaGrid::index(const int64_t (&cell)[3]) const {
    return static_cast<size_t>((cell[1] * count_[2] + cell[2]) * count_[0] + cell[0]);
}

void LeafAreaGrid::fill(const std::vector<LeafGroup>& groups) {
    // Whole numbers add up to the same in every order.
    std::vector<uint64_t> parts(static_cast<size_t>(count_[0] * count_[1] * count_[2]), 0);
    const double unit = edge_ * edge_ / kParts;
    for (const LeafGroup& group : groups)
        for (const LeafPlacement& leaf : *group.leaves) {
            const auto size = static_cast<double>(leaf.size);
            const int samples = std::clamp(static_cast<int>(std::ceil(size / edge_)), 1, kMostSamples);
            const auto share = static_cast<uint64_t>(group.area * size * size / (unit * samples) + 0.5);
            for (int i = 0; i < samples; i++) {
                const DVec3 p =
                    DVec3(leaf.position) + DVec3(leaf.y) * (size * (static_cast<double>(i) + 0.5) / samples);
                int64_t cell[3];
                for (int axis = 0; axis < 3; axis++)
                    cell[axis] = std::clamp(static_cast<int64_t>(std::floor((p[axis] - low_[axis]) / edge_)),
                                            kBorder, count_[axis] - 1 - kBorder);
                parts[index(cell)] += share;
            }
        }
    density_.resize(parts.size());
    for (size_t i = 0; i < parts.size(); i++)
        density_[i] = static_cast<float>(static_cast<double>(parts[i]) / kParts / edge_);
}

// Binomially, twice along each axis.
void LeafAreaGrid::smooth() {
    std::vector<float> other(density_.size());
    const int64_t strides[3] = {1, count_[0] * count_[2], count_[0]};
    for (int pass = 0; pass < 6; pass++) {
        const int axis = pass % 3;
        const int64_t stride = strides[axis];
        const auto rows = static_cast<size_t>(count_[1] * count_[2]);
        parallel_for(rows, kRowsPerChunk, [&](size_t begin, size_t end) {
            for (size_t row = begin; row < end; row++)
                for (int64_t x = 0; x < count_[0]; x++) {
                    const auto at = static_cast<int64_t>(row) * count_[0] + x;
                    const int64_t along[3] = {x, static_cast<int64_t>(row) / count_[2],
                                              static_cast<int64_t>(row) % count_[2]};
                    const bool inside = along[axis] > 0 && along[axis] < count_[axis] - 1;
                    const auto i = static_cast<size_t>(at);
                    other[i] =
                        !inside ? 0.0f
                                : 0.5f * density_[i] + 0.25f * (density_[static_cast<size_t>(at - stride)] +
                                                                density_[static_cast<size_t>(at + stride)]);
                }
        });
        std::swap(density_, other);
    }
}

void LeafAreaGrid::look_up() {
    sky_.assign(density_.size(), 1.0f);
    const std::array<Ray, kRays> rays = rays_over(count_);
    const auto rows = static_cast<size_t>(count_[1] * count_[2]);
    parallel_for(rows, kRowsPerChunk, [&](size_t begin, size_t end) {
        for (size_t row = begin; row < end; row++)
            for (int64_t x = 0; x < count_[0]; x++) {
                const int64_t own[3] = {x, static_cast<int64_t>(row) / count_[2],
                                        static_cast<int64_t>(row) % count_[2]};
                const float here = density_[index(own)];
                if (here <= 0.0f) continue;
                double sum = 0.0;
                for (const Ray& ray : rays) {
                    // Half of the cube that it begins in lies before it.
                    double met = 0.5 * static_cast<double>(here);
                    for (const auto& step : ray.cubes) {
                        const int64_t cell[3] = {x + step[0], own[1] + step[1], own[2] + step[2]};
                        if (cell[0] < 0 || cell[0] >= count_[0] || cell[1] >= count_[1] || cell[2] < 0 ||
                            cell[2] >= count_[2] || met * edge_ > kDark)
                            break;
                        met += static_cast<double>(density_[index(cell)]);
                    }
                    sum += portable::exp(-kExtinction * met * edge_);
                }
                sky_[index(own)] = static_cast<float>(sum / static_cast<double>(kRays));
            }
    });
}

double LeafAreaGrid::sample(const std::vector<float>& of, const DVec3& p) const {
    const DVec3 at = (p - low_) / edge_ - 0.5;
    int64_t cell[3];
    double part[3];
    for (int axis = 0; axis < 3; axis++) {
        const double inside = std::clamp(at[axis], 0.0, static_cast<double>(count_[axis] - 1) - 1e-9);
        cell[axis] = static_cast<int64_t>(inside);
        part[axis] = inside - static_cast<double>(cell[axis]);
    }
    double sum = 0.0;
    for (int corner = 0; corner < 8; corner++) {
        int64_t near[3];
        double weight = 1.0;
        for (int axis = 0; axis < 3; axis++) {
            const bool next = (corner >> axis & 1) != 0;
            near[axis] = std::min(cell[axis] + (next ? 1 : 0), count_[axis] - 1);
            weight *= next ? part[axis] : 1.0 - part[axis];
        }
        sum += weight * static_cast<double>(of[index(near)]);
    }
    return sum;
}

DVec3 LeafAreaGrid::outward(const DVec3& p) const {
    DVec3 slope(0.0);
    for (int axis = 0; axis < 3; axis++) {
        DVec3 step(0.0);
        step[axis] = edge_;
        slope[axis] = density(p - step) - density(p + step);
    }
    return slope / std::max(density(p), 1e-9);
}

void light_leaves(const std::vector<LeafGroup>& groups) {
    const LeafAreaGrid grid(groups);
    if (grid.empty()) return;
    for (const LeafGroup& group : groups) {
        std::vector<LeafPlacement>& leaves = *group.leaves;
        parallel_for(leaves.size(), kLeavesPerChunk, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; i++) {
                LeafPlacement& leaf = leaves[i];
                const DVec3 middle = middle_of(leaf), crown(leaf.outward);
                leaf.outward = Vec3(normalized_or(grid.outward(middle) + kCrownShare * crown, crown));
                const double open = std::min(grid.sky(middle) / kOpenSky, 1.0);
                leaf.occlusion = static_cast<float>(kScattered + (1.0 - kScattered) * open);
            }
        });
    }
}

}  // namespace treerec
