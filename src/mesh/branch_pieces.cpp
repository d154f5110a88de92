#include "mesh/branch_pieces.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "geometry/segment.h"
#include "tree/branches.h"

namespace treerec {

namespace {

// The wood of one branch that is stout enough, as a polyline.
struct StoutBranch {
    std::vector<DVec3> points;
    std::vector<double> radii;
    std::vector<NodeId> nodes;
};

// Some of a branch's points, [begin, end], and how well one shape stands for them.
struct Stretch {
    int32_t branch = 0;
    int32_t begin = 0;
    int32_t end = 0;
    double radius = 0.0;    // on average
    double error = 0.0;     // square metres
    int32_t farthest = -1;  // the inner point that strays most, where to part it; -1 if none does
};

Stretch fit(const std::vector<StoutBranch>& branches, int32_t index, int32_t begin, int32_t end,
            double tolerance, bool tapered) {
    const StoutBranch& branch = branches[index];
    Stretch stretch{index, begin, end, 0.0, 0.0, -1};
    double length = 0.0;
    std::vector<double> run{0.0};
    for (int32_t i = begin; i < end; ++i) {
        const double step = glm::length(branch.points[i + 1] - branch.points[i]);
        stretch.radius += 0.5 * (branch.radii[i] + branch.radii[i + 1]) * step;
        length += step;
        run.push_back(length);
    }
    // Two nodes may lie at one place.
    stretch.radius = length > 0.0 ? stretch.radius / length : branch.radii[end];
    double worst = tolerance;
    double before = 0.0;
    for (int32_t i = begin; i <= end; ++i) {
        const double share = length > 0.0 ? run[i - begin] / length : 0.5;
        const double radius = tapered
                                  ? branch.radii[begin] + (branch.radii[end] - branch.radii[begin]) * share
                                  : stretch.radius;
        const double off = distance_to_segment(branch.points[i], branch.points[begin], branch.points[end]) +
                           std::abs(branch.radii[i] - radius);
        if (i > begin) {
            stretch.error += 0.5 * (off + before) * glm::length(branch.points[i] - branch.points[i - 1]);
        }
        before = off;
        if (i > begin && i < end && off > worst) {
            worst = off;
            stretch.farthest = i;
        }
    }
    // A cone strays most at its ends.
    if (!tapered && stretch.farthest < 0 && end - begin > 1 &&
        std::abs(branch.radii[begin] - branch.radii[end]) > 2.0 * tolerance) {
        stretch.farthest = (begin + end) / 2;
    }
    return stretch;
}

double bare_error(const StoutBranch& branch) {
    double error = 0.0;
    for (size_t i = 1; i < branch.points.size(); ++i) {
        error +=
            (branch.radii[i] + branch.radii[i - 1]) * glm::length(branch.points[i] - branch.points[i - 1]);
    }
    return error;
}

std::vector<StoutBranch> stout_branches(const Tree& tree, double minimum_radius) {
    std::vector<StoutBranch> branches;
    const BranchList list = list_branches(tree);
    for (const Branch& listed : list.branches) {
        StoutBranch branch;
        const auto add = [&](NodeId id, double radius) {
            branch.points.push_back(tree.node(id).position);
            branch.radii.push_back(radius);
            branch.nodes.push_back(id);
        };
        for (const NodeId id : list.nodes_of(listed)) {
            const double radius = tree.node(id).radius;
            if (radius < minimum_radius) {
                break;
            }
            if (branch.points.empty() && listed.attach != kNoNode) {
                add(listed.attach, radius);
            }
            add(id, radius);
        }
        if (branch.points.size() > 1) {
            branches.push_back(std::move(branch));
        }
    }
    return branches;
}

// What may be done next: give a branch its first shape, or part a stretch in two.
struct Step {
    double error = 0.0;   // that is there now, square metres
    int32_t branch = -1;  // that has none yet, or -1
    int32_t stretch = -1;

    // The largest error comes first; of equal ones the earlier branch, so that the result is the same
    // everywhere.
    bool operator<(const Step& other) const {
        return std::make_tuple(error, -branch, -stretch) <
               std::make_tuple(other.error, -other.branch, -other.stretch);
    }
};

}  // namespace

std::vector<BranchPiece> part_branches(const Tree& tree, int maximum, double minimum_radius, double tolerance,
                                       bool tapered) {
    std::vector<BranchPiece> pieces;
    if (tree.size() < 2) return pieces;
    const std::vector<StoutBranch> branches = stout_branches(tree, minimum_radius);
    std::vector<Stretch> stretches;
    std::priority_queue<Step> steps;
    for (int32_t i = 0; i < int32_t(branches.size()); ++i) {
        steps.push({i == 0 ? HUGE_VAL : bare_error(branches[i]), i, -1});
    }
    const auto set = [&](int32_t index, const Stretch& stretch) {
        stretches[index] = stretch;
        if (stretch.farthest >= 0) {
            steps.push({stretch.error, -1, index});
        }
    };
    while (!steps.empty() && int(stretches.size()) < maximum) {
        const Step step = steps.top();
        steps.pop();
        const int32_t added = int32_t(stretches.size());
        stretches.emplace_back();
        if (step.branch >= 0) {
            const int32_t last = int32_t(branches[step.branch].points.size()) - 1;
            set(added, fit(branches, step.branch, 0, last, tolerance, tapered));
        } else {
            const Stretch whole = stretches[step.stretch];
            set(step.stretch, fit(branches, whole.branch, whole.begin, whole.farthest, tolerance, tapered));
            set(added, fit(branches, whole.branch, whole.farthest, whole.end, tolerance, tapered));
        }
    }
    std::sort(stretches.begin(), stretches.end(), [](const Stretch& a, const Stretch& b) {
        return std::make_tuple(a.branch, a.begin) < std::make_tuple(b.branch, b.begin);
    });
    for (const Stretch& stretch : stretches) {
        const StoutBranch& branch = branches[stretch.branch];
        pieces.push_back({branch.points[stretch.begin], branch.points[stretch.end],
                          branch.radii[stretch.begin], branch.radii[stretch.end], stretch.radius,
                          branch.nodes[stretch.end]});
    }
    return pieces;
}

}  // namespace treerec
