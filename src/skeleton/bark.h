// The surface of the limbs found so far: which of them a point lies on.
#pragma once

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "geometry/point_tree.h"
#include "skeleton/axis.h"
#include "skeleton/limbs.h"

namespace treerec {

// Where a point lies against a limb.
struct BarkPlace {
    int32_t limb = -1;
    int32_t station = 0;
    double distance = 0.0;  // metres to the axis
    double radius = 0.0;    // metres, of the limb there

    double outside() const { return distance - radius; }
};

// The nearest place on the line within a few stations of `station`; its limb is not set.
BarkPlace place_near(const std::vector<Station>& line, int32_t station, const DVec3& p);

class Bark {
  public:
    // Keeps references; the limbs that are there now are looked through, later ones are not.
    Bark(const std::vector<Limb>& limbs, const std::vector<std::vector<Station>>& axes);

    // The nearest place around a limb's station, or on the way to it from its parent's axis.
    BarkPlace on_limb(int32_t limb, int32_t station, const DVec3& p) const;

    // The limb whose surface is nearest to p, those marked in `except` left aside; limb -1 for none near.
    // reach: metres, how far axes of thin wood are looked for.
    BarkPlace nearest(const Vec3& p, const std::vector<uint8_t>* except = nullptr,
                      float reach = std::numeric_limits<float>::infinity()) const;

    // All limbs, those whose tips are near each other one after another.
    std::vector<int32_t> limbs_by_place() const;

  private:
    const std::vector<Limb>& limbs_;
    const std::vector<std::vector<Station>>& axes_;
    // Stations, to be searched by place.
    struct Index {
        std::vector<Vec3> positions;
        std::vector<std::pair<int32_t, int32_t>> names;  // the limb and station of each position
        std::vector<float> reach;                        // metres from it, reach_of() the station
        std::unique_ptr<PointTree> tree;
    };
    // Metres from the station that the bark which on_limb() looks at there reaches at most.
    double reach_of(int32_t limb, int32_t station) const;
    void look(const Index& index, size_t count, float reach, const Vec3& p,
              const std::vector<uint8_t>* except, BarkPlace& best) const;

    Index all_;
    Index thick_;               // of stout limbs alone, which many twigs would hide
    double thick_reach_ = 0.0;  // the largest reach_of() of these
};

// What leaves the bark must reach at least so far out of it: less is relief, or a strip of the bark itself.
double required_escape(double least_escape, double radius);

// Takes away the limbs that bear nothing and lie on the bark of others: strips of it that the slices parted.
void drop_strips(std::vector<Limb>& limbs, std::vector<std::vector<Station>>& axes, double least_escape);

}  // namespace treerec
