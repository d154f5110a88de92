#include "skeleton/branches/forks.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/segment.h"
#include "skeleton/branches/fork_points.h"

namespace treerec {

namespace {

constexpr double kThinnest = 0.008;    // metres: thinner wood is as wide as the scan is noisy
constexpr double kSettles = 3.0;       // radii beyond where it is separate: there a branch has its direction,
constexpr double kStretch = 6.0;       // told by so many radii more,
constexpr double kLeastStretch = 2.0;  // and no fewer
constexpr double kReach = 8.0;         // the parent's radii: so far down a fork may be
constexpr double kUp = 2.0;            // and up
constexpr double kWider = 0.17;        // radians that a branch may leave at a wider angle than it has later
constexpr double kMostTurn = 0.6;      // radians between the arc's chord and its end
constexpr double kBetter = 0.98;       // of the old misfit: less of a change is none
constexpr size_t kLeastPoints = 8;

double angle_between(const DVec3& a, const DVec3& b) {
    return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

using Line = std::vector<Station>;

double step(const Line& line, size_t i) {
    return glm::distance(line[i].position, line[i + 1].position);
}

DVec3 direction_at(const Line& line, int32_t i) {
    const int32_t last = static_cast<int32_t>(line.size()) - 1;
    return normalized_or(line[std::min(i + 1, last)].position - line[std::max(i - 1, 0)].position,
                         DVec3(0, 1, 0));
}

// A base of a branch: where it hangs on its parent, and the stations before the one that it leads to.
struct Base {
    int32_t attach = 0;
    std::vector<DVec3> places;
};

class ForkLayer {
  public:
    ForkLayer(const std::vector<SkeletonBranch>& branches, const std::vector<Line>& axes,
              const Slices& slices, const std::vector<Vec3>& points, size_t branch)
        : branch_(branches[branch]),
          parent_branch_(branches[static_cast<size_t>(branch_.parent)]),
          line_(axes[branch]),
          parent_(axes[static_cast<size_t>(branch_.parent)]),
          slices_(slices),
          points_(points) {}

    // Nothing where the base is good as it is, or no other is better.
    std::optional<Base> lay() {
        if (!find_stretch() || !is_elbow()) return std::nullopt;
        gather();
        if (near_.size() < kLeastPoints) return std::nullopt;
        Base old;
        old.attach = branch_.attach;
        for (size_t i = 0; i < to_; i++)
            old.places.push_back(line_[i].position);
        double least = kBetter * misfit(old);
        std::optional<Base> best;
        for (int32_t j = lowest_; j <= highest_; j++) {
            const std::optional<Base> base = base_from(j);
            if (!base) continue;
            const double own = misfit(*base);
            if (own >= least) continue;
            least = own;
            best = base;
        }
        return best;
    }

  private:
    // Where the branch is separate and has its direction: to_, tangent_. And the part of the parent that it
    // may come from.
    bool find_stretch() {
        const size_t count = line_.size();
        if (line_[0].bridged) return false;
        size_t separate = 0;
        int32_t beside = branch_.attach;
        for (; separate < count; separate++) {
            const BarkSide side = beside_parent(line_[separate].position, beside);
            if (side.distance >= side.radius + line_[separate].radius) break;
        }
        if (separate + 1 >= count) return false;
        to_ = separate;
        const double radius = line_[separate].radius;
        if (radius < kThinnest) return false;
        for (double way = 0.0; to_ + 1 < count && way < kSettles * radius; to_++)
            way += step(line_, to_);
        size_t end = to_;
        double stretch = 0.0;
        while (end + 1 < count && stretch < kStretch * radius && !line_[end + 1].bridged)
            stretch += step(line_, end++);
        if (stretch < kLeastStretch * radius) return false;
        for (size_t i = 0; i <= to_; i++)
            if (line_[i].bridged) return false;
        radius_ = radius;
        tangent_ = normalized_or(line_[end].position - line_[to_].position, DVec3(0, 1, 0));
        find_range();
        return true;
    }

    struct BarkSide {
        double distance = 0.0;
        double radius = 0.0;
    };

    // The nearest place of the parent's axis, looked for from station `at` on, which follows.
    BarkSide beside_parent(const DVec3& p, int32_t& at) const {
        const int32_t last = static_cast<int32_t>(parent_.size()) - 1;
        double least = glm::distance(parent_[at].position, p);
        for (bool nearer = true; nearer;) {
            nearer = false;
            for (const int32_t next : {at + 1, at - 1}) {
                if (next < 0 || next > last) continue;
                const double distance = glm::distance(parent_[next].position, p);
                if (distance >= least) continue;
                least = distance;
                at = next;
                nearer = true;
                break;
            }
        }
        BarkSide side{least, parent_[at].radius};
        for (int32_t i = std::max(0, at - 1); i < std::min(last, at + 1); i++)
            side.distance =
                std::min(side.distance, distance_to_segment(p, parent_[i].position, parent_[i + 1].position));
        return side;
    }

    void find_range() {
        const double radius = parent_[branch_.attach].radius;
        lowest_ = highest_ = branch_.attach;
        for (double way = 0.0; lowest_ > 0 && way < kReach * radius && !parent_[lowest_].bridged;)
            way += step(parent_, static_cast<size_t>(--lowest_));
        const int32_t last = static_cast<int32_t>(parent_.size()) - 1;
        for (double way = 0.0; highest_ < last && way < kUp * radius && !parent_[highest_ + 1].bridged;)
            way += step(parent_, static_cast<size_t>(highest_++));
    }

    // Whether the branch leaves at a wider angle than it has later, or bends tighter than it is thick.
    bool is_elbow() const {
        const DVec3 along = direction_at(parent_, branch_.attach);
        const DVec3& fork = parent_[branch_.attach].position;
        if (angle_between(normalized_or(line_[0].position - fork, tangent_), along) >
            angle_between(tangent_, along) + kWider)
            return true;
        DVec3 before = fork;
        for (size_t i = 0; i < to_; i++) {
            const DVec3 in = line_[i].position - before;
            const DVec3 out = line_[i + 1].position - line_[i].position;
            const double turn = angle_between(normalized_or(in, tangent_), normalized_or(out, tangent_));
            if (turn * radius_ > 0.5 * (glm::length(in) + glm::length(out))) return true;
            before = line_[i].position;
        }
        return false;
    }

    // The base from the parent's station j, on the arc that ends in the tangent.
    std::optional<Base> base_from(int32_t j) const {
        const DVec3& from = parent_[j].position;
        const DVec3& to = line_[to_].position;
        const double length = glm::distance(from, to);
        const DVec3 chord = normalized_or(to - from, tangent_);
        if (angle_between(chord, tangent_) > kMostTurn) return std::nullopt;
        const DVec3 start = 2.0 * glm::dot(chord, tangent_) * chord - tangent_;
        const DVec3 along = direction_at(parent_, j);
        if (angle_between(start, along) > angle_between(tangent_, along) + kWider) return std::nullopt;
        Base base;
        base.attach = j;
        for (size_t i = 0; i < to_; i++) {
            const double t = static_cast<double>(i + 1) / static_cast<double>(to_ + 1);
            base.places.push_back(hermite(from, length * start, to, length * tangent_, t));
        }
        return base;
    }

    // The points around the fork.
    void gather() {
        gather_points(branch_, slices_, 0, static_cast<int32_t>(to_), near_);
        gather_points(parent_branch_, slices_, lowest_, highest_, near_);
        thin_out(near_);
    }

    // Metres: how far the points keep from the bark of both, on average; beyond a radius, all are as far.
    double misfit(const Base& base) const {
        const int32_t first = std::max(0, lowest_ - 2);
        const int32_t last = std::min(static_cast<int32_t>(parent_.size()) - 1, highest_ + 2);
        double sum = 0.0;
        for (const uint32_t v : near_) {
            const DVec3 p(points_[v]);
            double off = radius_;
            for (int32_t i = first; i < last; i++)
                off = std::min(off, outside(p, parent_[i], parent_[i + 1]));
            Station before{parent_[base.attach].position, line_[0].radius};
            for (size_t i = 0; i <= to_; i++) {
                const Station here{i < to_ ? base.places[i] : line_[to_].position, line_[i].radius};
                off = std::min(off, outside(p, before, here));
                before = here;
            }
            if (to_ + 1 < line_.size()) off = std::min(off, outside(p, line_[to_], line_[to_ + 1]));
            sum += std::min(std::abs(off), radius_);
        }
        return sum / static_cast<double>(near_.size());
    }

    const SkeletonBranch& branch_;
    const SkeletonBranch& parent_branch_;
    const Line& line_;
    const Line& parent_;
    const Slices& slices_;
    const std::vector<Vec3>& points_;
    size_t to_ = 0;
    double radius_ = 0.0;
    DVec3 tangent_{0.0};
    int32_t lowest_ = 0;  // stations of the parent
    int32_t highest_ = 0;
    std::vector<uint32_t> near_;
};

}  // namespace

void lay_forks(std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes,
               const Slices& slices, const std::vector<Vec3>& points, const Progress& progress) {
    for (size_t l = 0; l < branches.size(); l++) {
        progress.check();
        if (branches[l].parent < 0 || branches[l].attach == 0) continue;
        const std::optional<Base> base = ForkLayer(branches, axes, slices, points, l).lay();
        if (!base) continue;
        branches[l].attach = base->attach;
        for (size_t i = 0; i < base->places.size(); i++)
            axes[l][i].position = base->places[i];
    }
}

}  // namespace treerec
