#include "mesh/limb_pieces.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

#include "geometry/segment.h"
#include "tree/branches.h"

namespace treerec {

namespace {

// The wood of one branch that is stout enough, as a polyline.
struct Limb {
    std::vector<DVec3> points;
    std::vector<double> radii;
    std::vector<NodeId> nodes;
};

// Some of a limb's points, [begin, end], and how well one shape stands for them.
struct Stretch {
    int32_t limb = 0;
    int32_t begin = 0;
    int32_t end = 0;
    double radius = 0.0;    // on average
    double error = 0.0;     // square metres
    int32_t farthest = -1;  // the inner point that strays most, where to part it; -1 if none does
};

Stretch fit(const std::vector<Limb>& limbs, int32_t index, int32_t begin, int32_t end, double tolerance,
            bool tapered) {
    const Limb& limb = limbs[index];
    Stretch stretch{index, begin, end, 0.0, 0.0, -1};
    double length = 0.0;
    std::vector<double> run{0.0};
    for (int32_t i = begin; i < end; ++i) {
        const double step = glm::length(limb.points[i + 1] - limb.points[i]);
        stretch.radius += 0.5 * (limb.radii[i] + limb.radii[i + 1]) * step;
        length += step;
        run.push_back(length);
    }
    // Two nodes may lie at one place.
    stretch.radius = length > 0.0 ? stretch.radius / length : limb.radii[end];
    double worst = tolerance;
    double before = 0.0;
    for (int32_t i = begin; i <= end; ++i) {
        const double share = length > 0.0 ? run[i - begin] / length : 0.5;
        const double radius =
            tapered ? limb.radii[begin] + (limb.radii[end] - limb.radii[begin]) * share : stretch.radius;
        const double off = distance_to_segment(limb.points[i], limb.points[begin], limb.points[end]) +
                           std::abs(limb.radii[i] - radius);
        if (i > begin) {
            stretch.error += 0.5 * (off + before) * glm::length(limb.points[i] - limb.points[i - 1]);
        }
        before = off;
        if (i > begin && i < end && off > worst) {
            worst = off;
            stretch.farthest = i;
        }
    }
    // A cone strays most at its ends.
    if (!tapered && stretch.farthest < 0 && end - begin > 1 &&
        std::abs(limb.radii[begin] - limb.radii[end]) > 2.0 * tolerance) {
        stretch.farthest = (begin + end) / 2;
    }
    return stretch;
}

double bare_error(const Limb& limb) {
    double error = 0.0;
    for (size_t i = 1; i < limb.points.size(); ++i) {
        error += (limb.radii[i] + limb.radii[i - 1]) * glm::length(limb.points[i] - limb.points[i - 1]);
    }
    return error;
}

std::vector<Limb> stout_limbs(const Tree& tree, double minimum_radius) {
    std::vector<Limb> limbs;
    const BranchList list = list_branches(tree);
    for (const Branch& branch : list.branches) {
        Limb limb;
        const auto add = [&](NodeId id, double radius) {
            limb.points.push_back(tree.node(id).position);
            limb.radii.push_back(radius);
            limb.nodes.push_back(id);
        };
        for (const NodeId id : list.nodes_of(branch)) {
            const double radius = tree.node(id).radius;
            if (radius < minimum_radius) {
                break;
            }
            if (limb.points.empty() && branch.attach != kNoNode) {
                add(branch.attach, radius);
            }
            add(id, radius);
        }
        if (limb.points.size() > 1) {
            limbs.push_back(std::move(limb));
        }
    }
    return limbs;
}

// What may be done next: give a limb its first shape, or part a stretch in two.
struct Step {
    double error = 0.0;  // that is there now, square metres
    int32_t limb = -1;   // that has none yet, or -1
    int32_t stretch = -1;

    // The largest error comes first; of equal ones the earlier limb, so that the result is the same
    // everywhere.
    bool operator<(const Step& other) const {
        return std::make_tuple(error, -limb, -stretch) <
               std::make_tuple(other.error, -other.limb, -other.stretch);
    }
};

}  // namespace

std::vector<LimbPiece> part_limbs(const Tree& tree, int maximum, double minimum_radius, double tolerance,
                                  bool tapered) {
    std::vector<LimbPiece> pieces;
    if (tree.size() < 2) return pieces;
    const std::vector<Limb> limbs = stout_limbs(tree, minimum_radius);
    std::vector<Stretch> stretches;
    std::priority_queue<Step> steps;
    for (int32_t i = 0; i < int32_t(limbs.size()); ++i) {
        steps.push({i == 0 ? HUGE_VAL : bare_error(limbs[i]), i, -1});
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
        if (step.limb >= 0) {
            const int32_t last = int32_t(limbs[step.limb].points.size()) - 1;
            set(added, fit(limbs, step.limb, 0, last, tolerance, tapered));
        } else {
            const Stretch whole = stretches[step.stretch];
            set(step.stretch, fit(limbs, whole.limb, whole.begin, whole.farthest, tolerance, tapered));
            set(added, fit(limbs, whole.limb, whole.farthest, whole.end, tolerance, tapered));
        }
    }
    std::sort(stretches.begin(), stretches.end(), [](const Stretch& a, const Stretch& b) {
        return std::make_tuple(a.limb, a.begin) < std::make_tuple(b.limb, b.begin);
    });
    for (const Stretch& stretch : stretches) {
        const Limb& limb = limbs[stretch.limb];
        pieces.push_back({limb.points[stretch.begin], limb.points[stretch.end], limb.radii[stretch.begin],
                          limb.radii[stretch.end], stretch.radius, limb.nodes[stretch.end]});
    }
    return pieces;
}

}  // namespace treerec
