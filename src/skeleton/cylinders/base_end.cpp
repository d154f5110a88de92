#include "skeleton/cylinders/base_end.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/bounds.h"
#include "geometry/parallel.h"
#include "scan/cleaning/thin_cloud.h"
#include "skeleton/geodesics/paths.h"

namespace treerec {

namespace {

constexpr size_t kMostPoints = 20000;
constexpr size_t kMostTips = 200;
constexpr size_t kTrials = 16;         // ends that are taken for the root
constexpr double kLeastTip = 0.02;     // of the extent: the branches whose ends count,
constexpr double kLeastSide = 0.03;    // and the side branches whose way counts
constexpr double kBefore = 0.03;       // of the extent: the way of the wood that a side branch leaves
constexpr double kAhead = 0.05;        // of the extent: the side branch's own, and that of the base
constexpr double kBehind = 0.5;        // cosine: what lies behind an end
constexpr double kAround = 0.06;       // of the extent: how far from its end a trial may begin
constexpr double kBeside = 1.2;        // of a side branch's length: how much of its parent is looked at,
constexpr double kParts = 0.35;        // and how far from that its tip is
constexpr double kBark = 2.5;          // times the widest end's width: more than across it
constexpr double kMostBehind = 0.3;    // of the points around it
constexpr double kThickness = 0.06;    // what the thickest end is worth, as a cosine
constexpr double kUpright = 0.8;       // the least sine of a trunk's slope at its base,
constexpr double kStanding = 0.03;     // and what such a base is worth
constexpr size_t kFewForks = 6;        // tell nothing: the wider one of two far ends is taken,
constexpr double kEndShare = 0.04;     // of the extent: what is around it
constexpr double kStep = 0.01;         // of the extent: between two sections of the wood,
constexpr double kSpacings = 3.0;      // and no fewer spacings of the points
constexpr double kBand = 1.5;          // steps: what belongs to a section, to either side
constexpr size_t kSections = 8;        // from an end
constexpr size_t kMostSection = 4000;  // points

// What is at the far end of the branches of a path tree.
struct Branches {
    std::vector<uint32_t> tip;  // by vertex: the farthest of those whose paths lead through it

    Branches() = default;
    explicit Branches(const PathTree& paths) : tip(paths.parent.size()) {
        for (uint32_t v = 0; v < tip.size(); v++)
            tip[v] = v;
        for (size_t i = tip.size(); i-- > 0;) {
            const uint32_t v = paths.order[i];
            if (paths.parent[v] < 0) continue;
            uint32_t& of_parent = tip[static_cast<size_t>(paths.parent[v])];
            if (paths.along[tip[v]] > paths.along[of_parent]) of_parent = tip[v];
        }
    }

    // Whether another branch goes on at the parent of v.
    bool begins(const PathTree& paths, uint32_t v) const {
        return paths.parent[v] < 0 || tip[static_cast<size_t>(paths.parent[v])] != tip[v];
    }
};

// An end that is taken for the root.
struct Trial {
    PathTree paths;
    Branches branches;
    BaseEnd end;
    bool is_end = true;  // no wood lies farther out
    double width = 0.0;  // metres: the wood's radius at the end, as a root mean square
};

// What lies farther out than an end, beside whose point it is.
struct Behind {
    double share;       // of the points around the end
    uint32_t farthest;  // of them; the end's own where there are none
};

// How the side branches of a trial go on.
struct Turns {
    double mean;   // cosine
    size_t forks;  // that tell it
};

class BaseFinder {
  public:
    BaseFinder(const std::vector<Vec3>& points, Progress& progress)
        : points_(points),
          progress_(progress),
          graph_(neighbour_graph(points, progress)),
          scale_(local_scale(graph_, 0.0)) {
        Bounds bounds;
        for (const Vec3& p : points)
            bounds.add(DVec3(p));
        extent_ = bounds.diagonal();
        std::vector<float> spacing = scale_.spacing;
        const auto middle = spacing.begin() + static_cast<std::ptrdiff_t>(spacing.size() / 2);
        std::nth_element(spacing.begin(), middle, spacing.end());
        step_ = std::max(kStep * extent_, kSpacings * *middle);
    }

