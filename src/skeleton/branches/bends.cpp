#include "skeleton/branches/bends.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/parallel.h"
#include "geometry/segment.h"
#include "skeleton/branches/fork_points.h"

namespace treerec {

namespace {

constexpr double kThinnest = 0.008;      // metres: thinner wood bends as it likes
constexpr double kApart = 3.0;           // radii: tight bends so near to each other are one
constexpr double kTangent = 2.5;         // radii that tell the direction at an end of the curve
constexpr double kWorse = 1.05;          // of the misfit that was: so much a curve may have
constexpr double kTightest = 1.0;        // radii: of the curve of an axis
constexpr double kSharpest = 0.5;        // cosine of the sharpest turn of thin wood: 60 degrees
constexpr double kMostMove = 1.0;        // radii in all, where no point is asked,
constexpr double kMostMoveThin = 0.012;  // metres: of thin wood
constexpr int kRounds = 24;
constexpr size_t kSideStations = 6;  // of a branch that leaves the bend

using Line = std::vector<Station>;

// Whether the axis bends at `here` tighter than wood of this radius can.
bool is_tight(const DVec3& before, const DVec3& here, const DVec3& after, double radius) {
    const DVec3 in = here - before;
    const DVec3 out = after - here;
    const double a = glm::length(in), b = glm::length(out);
    if (a <= 0.0 || b <= 0.0) return false;
    const double cosine = std::clamp(glm::dot(in, out) / (a * b), -1.0, 1.0);
    return std::acos(cosine) * kTightest * radius > 0.5 * (a + b);
}

class BendLayer {
  public:
    BendLayer(const std::vector<SkeletonBranch>& branches, const std::vector<Line>& axes,
              const Slices& slices, const std::vector<Vec3>& points, const std::vector<size_t>& sides,
              size_t branch)
        : branches_(branches),
          axes_(axes),
          slices_(slices),
          points_(points),
          all_sides_(sides),
          index_(branch),
          line_(axes[branch]) {}

    // The axis without the bends that can be laid anew.
    Line run() {
        arc_.assign(line_.size(), 0.0);
        for (size_t i = 1; i < line_.size(); i++)
            arc_[i] = arc_[i - 1] + glm::distance(line_[i].position, line_[i - 1].position);
        for (size_t i = 1; i + 1 < line_.size(); i++) {
            if (!tight(i)) continue;
            size_t last = i;
            for (size_t k = i + 1; k + 1 < line_.size() && arc_[k] - arc_[last] < kApart * line_[k].radius;
                 k++)
                if (tight(k)) last = k;
            lay(i, last);
            i = last;
        }
        return std::move(line_);
    }

  private:
    bool tight(size_t i) const {
        return line_[i].radius >= kThinnest &&
               is_tight(line_[i - 1].position, line_[i].position, line_[i + 1].position, line_[i].radius);
    }

    // The curve over the stations strictly between `a` and `b`, that goes on as the axis does outside.
    std::vector<DVec3> curve(size_t a, size_t b) const {
        const double reach = kTangent * line_[a].radius;
        size_t before = a, after = b;
        while (before > 0 && arc_[a] - arc_[before] < reach)
            before--;
        while (after + 1 < line_.size() && arc_[after] - arc_[b] < reach)
            after++;
        const DVec3& from = line_[a].position;
        const DVec3& to = line_[b].position;
        const double length = glm::distance(from, to);
        const DVec3 chord = normalized_or(to - from, DVec3(0, 1, 0));
        const DVec3 start = before < a ? normalized_or(from - line_[before].position, chord) : chord;
        const DVec3 end = after > b ? normalized_or(line_[after].position - to, chord) : chord;
        std::vector<DVec3> places;
        for (size_t i = a + 1; i < b; i++) {
            const double t = (arc_[i] - arc_[a]) / (arc_[b] - arc_[a]);
            places.push_back(hermite(from, length * start, to, length * end, t));
        }
        return places;
    }

