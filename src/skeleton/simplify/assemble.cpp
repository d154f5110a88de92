#include "skeleton/simplify/assemble.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr double kRelativeTolerance = 0.1;  // of the local radius
constexpr double kLeastTolerance = 0.003;   // metres
constexpr double kLongestSegment = 0.2;     // metres
constexpr size_t kBranchesPerTask = 64;

// How far station i is off the straight cone between a and b.
double deviation(const Station& station, const Station& a, const Station& b) {
    const DVec3 ab = b.position - a.position;
    const double square = glm::dot(ab, ab);
    const double t =
        square > 0.0 ? std::clamp(glm::dot(station.position - a.position, ab) / square, 0.0, 1.0) : 0.0;
    const double off_axis = glm::distance(station.position, a.position + t * ab);
    return std::max(off_axis, std::abs(station.radius - (a.radius + t * (b.radius - a.radius))));
}

// Marks the stations strictly between two kept ones that must stay.
void keep_bends(const std::vector<Station>& line, size_t begin, size_t end, double tolerance,
                std::vector<uint8_t>& keep) {
    std::vector<std::pair<size_t, size_t>> open{{begin, end}};
    while (!open.empty()) {
        const auto [a, b] = open.back();
        open.pop_back();
        if (b - a < 2) continue;
        double worst = 0.0;
        size_t at = (a + b) / 2;
        for (size_t i = a + 1; i < b; i++) {
            const double allowed =
                tolerance > 0.0 ? tolerance : std::max(kLeastTolerance, kRelativeTolerance * line[i].radius);
            const double off = deviation(line[i], line[a], line[b]) / allowed;
            if (off > worst) {
                worst = off;
                at = i;
            }
        }
        if (worst <= 1.0) {
            if (glm::distance(line[a].position, line[b].position) <= kLongestSegment) continue;
            at = (a + b) / 2;
        }
        keep[at] = 1;
        open.emplace_back(a, at);
        open.emplace_back(at, b);
    }
}

// What lies in a gap is as thick as its ends tell, all along: nodes from behind `from`, which is `last`, to
// before `to`. Returns the last of them.
NodeId taper_over_gap(Tree& tree, NodeId last, const Station& from, const Station& to) {
    if (from.radius - to.radius <= kRelativeTolerance * from.radius) return last;
    const int steps =
        static_cast<int>(std::ceil(glm::distance(from.position, to.position) / kLongestSegment));
    for (int k = 1; k < steps; k++) {
        const double t = static_cast<double>(k) / steps;
        last = tree.add_child(last, from.position + t * (to.position - from.position),
                              from.radius + t * (to.radius - from.radius), kGuessFlag);
    }
    return last;
}

}  // namespace

Tree assemble_tree(const std::vector<std::vector<Station>>& axes, const std::vector<SkeletonBranch>& branches,
                   double simplify_distance, PassSet left_out) {
    std::vector<std::vector<uint8_t>> keep(axes.size());
    for (size_t l = 0; l < axes.size(); l++) {
        keep[l].assign(axes[l].size(), 0);
        if (branches[l].parent < 0) keep[l].front() = 1;
        keep[l].back() = 1;
        for (size_t i = 0; i < axes[l].size(); i++)
            if (axes[l][i].bridged) {
                keep[l][i] = 1;
                if (i > 0) keep[l][i - 1] = 1;
            }
    }
    for (const SkeletonBranch& branch : branches)
        if (branch.parent >= 0) keep[branch.parent][branch.attach] = 1;

    // The line that is simplified starts on the parent's axis.
    parallel_for(axes.size(), kBranchesPerTask, [&](size_t begin, size_t end) {
        std::vector<Station> line;
        std::vector<uint8_t> kept;
        for (size_t l = begin; l < end; l++) {
            line.clear();
            if (branches[l].parent >= 0) {
                line.push_back(axes[branches[l].parent][branches[l].attach]);
                line.back().radius = axes[l].front().radius;
            }
            const auto first = static_cast<ptrdiff_t>(line.size());
            line.insert(line.end(), axes[l].begin(), axes[l].end());
            kept.assign(static_cast<size_t>(first), 1);
            kept.insert(kept.end(), keep[l].begin(), keep[l].end());
            kept.front() = 1;
            for (size_t a = 0, b = 1; b < line.size(); b++)
                if (kept[b]) {
                    keep_bends(line, a, b, simplify_distance, kept);
                    a = b;
                }
            std::copy(kept.begin() + first, kept.end(), keep[l].begin());
        }
    });

    Tree tree;
    std::vector<std::vector<NodeId>> ids(axes.size());
    for (size_t l = 0; l < axes.size(); l++) {
        ids[l].assign(axes[l].size(), kNoNode);
        NodeId last = branches[l].parent >= 0 ? ids[branches[l].parent][branches[l].attach] : kNoNode;
        for (size_t i = 0; i < axes[l].size(); i++) {
            if (!keep[l][i]) continue;
            const Station& station = axes[l][i];
            uint8_t flags = 0;
            if (station.measured) flags |= kMeasuredRadiusFlag;
            if (station.bridged) {
                flags |= kGuessFlag;
                if (i > 0 && !left_out.has(Pass::kGapTaper))
                    last = taper_over_gap(tree, last, axes[l][i - 1], station);
            }
            last = last == kNoNode ? tree.add_root(station.position, station.radius, flags)
                                   : tree.add_child(last, station.position, station.radius, flags);
            ids[l][i] = last;
        }
    }
    return tree.compacted();
}

}  // namespace treerec
