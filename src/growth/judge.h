// Whether a surface is what it must always be; by CGAL, which the growth itself does not ask. Internal to
// growth/.
#pragma once

#include "growth/grow_bark.h"
#include "growth/run.h"

namespace treerec::growth {

GrowthStep judge(const Run& run, double longest);

}  // namespace treerec::growth
