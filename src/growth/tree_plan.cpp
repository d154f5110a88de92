#include "growth/tree_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "error.h"
#include "foliage/branch_axis.h"

namespace treerec::growth {

namespace {

constexpr double kFastest = 1.0;      // longest edges that a tip grows in a step at most
constexpr double kThickening = 0.15;  // shortest edges that cambium grows in a step about at most
constexpr double kYoung = 0.5;        // shortest edges that a tip is thick at once: a needle could not bend
constexpr int kFewestSteps = 60;
constexpr double kBudSteps = 3.0;     // between a tip's passing a branch and that sprouting
constexpr double kDepth = 0.25;       // radii that the trunk's axis begins below its base
constexpr double kSinks = 2.0;        // longest edges before its open end within which the surface sinks
constexpr double kSunk = 0.6;         // to this share of the radius
constexpr double kAbove = 1.02;       // of the radius: what covers a tube that begins inside
constexpr double kEven = 2.0;         // radii over which to both sides the pith is evened out,
constexpr int kEvenPlaces = 8;        // at so many places,
constexpr double kAside = 0.5;        // and of the radius how far it may lie from the axis
constexpr double kLeastLength = 3.0;  // longest edges that a branch is covered at least

// What is thick is not as crooked inside as a skeleton that a scan led astray: a thin young tip could not
// follow each kink, and would run into itself. The bark comes to the axis's own radius all the same.
void even_out(GrowthBranch& branch, double longest, double shortest) {
    const double first = branch.axis.front().along, last = branch.axis.back().along;
    for (AxisPlace& place : branch.axis) {
        const double width =
            std::min({kEven * place.radius + longest, place.along - first, last - place.along});
        DVec3 sum(0.0);
        double weights = 0.0;
        for (int i = -kEvenPlaces; i <= kEvenPlaces; i++) {
            const double weight = kEvenPlaces + 1 - std::abs(i);
            sum += weight * place_at(branch, place.along + width * i / kEvenPlaces).position;
            weights += weight;
        }
        const DVec3 off = sum / weights - place.position;
        const double most = kAside * std::max(place.radius - shortest, 0.0), length = glm::length(off);
        place.pith = place.position + (length > most ? off * (most / length) : off);
    }
}

// The part of the axis that is covered, sampled evenly enough. Empty where too little is thick enough.
std::vector<AxisPlace> cover(const std::vector<AxisPoint>& points, double longest, double shortest,
                             bool& open) {
    std::vector<AxisPlace> axis;
    open = false;
    for (const AxisPoint& point : points) {
        if (point.radius < shortest && axis.size() > 1) {
            open = true;
            break;
        }
        AxisPlace place;
        place.position = point.position;
        place.direction = point.direction;
        place.along = point.along;
        place.radius = point.radius;
        axis.push_back(place);
    }
    if (axis.size() < 2 || axis.back().along - axis.front().along < kLeastLength * longest) return {};
    if (open) {
        const double end = axis.back().along, begin = std::max(end - kSinks * longest, 0.0);
        for (AxisPlace& place : axis)
            place.radius *=
                glm::mix(kAbove, kSunk,
                         glm::smoothstep(0.0, 1.0, (place.along - begin) / std::max(end - begin, 1e-9)));
    }
    return axis;
}

// Where the branch that starts there leaves its parent in the plan: metres along it; nothing where that is
// too far off, or so near to the end of what is covered that bark could not bear it.
std::optional<double> find_parent_along(const GrowthBranch& parent, const DVec3& from, double longest,
                                        double shortest) {
    double nearest = std::numeric_limits<double>::max(), along = 0.0;
    for (const AxisPlace& place : parent.axis) {
        const double distance = glm::distance(place.position, from);
        if (distance >= nearest) continue;
        nearest = distance;
        along = place.along;
    }
    if (nearest > longest + shortest || along > parent.axis.back().along - longest) return std::nullopt;
    return along;
}

// One branch of the tree as bark is to cover it; nothing where it stays a tube. parent: in the plan, null for
// the trunk. points: room for its samples.
std::optional<GrowthBranch> plan_branch(const Tree& tree, const BranchList& list, const Branch& branch,
                                        const GrowthBranch* parent, double longest, double shortest,
                                        std::vector<AxisPoint>& points) {
    GrowthBranch grown;
    sample_axis(tree, list, branch, 0.25 * shortest, points);
    if (points.size() < 2) return std::nullopt;
    // How thick it begins is told by its own first node: at the fork it is as thick as its parent.
    const double own = tree.node(list.nodes[static_cast<size_t>(branch.begin)]).radius;
    if (own < shortest) return std::nullopt;
    if (parent) {
        for (AxisPoint& point : points)
            point.radius = std::min(point.radius, std::max(own, shortest));
        const std::optional<double> along =
            find_parent_along(*parent, tree.node(branch.attach).position, longest, shortest);
        if (!along) return std::nullopt;
        grown.parent_along = *along;
    }
    grown.axis = cover(points, longest, shortest, grown.ends_open);
    if (grown.axis.empty()) return std::nullopt;
    if (!parent) {
        AxisPlace below = grown.axis.front();
        const double depth = kDepth * below.radius + longest;
        below.position -= below.direction * depth;
        below.along -= depth;
        grown.axis.insert(grown.axis.begin(), below);
    }
    even_out(grown, longest, shortest);
    return grown;
}

// Steps before the end, by thickness; then no tip faster than may be, and no branch before its parent. all:
// so many steps for the thickest. fastest: metres that a tip grows in a step.
void set_steps(GrowthPlan& plan, double all, double thickest, double longest, double fastest) {
    for (size_t b = plan.branches.size(); b-- > 0;) {
        GrowthBranch& branch = plan.branches[b];
        for (size_t i = branch.axis.size(); i-- > 0;) {
            AxisPlace& place = branch.axis[i];
            place.step = all * (1.0 - place.radius / thickest);
            if (i + 1 < branch.axis.size())
                place.step = std::min(
                    place.step, branch.axis[i + 1].step - (branch.axis[i + 1].along - place.along) / fastest);
        }
        // Of all branches that leave it: it must have passed them in time.
        for (size_t c = b + 1; c < plan.branches.size(); c++) {
            const GrowthBranch& child = plan.branches[c];
            if (child.parent != static_cast<int32_t>(b)) continue;
            const double until = child.axis.front().step - kBudSteps - longest / fastest;
            for (size_t i = branch.axis.size(); i-- > 0;) {
                AxisPlace& place = branch.axis[i];
                const double way = place.along - child.parent_along;
                if (way <= 0.0) place.step = std::min(place.step, until + way / fastest);
            }
        }
    }
}

// Counts the steps from the first one on and gives each place its speed. most: as many as were asked for,
// with faster tips where they would be more; 0: any number.
void count_steps(GrowthPlan& plan, double all, int most) {
    const double first = plan.branches.front().axis.front().step;
    plan.steps = static_cast<int>(std::ceil(all - first));
    for (GrowthBranch& branch : plan.branches)
        for (AxisPlace& place : branch.axis) {
            place.step -= first;
            place.speed = place.radius / std::max(plan.steps - place.step, 1.0);
        }
    if (most <= 0 || plan.steps <= most) return;
    const double faster = static_cast<double>(most) / plan.steps;
    for (GrowthBranch& branch : plan.branches)
        for (AxisPlace& place : branch.axis) {
            place.step *= faster;
            place.speed /= faster;
        }
    plan.steps = most;
}

// A branch begins where the bark of its parent is when it sprouts.
void begin_on_bark(GrowthPlan& plan) {
    for (GrowthBranch& branch : plan.branches) {
        if (branch.parent < 0) continue;
        const GrowthBranch& parent = plan.branches[static_cast<size_t>(branch.parent)];
        const AxisPlace base = place_at(parent, branch.parent_along);
        const double age = (branch.first_step() - base.step) / std::max(plan.steps - base.step, 1.0);
        const double bark = base.radius * std::clamp(age, 0.0, 1.0);
        size_t begin = 0;
        while (begin + 2 < branch.axis.size()) {
            const DVec3 off = branch.axis[begin].position - base.position;
            if (glm::length(off - base.direction * glm::dot(off, base.direction)) >= bark) break;
            begin++;
        }
        const double step = branch.first_step();
        branch.axis.erase(branch.axis.begin(), branch.axis.begin() + static_cast<std::ptrdiff_t>(begin));
        branch.axis.front().step = std::min(step, branch.axis.front().step);
    }
}

}  // namespace

TreePlan plan_tree(const Tree& tree, const BranchList& list, double longest, double shortest, int steps) {
    TreePlan result;
    result.covered.assign(list.branches.size(), 0.0);
    GrowthPlan& plan = result.plan;
    plan.follow = true;
    plan.young = kYoung * shortest;
    std::vector<int32_t> plan_of(list.branches.size(), -1);
    std::vector<AxisPoint> points;
    double thickest = 0.0;
    for (size_t b = 0; b < list.branches.size(); b++) {
        const Branch& branch = list.branches[b];
        const int32_t parent = branch.parent < 0 ? -1 : plan_of[static_cast<size_t>(branch.parent)];
        if (branch.parent >= 0 && parent < 0) continue;
        std::optional<GrowthBranch> grown = plan_branch(
            tree, list, branch, parent < 0 ? nullptr : &plan.branches[static_cast<size_t>(parent)], longest,
            shortest, points);
        if (!grown) continue;
        if (parent >= 0) grown->parent = parent;
        result.covered[b] = grown->ends_open ? grown->axis.back().along - kSinks * longest
                                             : std::numeric_limits<double>::infinity();
        for (const AxisPlace& place : grown->axis)
            thickest = std::max(thickest, place.radius);
        plan_of[b] = static_cast<int32_t>(plan.branches.size());
        plan.branches.push_back(std::move(*grown));
        result.branch_of.push_back(static_cast<int32_t>(b));
    }
    if (plan.branches.empty())
        throw Error("Nothing of this tree is thick enough for bark with edges of " +
                    std::to_string(static_cast<int>(std::lround(1000.0 * shortest))) +
                    " mm: make them shorter, or check the tree's units.");
    const double all =
        steps > 0 ? steps : std::max(thickest / (kThickening * shortest), double{kFewestSteps});
    set_steps(plan, all, thickest, longest, kFastest * longest);
    count_steps(plan, all, steps);
    begin_on_bark(plan);
    return result;
}

}  // namespace treerec::growth
