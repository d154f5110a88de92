#include "growth/texture.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"

namespace treerec::growth {

BranchCoordinates::BranchCoordinates(const GrowthBranch& branch, double twist)
    : branch_(branch), twist_(twist) {
    // From +X, of what stands upright.
    DVec3 x(1.0, 0.0, 0.0);
    if (std::abs(branch.axis.front().direction.x) > 0.9) x = DVec3(0.0, 0.0, 1.0);
    for (const AxisPlace& place : branch.axis) {
        x = normalized_or(x - place.direction * glm::dot(x, place.direction),
                          any_perpendicular(place.direction));
        x_.push_back(x);
    }
}

void BranchCoordinates::frame(double along, DVec3& centre, DVec3& x, DVec3& y) const {
    const AxisPlace place = place_at(branch_, along);
    const auto after = std::lower_bound(branch_.axis.begin(), branch_.axis.end(), along,
                                        [](const AxisPlace& p, double v) { return p.along < v; });
    const size_t at = std::min(static_cast<size_t>(after - branch_.axis.begin()), x_.size() - 1);
    centre = place.position;
    x = normalized_or(x_[at] - place.direction * glm::dot(x_[at], place.direction), x_[at]);
    y = glm::cross(place.direction, x);
}

double BranchCoordinates::around(const DVec3& place, double along) const {
    DVec3 centre, x, y;
    frame(along, centre, x, y);
    const DVec3 off = place - centre;
    const double turn = (portable::atan2(glm::dot(off, y), glm::dot(off, x)) - twist_ * along) / (2.0 * kPi);
    return turn - std::floor(turn);
}

DVec3 BranchCoordinates::direction(double along, double round) const {
    DVec3 centre, x, y;
    frame(along, centre, x, y);
    const SineCosine turn = portable_sine_cosine(2.0 * kPi * round);
    return x * turn.cosine + y * turn.sine;
}

}  // namespace treerec::growth
