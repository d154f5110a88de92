#include "growth/velocity.h"

#include <CGAL/boost/graph/iterator.h>

#include <algorithm>
#include <cmath>

#include "geometry/parallel.h"

namespace treerec::growth {

namespace {

// A vertex that is behind its axis's radius may catch up by so many times its usual speed.
constexpr double kCatchUp = 2.0;
// Of what a vertex stands out of an even bend, and beside wood of what it stands out of its neighbours, that
// it grows less in a step; there where it grows by so much of its edges in that, or more.
constexpr double kSmooth = 0.2, kTension = 0.15, kPace = 0.1;
constexpr int kPieces = 2, kTries = 6;  // to find where wood that is not round ends
constexpr double kFlatEnd = 4.0;  // a radius over how far its wood goes on beyond the axis's base or end

// How far a vertex is from the middle of its wood, and which way it grows, as its bark sees it: beside the
// axis, and below its base and above a closed end as in a flat bowl.
struct Stand {
    DVec3 off, normal;
};

Stand stand_of(const GrowthPlan& plan, const GrowthBranch& branch, const AxisPlace& axis, const DVec3& place,
               const DVec3& normal, int step) {
    const DVec3 off = place - wood_centre(plan, axis, step + 1.0);
    const double up = glm::dot(normal, axis.direction);
    Stand stand{off - axis.direction * glm::dot(off, axis.direction), normal - axis.direction * up};
    const AxisPlace &base = branch.axis.front(), &end = branch.axis.back();
    const double above = glm::dot(place - wood_centre(plan, base, step + 1.0), base.direction);
    const double past = glm::dot(place - wood_centre(plan, end, step + 1.0), end.direction);
    double beyond = 0.0;
    if (branch.parent < 0 && above < 0.0 && axis.along < base.along + base.radius) beyond = above;
    if (!branch.ends_open && past > 0.0 && axis.along > end.along - end.radius) beyond = past;
    if (beyond != 0.0) {
        stand.off += axis.direction * (kFlatEnd * beyond);
        stand.normal += axis.direction * (kFlatEnd * up);
    }
    return stand;
}

// Metres over the length of `stand.normal`, which is told in it, to where it first comes to bark that is not
// round, and of it no more than `most`. excess: metres that bark there lies farther outside. Along a radius
// alone valleys would be left behind, where what is on both sides grows towards one another.
double way_to_bark(const WoodSection& wood, const Stand& stand, double excess, double most) {
    const auto outside = [&](double t) {
        const DVec3 at = stand.off + t * stand.normal;
        return glm::length(at) - wood.radius(at) - excess;
    };
    double low = 0.0, high = 0.0, below = outside(0.0), above = below;
    if (below >= 0.0) return 0.0;
    for (int piece = 1; piece <= kPieces; piece++) {
        high = most * piece / kPieces;
        above = outside(high);
        if (above >= 0.0) break;
        low = high;
        below = above;
    }
    if (above < 0.0) return most;
    // The Illinois variant of regula falsi (Dowell and Jarratt 1971).
    double at = high;
    int side = 0;
    for (int i = 0; i < kTries; i++) {
        at = (low * above - high * below) / (above - below);
        const double here = outside(at);
        if (here < 0.0) {
            low = at;
            below = here;
            if (side < 0) above *= 0.5;
            side = -1;
        } else {
            high = at;
            above = here;
            if (side > 0) below *= 0.5;
            side = 1;
        }
    }
    return at;
}

// S_c: what cambium of this age has to grow along its normal to come to its axis's radius in the end. The
// pith need not lie on the axis: what grows from it towards the axis has farther to go. callus: beside wood,
// where bark rolls into the mouth, and would never come to the axis's radius that way: only what faces
// outwards catches up.
double cambium_speed(const Cell& cell, const AxisPlace& axis, const Stand& stand, const GrowthPlan& plan,
                     const WoodSection& wood, int step, bool callus = false) {
    if (!plan.follow) return axis.speed;
    const double usual =
        std::max(wood.pace(stand.off), 1.0) * axis.radius / std::max(plan.steps - axis.step, 1.0);
    const double young = std::min(plan.young, axis.radius);
    double most = std::max(kCatchUp * usual, 0.5 * young);
    if (callus) {
        const double away = glm::dot(stand.normal, normalized_or(stand.off, DVec3(0.0)));
        most = usual * (1.0 + (kCatchUp - 1.0) * std::clamp(away, 0.0, 1.0));
    }
    if (!wood.is_round()) return way_to_bark(wood, stand, cell.excess, most);
    const double bark = bark_radius(plan, axis, step + 1.0) + cell.excess;
    const double inside = bark * bark - glm::dot(stand.off, stand.off);
    if (!(inside > 0.0)) return 0.0;
    const double out = glm::dot(stand.normal, stand.off), square = glm::dot(stand.normal, stand.normal);
    // Where it first comes to the bark; no farther than `most` matters.
    const double way = std::sqrt(out * out + square * inside) - out;
    return square * most > way ? way / square : most;
}

// Equation 6's sum: of one feature the largest, of several together.
double extra_growth(const Surface& surface, const std::vector<Feature>& features, const DVec3& place) {
    double sum = 0.0;
    for (const Feature& feature : features) {
        if (!feature.reach.holds(Box{place, place})) continue;
        double most = 0.0;
        for (const BurlSphere& sphere : feature.spheres)
            most = std::max(most, burl_growth(sphere.radius, sphere.inner, sphere.growth,
                                              glm::distance(place, surface.place(sphere.centre))));
        sum += most;
    }
    return sum;
}

// How far a vertex is outside of where its neighbours are.
DVec3 bend(const Surface& surface, Vertex v) {
    DVec3 sum(0.0);
    int count = 0;
    for (const Vertex other : CGAL::vertices_around_target(surface.mesh.halfedge(v), surface.mesh)) {
        sum += surface.place(other);
        count++;
    }
    return surface.place(v) - sum / static_cast<double>(count);
}

// Beside the paper: where a lip closes there is less and less room, and it would buckle into beads. Metres by
// which a vertex that would grow by `whole` grows less in a step because it stands out of a surface that
// bends evenly, as a bead does and a lip's roll does not; and beside wood also because it stands out of its
// neighbours more than on a round trunk, so that mouths stay smooth. There as much growth is smoothed alike
// in many steps and in few. direction: of the axis, `distance` metres away.
double smoothed(const Surface& surface, Vertex v, const DVec3& normal, bool callus, const DVec3& direction,
                double distance, double whole) {
    double around = 0.0, across = 0.0, edges = 0.0;
    int count = 0;
    const DVec3 side = glm::cross(direction, normal);
    for (const Vertex other : CGAL::vertices_around_target(surface.mesh.halfedge(v), surface.mesh)) {
        around += glm::dot(bend(surface, other), normal);
        const DVec3 way = surface.place(other) - surface.place(v);
        const double aside = glm::dot(way, side);
        across += aside * aside;
        edges += glm::length(way);
        count++;
    }
    const double share = callus ? std::min(whole * count / (kPace * edges), 1.0) : 1.0;
    const double own = glm::dot(bend(surface, v), normal);
    const double round = distance > 0.0 ? across / (2.0 * distance * count) : 0.0;
    return share * (kSmooth * (own - around / count) + (callus ? kTension * (own - round) : 0.0));
}

// Equation 8, as far as the hollow may reach.
DVec3 decay_velocity(const Surface& surface, Vertex v, const Feature& hollow, const DVec3& from_axis,
                     const WoodSection& wood) {
    const double sinks = std::min(hollow.rate, hollow.deepest - surface.cells[v].sunk);
    if (!(sinks > 0.0)) return DVec3(0.0);
    const DVec3 velocity = -sinks * vertex_normal(surface, v);
    // What goes away from the axis comes nearer to the bark on another side.
    const bool outwards = glm::dot(velocity, from_axis) > 0.0;
    const DVec3 next = from_axis + velocity;
    return outwards && glm::length(next) > wood.radius(next) - hollow.wall ? DVec3(0.0) : velocity;
}

}  // namespace

double set_velocities(Surface& surface, const GrowthPlan& plan, std::vector<Feature>& features,
                      const Lips& lips, int step) {
    for (Feature& feature : features) {
        feature.reach = Box();
        for (const BurlSphere& sphere : feature.spheres) {
            const DVec3& centre = surface.place(sphere.centre);
            feature.reach.take(Box{centre, centre}.grown(sphere.radius));
        }
    }
    const WoodSections wood(plan);
    // What grew along a slanting normal is no longer as high as it was born.
    const auto wood_at = [&](const Cell& cell, const AxisPlace& axis, const DVec3& off) {
        const GrowthBranch& branch = plan.branches[static_cast<size_t>(cell.owner)];
        if (branch.sections.empty()) return wood.at(cell.owner, axis, step + 1.0);
        const double along = axis.along + glm::dot(off, axis.direction);
        return wood.at(cell.owner, place_at(branch, along), step + 1.0);
    };
    constexpr size_t kGrain = 512;
    const size_t count = surface.mesh.num_vertices();
    std::vector<double> fastest((count + kGrain - 1) / kGrain, 0.0);
    parallel_for(count, kGrain, [&](size_t begin, size_t end) {
        double most = 0.0;
        for (size_t i = begin; i < end; i++) {
            const Vertex v(static_cast<uint32_t>(i));
            if (surface.mesh.is_removed(v)) continue;
            Cell& cell = surface.cells[v];
            const DVec3 place = surface.place(v);
            const GrowthBranch& branch = plan.branches[static_cast<size_t>(cell.owner)];
            if (cell.tissue == Tissue::kApical) {  // equation 3
                const AxisPlace next = next_place(branch, cell.along, step);
                const DVec3 way = next.pith - place;
                cell.velocity = DVec3(0.0);
                cell.bound = next.along;
                const AxisPlace& end = branch.axis.back();
                if (cell.along >= end.along) {
                    // It has come to where the wood is cut off, and grows as that does.
                    if (plan.follow && !branch.ends_open)
                        cell.velocity =
                            end.direction *
                            cambium_speed(cell, end, stand_of(plan, branch, end, place, end.direction, step),
                                          plan, wood.at(cell.owner, end, step + 1.0), step);
                    continue;
                }
                // One that the bark has overtaken waits until its axis has come out of it.
                if (glm::dot(way, next.direction) > 0.0)
                    cell.velocity = way;
                else
                    cell.along = next.along;
                continue;
            }
            const AxisPlace axis = place_at(branch, cell.along);
            const DVec3 off = place - wood_centre(plan, axis, step + 1.0);
            const DVec3 from_axis = off - axis.direction * glm::dot(off, axis.direction);
            const double distance = glm::length(from_axis);
            cell.extra = 0.0;
            if (cell.tissue == Tissue::kDecayed) {
                cell.speed = 0.0;
                cell.velocity = decay_velocity(surface, v, features[static_cast<size_t>(cell.hollow)],
                                               from_axis, wood.at(cell.owner, axis, step));
            } else {
                const DVec3 normal = vertex_normal(surface, v);
                Lips::Growth lip = lips.at(place, normal);
                cell.speed = cambium_speed(cell, axis, stand_of(plan, branch, axis, place, normal, step),
                                           plan, wood_at(cell, axis, off), step, lip.callus);
                lip.wrap -= normal * std::min(glm::dot(lip.wrap, normal), 0.0);  // bark does not shrink
                const double extra = extra_growth(surface, features, place) + lip.extra;
                // Equations 4, 6, 9 and 10.
                const double whole = (1.0 + extra) * cell.speed;
                const double less = lip.extra > 0.0 ? std::clamp(smoothed(surface, v, normal, lip.callus,
                                                                          axis.direction, distance, whole),
                                                                 -whole, whole)
                                                    : 0.0;
                cell.velocity = (whole - less) * (normal + lip.wrap);
                // What of it goes away from the axis beside plain growth: that is no reason to stop sooner.
                const DVec3 more = (whole - cell.speed) * normal + whole * lip.wrap;
                const double away = distance > 0.0 ? glm::dot(more, from_axis) / distance : 0.0;
                const double smooth = distance > 0.0 ? less * glm::dot(normal, from_axis) / distance : 0.0;
                cell.extra = std::max(away, 0.0) - smooth;
                // Nor is what smoothing takes beside wood a reason to stay thinner than plain bark.
                if (lip.callus) cell.extra = std::max(cell.extra, -std::max(cell.excess, 0.0));
            }
            most = std::max(most, glm::length(cell.velocity));
        }
        fastest[begin / kGrain] = most;
    });
    return fastest.empty() ? 0.0 : *std::max_element(fastest.begin(), fastest.end());
}

}  // namespace treerec::growth
