// What leaves do to each other's light: how much leaf stands where, which way is out of it, and how much of
// the sky each leaf sees.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "foliage/leaves.h"
#include "geometry/bounds.h"
#include "geometry/vec.h"

namespace treerec {

// The leaves of one kind.
struct LeafGroup {
    std::vector<LeafPlacement>* leaves = nullptr;
    double area = 0.0;  // square metres of leaf, one side, on a card of size 1
};

// Leaf area density in cubes of 0.4 m (a power of two less on small trees, more where there would be too many
// cubes). Linear time; the same for every order of the leaves and number of threads.
class LeafAreaGrid {
  public:
    explicit LeafAreaGrid(const std::vector<LeafGroup>& groups);

    bool empty() const { return density_.empty(); }
    double edge() const { return edge_; }
    // Square metres of leaf per cubic metre, smoothed over about a cube.
    double density(const DVec3& p) const { return sample(density_, p); }
    // 0..1: the mean over the upper hemisphere of what leaves let through: exp(-k L), L being the leaf area
    // that a ray meets per square metre, k = 1/2 for leaves that face anywhere (Monsi and Saeki 1953).
    double sky(const DVec3& p) const { return sample(sky_, p); }
    // Out of the leaves: about a unit long where they end within a cube or two, 0 where they are even.
    DVec3 outward(const DVec3& p) const;

  private:
    void place(const Bounds& box);
    void fill(const std::vector<LeafGroup>& groups);
    void smooth();
    void look_up();
    size_t index(const int64_t (&cell)[3]) const;
    double sample(const std::vector<float>& of, const DVec3& p) const;

    double edge_ = 0.4;
    DVec3 low_{0.0};  // a corner of the first cube
    int64_t count_[3] = {0, 0, 0};
    std::vector<float> density_, sky_;
};

// Sets LeafPlacement::outward and occlusion of all by the light in a crown of all of them. outward as it was
// decides where leaves are even all around.
void light_leaves(const std::vector<LeafGroup>& groups);

}  // namespace treerec
