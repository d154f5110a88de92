#include "growth/run.h"

#include <CGAL/boost/graph/iterator.h>

#include <algorithm>
#include <cmath>

#include "geometry/parallel.h"
#include "growth/seed.h"
#include "growth/velocity.h"

namespace treerec::growth {

namespace {

constexpr size_t kGrain = 512;
constexpr double kTurned = 0.999;  // cosine between a velocity and the normal, from which on they are alike

}  // namespace

Run::Run(const GrowthPlan& plan, std::vector<Feature> features, double longest, double shortest,
         const Obstacles* obstacles)
    : plan_(plan),
      features_(std::move(features)),
      obstacles_(obstacles),
      longest_(longest),
      shortest_(shortest),
      contact_(surface_, longest, obstacles),
      optimiser_(surface_, contact_, plan_, longest, shortest),
      fuser_(surface_, contact_, longest, shortest),
      apex_(plan.branches.size(), SurfaceMesh::null_vertex()) {
    const GrowthBranch& trunk = plan_.branches.front();
    if (plan_.seed.empty()) {
        apex_[0] = plant_prism(surface_, plan_, longest_);
        contact_.list_all();
    } else {
        apex_[0] = plant_mesh(surface_, plan_, shortest_);
        contact_.list_all();
        optimiser_.run();
        follow(optimiser_.merged());
        // As old as a trunk that reaches out of it.
        step_ = std::clamp(static_cast<int>(place_at(trunk, surface_.cells[apex_[0]].along).step), 0,
                           std::max(plan_.steps - 1, 0));
    }
}

void Run::advance(const std::function<void(const Surface&)>& moved) {
    sprout();
    choose_buds();
    for (Feature& feature : features_)
        place_feature(surface_, plan_, apex_[static_cast<size_t>(feature.branch)], longest_, step_, feature);
    decay(surface_, features_, step_);
    lips_.find(surface_, features_, obstacles_);
    for (const Vertex v : surface_.mesh.vertices()) {
        Cell& cell = surface_.cells[v];
        cell.previous = surface_.place(v);
        cell.hold = Hold::kFree;
    }
    contact_.advance(set_velocities(surface_, plan_, features_, lips_, step_));
    move_all();
    if (moved) moved(surface_);
    if (plan_.fuse) {
        fuser_.run();
        follow(fuser_.merged());
    }
    optimiser_.run();
    follow(optimiser_.merged());
    step_++;
    count_.vertices = surface_.mesh.number_of_vertices();
    count_.edges = surface_.mesh.number_of_edges();
    count_.faces = surface_.mesh.number_of_faces();
    count_.short_edges = optimiser_.short_edges();
}

// Equation 1. Most have nothing in their way and go at once; the others in pieces of at most T_m / 4, each of
// which must be free.
void Run::move_all() {
    const double piece = shortest_ / 4.0;
    count_.frozen = count_.folded = 0;
    contact_.look_ahead();
    SurfaceMesh& mesh = surface_.mesh;
    std::vector<std::vector<Vertex>> rest((mesh.num_vertices() + kGrain - 1) / kGrain);
    parallel_for(mesh.num_vertices(), kGrain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            const Vertex v(static_cast<uint32_t>(i));
            if (mesh.is_removed(v)) continue;
            Cell& cell = surface_.cells[v];
            const double length = glm::length(cell.velocity);
            if (!(length > 0.0)) continue;
            if (cell.tissue == Tissue::kApical || length > piece || !contact_.may_go(cell)) {
                rest[begin / kGrain].push_back(v);
                continue;
            }
            mesh.point(v) += cell.velocity;
            cell.touched = -1;
            cell.excess += cell.extra;
            if (cell.tissue == Tissue::kDecayed) cell.sunk += length;
        }
    });
    contact_.follow();
    std::vector<Vertex> order;
    for (const std::vector<Vertex>& some : rest)
        order.insert(order.end(), some.begin(), some.end());
    for (int part = 0; !order.empty(); part++) {
        std::vector<Vertex> later;
        for (const Vertex v : order) {
            Cell& cell = surface_.cells[v];
            const double length = glm::length(cell.velocity);
            if (!(length > 0.0)) continue;
            const int parts = pieces_of(cell, shortest_);
            cell.hold = contact_.move(v, surface_.place(v) + cell.velocity / static_cast<double>(parts));
            const bool blocked = cell.hold == Hold::kObstacle;
            if (blocked) {
                // What turns towards an obstacle and is at it still grows along it (Mizoguchi and Miyata
                // 2014, 8).
                cell.touched = contact_.touched();
                const DVec3 normal = vertex_normal(surface_, v);
                const double up = glm::dot(cell.velocity, normal) / parts;
                if (up < kTurned * length / parts)
                    cell.hold = contact_.move(v, surface_.place(v) + up * normal);
            }
            if (cell.hold == Hold::kFree) {
                if (!blocked) cell.touched = -1;
                cell.excess += cell.extra / parts;
                if (cell.tissue == Tissue::kApical) cell.along += (cell.bound - cell.along) / (parts - part);
                if (cell.tissue == Tissue::kDecayed) cell.sunk += length / parts;
            } else {
                count_.frozen++;
                if (cell.hold == Hold::kFold) count_.folded++;
            }
            if (part + 1 < parts && cell.hold == Hold::kFree) later.push_back(v);
        }
        order = std::move(later);
    }
}

