// Photos of different exposures and white balances, brought to one.
#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

// What photos show of the same places.
class ExposureOverlaps {
  public:
    // ratio: by channel, the logarithm of how light photo `a` shows a place over how light `b` does. Give it
    // in both orders. One that no exposure explains is passed over: the two show different things there.
    void add(size_t a, size_t b, const DVec3& ratio);

    // The logarithm of each photo's gain, by channel: least squares over the places that two photos show,
    // with a weak prior of none (Brown and Lowe, "Automatic Panoramic Image Stitching using Invariant
    // Features", 2007, section 6).
    std::vector<DVec3> gains(size_t photos) const;

  private:
    struct Overlap {
        double count = 0.0;
        DVec3 sum{0.0};
    };
    std::map<std::pair<size_t, size_t>, Overlap> overlaps_;
};

}  // namespace treerec
