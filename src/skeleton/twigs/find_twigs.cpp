#include <algorithm>
#include <limits>

#include "skeleton/cylinders/radii.h"
#include "skeleton/stages.h"

namespace treerec {

namespace {

constexpr double kTwigEscape = 0.02;  // metres that a twig must reach out of the bark,
constexpr double kNoiseEscape = 2.5;  // and times the scan's noise

}  // namespace

void find_twigs(SkeletonWork& work) {
    work.twig_options.minimum_branch = work.branch_options.minimum_branch;
    work.twig_options.least_escape =
        work.options.one_stem
            ? std::numeric_limits<double>::max()
            : std::max(kTwigEscape, kNoiseEscape * std::max(noise_of(work.axes), work.options.noise));
    work.twig_options.left_out = work.options.left_out;
    work.places = add_twigs(work.points(), work.graph, work.first_scale, work.paths, work.slices,
                            work.twig_options, work.branches, work.axes, work.progress);
    work.clock.stop("Twigs", work.branches.size());
}

}  // namespace treerec
