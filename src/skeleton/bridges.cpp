#include "skeleton/bridges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr size_t kGrain = 2048;        // points between two looks at the cancel flag
constexpr float kLonger = 3.0f;        // times the shortest link: the links that are compared
constexpr size_t kNearStarts = 4;      // of them: the shortest,
constexpr size_t kEndStarts = 8;       // and those from the part's end
constexpr size_t kPartsPerTask = 8;    // of parallel work
constexpr uint32_t kSampled = 7;       // one of so many points
constexpr size_t kLeastPart = 40;      // points: a smaller part runs nowhere
constexpr size_t kLargePart = 200;     // points: of a larger part,
constexpr uint32_t kOfLargePart = 3;   // only one of so many is looked at
constexpr double kAround = 2.0;        // link lengths: the wood that tells the direction
constexpr double kLeastAround = 12.0;  // points
constexpr double kElongated = 3.0;     // variance along over variance across: a direction that can be trusted
constexpr double kAsideWeight = 2.5;   // a link straight aside counts as so many times longer, and once

struct Link {
    float squared;  // metres
    uint32_t from;
    uint32_t to;
};

// For KdTree::search(): the nearest point of another part.
struct NearestOutside {
    const std::vector<uint32_t>& part;
    uint32_t own;
    float best;  // squared metres
    uint32_t index;

    float limit() const { return best; }
    void add(float distance, uint32_t candidate) {
        if (part[candidate] == own || distance >= best) return;
        best = distance;
        index = candidate;
    }
};

uint32_t find(std::vector<uint32_t>& leader, uint32_t v) {
    while (leader[v] != v)
        v = leader[v] = leader[leader[v]];
    return v;
}

void join(std::vector<uint32_t>& leader, uint32_t a, uint32_t b) {
    a = find(leader, a);
    b = find(leader, b);
    leader[std::max(a, b)] = std::min(a, b);
}

class Bridges {
  public:
    Bridges(const std::vector<Vec3>& points, const KdTree& tree)
        : points_(points), tree_(tree), leader_(points.size()), part_(points.size()) {
        std::iota(leader_.begin(), leader_.end(), 0u);
    }

    void add(std::vector<PointEdge>& edges, Progress& progress) {
        for (const auto& [a, b] : edges)
            join(leader_, a, b);
        while (number_parts()) {
            // A few points of each part tell how far it is at most to the next.
            std::vector<Link> shortest(points_.size(), {std::numeric_limits<float>::infinity(), 0, 0});
            for (uint32_t v = 0; v < points_.size(); v++) {
                if (part_[v] == largest_ || v % kSampled != 0) continue;
                Link& best = shortest[part_[v]];
                const Link link = nearest_outside(v, best.squared);
                if (link.squared < best.squared) best = link;
            }
            // Then all: the link to the nearest other part, where that may count.
            std::vector<Link> nearest(points_.size());
            parallel_for(points_.size(), kGrain, [&](size_t begin, size_t end) {
                progress.check();
                for (size_t v = begin; v < end; v++)
                    if (part_[v] != largest_ && looked_at(static_cast<uint32_t>(v)))
                        nearest[v] = nearest_outside(static_cast<uint32_t>(v),
                                                     1.0001f * longer(part_[v]) * shortest[part_[v]].squared);
            });
            std::vector<Link> links;
            for (uint32_t v = 0; v < points_.size(); v++) {
                const Link& link = nearest[v];
                if (part_[v] == largest_ || link.from == link.to) continue;
                if (link.squared < shortest[part_[v]].squared) shortest[part_[v]] = link;
                if (members_[part_[v]] >= kLeastPart) links.push_back(link);
            }
            std::erase_if(links, [&](const Link& link) {
                return link.squared > shortest[part_[link.from]].squared * longer(part_[link.from]);
            });
            std::stable_sort(links.begin(), links.end(), [&](const Link& a, const Link& b) {
                return part_[a.from] != part_[b.from] ? part_[a.from] < part_[b.from] : a.squared < b.squared;
            });
            std::vector<PartLinks> parts;
            size_t next = 0;
            for (uint32_t part = 0; part < points_.size(); part++) {
                if (std::isinf(shortest[part].squared)) continue;
                const size_t begin = next;
                while (next < links.size() && part_[links[next].from] == part)
                    next++;
                parts.push_back({part, {links.data() + begin, next - begin}, shortest[part]});
            }
            parallel_for(parts.size(), kPartsPerTask, [&](size_t begin, size_t end) {
                progress.check();
                for (size_t i = begin; i < end; i++)
                    choose(parts[i]);
            });
            for (const PartLinks& part : parts) {
                const Link& best = part.best;
                if (find(leader_, best.from) == find(leader_, best.to)) continue;
                join(leader_, best.from, best.to);
                edges.emplace_back(std::min(best.from, best.to), std::max(best.from, best.to));
            }
        }
    }

  private:
    // The links that a part may take: the shortest of its points, ascending, and the best so far.
    struct PartLinks {
        uint32_t part;
        std::span<Link> links;
        Link best;
    };

