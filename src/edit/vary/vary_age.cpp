// What age makes of a variant.
//
// Growth slows down as a tree nears its size: over its age a (1: the tree itself) its height is a (3 - a) / 2
// of the tree's, steep at first, half as fast as the mean at 1. All lengths scale by that, all radii by its
// power that this tree's own branches show between their lengths and their radii. Twigs do not scale: each
// year's are as long and as thick on a young tree, only fewer, by the crown's surface. So the short branches
// are what a young tree does not have yet, with all that they bear, and with them its highest orders; the
// leader and what has trunk in it stay.
#include <algorithm>
#include <cmath>
#include <vector>

#include "edit/vary/vary.h"
#include "edit/vary/vary_parts.h"
#include "geometry/portable_math.h"
#include "geometry/random.h"

namespace treerec {

namespace {

constexpr size_t kFewBranches = 8;  // fewer show no allometry
// From geometric similarity to what carries its weight with room to spare; between them, elastic similarity:
// McMahon, "Size and Shape in Biology", Science 179, 1973.
constexpr double kLeastPower = 1.0, kElasticPower = 1.5, kMostPower = 2.0;

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

void VariantMaker::look_at_growth() {
    // The line of the reduced major axis through the logarithms: both sides scatter.
    std::vector<double> lengths, radii, twig_lengths, twig_radii;
    for (const VariedBranch& branch : branches_) {
        if (branch.first_child == branch.last_child) {
            twig_lengths.push_back(branch.length);
            twig_radii.push_back(radii_[branch.end - 1]);
        }
        if (!(branch.length > 0.0 && branch.radius > 0.0)) continue;
        lengths.push_back(portable::log(branch.length));
        radii.push_back(portable::log(branch.radius));
    }
    twig_length_ = median(twig_lengths);
    twig_radius_ = median(twig_radii);
    const auto scatter = [](const std::vector<double>& values) {
        double mean = 0.0, sum = 0.0;
        for (const double value : values)
            mean += value / static_cast<double>(values.size());
        for (const double value : values)
            sum += (value - mean) * (value - mean);
        return std::sqrt(sum);
    };
    const double spread = scatter(lengths);
    allometry_ = kElasticPower;
    if (lengths.size() >= kFewBranches && spread > 0.0)
        allometry_ = std::clamp(scatter(radii) / spread, kLeastPower, kMostPower);
}

void VariantMaker::set_age(Work& work, double age) const {
    if (age == 1.0) return;
    work.size = 0.5 * age * (3.0 - age);
    work.gauge = portable::pow(work.size, allometry_);
}

bool VariantMaker::is_yet_to_grow(const Work& work, const VariedBranch& branch, uint64_t key) const {
    if (work.size >= 1.0 || branch.stem) return false;
    // As many twigs as the crown's surface has room for; branches that are twigs' length by now are all
    // there.
    double there = work.size;
    if (branch.length > twig_length_ && twig_length_ > 0.0) there *= branch.length / twig_length_;
    if (there >= 1.0) return false;
    Random random(key, 3);
    return random.uniform() >= there * there;
}

}  // namespace treerec
