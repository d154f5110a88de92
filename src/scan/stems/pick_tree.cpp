#include "scan/stems/pick_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "error.h"
#include "geometry/portable_math.h"
#include "scan/stems/separate_trees.h"

namespace treerec {

namespace {

std::string place_text(const DVec3& p) {
    char text[160];
    std::snprintf(text, sizeof(text), "(%.2f, %.2f, %.2f)", p.x, p.y, p.z);
    return text;
}

size_t nearest_to(const DVec3& position, const Separation& separation, const ScanFrame& frame) {
    if (!is_finite(position)) throw Error("The position of the tree to take must be three numbers.");
    const DVec3 at = frame.to_tree(position);
    size_t best = 0;
    double best_distance = std::numeric_limits<double>::max();
    for (size_t s = 0; s < separation.stems.size(); s++) {
        const DVec3& foot = separation.stems[s].foot;
        const double distance = portable::hypot(foot.x - at.x, foot.z - at.z);
        if (distance >= best_distance) continue;
        best_distance = distance;
        best = s;
    }
    return best;
}

}  // namespace

PickReport choose_tree(const Separation& separation, const std::vector<Vec3>& points,
                       const std::vector<uint32_t>& weights, const ScanFrame& frame,
                       const PickOptions& options, std::vector<std::string>& warnings) {
    PickReport report;
    const size_t count = std::max<size_t>(1, separation.stems.size());
    if (options.number < 1 || (!options.position && options.number > count))
        throw Error("Tree number " + std::to_string(options.number) + " was asked for, but the cloud holds " +
                    (count == 1 ? "one tree" : std::to_string(count) + " trees") + ".");
    if (count < 2) return report;
    report.trees.resize(count);
    for (size_t s = 0; s < count; s++)
        report.trees[s].foot = frame.to_scan(separation.stems[s].foot);
    for (size_t i = 0; i < points.size(); i++) {
        const uint32_t s = separation.of_point[i];
        if (s == Separation::kNone) continue;
        report.trees[s].points += weights[i];
        report.trees[s].height =
            std::max(report.trees[s].height, static_cast<double>(points[i].y) - separation.stems[s].foot.y);
    }
    report.taken = options.position ? nearest_to(*options.position, separation, frame) : options.number - 1;
    const StandingTree& taken = report.trees[report.taken];
    char height[32];
    std::snprintf(height, sizeof(height), "%.1f m", taken.height);
    warnings.push_back(
        "The cloud holds " + std::to_string(count) + " trees; number " + std::to_string(report.taken + 1) +
        (report.taken == 0 ? ", the largest, was taken. It is " : " was taken. It is ") + height +
        " high and stands at " + place_text(taken.foot) +
        " in the scan. Another one can be chosen by its number or by a place near it. If they are "
        "one tree's stems or roots, take all of the scan for one tree (--one-tree).");
    return report;
}

}  // namespace treerec
