#include "growth/obstacles.h"

#include <algorithm>

#include "growth/triangle_tests.h"

namespace treerec::growth {

void Obstacles::add(const DVec3& a, const DVec3& b, const DVec3& c) {
    Box box;
    for (const DVec3& p : {a, b, c})
        box.take(p);
    grid_.add(static_cast<uint32_t>(triangles_.size()), box);
    triangles_.push_back({a, b, c});
    boxes_.push_back(box);
}

bool Obstacles::meets(const DVec3 (&triangle)[3], double gap) const {
    Box box;
    for (const DVec3& p : triangle)
        box.take(p);
    box = box.grown(gap);
    bool met = false;
    grid_.visit(box, [&](uint32_t item) {
        if (met || !boxes_[item].meets(box)) return;
        const std::array<DVec3, 3>& t = triangles_[item];
        const DVec3 other[3] = {t[0], t[1], t[2]};
        met = triangles_meet(triangle, other, gap);
    });
    return met;
}

double Obstacles::distance(const Box& box, double reach) const {
    double nearest = reach;
    grid_.visit(box.grown(reach),
                [&](uint32_t item) { nearest = std::min(nearest, box.distance(boxes_[item])); });
    return nearest;
}

}  // namespace treerec::growth
