// Where cambium meets decayed wood and obstacles: it swells there and turns towards them (Mizoguchi and
// Miyata 2014, 7.2, 7.3 and 8). Internal to growth/.
#pragma once

#include <optional>
#include <vector>

#include "growth/box_grid.h"
#include "growth/feature.h"
#include "growth/obstacles.h"
#include "growth/surface.h"

namespace treerec::growth {

class Lips {
  public:
    // As the surface is now. obstacles: null for none. All must outlive what is asked next.
    void find(const Surface& surface, const std::vector<Feature>& features, const Obstacles* obstacles);
    struct Growth {
        double extra = 0.0;   // to equation 6's sum
        bool callus = false;  // beside wood
        DVec3 wrap{0.0};      // A W + B W of equations 9 and 10
    };
    // Of cambium at a place, whose normal is unit or zero.
    Growth at(const DVec3& place, const DVec3& normal) const;

  private:
    enum class Kind : uint8_t { kWood, kRim, kContact };  // of wood, of cambium beside it, of an obstacle
    struct Source {
        DVec3 place;
        const Lip* lip = nullptr;
        Kind kind = Kind::kWood;
    };

    std::vector<Source> sources_;
    std::optional<BoxGrid> grid_;
    double reach_ = 0.0;  // metres
};

}  // namespace treerec::growth
