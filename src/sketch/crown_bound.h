// What bounds the twigs of a branch.
#pragma once

#include <cstddef>

#include "geometry/vec.h"

namespace treerec {

class CrownBound {
  public:
    virtual ~CrownBound() = default;
    // How far from `from` in the unit direction `way` the crown's part that belongs to `axis` goes on, in
    // metres, found in steps and then to within `step`. 0 where it does not begin. margin: metres that it
    // ends before the crown's surface, about.
    virtual double reach(const DVec3& from, const DVec3& way, size_t axis, double step,
                         double margin) const = 0;
};

}  // namespace treerec
