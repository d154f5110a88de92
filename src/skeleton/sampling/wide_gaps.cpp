#include "skeleton/sampling/wide_gaps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/parallel.h"
#include "geometry/point_tree.h"
#include "skeleton/branches/run.h"

namespace treerec {

namespace {

constexpr double kWide = 0.04;        // of the tree's extent: a gap that is looked at
constexpr double kBeyond = 0.15;      // of all points: what lies beyond it at least
constexpr float kAsShort = 1.5F;      // times the shortest, squared: a gap's link that may be the best
constexpr float kLonger = 1.5F;       // times the gap: the links that are compared
constexpr float kAround = 1.5F;       // gaps: the wood that tells the direction
constexpr float kMostAround = 6.0F;   // gaps: where less tells none
constexpr float kTouching = 0.25F;    // of the gap: points of one piece of wood are no farther apart
constexpr double kAside = 0.28;       // of the way: what still lies ahead
constexpr double kAtEnd = 0.9;        // of the piece lies behind its end
constexpr double kCost = 2.0;         // times the length,
constexpr double kAlike = 3.0;        // and as often as the widest link is wider than so many times,
constexpr double kMostThin = 8.0;     // up to so often
constexpr float kApart = 0.5F;        // gaps: between the ends of two stems
constexpr float kBeside = 0.1F;       // of the gap: what is one end
constexpr size_t kMostEnds = 400;     // that are looked at
constexpr size_t kMostPiece = 20000;  // points
constexpr size_t kGrain = 256;

// A link that hangs much of the tree on the rest, over a gap.
struct Gap {
    uint32_t child;
    uint32_t parent;
    float width;  // metres
};

bool is_sure(const std::vector<SureLink>& links, const PointEdge& edge) {
    return std::any_of(links.begin(), links.end(), [&](const SureLink& link) { return link.edge == edge; });
}

// Of those as wide as `least` (metres) that are not known, the one that most hangs on.
Gap heaviest_gap(const PathTree& paths, double least, const std::vector<PointEdge>& known) {
    const size_t count = paths.parent.size();
    std::vector<uint32_t> behind(count, 1);
    Gap gap{0, 0, 0.0F};
    double most = kBeyond * static_cast<double>(count);
    for (size_t i = count; i-- > 0;) {
        const uint32_t v = paths.order[i];
        if (paths.parent[v] < 0) continue;
        behind[paths.parent[v]] += behind[v];
        if (paths.step[v] < least || behind[v] < most) continue;
        const uint32_t parent = static_cast<uint32_t>(paths.parent[v]);
        if (std::find(known.begin(), known.end(), PointEdge(std::min(v, parent), std::max(v, parent))) !=
            known.end())
            continue;
        gap = {v, parent, paths.step[v]};
        most = behind[v];
    }
    return gap;
}

// For PointTree::search(): how far it is to the nearest point.
struct Nearest {
    float best;  // squared metres

    float limit() const { return best; }
    void add(float squared, uint32_t) { best = std::min(best, squared); }
};

class Linker {
  public:
    Linker(const std::vector<Vec3>& points, const PointGraph& graph, std::vector<uint8_t> beyond,
           const Gap& gap)
        : points_(points),
          graph_(graph),
          beyond_(std::move(beyond)),
          gap_(gap),
          visited_(points.size(), 0),
          done_(points.size(), 0) {}

    std::vector<SureLink> links(Progress& progress) {
        // Of a piece of wood that runs into the gap, either end may be the one that can be told.
        link_from(1, progress);
        link_from(0, progress);
        // Where all end at the gap's own, one stem crosses it, and that has its link.
        const auto elsewhere = [&](const SureLink& link) {
            const uint32_t end = beyond_[link.edge.first] ? link.edge.first : link.edge.second;
            return glm::distance(points_[end], points_[gap_.child]) > kApart * gap_.width;
        };
        if (std::none_of(links_.begin(), links_.end(), elsewhere)) return {};
        // A thin end is less likely to be where thick wood goes on.
        const double widest = *std::max_element(widths_.begin(), widths_.end());
        for (size_t i = 0; i < links_.size(); i++) {
            const double thinner = widest / std::max(widths_[i], 1e-9) / kAlike;
            links_[i].cost *= static_cast<float>(kCost * std::clamp(thinner, 1.0, kMostThin));
        }
        return links_;
    }

