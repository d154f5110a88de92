#include "tree/turned_section.h"

#include "geometry/portable_math.h"

namespace treerec {

SectionShape turned_section(const SectionShape& shape, const DVec3& direction, const DMat3& turn) {
    const DVec3 now = turn * direction, zero = section_zero(now), was = turn * section_zero(direction);
    const double angle = portable::atan2(glm::dot(was, glm::cross(now, zero)), glm::dot(was, zero));
    const double hand = glm::determinant(turn) < 0.0 ? -1.0 : 1.0;
    SectionShape turned;
    for (size_t i = 0; i < SectionShape::kHarmonics; i++) {
        const double by = static_cast<double>(i + 2) * angle;
        const double c = shape.cosine[i], s = hand * static_cast<double>(shape.sine[i]);
        turned.cosine[i] = static_cast<float>(c * portable::cos(by) - s * portable::sin(by));
        turned.sine[i] = static_cast<float>(s * portable::cos(by) + c * portable::sin(by));
    }
    return turned;
}

}  // namespace treerec
