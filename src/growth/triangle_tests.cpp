#include "growth/triangle_tests.h"

#include <algorithm>
#include <cmath>

namespace treerec::growth {

namespace {

constexpr double kLess = 1.0 - 1e-12;  // so much less is less in spite of rounding

// Whether the axis shows more than `gap` between the two sets of points.
template <int N, int M>
bool separates(const DVec3& axis, const DVec3 (&p)[N], const DVec3 (&q)[M], double gap) {
    const double squared = glm::dot(axis, axis);
    if (!(squared > 0.0)) return false;
    double p_low = 1e300, p_high = -1e300, q_low = 1e300, q_high = -1e300;
    for (const DVec3& v : p) {
        const double d = glm::dot(axis, v);
        p_low = std::min(p_low, d);
        p_high = std::max(p_high, d);
    }
    for (const DVec3& v : q) {
        const double d = glm::dot(axis, v);
        q_low = std::min(q_low, d);
        q_high = std::max(q_high, d);
    }
    const double between = std::max(p_low - q_high, q_low - p_high);
    return between > 0.0 && between * between > gap * gap * squared;
}

// The larger of `widest` and the metres between the two sets along the axis. p begins at the origin.
double wider(double widest, const DVec3& axis, const DVec3 (&p)[3], const DVec3 (&q)[3]) {
    const double a[2] = {glm::dot(axis, p[1]), glm::dot(axis, p[2])};
    const double b[3] = {glm::dot(axis, q[0]), glm::dot(axis, q[1]), glm::dot(axis, q[2])};
    const double between = std::max(std::min({0.0, a[0], a[1]}) - std::max({b[0], b[1], b[2]}),
                                    std::min({b[0], b[1], b[2]}) - std::max({0.0, a[0], a[1]}));
    if (!(between > 0.0)) return widest;
    const double squared = glm::dot(axis, axis);
    // Most axes show less: that is told without a root.
    if (!(squared > 0.0) || between * between < kLess * (widest * widest * squared)) return widest;
    return std::max(widest, between / std::sqrt(squared));
}

}  // namespace

double triangles_apart(const DVec3 (&p_in)[3], const DVec3 (&q_in)[3], double most) {
    const DVec3 p[3] = {DVec3(0.0), p_in[1] - p_in[0], p_in[2] - p_in[0]};
    const DVec3 q[3] = {q_in[0] - p_in[0], q_in[1] - p_in[0], q_in[2] - p_in[0]};
    const DVec3 pe[3] = {p[1] - p[0], p[2] - p[1], p[0] - p[2]};
    const DVec3 qe[3] = {q[1] - q[0], q[2] - q[1], q[0] - q[2]};
    const DVec3 pn = glm::cross(pe[0], pe[1]), qn = glm::cross(qe[0], qe[1]);
    double widest = wider(wider(0.0, pn, p, q), qn, p, q);
    for (int i = 0; i < 3 && widest < most; i++) {
        widest = wider(widest, glm::cross(pn, pe[i]), p, q);
        widest = wider(widest, glm::cross(qn, qe[i]), p, q);
        for (const DVec3& b : qe)
            widest = wider(widest, glm::cross(pe[i], b), p, q);
    }
    return std::min(widest, most);
}

bool triangles_meet(const DVec3 (&p_in)[3], const DVec3 (&q_in)[3], double gap) {
    // About one of the corners: products of large coordinates would lose the digits that count.
    const DVec3 p[3] = {DVec3(0.0), p_in[1] - p_in[0], p_in[2] - p_in[0]};
    const DVec3 q[3] = {q_in[0] - p_in[0], q_in[1] - p_in[0], q_in[2] - p_in[0]};
    const DVec3 pe[3] = {p[1] - p[0], p[2] - p[1], p[0] - p[2]};
    const DVec3 qe[3] = {q[1] - q[0], q[2] - q[1], q[0] - q[2]};
    const DVec3 pn = glm::cross(pe[0], pe[1]), qn = glm::cross(qe[0], qe[1]);
    if (separates(pn, p, q, gap) || separates(qn, p, q, gap)) return false;
    for (const DVec3& a : pe)
        for (const DVec3& b : qe)
            if (separates(glm::cross(a, b), p, q, gap)) return false;
    for (const DVec3& a : pe)
        if (separates(glm::cross(pn, a), p, q, gap)) return false;
    for (const DVec3& b : qe)
        if (separates(glm::cross(qn, b), p, q, gap)) return false;
    return true;
}

bool segment_meets_triangle(const DVec3 (&s_in)[2], const DVec3 (&t_in)[3], double gap) {
    const DVec3 s[2] = {DVec3(0.0), s_in[1] - s_in[0]};
    const DVec3 t[3] = {t_in[0] - s_in[0], t_in[1] - s_in[0], t_in[2] - s_in[0]};
    const DVec3 te[3] = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
    const DVec3 tn = glm::cross(te[0], te[1]);
    if (separates(tn, s, t, gap)) return false;
    for (const DVec3& e : te)
        if (separates(glm::cross(s[1], e), s, t, gap) || separates(glm::cross(tn, e), s, t, gap))
            return false;
    return !separates(glm::cross(tn, s[1]), s, t, gap) && !separates(s[1], s, t, gap);
}

}  // namespace treerec::growth
