#include "skeleton/sampling/bridges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "geometry/parallel.h"
#include "skeleton/branches/run.h"

namespace treerec {

namespace {

constexpr size_t kGrain = 256;        // points between two looks at the cancel flag
constexpr float kLonger = 3.0f;       // times the shortest link: the links that are compared
constexpr size_t kNearStarts = 4;     // of them: the shortest,
constexpr size_t kEndStarts = 8;      // and those from the part's end
constexpr uint32_t kSampled = 7;      // one of so many points
constexpr size_t kLeastPart = 40;     // points: a smaller part runs nowhere
constexpr size_t kLargePart = 200;    // points: of a larger part,
constexpr uint32_t kOfLargePart = 3;  // only one of so many is looked at
constexpr double kAround = 2.0;       // link lengths: the wood that tells the direction

struct Link {
    float squared;  // metres
    uint32_t from;
    uint32_t to;
};

// For PointTree::search(): the nearest point of another part; of equals the first.
struct NearestOutside {
    const std::vector<uint32_t>& part;
    uint32_t own;
    float best;  // squared metres
    uint32_t index = 0;

    float limit() const { return best; }
    void add(float distance, uint32_t candidate) {
        if (part[candidate] == own || (distance == best && candidate >= index)) return;
        if (distance > best) return;
        best = distance;
        index = candidate;
    }
};

// The points of one part nearer than a distance.
struct Inside {
    const std::vector<uint32_t>& part;
    uint32_t own;
    float squared;  // metres
    std::vector<uint32_t>& found;

    float limit() const { return squared; }
    void add(float distance, uint32_t v) {
        if (distance < squared && part[v] == own) found.push_back(v);
    }
};

// The cheapest link from a point to another part: its length in metres, the more the further it turns aside.
struct CheapestLink {
    const std::vector<Vec3>& points;
    const std::vector<uint32_t>& part;
    const Run& run;
    uint32_t from;
    float longest;  // squared metres
    double least;   // cost, of `best` or of a link from elsewhere
    Link best;

    // No link costs less than its length.
    float limit() const { return static_cast<float>(std::min<double>(longest, 1.0001 * least * least)); }
    void add(float squared, uint32_t to) {
        if (part[to] == part[from] || squared >= longest) return;
        const double aside = run.known ? run.aside(DVec3(points[to])) : 0.5;
        const double cost = std::sqrt(squared) * (1.0 + kAsideWeight * aside);
        const bool first = squared != best.squared ? squared < best.squared : to < best.to;
        if (cost > least || (cost == least && !(best.from == from && first))) return;
        least = cost;
        best = {squared, from, to};
    }
};

class Bridges {
  public:
    Bridges(const std::vector<Vec3>& points, const PointTree& tree, Groups groups, PassSet left_out)
        : points_(points),
          tree_(tree),
          groups_(std::move(groups)),
          part_(points.size()),
          run_on_(!left_out.has(Pass::kBridgesRunOn)) {}