    void choose(PartLinks& of_part) const {
        const double longest = kLonger * std::sqrt(of_part.best.squared);
        double least = std::numeric_limits<double>::max();
        const std::span<Link> links = of_part.links;
        const size_t near = std::min(kNearStarts, links.size());
        const size_t all = std::min(kNearStarts + kEndStarts, links.size());
        // Behind the shortest links, those from the part's end: the farthest from its middle.
        const Vec3 middle(middle_[of_part.part] / static_cast<double>(members_[of_part.part]));
        std::partial_sort(links.begin() + static_cast<ptrdiff_t>(near),
                          links.begin() + static_cast<ptrdiff_t>(all), links.end(),
                          [&](const Link& a, const Link& b) {
                              const float to_a = glm::distance(points_[a.from], middle);
                              const float to_b = glm::distance(points_[b.from], middle);
                              return to_a != to_b ? to_a > to_b : a.from < b.from;
                          });
        std::vector<std::pair<uint32_t, float>> around;
        for (const Link& link : links.first(all))
            straightest(link, longest, around, least, of_part.best);
    }

    // False where only one part is left.
    bool number_parts() {
        members_.assign(points_.size(), 0u);
        middle_.assign(points_.size(), DVec3(0.0));
        for (uint32_t v = 0; v < points_.size(); v++) {
            members_[part_[v] = find(leader_, v)]++;
            middle_[part_[v]] += DVec3(points_[v]);
        }
        largest_ =
            static_cast<uint32_t>(std::max_element(members_.begin(), members_.end()) - members_.begin());
        return members_[largest_] < points_.size();
    }

    // Of a large part, some points do for all.
    bool looked_at(uint32_t v) const { return members_[part_[v]] < kLargePart || v % kOfLargePart == 0; }

    // A link from v to itself where no other part is nearer than `most` (squared metres).
    Link nearest_outside(uint32_t v, float most) const {
        NearestOutside nearest{part_, part_[v], most, v};
        tree_.search(points_[v], nearest);
        return {nearest.best, v, nearest.index};
    }

    // Squared lengths, times the shortest: the links of a part that are compared. A few points run nowhere:
    // of their links, the shortest is the best.
    float longer(uint32_t part) const { return members_[part] < kLeastPart ? 1.0f : kLonger * kLonger; }

    // Where the wood around a link's start runs: a line through `middle`, or no direction.
    struct Run {
        DVec3 middle{0.0};
        DVec3 axis{0.0};
        bool known = false;
    };

    // around: scratch.
    Run run_around(const Link& link, std::vector<std::pair<uint32_t, float>>& around) const {
        const float radius = static_cast<float>(kAround) * std::sqrt(link.squared);
        tree_.within(points_[link.from], radius * radius, around);
        Run run;
        double count = 0.0;
        for (const auto& [v, distance] : around) {
            if (part_[v] != part_[link.from]) continue;
            run.middle += DVec3(points_[v]);
            count += 1.0;
        }
        if (count < kLeastAround) return run;
        run.middle /= count;
        DMat3 covariance(0.0);
        for (const auto& [v, distance] : around) {
            if (part_[v] != part_[link.from]) continue;
            const DVec3 d = DVec3(points_[v]) - run.middle;
            covariance += glm::outerProduct(d, d);
        }
        // Power iteration finds the main axis.
        run.axis = normalized_or(DVec3(points_[link.to]) - run.middle, DVec3(0, 1, 0));
        for (int i = 0; i < 16; i++)
            run.axis = normalized_or(covariance * run.axis, run.axis);
        const double along = glm::dot(run.axis, covariance * run.axis);
        const double across = 0.5 * (covariance[0][0] + covariance[1][1] + covariance[2][2] - along);
        run.known = along >= kElongated * across;
        return run;
    }

    // Takes the cheapest link from the start of `link` that is at most `longest` metres long, if it costs
    // less than `least`: its length in metres, the more the further it turns aside.
    void straightest(const Link& link, double longest, std::vector<std::pair<uint32_t, float>>& around,
                     double& least, Link& best) const {
        const Run run = run_around(link, around);
        const float radius = static_cast<float>(longest);
        tree_.within(points_[link.from], radius * radius, around);
        for (const auto& [to, squared] : around) {
            if (part_[to] == part_[link.from]) continue;
            const double length = std::sqrt(squared);
            if (length >= least) break;
            double aside = 0.5;  // of the way
            if (run.known) {
                const DVec3 way = DVec3(points_[to]) - run.middle;
                const double ahead = std::abs(glm::dot(way, run.axis));
                const double off = std::sqrt(std::max(0.0, glm::dot(way, way) - ahead * ahead));
                aside = off / (ahead + off);
            }
            const double cost = length * (1.0 + kAsideWeight * aside);
            if (cost >= least) continue;
            least = cost;
            best = {squared, link.from, to};
        }
    }

    const std::vector<Vec3>& points_;
    const KdTree& tree_;
    std::vector<uint32_t> leader_;
    std::vector<uint32_t> part_;
    std::vector<uint32_t> members_;  // by part
    std::vector<DVec3> middle_;      // by part: the sum of its points
    uint32_t largest_ = 0;
};

}  // namespace

void bridge_parts(const std::vector<Vec3>& points, const KdTree& tree, std::vector<PointEdge>& edges,
                  Progress& progress) {
    Bridges(points, tree).add(edges, progress);
}

}  // namespace treerec
