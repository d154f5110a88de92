#include "growth/obstacles.h"

#include <algorithm>

#include "error.h"
#include "growth/triangle_tests.h"

namespace treerec::growth {

int32_t Obstacles::begin(const Lip& lip) {
    lips_.push_back(lip);
    return static_cast<int32_t>(lips_.size()) - 1;
}

void Obstacles::add(const DVec3& a, const DVec3& b, const DVec3& c) {
    Box box;
    for (const DVec3& p : {a, b, c})
        box.take(p);
    const double ab = glm::distance(a, b), bc = glm::distance(b, c), ca = glm::distance(c, a);
    const double longest = std::max({ab, bc, ca});
    if (!(ab + bc + ca < 1e300))
        throw Error("An obstacle has corners that are no numbers: give it a mesh that has its place.");
    if (!within_.meets(box)) return;
    if (longest > most_) {
        const DVec3 &p = longest == ab   ? a
                         : longest == bc ? b
                                         : c,
                    &q = longest == ab   ? b
                         : longest == bc ? c
                                         : a,
                    &r = longest == ab   ? c
                         : longest == bc ? a
                                         : b;
        const DVec3 middle = 0.5 * (p + q);
        add(p, middle, r);
        add(middle, q, r);
        return;
    }
    if (lips_.empty()) begin({});
    grid_.add(static_cast<uint32_t>(triangles_.size()), box);
    triangles_.push_back({a, b, c});
    owners_.push_back(static_cast<int32_t>(lips_.size()) - 1);
    boxes_.push_back(box);
}

int32_t Obstacles::meets(const DVec3 (&triangle)[3], double gap) const {
    Box box;
    for (const DVec3& p : triangle)
        box.take(p);
    box = box.grown(gap);
    int32_t met = -1;
    grid_.visit(box, [&](uint32_t item) {
        if (met >= 0 || !boxes_[item].meets(box)) return;
        const std::array<DVec3, 3>& t = triangles_[item];
        const DVec3 other[3] = {t[0], t[1], t[2]};
        if (triangles_meet(triangle, other, gap)) met = owners_[item];
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
