#include "growth/features.h"

#include <CGAL/boost/graph/iterator.h>

#include <algorithm>

namespace treerec::growth {

namespace {

constexpr double kNear = 3.0;      // longest edges beside its place within which a burl is set
constexpr double kFewSteps = 5.0;  // in which a hollow sinks in at the fastest

bool has_link(const Surface& surface, Vertex v) {
    const SurfaceMesh& mesh = surface.mesh;
    for (const Halfedge h : CGAL::halfedges_around_target(mesh.halfedge(v), mesh))
        if (surface.links[mesh.edge(h)]) return true;
    return false;
}

// Next on the link that leads on towards the tip (1) or the base (-1), the way that climbs most; null: none.
Vertex next_on_link(const Surface& surface, Vertex from, int way) {
    const SurfaceMesh& mesh = surface.mesh;
    Vertex best = SurfaceMesh::null_vertex();
    double most = 0.0;
    const Cell& here = surface.cells[from];
    for (const Halfedge h : CGAL::halfedges_around_target(mesh.halfedge(from), mesh)) {
        const Cell& there = surface.cells[mesh.source(h)];
        if (!surface.links[mesh.edge(h)] || there.tissue != Tissue::kCambium || there.owner != here.owner)
            continue;
        const double climb = way * (there.along - here.along) / surface.length(mesh.edge(h));
        if (climb <= most) continue;
        most = climb;
        best = mesh.source(h);
    }
    return best;
}

void set_spheres(Surface& surface, Vertex middle, Feature& feature) {
    const std::vector<Vertex> centres = feature.length > 0.0
                                            ? along_link(surface, middle, feature.length, feature.every)
                                            : std::vector<Vertex>{middle};
    for (const Vertex centre : centres) {
        feature.spheres.push_back({centre, feature.radius, feature.inner, feature.growth});
        surface.cells[centre].centre = true;
    }
}

}  // namespace

std::vector<Vertex> along_link(const Surface& surface, Vertex from, double length, double every) {
    std::vector<Vertex> found{from};
    for (const int way : {1, -1}) {
        double gone = 0.0, last = 0.0;
        for (Vertex at = from;;) {
            const Vertex next = next_on_link(surface, at, way);
            if (next == SurfaceMesh::null_vertex()) break;
            gone += glm::distance(surface.place(at), surface.place(next));
            if (gone > 0.5 * length) break;
            at = next;
            if (gone - last < every) continue;
            last = gone;
            found.push_back(at);
        }
    }
    return found;
}

void place_feature(Surface& surface, const GrowthPlan& plan, Vertex apex, double longest, int step,
                   Feature& feature) {
    if (feature.placed || step < feature.first_step || apex == SurfaceMesh::null_vertex()) return;
    const Cell& leader = surface.cells[apex];
    const GrowthBranch& branch = plan.branches[static_cast<size_t>(feature.branch)];
    const double end = branch.axis.back().along - 0.5 * longest;
    const double passed = feature.along + longest;
    // A tip that was cut has passed all.
    if (leader.tissue == Tissue::kCambium ||
        (leader.tissue == Tissue::kApical &&
         leader.along < std::max(passed, std::min(passed + 0.5 * feature.length, end))))
        return;
    const AxisPlace base = place_at(branch, feature.along);
    if (feature.kind == Feature::Kind::kHollow) {
        if (feature.cut) {
            // A tip that was late is cut once it is there.
            feature.last_step = std::max(feature.last_step, step + 1.0);
        } else {
            // Depth counts from the bark of the end, and that has not come out to there yet.
            const WoodSections wood(plan);
            const auto bark = [&](double when) {
                return wood.at(feature.branch, base, when).radius(feature.direction);
            };
            feature.deepest -= bark(plan.steps) - bark(step);
        }
        feature.rate = std::max(feature.deepest, 0.0) / std::max(feature.last_step - step, kFewSteps);
        feature.placed = true;
        return;
    }
    Vertex best = SurfaceMesh::null_vertex();
    double least = 1e300;
    for (const Vertex v : surface.mesh.vertices()) {
        const Cell& cell = surface.cells[v];
        if (cell.tissue != Tissue::kCambium || cell.owner != feature.branch) continue;
        const DVec3 off = surface.place(v) - base.position;
        const double out = glm::dot(off, feature.direction);
        if (out <= 0.0) continue;
        const double beside = glm::length(off - feature.direction * out);
        if (beside >= least || (feature.length > 0.0 && !has_link(surface, v))) continue;
        least = beside;
        best = v;
    }
    if (best == SurfaceMesh::null_vertex() || (feature.length <= 0.0 && least > kNear * longest)) return;
    set_spheres(surface, best, feature);
    feature.placed = true;
}

void decay(Surface& surface, const std::vector<Feature>& features, int step) {
    for (size_t i = 0; i < features.size(); i++) {
        const Feature& hollow = features[i];
        if (hollow.kind != Feature::Kind::kHollow || !hollow.placed || step > hollow.last_step) continue;
        for (const Vertex v : surface.mesh.vertices()) {
            Cell& cell = surface.cells[v];
            const bool dies = cell.tissue == Tissue::kCambium ||
                              (hollow.cut && cell.tissue == Tissue::kApical && cell.owner == hollow.branch);
            if (!dies || cell.bud >= 0 || !hollow.region.holds(surface.place(v))) continue;
            cell.tissue = Tissue::kDecayed;
            cell.hollow = static_cast<int32_t>(i);
            cell.sunk = 0.0;
        }
    }
}

}  // namespace treerec::growth