    bool any_goes_on() const { return !links_.empty(); }

  private:
    // side: of the ends that are looked at; 1 beyond the gap.
    void link_from(uint8_t side, Progress& progress) {
        std::vector<Vec3> opposite;
        std::vector<uint32_t> number;
        for (uint32_t v = 0; v < points_.size(); v++) {
            if (beyond_[v] == side) continue;
            opposite.push_back(points_[v]);
            number.push_back(v);
        }
        const PointTree tree(opposite, &progress);
        const float longest = kLonger * gap_.width;
        std::vector<float> across(points_.size(), longest * longest);
        parallel_for(points_.size(), kGrain, [&](size_t begin, size_t end) {
            progress.check();
            for (size_t v = begin; v < end; v++) {
                if (beyond_[v] != side) continue;
                Nearest nearest{across[v]};
                tree.search(points_[v], nearest);
                across[v] = nearest.best;
            }
        });
        const float shortest = *std::min_element(across.begin(), across.end());
        if (side == 1 && (gap_.width * gap_.width <= kAsShort * shortest || gap_goes_on()))
            add(gap_.child, gap_.parent);
        const float most = std::min(longest * longest, kLonger * kLonger * shortest);
        std::vector<uint32_t> ends;  // nearer to the other side than what they touch
        for (uint32_t v = 0; v < points_.size(); v++)
            if (beyond_[v] == side && across[v] < most && is_end(v, across)) ends.push_back(v);
        std::sort(ends.begin(), ends.end(), [&](uint32_t a, uint32_t b) {
            return across[a] != across[b] ? across[a] < across[b] : a < b;
        });
        size_t looked = 0;
        for (const uint32_t v : ends) {
            progress.check();
            if (done_[v]) continue;
            if (++looked > kMostEnds) break;
            const float gap = std::sqrt(across[v]);
            std::vector<uint32_t> piece;
            const Run run = run_at(v, gap, piece);
            bool linked = false;
            if (run.known) {
                Straightest best{opposite, run, kLonger * kLonger * across[v], [](uint32_t) { return true; }};
                tree.search(points_[v], best);
                const uint32_t to = number[best.to];
                linked = best.found() && goes_on(piece, run, v, to);
                if (linked) add(v, to);
            }
            // What lies right beside an end that is none is none either.
            for (const uint32_t p : piece)
                if (linked || glm::distance(points_[p], points_[v]) < kBeside * gap) done_[p] = 1;
        }
    }

    void add(uint32_t a, uint32_t b) {
        const PointEdge edge(std::min(a, b), std::max(a, b));
        if (is_sure(links_, edge)) return;
        const float gap = glm::distance(points_[a], points_[b]);
        const DVec3 way = normalized_or(DVec3(points_[b]) - DVec3(points_[a]), DVec3(0, 1, 0));
        widths_.push_back(std::min(width_of(piece_around(a, gap, kAround * gap), way),
                                   width_of(piece_around(b, gap, kAround * gap), way)));
        links_.push_back({edge, gap});
    }

    // How the wood runs that ends at v, and its points. gap: metres.
    Run run_at(uint32_t v, float gap, std::vector<uint32_t>& piece) {
        Run run;
        for (float around = kAround; !run.known && around <= kMostAround; around *= 2.0F) {
            piece = piece_around(v, gap, around * gap);
            run = run_of(points_, piece, DVec3(points_[v]));
        }
        return run;
    }

    bool gap_goes_on() {
        std::vector<uint32_t> piece;
        const Run run = run_at(gap_.child, gap_.width, piece);
        return run.known && goes_on(piece, run, gap_.child, gap_.parent);
    }

    bool touch(uint32_t e, float gap) const { return graph_.length[e] <= kTouching * gap; }

