// The outline of a cross-section, from the points around it.
#pragma once

#include <optional>
#include <span>

#include "geometry/vec.h"
#include "tree/section_shape.h"

namespace treerec {

// The harmonics of the outline, by iteratively reweighted least squares (Tukey's biweights, Holland and
// Welsch 1977) over the medians of 36 directions, about the outline's own middle: what lies off the wood,
// such as ivy and leaves, goes as long as bark is most of what is seen. Each harmonic is shrunk by what noise
// of the size that the points show would give (James and Stein 1961), down to none. Nothing where fewer than
// 70 % of the directions have bark, since a gap could hold anything. offsets: from the axis, over the wood's
// radius; angle 0 is +x. Their order does not matter.
std::optional<SectionShape> outline_of(std::span<const DVec2> offsets);

}  // namespace treerec
