#include "growth/velocity.h"

#include <algorithm>
#include <cmath>

#include "geometry/parallel.h"

namespace treerec::growth {

namespace {

// A vertex that is behind its axis's radius may catch up by so many times its usual speed.
constexpr double kCatchUp = 2.0;

// S_c: what cambium of this age has to grow to come to its axis's radius in the end.
double cambium_speed(const Cell& cell, const DVec3& place, const GrowthPlan& plan, int step) {
    const AxisPlace axis = place_at(plan.branches[static_cast<size_t>(cell.owner)], cell.along);
    if (!plan.follow) return axis.speed;
    const DVec3 off = place - axis.position;
    const double radius = glm::length(off - axis.direction * glm::dot(off, axis.direction)) - cell.excess;
    const double age = std::max(step + 1.0 - axis.step, 0.0);
    const double whole = std::max(plan.steps - axis.step, 1.0);
    const double young = std::min(plan.young, axis.radius);
    const double usual = axis.radius / whole;
    return std::clamp(glm::mix(young, axis.radius, std::min(age / whole, 1.0)) - radius, 0.0,
                      std::max(kCatchUp * usual, 0.5 * young));
}

// Equation 6's sum: of one feature the largest, of several together.
double extra_growth(const Surface& surface, const std::vector<Feature>& features, const DVec3& place) {
    double sum = 0.0;
    for (const Feature& feature : features) {
        double most = 0.0;
        for (const BurlSphere& sphere : feature.spheres)
            most = std::max(most, burl_growth(sphere, glm::distance(place, surface.place(sphere.centre))));
        sum += most;
    }
    return sum;
}

}  // namespace

double burl_growth(const BurlSphere& sphere, double distance) {
    if (distance >= sphere.radius) return 0.0;
    if (distance <= sphere.inner) return sphere.growth;
    const double t = (sphere.radius - distance) / (sphere.radius - sphere.inner);
    return sphere.growth * t * t * (3.0 - 2.0 * t);
}

double set_velocities(Surface& surface, const GrowthPlan& plan, const std::vector<Feature>& features,
                      int step) {
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
            if (cell.tissue == Tissue::kApical) {  // equation 3
                const GrowthBranch& branch = plan.branches[static_cast<size_t>(cell.owner)];
                const AxisPlace tip = tip_at(branch, step + 1.0);
                cell.along = tip.along;
                const DVec3 way = tip.position - place;
                // One that the bark has overtaken waits until its axis has come out of it.
                const bool ahead = glm::dot(way, tip.direction) > 0.0;
                cell.velocity = step < branch.last_step() && ahead ? way : DVec3(0.0);
                continue;
            }
            cell.speed = cambium_speed(cell, place, plan, step);
            const double extra = extra_growth(surface, features, place) * cell.speed;
            cell.velocity = (cell.speed + extra) * vertex_normal(surface, v);  // equations 4 and 6
            most = std::max(most, cell.speed + extra);
        }
        fastest[begin / kGrain] = most;
    });
    return fastest.empty() ? 0.0 : *std::max_element(fastest.begin(), fastest.end());
}

}  // namespace treerec::growth
