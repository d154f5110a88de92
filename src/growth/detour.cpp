#include "growth/detour.h"

#include <algorithm>
#include <cmath>

#include "geometry/portable_math.h"

namespace treerec::growth {

namespace {

constexpr double kRoom = 0.5;       // shortest edges beside young wood that must be free
constexpr double kMostAside = 0.8;  // of the wood's radius: the pith stays within the wood
constexpr double kTogether = 2.0;   // radii between obstacles that are passed at once
constexpr double kEase = 2.5;       // of the way aside: over how much of the axis it is begun and ended
constexpr int kWays = 16;           // that are tried about the axis,
constexpr int kTries = 16;          // and how far on each
constexpr double kThin = 1e-3;      // metres: how wide the strips are that obstacles are asked with

// A branch's pith, which may be moved aside between two places of its axis.
class Way {
  public:
    Way(GrowthBranch& branch, const Obstacles& obstacles, double clear)
        : axis_(branch.axis), obstacles_(obstacles), clear_(clear) {}

    bool blocked(size_t i) const { return strikes(axis_[i].pith, axis_[i + 1].pith); }

    // From place first to last, both included. False: nothing is free.
    bool move_aside(size_t first, size_t last) {
        const double begin = axis_[first].along, end = axis_[last].along;
        double radius = axis_[first].radius;
        for (size_t i = first; i <= last; i++)
            radius = std::min(radius, axis_[i].radius);
        const DVec3 direction = axis_[(first + last) / 2].direction;
        const DVec3 x = any_perpendicular(direction), y = glm::cross(direction, x);
        for (int far = 1; far <= kTries; far++) {
            const double aside = kMostAside * radius * far / kTries;
            for (int way = 0; way < kWays; way++) {
                const SineCosine turn = portable_sine_cosine(2.0 * kPi * way / kWays);
                if (try_way(begin, end, aside * (turn.cosine * x + turn.sine * y), kEase * aside))
                    return true;
            }
        }
        return false;
    }

  private:
    bool strikes(const DVec3& a, const DVec3& b) const {
        const DVec3 side = any_perpendicular(normalized_or(b - a, DVec3(0.0, 1.0, 0.0)));
        const DVec3 strip[3] = {a, b, a + kThin * side};
        return obstacles_.meets(strip, clear_) >= 0;
    }

    bool try_way(double begin, double end, const DVec3& aside, double over) {
        moved_.clear();
        size_t from = axis_.size();
        for (size_t i = 0; i < axis_.size(); i++) {
            const double along = axis_[i].along;
            if (along < begin - over || along > end + over) continue;
            from = std::min(from, i);
            const double share = std::min(glm::smoothstep(begin - over, begin, along),
                                          1.0 - glm::smoothstep(end, end + over, along));
            moved_.push_back(axis_[i].pith + share * aside);
        }
        for (size_t i = 0; i + 1 < moved_.size(); i++)
            if (strikes(moved_[i], moved_[i + 1])) return false;
        for (size_t i = 0; i < moved_.size(); i++)
            axis_[from + i].pith = moved_[i];
        return true;
    }

    std::vector<AxisPlace>& axis_;
    const Obstacles& obstacles_;
    const double clear_;
    std::vector<DVec3> moved_;
};

}  // namespace

void go_around(GrowthPlan& plan, const Obstacles& obstacles, double shortest) {
    if (obstacles.empty()) return;
    for (GrowthBranch& branch : plan.branches) {
        Way way(branch, obstacles, plan.young + kRoom * shortest);
        const size_t count = branch.axis.size();
        for (size_t first = 0; first + 1 < count; first++) {
            if (!way.blocked(first)) continue;
            size_t last = first + 1;
            for (size_t i = last; i + 1 < count; i++) {
                if (branch.axis[i].along - branch.axis[last].along > kTogether * branch.axis[last].radius)
                    break;
                if (way.blocked(i)) last = i + 1;
            }
            way.move_aside(first, last);
            first = last;
        }
    }
}

}  // namespace treerec::growth
