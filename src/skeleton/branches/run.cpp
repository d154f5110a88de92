#include "skeleton/branches/run.h"

#include <algorithm>
#include <cmath>

namespace treerec {

namespace {

constexpr double kLeastAround = 12.0;  // points
constexpr double kElongated = 3.0;     // variance along over variance across: a direction that can be trusted

}  // namespace

double Run::aside(const DVec3& to) const {
    const DVec3 way = to - middle;
    const double ahead = std::abs(glm::dot(way, axis));
    const double off = std::sqrt(std::max(0.0, glm::dot(way, way) - ahead * ahead));
    return off / (ahead + off);
}

Run run_of(const std::vector<Vec3>& points, const std::vector<uint32_t>& around, const DVec3& toward) {
    Run run;
    const double count = static_cast<double>(around.size());
    if (count < kLeastAround) return run;
    for (const uint32_t v : around)
        run.middle += DVec3(points[v]);
    run.middle /= count;
    DMat3 covariance(0.0);
    for (const uint32_t v : around) {
        const DVec3 d = DVec3(points[v]) - run.middle;
        covariance += glm::outerProduct(d, d);
    }
    // Power iteration finds the main axis.
    run.axis = normalized_or(toward - run.middle, DVec3(0, 1, 0));
    for (int i = 0; i < 16; i++)
        run.axis = normalized_or(covariance * run.axis, run.axis);
    const double along = glm::dot(run.axis, covariance * run.axis);
    const double across = 0.5 * (covariance[0][0] + covariance[1][1] + covariance[2][2] - along);
    run.known = along >= kElongated * across;
    return run;
}

}  // namespace treerec
