// The simulation: a seed grows into a tree's surface, step by step. Internal to growth/.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "growth/contact.h"
#include "growth/features.h"
#include "growth/fuse.h"
#include "growth/lips.h"
#include "growth/obstacles.h"
#include "growth/optimise.h"
#include "growth/plan.h"
#include "growth/surface.h"
#include "progress.h"

namespace treerec::growth {

struct StepCount {
    size_t vertices = 0, edges = 0, faces = 0;
    size_t frozen = 0;  // that could not move,
    size_t folded = 0;  // and of them by a fold of their own neighbourhood
    ShortEdges short_edges;
};

inline long chi_of(const StepCount& count) {
    return static_cast<long>(count.vertices) - static_cast<long>(count.edges) +
           static_cast<long>(count.faces);
}

class Run {
  public:
    // longest, shortest: T_s and T_m, metres. obstacles: null for none; must outlive this.
    Run(const GrowthPlan& plan, std::vector<Feature> features, double longest, double shortest,
        const Obstacles* obstacles = nullptr);

    int step() const { return step_; }
    bool done() const { return step_ >= plan_.steps; }
    // From step() to step() + 1. moved: called when all have moved, before the triangles are made even.
    void advance(const std::function<void(const Surface&)>& moved = {});
    const Surface& surface() const { return surface_; }
    const std::vector<Feature>& features() const { return features_; }
    const StepCount& count() const { return count_; }
    size_t fused() const { return fuser_.joined(); }  // so far

  private:
    void choose_buds();
    void sprout();
    void move_all();
    void follow(const std::vector<std::pair<Vertex, Vertex>>& merged);

    const GrowthPlan plan_;
    std::vector<Feature> features_;
    const Obstacles* obstacles_;
    Lips lips_;
    const double longest_, shortest_;
    Surface surface_;
    Contact contact_;
    Optimiser optimiser_;
    Fuser fuser_;
    std::vector<Vertex> apex_;  // by branch: its apical vertex or bud
    StepCount count_;
    int step_ = 0;
};

}  // namespace treerec::growth
