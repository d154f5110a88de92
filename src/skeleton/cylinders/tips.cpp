#include "skeleton/cylinders/tips.h"

#include <algorithm>

namespace treerec {

namespace {

constexpr double kBeyond = 2.0;      // radii: so far the farthest point is beyond the axis' end
constexpr double kThickest = 0.008;  // metres: thicker wood was cut, and its end is flat
constexpr double kMostShare = 0.5;   // of the way from the last fork
constexpr double kMargin = 1.05;     // times the shortest branch: simplification takes the rest

}  // namespace

void draw_back_tips(std::vector<std::vector<Station>>& axes, const std::vector<SkeletonBranch>& branches,
                    double minimum_branch) {
    std::vector<int32_t> last_fork(branches.size(), -1);
    for (const SkeletonBranch& branch : branches)
        if (branch.parent >= 0) last_fork[branch.parent] = std::max(last_fork[branch.parent], branch.attach);
    for (size_t l = 0; l < axes.size(); l++) {
        std::vector<Station>& line = axes[l];
        if (line.back().measured || line.back().radius > kThickest) continue;
        const size_t fork = static_cast<size_t>(std::max(0, last_fork[l]));
        // With no fork of its own, the branch's way begins on its parent.
        double length = 0.0;
        if (last_fork[l] < 0 && branches[l].parent >= 0)
            length = glm::distance(axes[branches[l].parent][branches[l].attach].position, line[0].position);
        for (size_t i = fork; i + 1 < line.size(); i++)
            length += glm::distance(line[i].position, line[i + 1].position);
        double back =
            std::min({kBeyond * line.back().radius, kMostShare * length, length - kMargin * minimum_branch});
        while (back > 0.0 && line.size() > fork + 1) {
            Station& tip = line.back();
            const Station& before = line[line.size() - 2];
            if (tip.bridged) break;
            const double step = glm::distance(tip.position, before.position);
            if (step > back) {
                tip.position += back / step * (before.position - tip.position);
                break;
            }
            back -= step;
            const double radius = tip.radius;
            line.pop_back();
            line.back().radius = std::min(line.back().radius, radius);
        }
    }
}

}  // namespace treerec
