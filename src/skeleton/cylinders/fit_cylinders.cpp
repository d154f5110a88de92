#include <algorithm>
#include <utility>

#include "skeleton/branches/bends.h"
#include "skeleton/branches/forks.h"
#include "skeleton/branches/stems.h"
#include "skeleton/cylinders/bark.h"
#include "skeleton/cylinders/radii.h"
#include "skeleton/cylinders/refine.h"
#include "skeleton/cylinders/stem_base.h"
#include "skeleton/cylinders/tips.h"
#include "skeleton/stages.h"
#include "skeleton/twigs/hugging_shoots.h"

namespace treerec {

namespace {

// The places of the points that measures are taken from.
PointPlaces places_of_sample(const ThinnedCloud& thinned, PointPlaces& places) {
    if (thinned.sample.empty()) return std::move(places);
    PointPlaces own;
    for (const uint32_t point : thinned.cube) {
        own.branch.push_back(places.branch[point]);
        own.station.push_back(places.station[point]);
    }
    return own;
}

}  // namespace

void fit_cylinders(SkeletonWork& work) {
    std::vector<SkeletonBranch>& branches = work.branches;
    std::vector<std::vector<Station>>& axes = work.axes;
    work.progress.update(0.8, "Radii");
    work.axis_options.long_windows = true;
    axes = fit_axes(branches, work.slices, work.points(), work.scale, work.axis_options, work.progress);
    if (work.options.one_stem) {
        branches.resize(1);
        axes.resize(1);
    }
    if (work.does(Pass::kStraightStems)) straighten_stems(branches, axes);
    if (work.does(Pass::kPlantedBase) && !work.root.lying &&
        std::none_of(branches.begin(), branches.end(),
                     [](const SkeletonBranch& branch) { return branch.parent == 0 && branch.attach == 0; }))
        plant_stem_base(axes.front());
    if (work.does(Pass::kStraightBases)) straighten_bases(branches, axes);
    if (work.does(Pass::kLimitedBase) && !work.root.lying) limit_stem_base(axes.front());
    infer_radii(axes, branches, false, work.options.left_out);
    if (work.does(Pass::kForks)) lay_forks(branches, axes, work.slices, work.points(), work.progress);
    if (work.does(Pass::kTightBends)) lay_bends(branches, axes, work.slices, work.points(), work.progress);
    if (work.does(Pass::kEarlyStrips)) drop_strips(branches, axes, work.branch_options.least_escape);
    work.clock.stop("Radii", branches.size());
}

void refine_cylinders(SkeletonWork& work) {
    std::vector<SkeletonBranch>& branches = work.branches;
    std::vector<std::vector<Station>>& axes = work.axes;
    work.progress.update(0.9, "Refinement");
    infer_radii(axes, branches, false, work.options.left_out);
    if (work.does(Pass::kRefinement))
        refine_axes(axes, branches, places_of_sample(work.thinned, work.places), work.thinned.measured(),
                    work.progress, work.options.noise, work.options.left_out);
    if (work.options.fit_radii) work.known->tell(axes);
    if (work.does(Pass::kSeatedRoot)) seat_root(branches, axes);
    if (work.does(Pass::kLimitedBase) && !work.root.lying) limit_stem_base(axes.front());
    infer_radii(axes, branches, true, work.options.left_out);
    if (work.does(Pass::kPalmWidth) && work.options.one_stem) keep_width(axes.front());
    // Twigs that now lie on the bark of others were none.
    if (work.does(Pass::kLateStrips)) drop_strips(branches, axes, 0.5 * work.twig_options.least_escape);
    if (work.does(Pass::kHugging)) drop_hugging_shoots(branches, axes);
    if (work.does(Pass::kTightBends)) smooth_bends(branches, axes);
    if (work.does(Pass::kTips)) draw_back_tips(axes, branches, work.branch_options.minimum_branch);
    work.clock.stop("Refinement", branches.size());
}

}  // namespace treerec
