#include "skeleton/bark.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/parallel.h"
#include "geometry/segment.h"

namespace treerec {

namespace {

constexpr int kLookAround = 2;       // stations to each side
constexpr size_t kNearest = 8;       // stations looked at
constexpr size_t kNearestThick = 3;  // likewise, of stout wood
constexpr double kThick = 0.03;      // metres: from stouter wood,
constexpr double kWhisker = 0.6;     // so many times what it is stouter, besides
constexpr float kFar = 0.12f;        // metres: no station of thin wood so far away explains a place
constexpr double kRounding = 1e-3;   // metres, more than that of places to floats
constexpr double kStub = 0.6;        // radii that a branch must reach out of thick wood

// For PointTree::search(): the nearest stations of limbs that are not left aside, of equally near ones the
// first.
struct NearestAllowed {
    const std::vector<std::pair<int32_t, int32_t>>& names;
    const std::vector<uint8_t>* except;
    size_t wanted;
    float most;  // squared metres
    size_t found = 0;
    std::array<float, kNearest> distance{};
    std::array<uint32_t, kNearest> index{};

    float limit() const { return found == wanted ? distance[found - 1] : most; }
    void add(float squared, uint32_t candidate) {
        const auto comes_before = [&](size_t at) {
            return squared < distance[at] || (squared == distance[at] && candidate < index[at]);
        };
        if (found == wanted ? !comes_before(found - 1) : squared > most) return;
        if (except != nullptr && (*except)[names[candidate].first] != 0) return;
        size_t at = found == wanted ? found - 1 : found++;
        for (; at > 0 && comes_before(at - 1); at--) {
            distance[at] = distance[at - 1];
            index[at] = index[at - 1];
        }
        distance[at] = squared;
        index[at] = candidate;
    }
};

}  // namespace

BarkPlace place_near(const std::vector<Station>& line, int32_t station, const DVec3& p) {
    const int32_t last = static_cast<int32_t>(line.size()) - 1;
    const DVec3 off = line[station].position - p;
    double least = glm::dot(off, off);
    BarkPlace best{-1, station, std::sqrt(least), line[station].radius};
    for (int32_t i = std::max(0, station - kLookAround); i < std::min(last, station + kLookAround); i++) {
        double t;
        const double square = square_to_segment(p, line[i].position, line[i + 1].position, t);
        if (square >= least) continue;
        // Squares that differ may have the same root.
        const double distance = std::sqrt(square);
        if (distance >= best.distance) continue;
        least = square;
        best = {-1, t < 0.5 ? i : i + 1, distance,
                line[i].radius + t * (line[i + 1].radius - line[i].radius)};
    }
    return best;
}

Bark::Bark(const std::vector<Limb>& limbs, const std::vector<std::vector<Station>>& axes)
    : limbs_(limbs), axes_(axes) {
    const auto add = [](Index& index, const DVec3& position, int32_t limb, int32_t station, double reach) {
        index.positions.emplace_back(position);
        index.names.emplace_back(limb, station);
        index.reach.push_back(static_cast<float>(reach));
    };
    for (size_t l = 0; l < axes.size(); l++) {
        const int32_t limb = static_cast<int32_t>(l);
        for (size_t i = 0; i < axes[l].size(); i++) {
            const Station& station = axes[l][i];
            const double reach = reach_of(limb, static_cast<int32_t>(i));
            add(all_, station.position, limb, static_cast<int32_t>(i), reach);
            if (station.radius <= kThick) continue;
            add(thick_, station.position, limb, static_cast<int32_t>(i), reach);
            thick_reach_ = std::max(thick_reach_, reach);
        }
        if (limbs[l].parent < 0) continue;
        // And along the way from the fork to the limb's first station.
        const DVec3& fork = axes[limbs[l].parent][limbs[l].attach].position;
        const DVec3 way = axes[l][0].position - fork;
        const double reach = reach_of(limb, 0);
        for (const double t : {0.25, 0.5, 0.75})
            add(all_, fork + t * way, limb, 0, reach + (1.0 - t) * glm::length(way));
    }
    for (Index* index : {&all_, &thick_})
        if (!index->positions.empty()) index->tree = std::make_unique<PointTree>(index->positions);
}

double Bark::reach_of(int32_t limb, int32_t station) const {
    const std::vector<Station>& line = axes_[limb];
    const int32_t last = static_cast<int32_t>(line.size()) - 1;
    double farthest = 0.0, thickest = 0.0;
    const auto reach_to = [&](const DVec3& position) {
        const DVec3 off = position - line[station].position;
        farthest = std::max(farthest, glm::dot(off, off));
    };
    for (int32_t i = std::max(0, station - kLookAround); i <= std::min(last, station + kLookAround); i++) {
        reach_to(line[i].position);
        thickest = std::max(thickest, line[i].radius);
    }
    if (station == 0 && limbs_[limb].parent >= 0)
        reach_to(axes_[limbs_[limb].parent][limbs_[limb].attach].position);
    return std::sqrt(farthest) + thickest;
}

BarkPlace Bark::on_limb(int32_t limb, int32_t station, const DVec3& p) const {
    const std::vector<Station>& line = axes_[limb];
    BarkPlace place = place_near(line, station, p);
    place.limb = limb;
    if (station > 0 || limbs_[limb].parent < 0) return place;
    const DVec3& fork = axes_[limbs_[limb].parent][limbs_[limb].attach].position;
    const double distance = distance_to_segment(p, fork, line[0].position);
    if (distance < place.distance) place = {limb, 0, distance, line[0].radius};
    return place;
}

void Bark::look(const Index& index, size_t count, float reach, const Vec3& p,
                const std::vector<uint8_t>* except, BarkPlace& best) const {
    if (!index.tree) return;
    NearestAllowed found{index.names, except, count, reach * reach};
    index.tree->search(p, found);
    for (size_t k = 0; k < found.found; k++) {
        // What is seen from far stations that reach no nearer needs no look.
        const double away = std::sqrt(found.distance[k]);
        if (away - index.reach[found.index[k]] - kRounding >= best.outside()) continue;
        const auto& name = index.names[found.index[k]];
        // The way from the fork to a first station has that one's name.
        if (name.second == 0 && std::any_of(&found.index[0], &found.index[k],
                                            [&](uint32_t other) { return index.names[other] == name; }))
            continue;
        const auto [limb, station] = name;
        const BarkPlace place = on_limb(limb, station, DVec3(p));
        if (place.outside() < best.outside()) best = place;
    }
}

BarkPlace Bark::nearest(const Vec3& p, const std::vector<uint8_t>* except, float reach) const {
    BarkPlace best;
    best.distance = std::numeric_limits<double>::max();
    look(all_, kNearest, reach, p, except, best);
    // From farther away, no stout wood comes nearer than what is found.
    const float far = best.limb < 0
                          ? std::numeric_limits<float>::infinity()
                          : static_cast<float>(1.00001 * (best.outside() + thick_reach_) + kRounding);
    if (far > 0.0f) look(thick_, kNearestThick, far, p, except, best);
    return best;
}

std::vector<int32_t> Bark::limbs_by_place() const {
    std::vector<int32_t> order;
    if (!all_.tree) return order;
    order.reserve(limbs_.size());
    for (size_t group = 0; group < all_.tree->group_count(); group++)
        for (const uint32_t i : all_.tree->in_group(group)) {
            const auto [limb, station] = all_.names[i];
            const bool is_tip = static_cast<size_t>(station) + 1 == axes_[limb].size();
            // What follows a first station is the way to it, of the same name.
            const bool is_station = station > 0 || i == 0 || all_.names[i - 1] != all_.names[i];
            if (is_tip && is_station) order.push_back(limb);
        }
    return order;
}

double required_escape(double least_escape, double radius) {
    if (radius <= kThick) return std::max(least_escape, kStub * radius);
    return std::max(least_escape, kStub * kThick) + kWhisker * (radius - kThick);
}

void drop_strips(std::vector<Limb>& limbs, std::vector<std::vector<Station>>& axes, double least_escape) {
    const Bark bark(limbs, axes);
    std::vector<uint32_t> bears(limbs.size(), 0);
    for (const Limb& limb : limbs)
        if (limb.parent >= 0) bears[limb.parent]++;
    // A place that no limb but `except` explains.
    const auto escapes = [&](const std::vector<Station>& line, const std::vector<uint8_t>& except) {
        return std::any_of(line.rbegin(), line.rend(), [&](const Station& station) {
            const BarkPlace place = bark.nearest(Vec3(station.position), &except, kFar);
            return place.limb < 0 || place.outside() >= required_escape(least_escape, place.radius);
        });
    };
    // What is clear of all others stays. Of the rest, the last limbs go first, and then hold nothing any
    // more.
    std::vector<uint8_t> doubtful(limbs.size(), 0);
    // Limbs side by side are compared with much the same ones, which memory then still has at hand.
    const std::vector<int32_t> order = bark.limbs_by_place();
    parallel_for(order.size(), 64, [&](size_t begin, size_t end) {
        std::vector<uint8_t> except(limbs.size(), 0);
        for (size_t i = begin; i < end; i++) {
            const int32_t l = order[i];
            if (l == 0) continue;
            except[l] = 1;
            doubtful[l] = escapes(axes[l], except) ? 0 : 1;
            except[l] = 0;
        }
    });
    std::vector<uint8_t> goes(limbs.size(), 0);
    for (size_t l = limbs.size(); l-- > 1;) {
        if (bears[l] > 0 || doubtful[l] == 0) continue;
        goes[l] = 1;  // nor is it looked at itself
        if (escapes(axes[l], goes)) {
            goes[l] = 0;
            continue;
        }
        bears[limbs[l].parent]--;
    }
    std::vector<int32_t> now(limbs.size());
    size_t kept = 0;
    for (size_t l = 0; l < limbs.size(); l++) {
        if (goes[l] != 0) continue;
        now[l] = static_cast<int32_t>(kept);
        if (limbs[l].parent >= 0) limbs[l].parent = now[limbs[l].parent];
        if (kept != l) {
            limbs[kept] = std::move(limbs[l]);
            axes[kept] = std::move(axes[l]);
        }
        kept++;
    }
    limbs.resize(kept);
    axes.resize(kept);
}

}  // namespace treerec
