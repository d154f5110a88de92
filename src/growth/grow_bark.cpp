#include "growth/grow_bark.h"

#include <algorithm>
#include <limits>

#include "exchange/read_triangles.h"
#include "growth/blended_normals.h"
#include "growth/detour.h"
#include "growth/features_of.h"
#include "growth/judge.h"
#include "growth/levels.h"
#include "growth/run.h"
#include "growth/texture.h"
#include "growth/trace.h"
#include "growth/tree_plan.h"

namespace treerec {

namespace {

using namespace growth;

constexpr double kObstacleCell = 1.5;  // of the longest edge
constexpr double kAbout = 4.0;         // radii of wood and lumps about it, and a metre, that bark may come to
constexpr double kThrough = 3.0;       // longest edges from its axis's end within which a tip is through

// Metres along its axis that a branch has come, whose tip may have met what it could not pass; infinite where
// it is through, nothing where it never sprouted.
double reached(const Surface& surface, const GrowthBranch& branch, int32_t index, double longest) {
    for (const Vertex v : surface.mesh.vertices()) {
        const Cell& cell = surface.cells[v];
        if (cell.tissue != Tissue::kApical || cell.owner != index) continue;
        const AxisPlace* nearest = &branch.axis.front();
        for (const AxisPlace& at : branch.axis)
            if (glm::distance(at.position, surface.place(v)) <
                glm::distance(nearest->position, surface.place(v)))
                nearest = &at;
        if (branch.axis.back().along - nearest->along < kThrough * longest)
            return std::numeric_limits<double>::infinity();
        return std::max(nearest->along - longest, 0.0);
    }
    return 0.0;
}

// Where bark may come to.
Box reach_of(const GrowthPlan& plan, const GrowthRecipe& recipe) {
    Box box;
    double thickest = 0.0, swells = 0.0;
    for (const GrowthBranch& branch : plan.branches)
        for (const AxisPlace& place : branch.axis) {
            box.take(place.position);
            thickest = std::max(thickest, place.radius);
        }
    for (const GrowthFeature& feature : recipe.features)
        swells = std::max({swells, feature.radius, feature.lip.radius});
    for (const GrowthObstacle& obstacle : recipe.obstacles)
        swells = std::max(swells, obstacle.lip.radius);
    return box.grown(kAbout * (thickest + swells) + 1.0);
}

std::vector<BranchCoordinates> coordinates_of(const GrowthPlan& plan) {
    std::vector<BranchCoordinates> coordinates;
    for (const GrowthBranch& branch : plan.branches)
        coordinates.emplace_back(branch, plan.twist);
    return coordinates;
}

// Its branches are covered as far as they have come; all of them where it is on its way.
GrownBark bark_of(const Run& run, const BranchList& list, const TreePlan& planned,
                  const std::vector<BranchCoordinates>& coordinates, double longest) {
    const Surface& surface = run.surface();
    GrownBark bark;
    for (size_t b = 0; b < planned.plan.branches.size(); b++) {
        const size_t own = static_cast<size_t>(planned.branch_of[b]);
        const int32_t index = static_cast<int32_t>(b);
        const double most = planned.covered[own];
        const bool cut = std::any_of(run.features().begin(), run.features().end(), [&](const Feature& f) {
            return f.cut && f.placed && f.branch == index;
        });
        const double until = run.done() && !cut
                                 ? std::min(most, reached(surface, planned.plan.branches[b], index, longest))
                                 : most;
        bark.branches.push_back({list.nodes[static_cast<size_t>(list.branches[own].begin)], until});
    }
    std::vector<uint32_t> vertex_of(surface.mesh.num_vertices());
    for (const Vertex v : surface.mesh.vertices()) {
        const Cell& cell = surface.cells[v];
        const size_t branch = static_cast<size_t>(cell.owner);
        GrownBark::Vertex vertex;
        vertex.position = Vec3(surface.place(v));
        vertex.normal = Vec3(normalized_or(vertex_normal(surface, v), DVec3(0.0, 1.0, 0.0)));
        vertex.along = static_cast<float>(cell.along);
        vertex.around = static_cast<float>(coordinates[branch].around(surface.place(v), cell.along));
        vertex.radius = static_cast<float>(place_at(planned.plan.branches[branch], cell.along).radius);
        vertex.branch = cell.owner;
        vertex.decayed = cell.tissue == Tissue::kDecayed;
        vertex_of[v] = static_cast<uint32_t>(bark.vertices.size());
        bark.vertices.push_back(vertex);
    }
    for (const Face face : surface.mesh.faces()) {
        Vertex corners[3];
        surface.corners(face, corners);
        for (const Vertex corner : corners)
            bark.indices.push_back(vertex_of[corner]);
    }
    return bark;
}

}  // namespace

GrownTree grow_bark(const Tree& tree, const GrowthRecipe& recipe, const GrowBarkOptions& options,
                    Progress* progress) {
    if (tree.size() < 2) throw Error("The tree has no wood that bark could grow on.");
    GrownTree result;
    const BranchList list = list_branches(tree);
    TreePlan planned = plan_tree(tree, list, recipe.longest, recipe.shortest, recipe.steps);
    planned.plan.twist = recipe.twist;
    planned.plan.fuse = recipe.fuse;
    if (!recipe.seed.empty()) planned.plan.seed = read_triangles(recipe.seed);
    add_sections(tree, list, recipe, result.remarks, planned);
    result.steps = planned.plan.steps;
    Obstacles obstacles(kObstacleCell * recipe.longest, reach_of(planned.plan, recipe));
    add_obstacles(tree, list, planned, recipe, result.remarks, obstacles);
    go_around(planned.plan, obstacles, recipe.shortest);
    Run run(planned.plan, features_of(tree, list, planned, recipe, result.remarks), recipe.longest,
            recipe.shortest, &obstacles);
    std::function<void(const Surface&)> moved;
    if (!options.trace.empty())
        moved = [&](const Surface& surface) {
            write_trace(options.trace, surface, run.step(), recipe.shortest);
        };
    const std::vector<BranchCoordinates> coordinates = coordinates_of(planned.plan);
    while (!run.done()) {
        if (progress) {
            progress->check();
            // The surface grows with the steps, and so does what one costs.
            const double done = static_cast<double>(run.step()) / planned.plan.steps;
            progress->update(done * done, "Growing bark");
        }
        run.advance(moved);
        if (options.check_every > 0 && (run.done() || run.step() % options.check_every == 0))
            result.checks.push_back(judge(run, recipe.longest));
        if (options.watcher && !run.done() && options.watcher->wants(run.step(), planned.plan.steps)) {
            GrownBark bark = bark_of(run, list, planned, coordinates, recipe.longest);
            blend_normals(bark, recipe.longest);
            options.watcher->take(run.step(), bark);
        }
    }
    result.fused = run.fused();
    result.chi = chi_of(run.count());
    for (const Feature& feature : run.features())
        if (!feature.placed)
            result.remarks.push_back(std::string(feature.cut                              ? "A cut"
                                                 : feature.kind == Feature::Kind::kHollow ? "A hollow"
                                                                                          : "A burl") +
                                     " found no bark " + number_text(feature.along) +
                                     " m along its branch and was left out.");
    result.bark = bark_of(run, list, planned, coordinates, recipe.longest);
    blend_normals(result.bark, recipe.longest);
    order_levels(result.bark, progress);
    result.bark.digest = covered_wood_digest(tree, result.bark.branches);
    if (options.watcher && options.watcher->wants(run.step(), planned.plan.steps))
        options.watcher->take(run.step(), result.bark);
    return result;
}

}  // namespace treerec