    BaseEnd find(PassSet left_out) const {
        std::vector<uint32_t> ends = far_ends();
        // A way of fewer than some points has no direction.
        if (step_ > kLeastSide * extent_ || left_out.has(Pass::kBaseByForks))
            return thicker_end(trial_at(ends.front()));
        const auto lower = [](const Vec3& a, const Vec3& b) { return a.y < b.y; };
        const auto lowest = std::min_element(points_.begin(), points_.end(), lower);
        ends.push_back(static_cast<uint32_t>(lowest - points_.begin()));
        std::vector<Trial> trials(ends.size());
        parallel_for(ends.size(), 1, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; i++)
                trials[i] = rooted_at(ends[i]);
        });
        double widest = 0.0;
        for (const Trial& trial : trials)
            widest = std::max(widest, trial.width);
        if (turns(trials.front(), kBark * widest).forks < kFewForks) return thicker_end(trials.front());
        const auto worth = [&](const Trial& trial) {
            const bool stands = &trial == &trials.back() && trial.end.direction.y > kUpright;
            const double wide = widest > 0.0 ? trial.width / widest : 0.0;
            return turns(trial, kBark * widest).mean - (trial.is_end ? 0.0 : 1.0) +
                   (kThickness + (stands ? kStanding : 0.0)) * wide;
        };
        const Trial* best = nullptr;
        double most = 0.0;
        for (const Trial& trial : trials) {
            const double own = worth(trial);
            if (best && own <= most) continue;
            best = &trial;
            most = own;
        }
        return best->end;
    }

  private:
    PathTree paths_from(uint32_t v) const { return shortest_paths(graph_, scale_, {{v, 0.0}}, progress_); }

    DVec3 place(uint32_t v) const { return DVec3(points_[v]); }

    // Ends of long branches, each as far away from those before as can be; the longest path's own first.
    std::vector<uint32_t> far_ends() const {
        const uint32_t first = Branches(paths_from(0)).tip[0];
        const PathTree paths = paths_from(first);
        const Branches branches(paths);
        std::vector<std::pair<double, uint32_t>> tips;
        for (const uint32_t v : paths.order) {
            if (!branches.begins(paths, v) || paths.parent[v] < 0) continue;
            const double length =
                paths.along[branches.tip[v]] - paths.along[static_cast<size_t>(paths.parent[v])];
            if (length >= kLeastTip * extent_) tips.emplace_back(-length, branches.tip[v]);
        }
        std::sort(tips.begin(), tips.end());
        tips.resize(std::min(tips.size(), kMostTips));
        tips.emplace_back(0.0, branches.tip[first]);
        std::vector<uint32_t> ends = {first};
        std::vector<double> away(tips.size(), std::numeric_limits<double>::max());
        while (ends.size() < kTrials) {
            for (size_t t = 0; t < tips.size(); t++)
                away[t] = std::min(away[t], glm::distance(place(tips[t].second), place(ends.back())));
            const auto farthest = std::max_element(away.begin(), away.end());
            if (*farthest <= 0.0) break;
            ends.push_back(tips[static_cast<size_t>(farthest - away.begin())].second);
        }
        return ends;
    }

    Trial rooted_at(uint32_t end) const {
        Trial trial = trial_at(end);
        if (Behind behind = behind_of(trial.paths, trial.end); behind.share > kMostBehind) {
            // A point of the bark beside the end.
            trial = trial_at(behind.farthest);
            behind = behind_of(trial.paths, trial.end);
            trial.is_end = behind.share <= kMostBehind;
        }
        trial.width = width_at(trial);
        return trial;
    }

    Trial trial_at(uint32_t end) const {
        PathTree paths = paths_from(end);
        Branches branches(paths);
        const uint32_t ahead = point_on(paths, branches.tip[end], kAhead * extent_);
        const BaseEnd base{place(end), normalized_or(place(ahead) - place(end), DVec3(0.0))};
        return {std::move(paths), std::move(branches), base, true};
    }

