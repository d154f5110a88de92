// A k-d tree over points, nanoflann's: who is nearest to a place.
#pragma once

#include <cstdint>
#include <nanoflann.hpp>
#include <span>
#include <utility>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

// Keeps copies of the points. Distances are squared.
class KdTree {
  public:
    // points: finite. leaf: so many points, at most, are not split any further.
    explicit KdTree(std::span<const Vec3> points, size_t leaf = 16)
        : cloud_{{points.begin(), points.end()}},
          tree_(3, cloud_, nanoflann::KDTreeSingleIndexAdaptorParams(leaf)) {}
    // What is inside points to what is beside it.
    KdTree(const KdTree&) = delete;
    KdTree& operator=(const KdTree&) = delete;

    // Fills index and squared, which have room for `count`, with the nearest points, ascending; how many
    // there are.
    size_t nearest(const Vec3& p, size_t count, uint32_t* index, float* squared) const {
        return count == 0 ? 0 : tree_.knnSearch(&p.x, count, index, squared);
    }

    // All points nearer than a squared distance, ascending.
    void within(const Vec3& p, float squared, std::vector<std::pair<uint32_t, float>>& found) const {
        tree_.radiusSearch(&p.x, squared, found, Settings());
    }

    // Calls found.add(squared, index) for points nearer than found.limit() (squared) was when their leaf was
    // come to. add() may lower the limit.
    template <typename Found>
    void search(const Vec3& p, Found& found) const {
        Results<Found> results{found};
        tree_.findNeighbors(results, &p.x, Settings());
    }

  private:
#if NANOFLANN_VERSION < 0x150
    using Settings = nanoflann::SearchParams;
#else
    using Settings = nanoflann::SearchParameters;
#endif

    struct Cloud {
        std::vector<Vec3> points;

        size_t kdtree_get_point_count() const { return points.size(); }
        float kdtree_get_pt(size_t index, size_t axis) const { return points[index][static_cast<int>(axis)]; }
        template <typename Box>
        bool kdtree_get_bbox(Box&) const {
            return false;
        }
    };

    // What nanoflann hands its finds to.
    template <typename Found>
    struct Results {
        using DistanceType = float;
        Found& found;

        size_t size() const { return 0; }
        bool full() const { return true; }
        float worstDist() const { return found.limit(); }
        bool addPoint(float squared, uint32_t index) {
            found.add(squared, index);
            return true;
        }
    };

    Cloud cloud_;
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3, uint32_t> tree_;
};

}  // namespace treerec
