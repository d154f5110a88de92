#include "skeleton/twigs/twig_growth.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "geometry/parallel.h"
#include "skeleton/cylinders/bark.h"
#include "skeleton/geodesics/heap.h"

namespace treerec {

namespace {

constexpr double kGapFactor = 3.0;  // reaches: no twig crosses a wider gap
constexpr int kSmoothings = 3;
constexpr double kMostMove = 0.003;  // metres: about a twig's radius, so that its points stay on its bark
constexpr double kSharpest = 0.0;    // cosine of the sharpest turn of a twig
constexpr double kFootEscape = 4.0;  // radii of the stem: what reaches less far out around its foot is a root
constexpr size_t kLeastPoints = 3;   // of a twig on measured wood: where that is seen, so are its twigs
constexpr size_t kShootPoints = 4;   // of a short shoot; fewer may be strays
constexpr double kShortest = 0.8;    // of the shortest branch, where that many points show a shoot
// Of it, that a shoot has from the parent's axis on: simplification takes some.
constexpr double kShootLength = 1.07;
constexpr float kStrayFactor = 5.0f;  // reaches of the wood on the near side: nor this one,
constexpr float kStrayWood = 0.2f;    // of the gap: with less wood beyond it
constexpr double kBareFoot = 0.5;     // metres up a stem that has no shoots there,
constexpr double kStoutStem = 0.05;   // where its radius is more than this:
constexpr double kSprout = 0.5;       // grass, unless it is so long that a scan shows a basal sprout clearly
constexpr size_t kPointsPerTask = 512;
constexpr float kGather = 0.5f;  // point spacings: points so near to a path are one with it

class TwigGrower {
  public:
    explicit TwigGrower(TwigField& field) : field_(field), given_(static_cast<int32_t>(field.axes.size())) {}

    GrownTwigs run(std::vector<uint64_t> tips, Progress& progress) {
        LeastFirst queue(std::move(tips));
        size_t looked = 0;
        while (!queue.empty()) {
            if (++looked % 1024 == 0) progress.check();
            const uint64_t top = queue.pop();
            const uint32_t v = static_cast<uint32_t>(~top);
            if (field_.branch[v] >= 0) continue;
            const float now = path_to(v);
            if (farthest_first(now, v) > top) {
                queue.push(farthest_first(now, v));
                continue;
            }
            if (!path_.empty()) add_twig(top);
        }
        return std::move(grown_);
    }

  private:
    bool does(Pass pass) const { return !field_.options.left_out.has(pass); }

    // Of a branch that was given, or of a twig.
    const std::vector<Station>& axis(int32_t branch) const {
        return branch < given_ ? field_.axes[branch] : grown_.axes[branch - given_];
    }

    // Fills path_, from the base to v; its first vertex hangs on foot_. Empty where it would cross a gap, or
    // nothing of it can escape the bark.
    float path_to(uint32_t v) {
        path_.clear();
        float length = 0.0f;
        bool gap = false;
        bool may = false;
        while (field_.branch[v] < 0) {
            const uint32_t next = static_cast<uint32_t>(field_.paths.parent[v]);
            const float step = field_.paths.step[v];
            gap = gap || step > kGapFactor * edge_reach(field_.scale, v, next) ||
                  (length < kStrayWood * step && step > kStrayFactor * field_.scale.reach[next]);
            path_.push_back(v);
            may = may || field_.may_escape(v);
            length += step;
            v = next;
        }
        foot_ = v;
        std::reverse(path_.begin(), path_.end());
        if (gap || !may) path_.clear();
        return length;
    }

    bool on_bare_foot(int32_t station) const {
        const Station& at = axis(0)[station];
        return at.radius > kStoutStem && glm::distance(at.position, axis(0)[0].position) < kBareFoot;
    }

