// The only user of CGAL: what a skeletonizer that triangulates its points cannot be faster than.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <ctime>

#include "bench.h"
#include "error.h"

namespace treerec::bench {

double delaunay_floor_ms(const std::vector<float>& coordinates) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    std::vector<Kernel::Point_3> points;
    points.reserve(coordinates.size() / 3);
    for (size_t i = 0; i + 2 < coordinates.size(); i += 3)
        points.emplace_back(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
    const std::clock_t start = std::clock();
    const CGAL::Delaunay_triangulation_3<Kernel> triangulation(points.begin(), points.end());
    const std::clock_t end = std::clock();
    if (triangulation.number_of_vertices() > points.size() || triangulation.dimension() < 3)
        throw Error("The points have no triangulation in space.");
    return 1000.0 * static_cast<double>(end - start) / CLOCKS_PER_SEC;
}

}  // namespace treerec::bench
