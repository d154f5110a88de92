#include "scan/usual_size.h"

#include <algorithm>
#include <utility>

#include "geometry/bounds.h"

namespace treerec {

namespace {

constexpr double kSmall = 0.9;  // metres
constexpr double kUsual = 7.0;  // metres

}  // namespace

double enlargement_to_usual(const std::vector<Vec3>& points) {
    Bounds bounds;
    for (const Vec3& p : points)
        if (is_finite(DVec3(p))) bounds.add(DVec3(p));
    const DVec3 size = bounds.size();
    const double largest = std::max({size.x, size.y, size.z});
    return largest > 0.0 && largest <= kSmall ? kUsual / largest : 1.0;
}

std::vector<Vec3> enlarged(std::vector<Vec3> points, double factor) {
    for (Vec3& p : points)
        p = Vec3(DVec3(p) * factor);
    return points;
}

PointCloud enlarged(PointCloud cloud, double factor) {
    cloud.positions = enlarged(std::move(cloud.positions), factor);
    for (float& radius : cloud.radii)
        radius *= static_cast<float>(factor);
    cloud.frame.metres_per_unit *= factor;
    return cloud;
}

}  // namespace treerec
