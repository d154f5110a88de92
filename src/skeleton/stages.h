// What all methods work on, how all begin and end, and the stages of the geodesic one, in the order that
// skeletonize() calls them. Each lies in the folder of its concept. Internal to skeleton/.
#pragma once

#include <optional>
#include <vector>

#include "progress.h"
#include "scan/point_cloud.h"
#include "skeleton/branches/skeleton_branches.h"
#include "skeleton/branches/slices.h"
#include "skeleton/cylinders/axis.h"
#include "skeleton/cylinders/known_radii.h"
#include "skeleton/geodesics/paths.h"
#include "skeleton/geodesics/root.h"
#include "skeleton/sampling/point_graph.h"
#include "skeleton/sampling/thin.h"
#include "skeleton/skeleton.h"
#include "skeleton/twigs/twigs.h"
#include "stage_clock.h"

namespace treerec {

// Lengths are metres of the cloud as it was enlarged to a usual tree's size: by `factor`.
struct SkeletonWork {
    SkeletonWork(const PointCloud& of, const SkeletonOptions& asked, double by, Progress* hears)
        : cloud(of), options(asked), factor(by), listener(hears), progress(hears, 0.0, 1.0) {}
    SkeletonWork(const SkeletonWork&) = delete;
    SkeletonWork& operator=(const SkeletonWork&) = delete;

    const PointCloud& cloud;
    const SkeletonOptions& options;
    const double factor;
    Progress* const listener;
    SubProgress progress;
    SkeletonResult result;
    StageClock clock{result.stages};

    // Of sampling,
    ThinnedCloud thinned;
    PointGraph graph;
    LocalScale first_scale;  // before it is known where wood is thick
    std::optional<KnownRadii> known;
    // geodesics,
    RootGuess root;
    double extent = 0.0;  // to the point farthest from the root
    PathTree paths;
    // branches,
    BranchOptions branch_options;
    AxisOptions axis_options;
    LocalScale scale;
    Slices slices;
    std::vector<SkeletonBranch> branches;
    // cylinders, and twigs.
    std::vector<std::vector<Station>> axes;
    TwigOptions twig_options;
    PointPlaces places;  // of the thinned points

    const std::vector<Vec3>& points() const { return thinned.points; }
    // Shorter ones are noise, metres; once the extent is known.
    double least_branch() const {
        return options.minimum_branch > 0.0 ? options.minimum_branch : automatic_branch(extent);
    }
    bool does(Pass pass) const { return !options.left_out.has(pass); }
    bool floods() const { return options.method == SkeletonMethod::kFlood; }
};

// sampling/: fewer points, as even as the scan allows. Throws Error where no tree can be made of them.
void sample_points(SkeletonWork& work);
// simplify/: of a trunk without a crown its sections, one after another, are the whole tree. Whether it is
// one.
bool take_stump(SkeletonWork& work);
// sampling/: which points are neighbours.
void link_neighbours(SkeletonWork& work);
// geodesics/: the root, and shortest paths to it, over wide gaps, too (Chen 2025, 2.2.2).
void find_paths(SkeletonWork& work);
// branches/: level sets of the way to the root, as branches (Verroust and Lazarus 2000).
void find_branches(SkeletonWork& work);
// cylinders/: an axis through each, and its radii.
void fit_cylinders(SkeletonWork& work);
// twigs/: thin wood that the level sets left over (TEASAR: Sato et al. 2000).
void find_twigs(SkeletonWork& work);
// cylinders/: all points of all wood once more, each where it belongs.
void refine_cylinders(SkeletonWork& work);
// simplify/: axes become a Tree.
void simplify(SkeletonWork& work);
// simplify/: the trunk is marked, the frame is the cloud's, and the root is at the origin, of the raw tree,
// too. Where the root lay, metres of the cloud's frame.
DVec3 finish(SkeletonWork& work);

}  // namespace treerec
