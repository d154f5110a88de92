#include "sketch/alpha_crown.h"

#ifdef TREEREC_CGAL

#include <CGAL/Alpha_shape_3.h>
#include <CGAL/Alpha_shape_cell_base_3.h>
#include <CGAL/Alpha_shape_vertex_base_3.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/random.h"

#endif

namespace treerec {

#ifndef TREEREC_CGAL

std::unique_ptr<const CrownBound> alpha_crown(const CrownSections&, const AxisCells&, size_t, uint64_t,
                                              const Progress*) {
    throw Error(
        "This build was made without CGAL and has no alpha shapes; let sections bound the crown instead.");
}

#else

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Alpha_shape_vertex_base_3<Kernel>;
using Cell = CGAL::Alpha_shape_cell_base_3<Kernel>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell> >;
using AlphaShape = CGAL::Alpha_shape_3<Delaunay>;

// Points in a crown. The paper tells none; with these a shape follows the outline to a fortieth of its width.
constexpr int kPoints = 6000;
constexpr double kOfLeast = 3.0;  // of the least alpha in one piece (Ma and Liu 2020, 3.2)

struct Triangle {
    DVec3 a, b, c;
};

DVec3 to_vector(const Kernel::Point_3& p) {
    return {p.x(), p.y(), p.z()};
}

// The least radius from which on the shape stays in one piece, squared as CGAL has it. There always is one:
// the hull's.
double least_alpha(const AlphaShape& shape) {
    long first = 0, last = static_cast<long>(shape.number_of_alphas());
    // Pieces only ever join beyond the alpha at which the most of them stand: so this finds where they are
    // one.
    while (first + 1 < last) {
        const long middle = (first + last) / 2;
        if (shape.number_of_solid_components(shape.get_nth_alpha(middle)) > 1)
            first = middle;
        else
            last = middle;
    }
    return shape.get_nth_alpha(std::min(last, static_cast<long>(shape.number_of_alphas())));
}

// The distance from `from` along the unit `way` to the triangle (Moeller and Trumbore 1997), or a negative
// number.
double hit(const DVec3& from, const DVec3& way, const Triangle& t) {
    const DVec3 e = t.b - t.a, f = t.c - t.a;
    const DVec3 p = glm::cross(way, f);
    const double det = glm::dot(e, p);
    if (std::abs(det) < 1e-15) return -1.0;
    const DVec3 s = from - t.a;
    const double u = glm::dot(s, p) / det;
    const DVec3 q = glm::cross(s, e);
    const double v = glm::dot(way, q) / det;
    if (u < 0.0 || v < 0.0 || u + v > 1.0) return -1.0;
    return glm::dot(f, q) / det;
}

class AlphaCrown : public CrownBound {
  public:
    explicit AlphaCrown(std::vector<std::vector<Triangle> > parts) : parts_(std::move(parts)) {}

    // The first place where the line meets the shape's surface, as the paper steps to it.
    double reach(const DVec3& from, const DVec3& way, size_t axis, double step,
                 double margin) const override {
        double nearest = 0.0;
        for (const Triangle& triangle : parts_[axis]) {
            const double at = hit(from, way, triangle);
            if (at > 0.0 && (nearest == 0.0 || at < nearest)) nearest = at;
        }
        return std::max(std::floor((nearest - margin) / step) * step, 0.0);
    }

  private:
    std::vector<std::vector<Triangle> > parts_;
};

std::vector<Triangle> shape_of(const std::vector<Kernel::Point_3>& points) {
    std::vector<Triangle> triangles;
    if (points.size() < 5) return triangles;
    AlphaShape shape(points.begin(), points.end(), 0.0, AlphaShape::REGULARIZED);
    if (shape.number_of_alphas() < 1) return triangles;
    shape.set_alpha(kOfLeast * kOfLeast * least_alpha(shape));
    std::vector<AlphaShape::Facet> facets;
    shape.get_alpha_shape_facets(std::back_inserter(facets), AlphaShape::REGULAR);
    for (const AlphaShape::Facet& facet : facets) {
        DVec3 corners[3];
        for (int i = 0, k = 0; i < 4; i++)
            if (i != facet.second) corners[k++] = to_vector(facet.first->vertex(i)->point());
        triangles.push_back({corners[0], corners[1], corners[2]});
    }
    return triangles;
}

}  // namespace

std::unique_ptr<const CrownBound> alpha_crown(const CrownSections& crown, const AxisCells& cells, size_t axes,
                                              uint64_t seed, const Progress* progress) {
    std::vector<std::vector<Kernel::Point_3> > points(axes);
    Random random(hash_seed(seed, 21));
    const double depth = crown.reach();
    // As thick everywhere: those of the crown's box that lie in the crown.
    int made = 0;
    for (int tries = 0; made < kPoints && tries < 200 * kPoints; tries++) {
        const DVec3 p(random.uniform(crown.left(), crown.right()),
                      random.uniform(crown.bottom(), crown.top()), random.uniform(-depth, depth));
        if (!crown.contains(p)) continue;
        if (progress && made % 500 == 0) progress->check();
        points[cells.nearest(p)].emplace_back(p.x, p.y, p.z);
        made++;
    }
    std::vector<std::vector<Triangle> > parts;
    for (const std::vector<Kernel::Point_3>& own : points) {
        if (progress) progress->check();
        parts.push_back(shape_of(own));
    }
    return std::make_unique<AlphaCrown>(std::move(parts));
}

#endif

}  // namespace treerec