    // tip: its entry in the queue.
    void add_twig(uint64_t tip) {
        const int32_t parent = field_.branch[foot_];
        int32_t station = field_.station[foot_];
        bool escapes = false;
        const bool at_foot = does(Pass::kFootRoots) && parent == 0 && station < field_.foot_end;
        for (size_t i = 0; i < path_.size() && !escapes; i++) {
            const uint32_t v = path_[i];
            const BarkPlace place = place_near(axis(parent), station, DVec3(field_.points[v]));
            station = place.station;
            const double outside = std::min<double>(field_.outside[v], place.distance - place.radius);
            const double thickest = std::max<double>(field_.surface[v], place.radius);
            const double required = std::max(required_escape(field_.options.least_escape, thickest),
                                             at_foot ? kFootEscape * field_.axes[0][0].radius : 0.0);
            escapes = outside >= required;
        }
        if (!escapes) return;

        gather();
        SkeletonBranch twig;
        twig.parent = parent;
        twig.attach = field_.station[foot_];
        std::vector<Station> line = smooth_line(axis(parent)[twig.attach].position);
        if (does(Pass::kTwigForks)) twig.attach = fork_station(axis(parent), twig.attach, line);
        if (does(Pass::kSharpTurns)) straighten(line, axis(parent)[twig.attach].position);
        double outer = 0.0;
        for (size_t i = 1; i < line.size(); i++)
            outer += glm::distance(line[i].position, line[i - 1].position);
        for (const uint32_t v : near_)
            field_.nearest[v] = -1;
        twig.attach = long_enough(axis(parent), twig.attach, line.front().position, outer);
        if (twig.attach < 0) return;
        if (does(Pass::kFootRoots) && parent == 0 && outer < kSprout && on_bare_foot(twig.attach)) return;
        if (does(Pass::kFewPoints) && axis(parent)[twig.attach].measured && near_.size() < kLeastPoints)
            return;

        const int32_t index = given_ + static_cast<int32_t>(grown_.branches.size());
        grown_.branches.push_back(std::move(twig));
        grown_.axes.push_back(std::move(line));
        grown_.tips.push_back(tip);
        const std::vector<Station>& own = grown_.axes.back();
        // Fewer stations than points may be left.
        const size_t last = own.size() - 1;
        size_t at = 0;
        for (const uint32_t v : path_) {
            const DVec3 p(field_.points[v]);
            while (at < last && glm::distance(p, own[at + 1].position) <= glm::distance(p, own[at].position))
                at++;
            // What straightening has left aside may bear a twig of its own.
            const BarkPlace place = place_near(own, static_cast<int32_t>(at), p);
            if (v != path_.back() && place.distance > place.radius + kMostMove + field_.tolerance(v))
                continue;
            field_.branch[v] = index;
            field_.station[v] = place.station;
        }
        for (const uint32_t v : path_)
            if (field_.branch[v] == index) mark_around(v, index, field_.station[v], 2);
    }

    // A twig leaves at an angle: so far back along its parent as it starts outside of the parent's bark, if
    // that makes its start straighter.
    static int32_t fork_station(const std::vector<Station>& parent, int32_t near,
                                const std::vector<Station>& twig) {
        const DVec3& first = twig.front().position;
        const BarkPlace place = place_near(parent, near, first);
        const DVec3 ahead = twig.size() > 1 ? twig[1].position - first : DVec3(0.0);
        int32_t best = place.station;
        double straightest = -2.0;
        double back = 0.0;
        for (int32_t i = place.station; i >= 0 && back <= std::max(0.0, place.outside()); i--) {
            const DVec3 way = normalized_or(first - parent[i].position, DVec3(0.0));
            const DVec3 on = i + 1 < static_cast<int32_t>(parent.size())
                                 ? parent[i + 1].position - parent[i].position
                                 : DVec3(0.0);
            const double straight = glm::dot(way, normalized_or(ahead, DVec3(0.0))) +
                                    glm::dot(way, normalized_or(on, DVec3(0.0)));
            if (straight > straightest + 1e-6) {
                straightest = straight;
                best = i;
            }
            if (i > 0) back += glm::distance(parent[i].position, parent[i - 1].position);
        }
        return best;
    }

    // Where on the parent a twig leaves that is `outer` metres long from its first station on; -1 for none,
    // if it is too short. A short shoot that several points show is wood all the same, and nobody sees how it
    // runs under the bark: it leaves the axis as much further back as makes it a branch.
    int32_t long_enough(const std::vector<Station>& parent, int32_t attach, const DVec3& first,
                        double outer) const {
        const double shortest = field_.options.minimum_branch;
        const auto length = [&](int32_t from) { return glm::distance(parent[from].position, first) + outer; };
        const double found = length(attach);
        if (found >= 1.01 * shortest) return attach;
        if (!does(Pass::kShortShoots) || near_.size() < kShootPoints || found < kShortest * shortest)
            return -1;
        double back = 0.0;
        while (length(attach) < kShootLength * shortest) {
            // Further back than it is long, it would lie along its parent.
            if (attach == 0 || parent[attach].bridged || back >= found) return -1;
            back += glm::distance(parent[attach].position, parent[attach - 1].position);
            attach--;
        }
        return attach;
    }

    // Takes out the stations where the twig would turn sharply.
    static void straighten(std::vector<Station>& line, const DVec3& base) {
        for (size_t i = 0; i + 1 < line.size();) {
            const DVec3& before = i > 0 ? line[i - 1].position : base;
            const DVec3 to = normalized_or(line[i].position - before, DVec3(0.0));
            const DVec3 from = normalized_or(line[i + 1].position - line[i].position, DVec3(0.0));
            if (glm::dot(to, from) >= kSharpest) {
                i++;
                continue;
            }
            line.erase(line.begin() + static_cast<ptrdiff_t>(i));
            if (i > 0) i--;
        }
    }

