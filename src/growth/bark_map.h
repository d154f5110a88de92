// Bark unrolled: how far a scan's points, or a surface's, lie from the axes of the branches that bark grows
// on. Internal to growth/.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "geometry/capsule_tree.h"
#include "growth/texture.h"
#include "growth/tree_plan.h"
#include "progress.h"
#include "scan/point_cloud.h"

namespace treerec::growth {

// Where on the bark a point is.
struct BarkSpot {
    int32_t branch = 0;   // of the plan
    uint32_t point = 0;   // whose it is, for the caller
    double along = 0.0;   // metres of the branch's axis
    double around = 0.0;  // 0..1 of a round about it, whatever the grain
    double out = 0.0;     // metres from it
};

// Finds the branch that a point belongs to. The plan must outlive it.
class BarkAxes {
  public:
    // Wood that stays tubes takes what is nearest to it, too.
    BarkAxes(const Tree& tree, const BranchList& list, const TreePlan& planned);

    // Nothing for a point that other wood is nearer to, or that is farther outside than the branch is thick.
    std::optional<BarkSpot> find(const DVec3& p) const;
    // All that are found; `point`: their index. Throws Cancelled.
    std::vector<BarkSpot> find_all(std::span<const DVec3> points, const Progress* progress) const;
    // Metres of a branch's axis between which its bark is its own: outside its parent, and covered to the
    // end.
    std::pair<double, double> own_part(int32_t branch) const;
    // The nearest place of a branch's axis, and metres to it.
    std::pair<AxisPlace, double> nearest(int32_t branch, const DVec3& p) const;
    const BranchCoordinates& coordinates(int32_t branch) const {
        return coordinates_[static_cast<size_t>(branch)];
    }

  private:
    const TreePlan& planned_;
    std::vector<BranchCoordinates> coordinates_;
    std::vector<int32_t> branch_;    // by segment's child in wood_: of the plan; -1: not covered
    std::vector<CapsuleTree> axes_;  // by branch; a segment's child is the place where it ends
    CapsuleTree wood_;
};

// A branch's bark as rows along it and columns around it.
struct BarkMap {
    double begin = 0.0;  // metres along the axis,
    double step = 0.0;   // and from row to row
    size_t rows = 0, columns = 0;
    std::vector<double> radius;   // by row: metres, of the axis
    std::vector<double> height;   // metres beyond it, by row and column; NaN: nothing is known
    std::vector<uint32_t> count;  // points
    double noise = 0.0;           // metres: the usual standard deviation of points within a cell

    size_t cell(size_t row, size_t column) const { return row * columns + column; }
    double along(size_t row) const { return begin + (static_cast<double>(row) + 0.5) * step; }
    // The cell of a spot, or nothing.
    std::optional<size_t> cell_of(const BarkSpot& spot) const;
    // Circumference of a column, metres.
    double width(size_t row) const { return 2.0 * kPi * radius[row] / static_cast<double>(columns); }
};

// Each cell's height is the median of its points'. What is no sheet (ground, leaves, forks) is not known: its
// points are spread more than those of bark that is rough and leans. spots: of this branch, any order.
BarkMap map_bark(const GrowthBranch& branch, std::span<const BarkSpot> spots, double begin, double end,
                 double step, size_t columns);

// The points in the tree's space, metres; of very many evenly chosen ones. Throws Error for none.
std::vector<DVec3> points_near(const Tree& tree, const PointCloud& cloud);

// Metres along a branch's axis where a node is.
double along_of(const Tree& tree, const GrowthBranch& branch, NodeId node);

}  // namespace treerec::growth
