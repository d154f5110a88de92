// Keeps the surface's triangles even: splits, merges and flips (Mizoguchi and Miyata 2014, 4.3). Internal to
// growth/.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "growth/contact.h"
#include "growth/plan.h"
#include "growth/surface.h"

namespace treerec::growth {

// Why edges shorter than T_m are left.
struct ShortEdges {
    size_t apical = 0;       // between two apical vertices or buds
    size_t parting = 0;      // not nearer than a step ago (equation 2)
    size_t link = 0;         // the mesh would not stay a surface
    size_t fold = 0;         // faces would turn over
    size_t contact = 0;      // it would meet another part of the surface, or an obstacle
    size_t unexplained = 0;  // could have been merged in a further round
};

class Optimiser {
  public:
    // T_s and T_m, metres.
    Optimiser(Surface& surface, Contact& contact, const GrowthPlan& plan, double longest, double shortest)
        : surface_(surface), contact_(contact), plan_(plan), longest_(longest), shortest_(shortest) {}

    // Splits, merges, flips. None is longer than T_s after it.
    void run();
    const ShortEdges& short_edges() const { return short_edges_; }
    // For spheres and buds that ride on vertices: of each vertex that went, the one that took its place.
    const std::vector<std::pair<Vertex, Vertex>>& merged() const { return merged_; }

  private:
    void scan();
    void split_long();
    void split(Edge edge);
    void round_tips();
    void round_off(Vertex apical);
    void twist(Vertex vertex, Vertex apical, double since);
    bool linked(Vertex vertex) const;
    void settle();
    size_t merge_short();  // how many
    Hold try_merge(Edge edge);
    void flip_all();
    bool try_flip(Edge edge);
    bool nearer_tip(int32_t a, int32_t b) const;
    bool may_flip(Edge edge) const;
    void changed_around(Vertex vertex);

    Surface& surface_;
    Contact& contact_;
    const GrowthPlan& plan_;
    const double longest_, shortest_;
    ShortEdges short_edges_;
    Change change_;
    std::vector<Edge> long_, short_;  // of which some may not be so any more
    std::vector<std::pair<Vertex, Vertex>> merged_;
    std::vector<Vertex> ring_;
};

}  // namespace treerec::growth
