// Measured outlines of wood that was turned.
#pragma once

#include "tree/section_shape.h"

namespace treerec {

// What a section is called after its wood was turned by a matrix, which may mirror, from where it pointed in
// `direction`.
SectionShape turned_section(const SectionShape& shape, const DVec3& direction, const DMat3& turn);

}  // namespace treerec
