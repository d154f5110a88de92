#include "growth/grow_bark.h"

#include <algorithm>
#include <cmath>

#include "growth/judge.h"
#include "growth/run.h"
#include "growth/texture.h"
#include "growth/tree_plan.h"

namespace treerec {

namespace {

using namespace growth;

// Metres along its branch's axis where a node is.
double along_of(const Tree& tree, const GrowthBranch& branch, NodeId node) {
    const DVec3 place = tree.node(node).position;
    const AxisPlace* nearest = &branch.axis.front();
    for (const AxisPlace& at : branch.axis)
        if (glm::distance(at.position, place) < glm::distance(nearest->position, place)) nearest = &at;
    return nearest->along;
}

std::vector<Feature> features_of(const Tree& tree, const BranchList& list, const TreePlan& planned,
                                 const GrowthRecipe& recipe, std::vector<std::string>& remarks) {
    std::vector<Feature> features;
    for (const GrowthFeature& wanted : recipe.features) {
        const int32_t branch = list.branch_of[wanted.node];
        const auto at = std::find(planned.branch_of.begin(), planned.branch_of.end(), branch);
        if (at == planned.branch_of.end()) {
            remarks.push_back("A burl was left out: its branch is thinner than " +
                              std::to_string(static_cast<int>(std::lround(1000.0 * recipe.shortest))) +
                              " mm and stays a tube. Give it a thicker branch, or shorter edges.");
            continue;
        }
        Feature feature;
        feature.branch = static_cast<int32_t>(at - planned.branch_of.begin());
        const GrowthBranch& grown = planned.plan.branches[static_cast<size_t>(feature.branch)];
        const double from = wanted.node == tree.root() ? 0.0 : along_of(tree, grown, wanted.node);
        feature.along = from + wanted.along;
        if (feature.along < grown.axis.front().along || feature.along > grown.axis.back().along) {
            remarks.push_back(
                "A burl lies " + number_text(feature.along) + " m along its branch, which is grown from " +
                number_text(std::round(100.0 * grown.axis.front().along) / 100.0) + " to " +
                number_text(std::round(100.0 * grown.axis.back().along) / 100.0) + " m: it was left out.");
            continue;
        }
        const BranchCoordinates coordinates(grown);
        feature.direction = coordinates.direction(feature.along, wanted.around / 360.0);
        const double born = place_at(grown, feature.along).step;
        feature.first_step = born + wanted.from * (planned.plan.steps - born);
        feature.radius = wanted.radius;
        feature.inner = wanted.inner;
        feature.growth = wanted.growth;
        features.push_back(feature);
    }
    return features;
}

GrownBark bark_of(const Surface& surface, const BranchList& list, const TreePlan& planned) {
    GrownBark bark;
    std::vector<BranchCoordinates> coordinates;
    for (size_t b = 0; b < planned.plan.branches.size(); b++) {
        const size_t own = static_cast<size_t>(planned.branch_of[b]);
        bark.branches.push_back(
            {list.nodes[static_cast<size_t>(list.branches[own].begin)], planned.covered[own]});
        coordinates.emplace_back(planned.plan.branches[b]);
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

GrownTree grow_bark(const Tree& tree, const GrowthRecipe& recipe, const GrowOptions& options,
                    Progress* progress) {
    if (tree.size() < 2) throw Error("The tree has no wood that bark could grow on.");
    GrownTree result;
    const BranchList list = list_branches(tree);
    const TreePlan planned = plan_tree(tree, list, recipe.longest, recipe.shortest, recipe.steps);
    result.steps = planned.plan.steps;
    Run run(planned.plan, features_of(tree, list, planned, recipe, result.remarks), recipe.longest,
            recipe.shortest);
    while (!run.done()) {
        if (progress) {
            progress->check();
            // The surface grows with the steps, and so does what one costs.
            const double done = static_cast<double>(run.step()) / planned.plan.steps;
            progress->update(done * done, "Growing bark");
        }
        run.advance();
        if (options.check_every > 0 && (run.done() || run.step() % options.check_every == 0))
            result.checks.push_back(judge(run, recipe.longest));
    }
    for (const Feature& feature : run.features())
        if (!feature.placed)
            result.remarks.push_back("A burl found no bark " + number_text(feature.along) +
                                     " m along its branch and was left out.");
    result.bark = bark_of(run.surface(), list, planned);
    result.bark.digest = covered_wood_digest(tree, result.bark.branches);
    return result;
}

}  // namespace treerec
