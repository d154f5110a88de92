// Whether a surface is what it must always be; by CGAL, which the growth itself does not ask. Internal to
// growth/.
#pragma once

#include "growth/grow_bark.h"
#include "growth/run.h"

namespace treerec::growth {

struct Soundness {
    bool closed = false, outward = false;
    size_t components = 0;
    size_t intersections = 0;  // pairs of faces
};

Soundness judge_surface(const Surface& surface);
GrowthStep judge(const Run& run, double longest);

}  // namespace treerec::growth