    void add(std::vector<PointEdge>& edges, Progress& progress) {
        while (number_parts()) {
            std::vector<uint32_t> outside;
            for (uint32_t v = 0; v < points_.size(); v++)
                if (part_[v] != largest_ && (v % kSampled == 0 || looked_at(v))) outside.push_back(v);
            std::vector<Link> nearest(outside.size());
            const auto link_all = [&](const auto& most_of) {
                parallel_for(outside.size(), kGrain, [&](size_t begin, size_t end) {
                    progress.check();
                    for (size_t i = begin; i < end; i++)
                        nearest[i] = nearest_outside(outside[i], most_of(outside[i]));
                });
            };
            // A few points of each part tell how far it is at most to the next.
            std::vector<Link> shortest(points_.size(), {std::numeric_limits<float>::infinity(), 0, 0});
            link_all(
                [](uint32_t v) { return v % kSampled == 0 ? std::numeric_limits<float>::infinity() : 0.0F; });
            for (const Link& link : nearest)
                if (link.squared < shortest[part_[link.from]].squared && link.from != link.to)
                    shortest[part_[link.from]] = link;
            // Then all: the link to the nearest other part, where that may count.
            link_all([&](uint32_t v) {
                return looked_at(v) ? 1.0001F * longer(part_[v]) * shortest[part_[v]].squared : 0.0F;
            });
            std::vector<Link> links;
            for (const Link& link : nearest) {
                const uint32_t v = link.from;
                if (link.from == link.to) continue;
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
            parallel_for(parts.size(), 1, [&](size_t begin, size_t end) {
                progress.check();
                for (size_t i = begin; i < end; i++)
                    choose(parts[i]);
            });
            for (const PartLinks& part : parts) {
                const Link& best = part.best;
                if (!groups_.join(best.from, best.to)) continue;
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
        if (!run_on_) return;
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
        std::vector<uint32_t> around;
        for (const Link& link : links.first(all)) {
            const Run run = run_around(link, around);
            const float radius = static_cast<float>(longest);
            CheapestLink cheapest{points_, part_, run, link.from, radius * radius, least, of_part.best};
            tree_.search(points_[link.from], cheapest,
                         [&](uint32_t node) { return part_of_node_[node] != of_part.part; });
            least = cheapest.least;
            of_part.best = cheapest.best;
        }
    }

    // False where only one part is left.
    bool number_parts() {
        members_.assign(points_.size(), 0u);
        middle_.assign(points_.size(), DVec3(0.0));
        for (uint32_t v = 0; v < points_.size(); v++) {
            members_[part_[v] = groups_.find(v)]++;
            middle_[part_[v]] += DVec3(points_[v]);
        }
        largest_ =
            static_cast<uint32_t>(std::max_element(members_.begin(), members_.end()) - members_.begin());
        if (members_[largest_] == points_.size()) return false;
        // A node whose points are all of one part is passed over by who looks for another one.
        part_of_node_ = names_of_nodes(tree_, part_);
        return true;
    }

    // Of a large part, some points do for all.
    bool looked_at(uint32_t v) const { return members_[part_[v]] < kLargePart || v % kOfLargePart == 0; }

    // A link from v to itself where no other part is nearer than `most` (squared metres).
    Link nearest_outside(uint32_t v, float most) const {
        const uint32_t own = part_[v];
        NearestOutside nearest{part_, own, most};
        if (most > 0.0F)
            tree_.search(points_[v], nearest, [&](uint32_t node) { return part_of_node_[node] != own; });
        return {nearest.best, v, nearest.best < most ? nearest.index : v};
    }

    // Squared lengths, times the shortest: the links of a part that are compared. A few points run nowhere:
    // of their links, the shortest is the best.
    float longer(uint32_t part) const { return members_[part] < kLeastPart ? 1.0f : kLonger * kLonger; }

    // around: scratch.
    Run run_around(const Link& link, std::vector<uint32_t>& around) const {
        const float radius = static_cast<float>(kAround) * std::sqrt(link.squared);
        const uint32_t own = part_[link.from];
        around.clear();
        Inside inside{part_, own, radius * radius, around};
        tree_.search(points_[link.from], inside, [&](uint32_t node) {
            return part_of_node_[node] == own || part_of_node_[node] == kSeveral;
        });
        return run_of(points_, around, DVec3(points_[link.to]));
    }

    const std::vector<Vec3>& points_;
    const PointTree& tree_;
    Groups groups_;
    std::vector<uint32_t> part_;
    std::vector<uint32_t> members_;       // by part
    std::vector<DVec3> middle_;           // by part: the sum of its points
    std::vector<uint32_t> part_of_node_;  // of tree_
    uint32_t largest_ = 0;
    bool run_on_;
};

}  // namespace

void bridge_parts(const std::vector<Vec3>& points, const PointTree& tree, Groups groups,
                  std::vector<PointEdge>& edges, Progress& progress, PassSet left_out) {
    Bridges(points, tree, std::move(groups), left_out).add(edges, progress);
}

}  // namespace treerec
