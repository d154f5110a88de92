#include <algorithm>
#include <utility>

#include "skeleton/branches/stems.h"
#include "skeleton/cylinders/bark.h"
#include "skeleton/cylinders/foot.h"
#include "skeleton/cylinders/radii.h"
#include "skeleton/cylinders/refine.h"
#include "skeleton/cylinders/tips.h"
#include "skeleton/stages.h"

namespace treerec {

namespace {

// The places of the points that measures are taken from.
PointPlaces places_of_sample(const ThinnedCloud& thinned, PointPlaces& places) {
    if (thinned.sample.empty()) return std::move(places);
    PointPlaces own;
    for (const uint32_t point : thinned.cube) {
        own.limb.push_back(places.limb[point]);
        own.station.push_back(places.station[point]);
    }
    return own;
}

}  // namespace

void fit_cylinders(SkeletonWork& work) {
    std::vector<Limb>& limbs = work.limbs;
    std::vector<std::vector<Station>>& axes = work.axes;
    work.progress.update(0.8, "Radii");
    work.axis_options.long_windows = true;
    axes = fit_axes(limbs, work.slices, work.points(), work.scale, work.axis_options, work.progress);
    if (work.options.one_stem) {
        limbs.resize(1);
        axes.resize(1);
    }
    straighten_stems(limbs, axes);
    if (!work.root.lying && std::none_of(limbs.begin(), limbs.end(), [](const Limb& limb) {
            return limb.parent == 0 && limb.attach == 0;
        }))
        plant_foot(axes.front());
    straighten_bases(limbs, axes);
    if (!work.root.lying) limit_foot(axes.front());
    infer_radii(axes, limbs);
    drop_strips(limbs, axes, work.limb_options.least_escape);
    work.clock.stop("Radii", limbs.size());
}

void refine_cylinders(SkeletonWork& work) {
    std::vector<Limb>& limbs = work.limbs;
    std::vector<std::vector<Station>>& axes = work.axes;
    work.progress.update(0.9, "Refinement");
    infer_radii(axes, limbs);
    refine_axes(axes, limbs, places_of_sample(work.thinned, work.places), work.thinned.measured(),
                work.progress, work.options.noise);
    if (work.options.fit_radii) work.known->tell(axes);
    seat_root(limbs, axes);
    if (!work.root.lying) limit_foot(axes.front());
    infer_radii(axes, limbs, true);
    if (work.options.one_stem) keep_width(axes.front());
    // Twigs that now lie on the bark of others were none.
    drop_strips(limbs, axes, 0.5 * work.twig_options.least_escape);
    draw_back_tips(axes, limbs, work.limb_options.minimum_branch);
    work.clock.stop("Refinement", limbs.size());
}

}  // namespace treerec