    bool is_end(uint32_t v, const std::vector<float>& across) const {
        for (uint32_t e = graph_.begin[v]; e < graph_.begin[v + 1]; e++) {
            const uint32_t n = graph_.neighbour[e];
            if (beyond_[n] != beyond_[v] || !touch(e, std::sqrt(across[v]))) continue;
            if (across[n] < across[v] || (across[n] == across[v] && n < v)) return false;
        }
        return true;
    }

    // The points that v touches by way of others, no farther away than radius. gap, radius: metres.
    std::vector<uint32_t> piece_around(uint32_t v, float gap, float radius) {
        std::vector<uint32_t> piece = {v};
        visited_[v] = 1;
        for (size_t i = 0; i < piece.size() && piece.size() < kMostPiece; i++)
            for (uint32_t e = graph_.begin[piece[i]]; e < graph_.begin[piece[i] + 1]; e++) {
                const uint32_t n = graph_.neighbour[e];
                if (visited_[n] || beyond_[n] != beyond_[v] || !touch(e, gap)) continue;
                if (glm::distance(points_[n], points_[v]) > radius) continue;
                visited_[n] = 1;
                piece.push_back(n);
            }
        for (const uint32_t p : piece)
            visited_[p] = 0;
        return piece;
    }

    // Metres: how far the piece reaches across the axis, as a standard deviation.
    double width_of(const std::vector<uint32_t>& piece, const DVec3& axis) const {
        DVec3 mean(0.0);
        for (const uint32_t p : piece)
            mean += DVec3(points_[p]);
        mean /= static_cast<double>(piece.size());
        double squared = 0.0;
        for (const uint32_t p : piece) {
            const DVec3 d = DVec3(points_[p]) - mean;
            const double along = glm::dot(d, axis);
            squared += glm::dot(d, d) - along * along;
        }
        return std::sqrt(std::max(0.0, squared) / static_cast<double>(piece.size()));
    }

    // Whether the piece runs on to `to` and lies behind its end, as seen from there.
    bool goes_on(const std::vector<uint32_t>& piece, const Run& run, uint32_t end, uint32_t to) const {
        if (run.aside(DVec3(points_[to])) > kAside) return false;
        const auto along = [&](uint32_t v) { return glm::dot(DVec3(points_[v]) - run.middle, run.axis); };
        const double ahead = along(to) < 0.0 ? -1.0 : 1.0;
        const double most = ahead * along(end);
        size_t behind = 0;
        for (const uint32_t p : piece)
            behind += ahead * along(p) <= most;
        return static_cast<double>(behind) >= kAtEnd * static_cast<double>(piece.size());
    }

    const std::vector<Vec3>& points_;
    const PointGraph& graph_;
    std::vector<uint8_t> beyond_;  // by point: 1 on the far side of the gap
    Gap gap_;
    std::vector<uint8_t> visited_;
    std::vector<SureLink> links_;
    std::vector<double> widths_;  // metres, by link: of the thinner side
    std::vector<uint8_t> done_;   // by point: 1 where no more links are looked for
};

}  // namespace

bool link_over_wide_gap(const std::vector<Vec3>& points, const PathTree& paths, double extent,
                        PointGraph& graph, WideGaps& gaps, Progress& progress) {
    const Gap gap = heaviest_gap(paths, kWide * extent, gaps.known);
    if (gap.width == 0.0F) return false;
    gaps.known.emplace_back(std::min(gap.child, gap.parent), std::max(gap.child, gap.parent));
    std::vector<uint8_t> beyond(points.size(), 0);
    beyond[gap.child] = 1;
    for (const uint32_t v : paths.order)
        if (paths.parent[v] >= 0 && beyond[paths.parent[v]]) beyond[v] = 1;
    std::vector<PointEdge> added;
    Linker linker(points, graph, std::move(beyond), gap);
    for (const SureLink& link : linker.links(progress)) {
        if (is_sure(gaps.links, link.edge)) continue;
        gaps.links.push_back(link);
        gaps.known.push_back(link.edge);
        if (!find_edge(graph, link.edge)) added.push_back(link.edge);
    }
    if (!added.empty()) add_edges(graph, points, std::move(added));
    return linker.any_goes_on();
}

}  // namespace treerec