// Mizoguchi and Miyata 2014, 5.2: of the cambium near the tip that the branch leaves, the vertex that faces
// its way.
void Run::choose_buds() {
    for (size_t b = 1; b < plan_.branches.size(); b++) {
        const GrowthBranch& branch = plan_.branches[b];
        if (apex_[b] != SurfaceMesh::null_vertex()) continue;
        const Vertex tip = apex_[static_cast<size_t>(branch.parent)];
        if (tip == SurfaceMesh::null_vertex()) continue;
        const Cell& leader = surface_.cells[tip];
        const bool passed =
            leader.tissue == Tissue::kApical && leader.along > branch.parent_along + 0.5 * longest_;
        if (!passed && step_ < branch.first_step()) continue;
        // Near to where the branch leaves its parent's axis.
        const AxisPlace base =
            place_at(plan_.branches[static_cast<size_t>(branch.parent)], branch.parent_along);
        const DVec3 toward = branch.axis.front().direction;
        const DVec3 aside = normalized_or(toward - base.direction * glm::dot(toward, base.direction), toward);
        Vertex best = SurfaceMesh::null_vertex();
        double most = -1e300;
        for (const Vertex v : surface_.mesh.vertices()) {
            const Cell& cell = surface_.cells[v];
            if (cell.tissue != Tissue::kCambium || cell.bud >= 0 || cell.owner != branch.parent) continue;
            const double off = std::abs(glm::dot(surface_.place(v) - base.position, base.direction));
            if (off > longest_) continue;
            const double score = glm::dot(vertex_normal(surface_, v), aside) - off / longest_;
            if (score <= most) continue;
            most = score;
            best = v;
        }
        if (best == SurfaceMesh::null_vertex()) continue;
        surface_.cells[best].bud = static_cast<int32_t>(b);
        apex_[b] = best;
    }
}

void Run::sprout() {
    for (size_t b = 1; b < plan_.branches.size(); b++) {
        if (apex_[b] == SurfaceMesh::null_vertex() || step_ < plan_.branches[b].first_step()) continue;
        Cell& cell = surface_.cells[apex_[b]];
        if (cell.bud != static_cast<int32_t>(b)) continue;
        cell.bud = -1;
        cell.tissue = Tissue::kApical;
        cell.owner = static_cast<int32_t>(b);
        cell.along = plan_.branches[b].axis.front().along;
        // Its own sap links begin around it.
        const SurfaceMesh& mesh = surface_.mesh;
        for (const Halfedge h : CGAL::halfedges_around_target(mesh.halfedge(apex_[b]), mesh))
            surface_.links[mesh.edge(h)] = true;
    }
}

void Run::follow(const std::vector<std::pair<Vertex, Vertex>>& merged) {
    for (const auto& [gone, kept] : merged) {
        for (Vertex& apex : apex_)
            if (apex == gone) apex = kept;
        for (Feature& feature : features_)
            for (BurlSphere& sphere : feature.spheres)
                if (sphere.centre == gone) sphere.centre = kept;
    }
}

}  // namespace treerec::growth
