// The surface of the branches found so far: which of them a point lies on.
#pragma once

#include <memory>
#include <vector>

#include "geometry/point_tree.h"
#include "skeleton/branches/skeleton_branches.h"
#include "skeleton/cylinders/axis.h"

namespace treerec {

// Where a point lies against a branch.
struct BarkPlace {
    int32_t branch = -1;
    int32_t station = 0;
    double distance = 0.0;  // metres to the axis
    double radius = 0.0;    // metres, of the branch there

    double outside() const { return distance - radius; }
};

// The nearest place on the line within a few stations of `station`; its branch is not set.
BarkPlace place_near(const std::vector<Station>& line, int32_t station, const DVec3& p);

class Bark {
  public:
    // Keeps references; the branches that are there now are looked through, later ones are not.
    Bark(const std::vector<SkeletonBranch>& branches, const std::vector<std::vector<Station>>& axes);

    // The nearest place around a branch's station, or on the way to it from its parent's axis.
    BarkPlace on_branch(int32_t branch, int32_t station, const DVec3& p) const;

    // The place of all branches whose surface is nearest to p, those marked in `except` left aside; branch -1
    // where none is left that is nearer than `within` metres. Of equally near ones, that of the first branch.
    // hint: 0, or what an earlier call left there, best for a place nearby: that makes the search faster and
    // changes nothing else.
    BarkPlace nearest(const Vec3& p, double within, uint32_t& hint,
                      const std::vector<uint8_t>* except = nullptr) const;

    // Metres, of all branches.
    double thickest() const { return thickest_; }

    // All branches, those whose tips are near each other one after another.
    std::vector<int32_t> branches_by_place() const;

  private:
    // What lies between two stations, or on the way to a first one from its parent's axis.
    struct Piece {
        DVec3 from;
        DVec3 to;
        double from_radius;  // metres
        double to_radius;
        int32_t branch;
        int32_t from_station;
        int32_t to_station;
    };
    struct Nearest;
    void add(const Piece& piece);

    const std::vector<SkeletonBranch>& branches_;
    const std::vector<std::vector<Station>>& axes_;
    std::vector<Piece> pieces_;
    double thickest_ = 0.0;
    std::unique_ptr<PointTree> tree_;  // of the pieces' middles
    std::vector<float> reach_;         // by piece: metres that its bark reaches at most from its middle
    std::vector<float> node_reach_;    // by node of tree_: the largest of its pieces
};

// What leaves the bark must reach at least so far out of it: less is relief, or a strip of the bark itself.
double required_escape(double least_escape, double radius);

// Takes away the branches that are marked; none of them may bear one that stays.
void remove_branches(std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes,
                     const std::vector<uint8_t>& goes);

// Takes away the branches that bear nothing and lie on the bark of others: strips of it that the slices
// parted.
void drop_strips(std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes,
                 double least_escape);

}  // namespace treerec
