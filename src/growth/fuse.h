// Makes surfaces that have met one (Mizoguchi and Miyata 2014, 5.3: a vertex that meets a polygon is merged
// with the nearest of its vertices), so that the surface stays manifold. Internal to growth/.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "growth/contact.h"
#include "growth/surface.h"

namespace treerec::growth {

class Fuser {
  public:
    // T_s and T_m, metres.
    Fuser(Surface& surface, Contact& contact, double longest, double shortest)
        : surface_(surface), contact_(contact), longest_(longest), shortest_(shortest) {}

    // After all have moved, while it is known who was held. Where another part of the surface was in a
    // vertex's way, the face that faces it and its own go, and their corners become one: Euler's
    // characteristic falls by two, or two components become one. From there on, and from crotches, the crease
    // is zipped up.
    void run();
    // Of each vertex that went, the one that took its place; of the last run.
    const std::vector<std::pair<Vertex, Vertex>>& merged() const { return merged_; }
    size_t joined() const { return joined_; }  // pairs of faces, of all runs

  private:
    struct Pair {
        double cost;  // square metres
        Halfedge own, other;
    };

    void join(Vertex held);
    void find_near(Vertex vertex);
    bool try_join(const Pair& pair);
    void zip_all();
    bool creases(Edge edge) const;
    bool try_zip(Edge edge);
    bool sound(Vertex vertex) const;
    bool replace(Face face, const std::vector<std::pair<Vertex, Vertex>>& becomes);
    void settle(Vertex kept, const Cell& gone);

    Surface& surface_;
    Contact& contact_;
    const double longest_, shortest_;
    std::vector<std::pair<Vertex, Vertex>> merged_;
    size_t joined_ = 0;
    Change change_;
    uint32_t round_ = 0;
    std::vector<uint32_t> reached_;  // by vertex: the round in which it was found to be near
    std::vector<std::pair<double, Vertex>> heap_;
};

}  // namespace treerec::growth
