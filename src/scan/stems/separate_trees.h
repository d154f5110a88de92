// Which points belong to which tree. Internal to scan/.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/scan_frame.h"
#include "scan/cleaning/clean_steps.h"
#include "scan/stems/pick_tree.h"

namespace treerec {

// A stem that stands by itself: its slices, from the foot upwards.
struct Stem {
    DVec3 foot{0.0};             // tree space
    DVec2 lean{0.0};             // run over rise, along x and z
    double radius = 0.0;         // metres, root mean square over its slices
    bool in_branches = false;    // seen only as the densest spot among low branches
    bool bark = false;           // its round sections are seen
    std::vector<uint32_t> seed;  // points of its slices
    std::vector<DVec2> feet;     // x, z: of all stems that were taken for its tree's, its own first
};

struct Separation {
    static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

    std::vector<Stem> stems;         // largest tree first; fewer than two: one tree
    std::vector<uint32_t> of_point;  // index into stems, or kNone: low clutter, parts of trees without a stem
};

// Two trees count as two only where two stems are seen from the ground up, apart from each other, thick and
// compact: forks, stems from one stool, hanging and lying branches stay with their tree. Where the cloud is
// far wider than high and has ground below (an airborne scan), tree tops count instead of stems. Then all
// trees grow at once over the points, along the way from a stem that jumps and turns least, so that touching
// crowns part in between (after Tao et al. 2015, "Segmenting tree crowns from terrestrial and mobile LiDAR
// data by exploring ecological theories", and Livny et al. 2010, section 4.1). points: distinct, in canonical
// order, metres, Y up, without ground. spacing: as from find_outliers().
Separation separate_trees(const std::vector<Vec3>& points, const Ground& ground, double spacing,
                          const Progress* progress);

// The stems alone; exposed for separate_trees().
std::vector<Stem> find_stems(const std::vector<Vec3>& points, const std::vector<float>& above, double height,
                             double spacing, bool on_ground, const Progress* progress);
// Adds those whose round bark is seen (round_stems.h), straight up or along a leaning stem, and puts them in
// the place of `stems` that are dense there for another reason, such as bushes or two stems side by side.
void add_round_stems(const std::vector<Vec3>& points, const std::vector<float>& above, double height,
                     std::vector<Stem>& stems, const Progress* progress);
std::vector<Stem> find_tops(const std::vector<Vec3>& points, const std::vector<float>& above, double height,
                            double spacing, const Progress* progress);

// Makes one of those whose feet stand in a chain, each as near to the next as two trees never stand: the
// culms of a clump.
void join_clumps(std::vector<Stem>& stems, double height);
// Which stems are one tree's though they stand apart, by stem: the thickest of its tree. Wood about as thick
// as the thinner stem leads from one to the other, as from a banyan's trunk along its branch to a root that
// came down from it, and on to the next root; all are much thinner than the trunk. Crowns that touch do so by
// leaves and twigs, and stems whose crowns grow through each other are more alike. centres: of the occupied
// voxels. tree: by voxel, which stem it grew from.
std::vector<uint32_t> joined_by_wood(const std::vector<Stem>& stems, const std::vector<Vec3>& centres,
                                     const std::vector<uint32_t>& tree, double voxel,
                                     const Progress* progress);

// Which of them to take, with a sentence about it. points, weights (points of the cloud that each stands
// for): those that were separated. Throws Error where there is no such tree.
PickReport choose_tree(const Separation& separation, const std::vector<Vec3>& points,
                       const std::vector<uint32_t>& weights, const ScanFrame& frame,
                       const PickOptions& options, std::vector<std::string>& warnings);

}  // namespace treerec
