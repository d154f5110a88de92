// Bark cut into pieces, to tell which of it a scan saw. Internal to fidelity/.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tree/branches.h"
#include "tree/tree.h"

namespace treerec {

// Every branch unrolled: rows along it, about `patch` metres each, and in each row pieces around it of about
// that width. What lies inside the parent branch is left out.
class BarkPatches {
  public:
    BarkPatches(const Tree& tree, const BranchList& list, double patch);

    size_t size() const { return area_.size(); }
    double area(size_t patch) const { return area_[patch]; }
    // The patches of a branch.
    std::pair<size_t, size_t> range_of(size_t branch) const { return {begin_[branch], begin_[branch + 1]}; }
    // The patch that p falls on, straight out from the axis of the segment that ends in `child`; -1 for what
    // lies inside the parent branch.
    int32_t find(const DVec3& p, NodeId child) const;

  private:
    struct Piece {     // a segment, by its child
        DVec3 from;    // where it starts
        DVec3 axis;    // its direction; zero for one without length
        DVec3 normal;  // the zero of angles, carried along the branch without twist
        double length = 0.0;
        double start = 0.0;  // metres along the branch's bark; negative inside the parent
        int32_t branch = -1;
    };
    struct Row {
        int32_t first = 0;  // patch
        int32_t count = 1;
    };
    std::vector<Piece> pieces_;
    std::vector<Row> rows_;
    std::vector<int32_t> row_begin_;  // by branch; one more at the end
    std::vector<double> row_height_;  // by branch
    std::vector<size_t> begin_;       // patches by branch; one more at the end
    std::vector<double> area_;
};

}  // namespace treerec
