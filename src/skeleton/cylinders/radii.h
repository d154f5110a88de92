// Radii that never grow outward, measured where possible and inferred elsewhere.
#pragma once

#include <vector>

#include "skeleton/cylinders/axis.h"

namespace treerec {

// The points' noise (metres, standard deviation), as the scatter at the measured stations shows
// it; 0 where these are few.
double noise_of(const std::vector<std::vector<Station>>& axes);

// The most that wood may be thick whose section no points show, so far (metres) from its tip (McMahon and
// Kronauer 1976: thickness and length of branches are tied).
double thickest_unmeasured(double to_tip);

// Replaces every station's radius, in metres. Along a branch the measured radii (and, with little weight, the
// unmeasured stations' own estimates) go through a running median and an isotonic regression (pool adjacent
// violators, Ayer et al. 1955), so that they never grow outward. An unmeasured station's estimate is freed of
// the points' noise, and no thicker than the distance to the tip allows. Where no point told anything, the
// radius follows the distance to the tip as it does, in the median, where this tree was measured, and joins
// what points tell further in and out. No branch is thicker than its parent where it leaves it. last: axes do
// not change any more, so that where measured wood ends, it may be as thick as the points there say: it
// narrows evenly to the tip, or was cut. (Before, twigs around its end would be taken for its bark.)
void infer_radii(std::vector<std::vector<Station>>& axes, const std::vector<SkeletonBranch>& branches,
                 bool last = false, PassSet left_out = {});

// A palm's stem is as wide at its top, which fronds hide, as where it was last measured.
void keep_width(std::vector<Station>& stem);

}  // namespace treerec
