// What of the wind's motion bark and leaves must agree on (docs/wind.md): how far out on its primary branch,
// and on its secondary branch of that primary branch, a piece of wood is.
#pragma once

#include <cstdint>
#include <vector>

#include "foliage/branch_axis.h"
#include "geometry/vec.h"
#include "tree/branches.h"
#include "tree/tree.h"

namespace treerec {

inline constexpr int kWindPhases = 30;

// One number for a shader: a float whose exponent says which of kWindPhases phases the group has, and whose
// mantissa how far out on it (0 where the group begins, below 1). It survives half precision, where 10 bits
// of the second are left.
float wind_code(int phase, double out);
// A code as the bits of a half.
uint16_t half_code(float code);

// A primary branch is a branch of order 1 with all that it bears, a secondary branch one of order 2: each
// swings about its pivot, where it leaves its parent, as one. Whatever touches belongs to the same groups, or
// lies at the pivot of the one that begins there, where its motion and the change of that are zero; so
// nothing comes apart.
class WindGroups {
  public:
    // tree and list must outlive it. height: of the tree, metres.
    WindGroups(const Tree& tree, const BranchList& list, double height);

    // The codes of primary and secondary branch at a point on or in the bark. way: metres along the chords of
    // the branch (AxisPoint::way). off: from the axis there to the point.
    Vec2 codes(size_t branch, double way, const DVec3& off = DVec3(0.0)) const;
    // The same for a point far from any fork, where `off` is without effect.
    bool is_free(size_t branch, double way) const { return way >= runs_[branch].settled; }

  private:
    // How one branch goes on from its parent.
    struct Run {
        double exit = 0.0;     // metres of way, where it leaves its parent's bark
        double settled = 0.0;  // and from where on it goes its own way
        double cosine = 0.0;   // between its way and its parent's
        DVec3 parent_direction{0.0};
        double start[2] = {0.0, 0.0};  // metres from the groups' pivots to where it begins
        double scale[2] = {0.0, 0.0};  // from metres to the code's share; 0 outside of a group
        bool first[2] = {false, false};
        int phase[2] = {0, 0};
    };
    std::vector<Run> runs_;
};

}  // namespace treerec