    void mark_around(uint32_t v, int32_t index, int32_t at, int hops) {
        for (uint32_t e = field_.graph.begin[v]; e < field_.graph.begin[v + 1]; e++) {
            const uint32_t n = field_.graph.neighbour[e];
            if (field_.branch[n] >= 0) continue;
            const BarkPlace place = place_near(axis(index), at, DVec3(field_.points[n]));
            if (place.distance > place.radius + field_.tolerance(n)) continue;
            field_.branch[n] = index;
            field_.station[n] = place.station;
            if (hops > 1) mark_around(n, index, place.station, hops - 1);
        }
    }

    // The free points around the path, each with the vertex of the path that it is nearest to.
    void gather() {
        near_.clear();
        for (size_t i = 0; i < path_.size(); i++) {
            near_.push_back(path_[i]);
            field_.nearest[path_[i]] = static_cast<int32_t>(i);
        }
        for (size_t i = 0; i < path_.size(); i++) {
            const uint32_t v = path_[i];
            for (uint32_t e = field_.graph.begin[v]; e < field_.graph.begin[v + 1]; e++) {
                const uint32_t n = field_.graph.neighbour[e];
                if (field_.branch[n] >= 0 || field_.graph.length[e] > kGather * field_.scale.spacing[v])
                    continue;
                if (field_.nearest[n] < 0) {
                    near_.push_back(n);
                    field_.nearest[n] = static_cast<int32_t>(i);
                } else if (path_[field_.nearest[n]] != n &&
                           glm::distance(field_.points[n], field_.points[path_[field_.nearest[n]]]) >
                               field_.graph.length[e]) {
                    field_.nearest[n] = static_cast<int32_t>(i);
                }
            }
        }
    }

    std::vector<Station> smooth_line(const DVec3& base) {
        std::vector<Station> line(path_.size());
        std::vector<double>& weight = weight_;
        weight.assign(path_.size(), 0.0);
        for (const uint32_t v : near_) {
            line[field_.nearest[v]].position += DVec3(field_.points[v]);
            weight[field_.nearest[v]] += 1.0;
        }
        for (size_t i = 0; i < line.size(); i++)
            line[i].position /= weight[i];
        std::vector<DVec3>& seen = seen_;
        seen.clear();
        for (const Station& station : line)
            seen.push_back(station.position);
        for (int round = 0; round < kSmoothings; round++) {
            DVec3 before = base;
            for (size_t i = 0; i + 1 < line.size(); i++) {
                const DVec3 here = line[i].position;
                DVec3 move = 0.25 * before + 0.5 * here + 0.25 * line[i + 1].position - seen[i];
                const double most = kMostMove;
                if (glm::length(move) > most) move *= most / glm::length(move);
                line[i].position = seen[i] + move;
                before = here;
            }
        }
        // The points' distances, by station.
        std::vector<size_t>& begin = begin_;
        begin.assign(line.size() + 1, 0);
        for (const uint32_t v : near_)
            begin[static_cast<size_t>(field_.nearest[v]) + 1]++;
        for (size_t i = 0; i < line.size(); i++)
            begin[i + 1] += begin[i];
        std::vector<double>& distances = distances_;
        distances.resize(near_.size());
        std::vector<size_t>& fill = fill_;
        fill.assign(begin.begin(), begin.end() - 1);
        for (const uint32_t v : near_)
            distances[fill[static_cast<size_t>(field_.nearest[v])]++] =
                place_near(line, field_.nearest[v], DVec3(field_.points[v])).distance;
        // place_near looks at positions alone, so the radii can be set behind it.
        for (size_t i = 0; i < line.size(); i++) {
            const size_t count = begin[i + 1] - begin[i];
            if (count < 2) continue;
            const auto first = distances.begin() + static_cast<ptrdiff_t>(begin[i]);
            const auto middle = first + static_cast<ptrdiff_t>(count / 2);
            std::nth_element(first, middle, first + static_cast<ptrdiff_t>(count));
            line[i].radius = *middle;
        }
        return line;
    }