    void lay(size_t first, size_t last) {
        const double radius = line_[first].radius;
        size_t lowest = first, highest = last;
        const auto widen = [&](double by) {
            while (lowest > 0 && arc_[first] - arc_[lowest] < by && !line_[lowest].bridged)
                lowest--;
            while (highest + 1 < line_.size() && arc_[highest] - arc_[last] < by &&
                   !line_[highest + 1].bridged)
                highest++;
        };
        std::optional<Line> best;
        double least = 0.0;
        std::vector<std::pair<size_t, size_t>> spans;
        for (const double by : {1.5, 3.0, 5.0}) {
            widen(by * radius);
            if (highest - lowest >= 2) spans.emplace_back(lowest, highest);
        }
        if (spans.empty()) return;
        near_.clear();
        gather_points(branches_[index_], slices_, static_cast<int32_t>(lowest), static_cast<int32_t>(highest),
                      near_);
        thin_out(near_);
        if (near_.empty()) return;
        find_sides(lowest, highest);
        least = kWorse * misfit(line_, lowest, highest);
        for (const auto& [a, b] : spans) {
            Line trial = line_;
            const std::vector<DVec3> places = curve(a, b);
            for (size_t i = 0; i < places.size(); i++)
                trial[a + 1 + i].position = places[i];
            bool bends = false;
            for (size_t i = std::max<size_t>(a, 1); i <= b && i + 1 < trial.size(); i++)
                bends = bends || is_tight(trial[i - 1].position, trial[i].position, trial[i + 1].position,
                                          trial[i].radius);
            if (bends) continue;
            const double own = misfit(trial, lowest, highest);
            if (own > least) continue;
            least = own;
            best = std::move(trial);
        }
        if (best) line_ = std::move(*best);
    }

    // The branches that leave the stations.
    void find_sides(size_t first, size_t last) {
        sides_.clear();
        for (const size_t s : all_sides_) {
            const auto at = static_cast<size_t>(branches_[s].attach);
            if (at + 1 >= first && at <= last + 1) sides_.push_back(s);
        }
    }

    // Metres: how far the points keep from the bark of the axis and of what leaves it there.
    double misfit(const Line& line, size_t first, size_t last) const {
        const double most = line[first].radius;
        double sum = 0.0;
        for (const uint32_t v : near_) {
            const DVec3 p(points_[v]);
            double off = most;
            for (size_t i = first; i < last; i++)
                off = std::min(off, outside(p, line[i], line[i + 1]));
            for (const size_t s : sides_) {
                const Line& own = axes_[s];
                const Station fork{line[static_cast<size_t>(branches_[s].attach)].position, own[0].radius};
                off = std::min(off, outside(p, fork, own[0]));
                for (size_t i = 0; i + 1 < own.size() && i < kSideStations; i++)
                    off = std::min(off, outside(p, own[i], own[i + 1]));
            }
            sum += std::min(std::abs(off), most);
        }
        return sum / static_cast<double>(near_.size());
    }

    const std::vector<SkeletonBranch>& branches_;
    const std::vector<Line>& axes_;
    const Slices& slices_;
    const std::vector<Vec3>& points_;
    const std::vector<size_t>& all_sides_;
    size_t index_;
    Line line_;
    std::vector<double> arc_;
    std::vector<uint32_t> near_;
    std::vector<size_t> sides_;
};

// Evens out one axis. base: where the branch leaves its parent; null for the first.
class Smoother {
  public:
    Smoother(Line& line, const DVec3* base) : line_(line), base_(base) {
        for (const Station& station : line)
            seen_.push_back(station.position);
    }

    void run() {
        int round = 0;
        while (round < kRounds && even_out())
            round++;
    }

  private:
    DVec3 before(size_t i) const {
        return i > 0 ? line_[i - 1].position : base_ ? *base_ : line_[0].position;
    }

    bool is_thin(size_t i) const { return line_[i].radius < kThinnest; }

