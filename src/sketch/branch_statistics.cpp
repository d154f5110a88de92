#include "sketch/branch_statistics.h"

#include <algorithm>
#include <cmath>

#include "edit/graft/scion.h"
#include "geometry/portable_math.h"
#include "geometry/quantile.h"
#include "sketch/sketch_axes.h"

namespace treerec {

namespace {

constexpr size_t kLeastBranches = 5;   // for a law of their own
constexpr size_t kMostBranches = 300;  // in a law: pairs grow with the square
constexpr size_t kLeastSides = 20;     // to draw from
constexpr double kAsThick = 2.0;       // a factor
constexpr double kLeastSlope = 0.3;    // of the radius on the length, as logarithms
constexpr double kMostSlope = 2.0;
constexpr double kUsualShare = 0.012;  // base radius over length, where a tree tells none

double angle_between(const DVec3& a, const DVec3& b) {
    return portable::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// The way a side branch sets out, as scion_direction() has it, without copying its wood.
DVec3 sets_out(const Tree& tree, const BranchList& list, const Branch& branch, const DVec3& fallback) {
    const DVec3 from = tree.node(branch.attach).position;
    const std::span<const NodeId> nodes = list.nodes_of(branch);
    const double clear = std::max(tree.node(nodes[0]).radius, 0.02 * branch.length);
    DVec3 way(0.0);
    for (const NodeId id : nodes) {
        way = tree.node(id).position - from;
        if (glm::length(way) > clear) break;
    }
    return normalized_or(way, fallback);
}

}  // namespace

double RadiusLaw::base_radius(double length) const {
    if (!known) return std::max(kUsualShare * length, least);
    return std::max(portable::exp(intercept + slope * portable::log(std::max(length, 1e-6))), least);
}

double RadiusLaw::share_at(double share) const {
    return profile_at(profile, share);
}

std::vector<double> RadiusLaw::radii_along(const std::vector<DVec3>& points, double stouter,
                                           double most) const {
    const double length = length_of(points);
    const double base = std::min(stouter * base_radius(length), most);
    std::vector<double> radii;
    double along = 0.0;
    for (size_t i = 0; i < points.size(); i++) {
        if (i > 0) along += glm::distance(points[i], points[i - 1]);
        const double share = length > 0.0 ? along / length : 1.0;
        radii.push_back(std::min(std::max(base * share_at(share), least), most));
    }
    return radii;
}

double profile_at(const std::array<double, 11>& profile, double share) {
    const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(profile.size() - 1);
    const size_t i = std::min(static_cast<size_t>(at), profile.size() - 2);
    return profile[i] + (profile[i + 1] - profile[i]) * (at - static_cast<double>(i));
}

BranchStatistics::BranchStatistics(const Tree& tree) : tree_(tree), list_(list_branches(tree)) {
    std::vector<std::vector<int32_t>> children(list_.branches.size());
    for (size_t i = 0; i < list_.branches.size(); i++)
        if (list_.branches[i].parent >= 0)
            children[static_cast<size_t>(list_.branches[i].parent)].push_back(static_cast<int32_t>(i));
    for (size_t i = 0; i < list_.branches.size(); i++)
        sides_.push_back(measure_sides(static_cast<int32_t>(i), children[i]));
}

std::vector<DMat3> BranchStatistics::frames(int32_t index) const {
    const Branch& branch = list_.branches[static_cast<size_t>(index)];
    std::vector<NodeId> chain;
    if (branch.attach != kNoNode) chain.push_back(branch.attach);
    for (const NodeId id : list_.nodes_of(branch))
        chain.push_back(id);
    std::vector<DMat3> frames;
    DMat3 frame =
        frame_about(branch.attach == kNoNode ? DVec3(0.0, 1.0, 0.0) : direction_at(tree_, chain[0]));
    frames.push_back(frame);
    for (size_t i = 1; i < chain.size(); i++) {
        const DVec3 step = tree_.node(chain[i]).position - tree_.node(chain[i - 1]).position;
        const DVec3 way = normalized_or(step, frame[1]);
        // Carried along by the smallest rotation: twist would count as the side branches' azimuth.
        if (glm::dot(way, frame[1]) > -0.999999) frame = turn_between(frame[1], way) * frame;
        frames.push_back(frame);
    }
    return frames;
}

std::vector<SideBranch> BranchStatistics::measure_sides(int32_t index,
                                                        const std::vector<int32_t>& children) const {
    if (children.empty()) return {};
    const Branch& branch = list_.branches[static_cast<size_t>(index)];
    const std::vector<DMat3> all = frames(index);
    const std::span<const NodeId> own = list_.nodes_of(branch);
    std::vector<double> along(static_cast<size_t>(all.size()), 0.0);
    const size_t shift = branch.attach == kNoNode ? 0 : 1;
    for (size_t i = 1; i < all.size(); i++) {
        const NodeId id = own[i - shift];
        along[i] =
            along[i - 1] + glm::distance(tree_.node(id).position, tree_.node(tree_.node(id).parent).position);
    }
    std::vector<SideBranch> found;
    for (const int32_t child : children) {
        const Branch& side = list_.branches[static_cast<size_t>(child)];
        const auto at = std::find(own.begin(), own.end(), side.attach);
        const size_t place = at == own.end() ? 0 : static_cast<size_t>(at - own.begin()) + shift;
        const DMat3& frame = all[place];
        SideBranch one;
        one.branch = child;
        one.along = along[place];
        one.share = branch.length > 0.0 ? one.along / branch.length : 0.0;
        const DVec3 way = glm::transpose(frame_about(frame[1])) * sets_out(tree_, list_, side, frame[1]);
        one.angle = angle_between(way, DVec3(0.0, 1.0, 0.0));
        one.azimuth = portable::atan2(way.x, way.z);
        const DVec3 reach =
            tree_.node(list_.nodes_of(side).back()).position - tree_.node(side.attach).position;
        const DVec3 chord = glm::transpose(frame) * reach;
        one.chord = glm::length(chord);
        one.lean = angle_between(chord, DVec3(0.0, 1.0, 0.0));
        one.chord_azimuth = portable::atan2(chord.x, chord.z);
        found.push_back(one);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const SideBranch& a, const SideBranch& b) { return a.along < b.along; });
    for (size_t i = 0; i < found.size(); i++) {
        found[i].first = i == 0;
        found[i].internode = found[i].along - (i == 0 ? 0.0 : found[i - 1].along);
    }
    return found;
}

double BranchStatistics::base_radius(int32_t branch) const {
    return tree_.node(list_.nodes_of(list_.branches[static_cast<size_t>(branch)])[0]).radius;
}

std::array<double, 11> BranchStatistics::profile(int32_t index) const {
    const Branch& branch = list_.branches[static_cast<size_t>(index)];
    const std::span<const NodeId> nodes = list_.nodes_of(branch);
    const double base = base_radius(index);
    std::array<double, 11> shares{};
    double along = 0.0, radius = base;
    size_t next = 0;
    // The trunk's chain begins at its first own node.
    NodeId before = branch.attach == kNoNode ? nodes[0] : branch.attach;
    for (const NodeId id : nodes) {
        const double step = glm::distance(tree_.node(id).position, tree_.node(before).position);
        const double until = tree_.node(id).radius;
        while (next < 11 && 0.1 * static_cast<double>(next) * branch.length <= along + step) {
            const double part =
                step > 0.0 ? (0.1 * static_cast<double>(next) * branch.length - along) / step : 1.0;
            shares[next++] = (radius + (until - radius) * part) / base;
        }
        along += step;
        radius = until;
        before = id;
    }
    for (; next < 11; next++)
        shares[next] = radius / base;
    return shares;
}

RadiusLaw BranchStatistics::radius_law(int32_t order) const {
    RadiusLaw law;
    std::vector<double> tips;
    std::vector<int32_t> same, others;
    for (size_t i = 0; i < list_.branches.size(); i++) {
        const Branch& branch = list_.branches[i];
        tips.push_back(tree_.node(list_.nodes_of(branch).back()).radius);
        if (branch.order == 0 || !(branch.length > 0.0)) continue;
        (branch.order == order ? same : others).push_back(static_cast<int32_t>(i));
    }
    law.least = quantile(tips, 0.05);
    // Few branches of an order still say how these taper, better than many twigs.
    const bool own_profile = !same.empty();
    if (same.size() < kLeastBranches) same.insert(same.end(), others.begin(), others.end());
    law.profile.fill(1.0);
    if (same.empty()) {
        for (size_t i = 0; i < law.profile.size(); i++)
            law.profile[i] = 1.0 - 0.8 * static_cast<double>(i) / 10.0;
        return law;
    }
    // The longest tell most of a branch; of very many, these are enough.
    std::stable_sort(same.begin(), same.end(), [&](int32_t a, int32_t b) {
        return list_.branches[static_cast<size_t>(a)].length > list_.branches[static_cast<size_t>(b)].length;
    });
    if (same.size() > kMostBranches) same.resize(kMostBranches);
    law.known = true;
    std::vector<DVec2> places;
    std::array<std::vector<double>, 11> shares;
    for (const int32_t i : same) {
        const Branch& branch = list_.branches[static_cast<size_t>(i)];
        const double base = base_radius(i);
        places.emplace_back(portable::log(branch.length), portable::log(base));
        if (own_profile && branch.order != order) continue;
        const std::array<double, 11> own = profile(i);
        for (size_t k = 0; k < own.size(); k++)
            shares[k].push_back(own[k]);
    }
    std::vector<double> slopes;
    for (size_t a = 0; a < places.size(); a++)
        for (size_t b = a + 1; b < places.size(); b++)
            if (std::abs(places[b].x - places[a].x) > 0.05)
                slopes.push_back((places[b].y - places[a].y) / (places[b].x - places[a].x));
    law.slope = slopes.empty() ? 1.0 : std::clamp(quantile(slopes, 0.5), kLeastSlope, kMostSlope);
    std::vector<double> rests;
    for (const DVec2& p : places)
        rests.push_back(p.y - law.slope * p.x);
    law.intercept = quantile(rests, 0.5);
    double thickest = 1.0;
    for (size_t i = 0; i < 11; i++) {
        thickest = std::min(thickest, quantile(shares[i], 0.5));
        law.profile[i] = thickest;
    }
    return law;
}

std::vector<int32_t> BranchStatistics::kindred(int32_t order, double base) const {
    std::vector<int32_t> chosen;
    for (int level = 0; level < 3; level++) {
        chosen.clear();
        size_t sides = 0;
        for (size_t i = 0; i < list_.branches.size(); i++) {
            const int32_t branch = static_cast<int32_t>(i);
            if (list_.branches[i].order == 0 || sides_[i].empty()) continue;
            if (level < 2 && list_.branches[i].order != order) continue;
            const double ratio = base_radius(branch) / base;
            if (level < 1 && (ratio > kAsThick || ratio < 1.0 / kAsThick)) continue;
            chosen.push_back(branch);
            sides += sides_[i].size();
        }
        if (sides >= (level == 0 ? kLeastSides : kLeastSides / 2)) break;
    }
    return chosen;
}

}  // namespace treerec
