// Whether triangles come too near to one another. Internal to growth/.
#pragma once

#include "geometry/vec.h"

namespace treerec::growth {

// By separating axes (Gottschalk, Lin and Manocha 1996), in the plane, too: true unless some axis shows more
// than `gap` metres between the two. Never false for two that meet.
bool triangles_meet(const DVec3 (&p)[3], const DVec3 (&q)[3], double gap);
// Metres between the two, at most `most`; never more than it is: the widest gap that any of those axes shows.
double triangles_apart(const DVec3 (&p)[3], const DVec3 (&q)[3], double most);
bool segment_meets_triangle(const DVec3 (&s)[2], const DVec3 (&t)[3], double gap);

}  // namespace treerec::growth