    TwigField& field_;
    const int32_t given_;  // branches; the twigs are numbered on from there
    GrownTwigs grown_;
    std::vector<uint32_t> near_;
    std::vector<uint32_t> path_;
    std::vector<double> weight_, distances_;  // scratch of smooth_line()
    std::vector<DVec3> seen_;
    std::vector<size_t> begin_, fill_;
    uint32_t foot_ = 0;
};

// By point the task that grows the twigs there, -1 where it is not free. Thickets, which no edges between
// free points link, are not divided; the largest come first.
std::vector<int32_t> divide(const TwigField& field, size_t& tasks) {
    const PointGraph& graph = field.graph;
    constexpr int32_t kTaken = -1;
    constexpr int32_t kOpen = -2;
    std::vector<int32_t> thicket(graph.size());
    for (size_t v = 0; v < graph.size(); v++)
        thicket[v] = field.branch[v] >= 0 ? kTaken : kOpen;
    std::vector<std::pair<size_t, int32_t>> sizes;
    std::vector<uint32_t> open;
    for (uint32_t seed = 0; seed < graph.size(); seed++) {
        if (thicket[seed] != kOpen) continue;
        const int32_t own = static_cast<int32_t>(sizes.size());
        size_t size = 0;
        thicket[seed] = own;
        for (open.push_back(seed); !open.empty(); size++) {
            const uint32_t v = open.back();
            open.pop_back();
            for (uint32_t e = graph.begin[v]; e < graph.begin[v + 1]; e++) {
                const uint32_t n = graph.neighbour[e];
                if (thicket[n] != kOpen) continue;
                thicket[n] = own;
                open.push_back(n);
            }
        }
        sizes.emplace_back(size, own);
    }
    std::stable_sort(sizes.begin(), sizes.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<int32_t> task_of(sizes.size());
    size_t filled = kPointsPerTask;  // points in the last task
    tasks = 0;
    for (const auto& [size, index] : sizes) {
        if (filled >= kPointsPerTask) {
            tasks++;
            filled = 0;
        }
        filled += size;
        task_of[index] = static_cast<int32_t>(tasks) - 1;
    }
    for (int32_t& of_point : thicket)
        if (of_point >= 0) of_point = task_of[of_point];
    return thicket;
}

// Puts the twigs of all tasks in the order in which they would have grown one after another, and gives them
// the numbers of that order.
GrownTwigs put_in_order(std::vector<GrownTwigs>& grown, const std::vector<int32_t>& task, TwigField& field) {
    struct Twig {
        uint64_t tip;
        uint32_t task;
        uint32_t at;
    };
    std::vector<Twig> order;
    std::vector<std::vector<int32_t>> number(grown.size());
    for (uint32_t t = 0; t < grown.size(); t++) {
        number[t].resize(grown[t].tips.size());
        for (uint32_t i = 0; i < grown[t].tips.size(); i++)
            order.push_back({grown[t].tips[i], t, i});
    }
    std::sort(order.begin(), order.end(), [](const Twig& a, const Twig& b) { return a.tip < b.tip; });
    const int32_t given = static_cast<int32_t>(field.axes.size());
    GrownTwigs all;
    all.branches.reserve(order.size());
    all.axes.reserve(order.size());
    all.tips.reserve(order.size());
    for (const Twig& twig : order) {
        number[twig.task][twig.at] = given + static_cast<int32_t>(all.branches.size());
        SkeletonBranch& branch = all.branches.emplace_back(std::move(grown[twig.task].branches[twig.at]));
        // Twigs grow on earlier ones of their own thicket.
        if (branch.parent >= given) branch.parent = number[twig.task][branch.parent - given];
        all.axes.push_back(std::move(grown[twig.task].axes[twig.at]));
        all.tips.push_back(twig.tip);
    }
    for (size_t v = 0; v < task.size(); v++)
        if (field.branch[v] >= given) field.branch[v] = number[task[v]][field.branch[v] - given];
    return all;
}

}  // namespace

GrownTwigs grow_one_by_one(TwigField& field, std::vector<uint64_t> tips, Progress& progress) {
    return TwigGrower(field).run(std::move(tips), progress);
}

GrownTwigs grow_twigs(TwigField& field, std::vector<uint64_t> tips, Progress& progress) {
    size_t tasks = 0;
    const std::vector<int32_t> task = divide(field, tasks);
    progress.check();
    if (tasks < 2) return grow_one_by_one(field, std::move(tips), progress);
    std::vector<std::vector<uint64_t>> tips_of(tasks);
    for (const uint64_t tip : tips)
        tips_of[task[static_cast<uint32_t>(~tip)]].push_back(tip);
    std::vector<GrownTwigs> grown(tasks);
    parallel_for(tasks, 1, [&](size_t begin, size_t end) {
        for (size_t t = begin; t < end; t++)
            grown[t] = grow_one_by_one(field, std::move(tips_of[t]), progress);
    });
    return put_in_order(grown, task, field);
}

}  // namespace treerec