    // The last vertex on the way to a tip that is no farther along than that; metres.
    static uint32_t point_on(const PathTree& paths, uint32_t tip, double along) {
        while (paths.parent[tip] >= 0 && paths.along[tip] > along)
            tip = static_cast<uint32_t>(paths.parent[tip]);
        return tip;
    }

    Behind behind_of(const PathTree& paths, const BaseEnd& end) const {
        Behind result{0.0, paths.order.front()};
        double near = 0.0, behind = 0.0;
        for (const uint32_t v : paths.order) {
            if (paths.along[v] > kAround * extent_) continue;
            const DVec3 off = place(v) - end.position;
            const bool is_behind = glm::dot(off, end.direction) < -kBehind * glm::length(off);
            if (is_behind && paths.along[v] > paths.along[result.farthest]) result.farthest = v;
            if (paths.along[v] > kBefore * extent_) continue;
            near += 1.0;
            behind += is_behind;
        }
        result.share = behind / near;
        return result;
    }

    // Whether a side branch goes elsewhere than the branch that it leaves at the fork; otherwise both are
    // strips of one bark. main, side: their tips. length: of the side branch; bark: across; metres.
    bool parts(const PathTree& paths, uint32_t main, uint32_t fork, uint32_t side, double length,
               double bark) const {
        const double least = std::max(bark, kParts * length);
        uint32_t at = point_on(paths, main, paths.along[fork] + kBeside * length);
        while (at != fork) {
            if (glm::distance(place(at), place(side)) < least) return false;
            at = static_cast<uint32_t>(paths.parent[at]);
        }
        return true;
    }

    // Of a branch with hardly a fork: the end of the longest path around which the points spread wider.
    BaseEnd thicker_end(const Trial& first) const {
        const Trial second = trial_at(first.branches.tip[first.paths.order.front()]);
        return spread_around(first.end.position) >= spread_around(second.end.position) ? first.end
                                                                                       : second.end;
    }

    // Root mean square distance of the points around an end from their main axis, metres.
    double spread_around(const DVec3& end) const {
        std::vector<DVec3> around;
        DVec3 mean(0.0);
        for (const Vec3& p : points_)
            if (glm::distance(DVec3(p), end) < kEndShare * extent_) {
                around.emplace_back(p);
                mean += around.back();
            }
        const auto count = static_cast<double>(around.size());
        mean /= count;
        DMat3 covariance(0.0);
        for (const DVec3& p : around)
            covariance += glm::outerProduct(p - mean, p - mean);
        // Power iteration finds the axis; what is left of the trace is the cross-section.
        DVec3 axis = glm::normalize(DVec3(1.0, 0.9, 1.1));
        for (int i = 0; i < 50; i++)
            axis = normalized_or(covariance * axis, axis);
        const double trace = covariance[0][0] + covariance[1][1] + covariance[2][2];
        return std::sqrt(std::max(0.0, trace - glm::dot(axis, covariance * axis)) / count);
    }

