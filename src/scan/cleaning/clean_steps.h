// The steps of clean_cloud(), each on sample points in canonical order. Internal to scan/.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/vec.h"
#include "progress.h"
#include "scan/cleaning/clean_cloud.h"
#include "scan/robust.h"

namespace treerec {

// Takes the points that are near white or near black, where they are few, or where they lie around the wood
// as sky does or strewn over it as noise does; says so in the report where they are many.
void clean_colors(PointCloud& cloud, const CleanOptions& options, CleanReport& report,
                  const Progress* progress);

// All others take points in metres, Y up, and return one flag per point: 1 where it should go. ranges:
// robust_ranges() of the points or of a cloud that holds them.

// Points whose mean distance to their k nearest neighbours is beyond the median of all points by `deviations`
// robust standard deviations (1.4826 x the median absolute deviation), and stands out among its neighbours
// too: a sparse twig is thin everywhere and stays (Chen 2025, 3.2.1, made local). spacing: gets the mean
// distance that 95 % of the points stay under.
std::vector<uint8_t> find_outliers(const std::vector<Vec3>& points, const std::array<Range, 3>& ranges, int k,
                                   double deviations, double& spacing, const Progress* progress);

// Small clusters far from the rest, but not what lies beyond a gap in the tree: below the foot, or in line
// with a stem or branch. spacing: as from find_outliers().
std::vector<uint8_t> find_fragments(const std::vector<Vec3>& points, double spacing,
                                    const Progress* progress);

// The ground's height: a plane and, in square columns, how far the ground is above it.
struct Ground {
    bool found = false;
    DVec2 centre{0.0};
    double height = 0.0;  // of the plane at the centre
    DVec2 slope{0.0};
    Range x;
    Range z;
    double cell = 1.0;
    int width = 0;
    int depth = 0;
    std::vector<float> relief;  // by column, z * width + x
    double tolerance = 0.0;     // how thick the layer is taken to be, to either side
    double surface = 0.0;       // how far above it half of its points lie; it runs along the lowest ones

    double above_plane(const Vec3& p) const {
        return p.y - height - glm::dot(slope, DVec2(p.x, p.z) - centre);
    }
    // Beyond the columns, the nearest one counts.
    double above(const Vec3& p) const {
        const int i = static_cast<int>(std::clamp((p.x - x.low) / cell, 0.0, width - 1.0));
        const int k = static_cast<int>(std::clamp((p.z - z.low) / cell, 0.0, depth - 1.0));
        return above_plane(p) - static_cast<double>(relief[static_cast<size_t>(k * width + i)]);
    }
};

// The ground around the stem, where there is any: a wide, thin, well filled layer with a slope below 35
// degrees that has nothing under it; hollows and bumps belong to it as far as it runs on smoothly. The stem's
// foot stays. ground: gets it.
std::vector<uint8_t> find_ground(const std::vector<Vec3>& points, Ground& ground, const Progress* progress);

// Walls and fences: upright planes, wide and filled, that keep to their plane more sharply than a crown's or
// a hedge's face, with next to nothing right before or behind them; and what hangs on them: sills, lamps.
// None of a room or a house, in which there is no tree: with more than three walls, or with hardly more than
// walls and other flat surfaces. points: without ground. walls: gets the length and the height of each.
std::vector<uint8_t> find_walls(const std::vector<Vec3>& points, std::vector<DVec2>& walls,
                                const Progress* progress);

// Low things that stand on the ground apart from a tree of which it is known that it stands nearest to
// `place`: benches, bushes. Nothing where no ground was found. points: without ground.
std::vector<uint8_t> find_beside(const std::vector<Vec3>& points, const Ground& ground, const DVec3& place,
                                 const Progress* progress);

}  // namespace treerec
