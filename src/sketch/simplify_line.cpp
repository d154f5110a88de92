#include "sketch/simplify_line.h"

#include <algorithm>

#include "geometry/segment.h"

namespace treerec {

std::vector<size_t> simplify_line(const std::vector<DVec2>& points, const std::vector<size_t>& keep,
                                  double tolerance) {
    std::vector<bool> kept(points.size(), false);
    kept.front() = kept.back() = true;
    for (const size_t i : keep)
        kept[i] = true;
    std::vector<std::pair<size_t, size_t>> open;
    size_t last = 0;
    for (size_t i = 1; i < points.size(); i++) {
        if (!kept[i]) continue;
        open.emplace_back(last, i);
        last = i;
    }
    while (!open.empty()) {
        const auto [first, end] = open.back();
        open.pop_back();
        double most = tolerance * tolerance;
        size_t farthest = 0;
        for (size_t i = first + 1; i < end; i++) {
            double where;
            const double square = square_to_segment(DVec3(points[i], 0.0), DVec3(points[first], 0.0),
                                                    DVec3(points[end], 0.0), where);
            if (square <= most) continue;
            most = square;
            farthest = i;
        }
        if (farthest == 0) continue;
        kept[farthest] = true;
        open.emplace_back(first, farthest);
        open.emplace_back(farthest, end);
    }
    std::vector<size_t> places;
    for (size_t i = 0; i < points.size(); i++)
        if (kept[i]) places.push_back(i);
    return places;
}

std::vector<size_t> split_long_steps(const std::vector<DVec2>& points, const std::vector<size_t>& kept,
                                     double longest) {
    std::vector<size_t> places{kept[0]};
    for (size_t k = 1; k < kept.size(); k++) {
        for (size_t i = kept[k - 1] + 1; i < kept[k]; i++)
            if (glm::length(points[i + 1] - points[places.back()]) > longest) places.push_back(i);
        places.push_back(kept[k]);
    }
    return places;
}

}  // namespace treerec