    // bark: metres across; what reaches no farther out is no branch.
    Turns turns(const Trial& trial, double bark) const {
        const PathTree& paths = trial.paths;
        const Branches& branches = trial.branches;
        double sum = 0.0, weights = 0.0;
        size_t forks = 0;
        std::vector<double> mass(paths.order.size(), 1.0);
        for (size_t i = mass.size(); i-- > 0;)
            if (const int32_t parent = paths.parent[paths.order[i]]; parent >= 0)
                mass[static_cast<size_t>(parent)] += mass[paths.order[i]];
        for (const uint32_t v : paths.order) {
            if (paths.parent[v] < 0 || !branches.begins(paths, v)) continue;
            const auto fork = static_cast<uint32_t>(paths.parent[v]);
            const uint32_t tip = branches.tip[v];
            const double from = paths.along[fork], length = paths.along[tip] - from;
            if (length < kLeastSide * extent_) continue;
            if (!parts(paths, branches.tip[fork], fork, tip, length, bark)) continue;
            const double ahead = std::clamp(0.5 * length, kLeastSide * extent_, kAhead * extent_);
            // At the end itself there is no way before; what goes back from there tells against it.
            const bool at_end = from < kBefore * extent_;
            const DVec3 before = place(point_on(paths, fork, from - kBefore * extent_));
            const DVec3 way = at_end ? trial.end.direction : normalized_or(place(fork) - before, DVec3(0.0));
            const auto turn = [&](uint32_t of) {
                const DVec3 on = place(point_on(paths, of, from + ahead)) - place(fork);
                return glm::dot(way, normalized_or(on, DVec3(0.0)));
            };
            if (at_end && turn(tip) > -kBehind) continue;
            forks += at_end ? 0 : 1;
            const double weight = std::sqrt(length * mass[v]);
            sum += weight * (at_end ? turn(tip) : 0.5 * (turn(tip) + turn(branches.tip[fork])));
            weights += weight;
        }
        return {weights > 0.0 ? sum / weights : 0.0, forks};
    }

    // Metres: how far the points of the first sections on the way to the tip lie from their middles, across
    // the way; the lower quartile, for where twigs stand beside it a section is wider.
    double width_at(const Trial& trial) const {
        const PathTree& paths = trial.paths;
        const uint32_t tip = trial.branches.tip[paths.order.front()];
        std::vector<std::vector<uint32_t>> sections;
        std::vector<DVec3> middles;
        for (size_t s = 1; s <= kSections; s++) {
            const double along = static_cast<double>(s) * step_;
            if (along > paths.along[tip]) break;
            sections.push_back(section_at(paths, point_on(paths, tip, along)));
            DVec3 middle(0.0);
            for (const uint32_t p : sections.back())
                middle += place(p);
            middles.push_back(middle / static_cast<double>(sections.back().size()));
        }
        std::vector<double> widths;
        for (size_t s = 1; s + 1 < sections.size(); s++) {
            const DVec3 way = normalized_or(middles[s + 1] - middles[s - 1], DVec3(0.0));
            double squared = 0.0;
            for (const uint32_t p : sections[s]) {
                const DVec3 off = place(p) - middles[s];
                const double along = glm::dot(off, way);
                squared += glm::dot(off, off) - along * along;
            }
            widths.push_back(std::sqrt(std::max(0.0, squared) / static_cast<double>(sections[s].size())));
        }
        if (widths.empty()) return 0.0;
        std::sort(widths.begin(), widths.end());
        return widths[widths.size() / 4];
    }

    // The points that are about as far along as v and hang together with it there.
    std::vector<uint32_t> section_at(const PathTree& paths, uint32_t v) const {
        std::vector<uint32_t> section = {v};
        std::vector<uint8_t> seen(points_.size(), 0);
        seen[v] = 1;
        for (size_t i = 0; i < section.size() && section.size() < kMostSection; i++)
            for (uint32_t e = graph_.begin[section[i]]; e < graph_.begin[section[i] + 1]; e++) {
                const uint32_t n = graph_.neighbour[e];
                if (seen[n] || graph_.length[e] > edge_reach(scale_, section[i], n)) continue;
                if (std::abs(paths.along[n] - paths.along[v]) > kBand * step_) continue;
                seen[n] = 1;
                section.push_back(n);
            }
        return section;
    }

    const std::vector<Vec3>& points_;
    Progress& progress_;
    PointGraph graph_;
    LocalScale scale_;
    double extent_, step_;  // metres; a step lies between two sections
};

}  // namespace

BaseEnd find_base_end(const std::vector<Vec3>& points, Progress& progress, PassSet left_out) {
    PointCloud few;
    few.positions = points;
    thin_cloud(few, kMostPoints, &progress);
    return BaseFinder(few.positions, progress).find(left_out);
}

}  // namespace treerec