    bool is_bent(size_t i) const {
        const DVec3& after = line_[i + 1].position;
        const DVec3 in = normalized_or(line_[i].position - before(i), DVec3(0.0));
        const DVec3 out = normalized_or(after - line_[i].position, DVec3(0.0));
        return glm::dot(in, out) < kSharpest ||
               (!is_thin(i) && is_tight(before(i), line_[i].position, after, line_[i].radius));
    }

    // Ends of gaps stay where they were seen.
    bool may_move(size_t i) const { return (i > 0 || base_) && !line_[i].bridged && !line_[i + 1].bridged; }

    // One round. Whether anything was bent too far.
    bool even_out() {
        std::vector<uint8_t> moves(line_.size(), 0);
        bool any = false;
        for (size_t i = base_ ? 0 : 1; i + 1 < line_.size(); i++) {
            if (!is_bent(i)) continue;
            any = true;
            for (size_t k = i > 0 ? i - 1 : 0; k <= std::min(i + 1, line_.size() - 2); k++)
                moves[k] = 1;
        }
        if (!any) return false;
        std::vector<DVec3> next = seen_;
        for (size_t i = 0; i < line_.size(); i++) {
            next[i] = line_[i].position;
            if (moves[i] == 0 || !may_move(i)) continue;
            const DVec3 middle = 0.5 * (before(i) + line_[i + 1].position);
            DVec3 move = 0.5 * (line_[i].position + middle) - seen_[i];
            const double most = is_thin(i) ? kMostMoveThin : kMostMove * line_[i].radius;
            if (glm::length(move) > most) move *= most / glm::length(move);
            next[i] = seen_[i] + move;
        }
        for (size_t i = 0; i < line_.size(); i++)
            line_[i].position = next[i];
        return true;
    }

    Line& line_;
    const DVec3* base_;
    std::vector<DVec3> seen_;
};

// From where on its parent a branch should leave it so as not to turn back: at less than a right angle, or by
// no more than an axis may turn where it grows from the parent's end and goes on from there. Where it does
// leave if there is no such station. first: the branch's first place.
int32_t leaves_forwards(const Line& parent, int32_t attach, const DVec3& first) {
    const double least = attach + 1 < static_cast<int32_t>(parent.size()) ? 0.0 : kSharpest;
    for (int32_t j = attach; j > 0 && !parent[static_cast<size_t>(j)].bridged; j--) {
        const DVec3& fork = parent[static_cast<size_t>(j)].position;
        const DVec3 in = normalized_or(fork - parent[static_cast<size_t>(j) - 1].position, DVec3(0.0));
        if (glm::dot(in, normalized_or(first - fork, DVec3(0.0))) >= least) return j;
    }
    return attach;
}

}  // namespace

void lay_bends(const std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes,
               const Slices& slices, const std::vector<Vec3>& points, const Progress& progress) {
    std::vector<std::vector<size_t>> sides(branches.size());
    for (size_t l = 0; l < branches.size(); l++)
        if (branches[l].parent >= 0) sides[static_cast<size_t>(branches[l].parent)].push_back(l);
    for (size_t l = 0; l < branches.size(); l++) {
        progress.check();
        axes[l] = BendLayer(branches, axes, slices, points, sides[l], l).run();
    }
}

void smooth_bends(std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes) {
    // Parents first: where a branch begins, they have moved.
    for (size_t l = 0; l < axes.size(); l++) {
        Line& line = axes[l];
        SkeletonBranch& branch = branches[l];
        if (branch.parent >= 0)
            branch.attach = leaves_forwards(axes[static_cast<size_t>(branch.parent)], branch.attach,
                                            line.front().position);
        if (line.size() < 2) continue;
        const DVec3* base =
            branch.parent >= 0
                ? &axes[static_cast<size_t>(branch.parent)][static_cast<size_t>(branch.attach)].position
                : nullptr;
        Smoother(line, base).run();
    }
}

}  // namespace treerec
