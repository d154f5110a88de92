#include "sketch/axis_cells.h"

#include <algorithm>
#include <cmath>

#include "geometry/segment.h"

namespace treerec {

namespace {

constexpr double kStride = 8.0;  // steps that are taken at once, until one leads out

double square_to(const DVec3& p, const DVec3& a, const DVec3& b) {
    double where;
    return square_to_segment(p, a, b, where);
}

}  // namespace

AxisCells::AxisCells(const CrownSections& crown, const std::vector<std::vector<DVec3>>& lines)
    : crown_(crown) {
    for (const std::vector<DVec3>& line : lines) {
        std::vector<Part> parts;
        for (size_t i = 0; i + 1 < line.size(); i++)
            parts.push_back({line[i], line[i + 1]});
        DVec3 low = line[0], high = line[0];
        for (const DVec3& p : line) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        parts_.push_back(std::move(parts));
        balls_.push_back({0.5 * (low + high), 0.5 * glm::length(high - low)});
    }
}

size_t AxisCells::nearest(const DVec3& p) const {
    size_t best = 0;
    double least = 1e300;
    for (size_t axis = 0; axis < parts_.size(); axis++) {
        const double away = glm::length(p - balls_[axis].centre) - balls_[axis].radius;
        if (away > 0.0 && away * away >= least) continue;
        for (const Part& part : parts_[axis]) {
            const double square = square_to(p, part.a, part.b);
            if (square >= least) continue;
            least = square;
            best = axis;
        }
    }
    return best;
}

bool AxisCells::within(const DVec3& p, size_t axis, double margin) const {
    return crown_.contains(p, margin) && nearest(p) == axis;
}

double AxisCells::reach(const DVec3& from, const DVec3& way, size_t axis, double step, double margin) const {
    const double most = 4.0 * crown_.reach() + (crown_.top() - crown_.bottom());
    double along = 0.0;
    if (!within(from + way * step, axis, margin)) return 0.0;
    for (double stride = kStride * step; along < most && within(from + way * (along + stride), axis, margin);)
        along += stride;
    while (along < most && within(from + way * (along + step), axis, margin))
        along += step;
    return along;
}

}  // namespace treerec
