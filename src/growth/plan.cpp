#include "growth/plan.h"

#include <algorithm>

namespace treerec::growth {

namespace {

constexpr double kCatchUp = 2.0;  // of its pace, that a tip comes after with

AxisPlace between(const AxisPlace& a, const AxisPlace& b, double t) {
    AxisPlace place;
    place.position = glm::mix(a.position, b.position, t);
    place.pith = glm::mix(a.pith, b.pith, t);
    place.direction = normalized_or(glm::mix(a.direction, b.direction, t), a.direction);
    place.along = glm::mix(a.along, b.along, t);
    place.radius = glm::mix(a.radius, b.radius, t);
    place.step = glm::mix(a.step, b.step, t);
    place.speed = glm::mix(a.speed, b.speed, t);
    return place;
}

template <typename Key>
AxisPlace find(const GrowthBranch& branch, double value, Key key) {
    const std::vector<AxisPlace>& axis = branch.axis;
    const auto after = std::lower_bound(axis.begin(), axis.end(), value,
                                        [&](const AxisPlace& place, double v) { return key(place) < v; });
    if (after == axis.begin()) return axis.front();
    if (after == axis.end()) return axis.back();
    const auto before = after - 1;
    const double span = key(*after) - key(*before);
    return between(*before, *after, span > 0.0 ? (value - key(*before)) / span : 1.0);
}

}  // namespace

AxisPlace place_at(const GrowthBranch& branch, double along) {
    return find(branch, along, [](const AxisPlace& place) { return place.along; });
}

AxisPlace tip_at(const GrowthBranch& branch, double step) {
    return find(branch, step, [](const AxisPlace& place) { return place.step; });
}

AxisPlace next_place(const GrowthBranch& branch, double along, int step) {
    const double mean = (branch.axis.back().along - branch.axis.front().along) /
                        std::max(branch.last_step() - branch.first_step(), 1.0);
    const AxisPlace next = tip_at(branch, step + 1.0);
    const double pace = std::max(next.along - tip_at(branch, step).along, mean);
    return next.along > along + kCatchUp * pace ? place_at(branch, along + kCatchUp * pace) : next;
}

double age_of(const GrowthPlan& plan, const AxisPlace& place, double step) {
    return std::clamp((step - place.step) / std::max(plan.steps - place.step, 1.0), 0.0, 1.0);
}

DVec3 wood_centre(const GrowthPlan& plan, const AxisPlace& place, double step) {
    return glm::mix(place.pith, place.position, age_of(plan, place, step));
}

double bark_radius(const GrowthPlan& plan, const AxisPlace& place, double step) {
    if (!plan.follow) return std::max(step - place.step, 0.0) * place.speed;
    return glm::mix(std::min(plan.young, place.radius), place.radius, age_of(plan, place, step));
}

}  // namespace treerec::growth
