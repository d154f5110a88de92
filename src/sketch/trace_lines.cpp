#include "sketch/trace_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "geometry/portable_math.h"
#include "sketch/line_graph.h"

namespace treerec {

namespace {

// How far two lines at a junction may turn to be one, in radians: first where it is plain, then, once large
// loops are told, where there is no better.
constexpr double kPlain = 35.0 * kPi / 180.0;
constexpr double kMost = 60.0 * kPi / 180.0;
constexpr double kLoopShare = 0.25;    // of the drawing's diagonal: a loop so large is an outline
constexpr double kFarBothSides = 0.3;  // of the longer part: a line across the trunk with less is a slip
constexpr double kSmoothing = 2.0;     // pixels: the deviation of a Gaussian

// One end of an edge.
struct Arm {
    size_t edge = LineEdge::kNone;
    size_t end = 0;

    bool operator==(const Arm&) const = default;
    explicit operator bool() const { return edge != LineEdge::kNone; }
    Arm other() const { return {edge, 1 - end}; }
};

struct Path {
    std::vector<Arm> arms;  // each edge by the end at which it is entered
    bool closed = false;
};

// By edge and end: as which arm it goes on.
using Mates = std::vector<std::array<Arm, 2>>;

struct Box {
    DVec2 low{INFINITY}, high{-INFINITY};

    void add(const std::vector<DVec2>& points) {
        for (const DVec2& p : points) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
    double diagonal() const { return low.x <= high.x ? glm::length(high - low) : 0.0; }
};

// The place so far along an edge from the arm's junction, in pixels.
DVec2 place_along(const LineEdge& edge, const Arm& arm, double along) {
    const std::vector<DVec2>& points = edge.points;
    const size_t count = points.size();
    for (size_t i = 1; i < count; i++) {
        const DVec2& a = points[arm.end == 0 ? i - 1 : count - i];
        const DVec2& b = points[arm.end == 0 ? i : count - i - 1];
        const double step = glm::length(b - a);
        if (along <= step && step > 0.0) return a + (b - a) * (along / step);
        along -= step;
    }
    return arm.end == 0 ? points.back() : points.front();
}

// How far from its junction an arm is as it was drawn: within the ink of what it meets, thinning bends it.
double bent_length(const LineGraph& graph, const Arm& arm) {
    const LineEdge& edge = graph.edges[arm.edge];
    return std::min(1.2 * graph.nodes[edge.nodes[arm.end]].depth, edge.length / 3.0);
}

// The way that an arm leaves its junction.
DVec2 direction(const LineGraph& graph, const Arm& arm) {
    const LineEdge& edge = graph.edges[arm.edge];
    const double from = bent_length(graph, arm);
    const double to =
        std::min(from + std::max(8.0, 4.0 * graph.nodes[edge.nodes[arm.end]].depth), edge.length);
    const DVec2 way = place_along(edge, arm, to) - place_along(edge, arm, from);
    const double length = glm::length(way);
    return length > 0.0 ? way / length : DVec2(0.0);
}

// Says which arms go on as which.
class Joiner {
  public:
    static constexpr size_t kNoTrunk = static_cast<size_t>(-1);

    explicit Joiner(const LineGraph& graph)
        : graph_(graph), mates_(graph.edges.size()), on_trunk_(graph.nodes.size(), false) {
        Box all;
        for (const LineEdge& edge : graph.edges)
            if (edge.alive) all.add(edge.points);
        diagonal_ = all.diagonal();
    }

    std::vector<Path> run() {
        join_straight(kPlain);
        close_loops();
        join_straight(kMost);
        close_loops();
        std::vector<Path> paths = follow();
        part_at_trunk(paths);
        return paths;
    }

    const Mates& mates() const { return mates_; }
    // The place of the trunk's path, or kNoTrunk.
    size_t trunk() const { return trunk_; }
    // Whether the arm's end of an open line is where the line begins rather than ends: 2 at the trunk, 1
    // where it meets another line, else 0.
    int rank(const Arm& arm) const {
        const size_t at = node(arm);
        return on_trunk_[at] ? 2 : graph_.nodes[at].edges.size() > 1 ? 1 : 0;
    }

  private:
    Arm& mate(const Arm& arm) { return mates_[arm.edge][arm.end]; }
    const LineEdge& edge(const Arm& arm) const { return graph_.edges[arm.edge]; }
    size_t node(const Arm& arm) const { return edge(arm).nodes[arm.end]; }

    void pair(const Arm& a, const Arm& b) {
        mate(a) = b;
        mate(b) = a;
    }

    void join_straight(double most) {
        struct Choice {
            double turn;
            Arm a, b;
        };
        std::vector<Choice> choices;
        for (const LineNode& at : graph_.nodes) {
            if (at.edges.size() < 2) continue;
            std::vector<Arm> arms;
            std::vector<DVec2> ways;
            for (size_t i = 0; i < at.edges.size(); i++) {
                const Arm arm{at.edges[i], at.ends[i]};
                if (mate(arm)) continue;
                arms.push_back(arm);
                ways.push_back(direction(graph_, arm));
            }
            choices.clear();
            for (size_t i = 0; i < arms.size(); i++)
                for (size_t j = i + 1; j < arms.size(); j++) {
                    const double turn = portable::acos(std::clamp(-glm::dot(ways[i], ways[j]), -1.0, 1.0));
                    if (turn <= most) choices.push_back({turn, arms[i], arms[j]});
                }
            std::stable_sort(choices.begin(), choices.end(),
                             [](const Choice& a, const Choice& b) { return a.turn < b.turn; });
            for (const Choice& choice : choices)
                if (!mate(choice.a) && !mate(choice.b)) pair(choice.a, choice.b);
        }
    }

    // From an arm along its edge and those that it goes on as, to the last arm, which has no mate.
    std::optional<Arm> far_end(const Arm& from, Box& box) {
        Arm at = from;
        while (true) {
            box.add(edge(at).points);
            const Arm out = at.other(), next = mate(out);
            if (!next) return out;
            if (next == from) return {};
            at = next;
        }
    }

    void close_loops() {
        for (const LineNode& at : graph_.nodes)
            for (size_t i = 0; i < at.edges.size(); i++) {
                const Arm arm{at.edges[i], at.ends[i]};
                if (mate(arm)) continue;
                Box box;
                const std::optional<Arm> far = far_end(arm, box);
                if (far && *far != arm && node(*far) == node(arm) && box.diagonal() >= kLoopShare * diagonal_)
                    pair(arm, *far);
            }
    }

    std::vector<Path> follow() {
        std::vector<Path> paths;
        std::vector<bool> taken(graph_.edges.size(), false);
        const auto take = [&](const Arm& first) {
            Path path;
            Arm at = first;
            do {
                taken[at.edge] = true;
                path.arms.push_back(at);
                at = mate(at.other());
            } while (at && at != first);
            path.closed = static_cast<bool>(at);
            paths.push_back(std::move(path));
        };
        // First from the ends of open ones, then what goes round.
        for (const bool open : {true, false})
            for (size_t e = 0; e < graph_.edges.size(); e++)
                for (size_t end = 0; end < 2; end++) {
                    const LineEdge& here = graph_.edges[e];
                    const Arm arm{e, end};
                    const bool ring = here.nodes[0] == LineEdge::kNone;
                    if (!here.alive || taken[e] || (open && (ring || mate(arm)))) continue;
                    if (ring) {
                        taken[e] = true;
                        paths.push_back({{arm}, true});
                    } else {
                        take(arm);
                    }
                }
        return paths;
    }

    Box box_of(const Path& path) const {
        Box box;
        for (const Arm& arm : path.arms)
            box.add(edge(arm).points);
        return box;
    }

    double length_of(const Path& path, size_t first, size_t last) const {
        double length = 0.0;
        for (size_t i = first; i < last; i++)
            length += edge(path.arms[i]).length;
        return length;
    }

    // Branches that leave the trunk at one height are no line across it.
    void part_at_trunk(std::vector<Path>& paths) {
        size_t trunk = kNoTrunk, top = paths.size();
        double lowest = -INFINITY, highest = INFINITY;
        for (size_t i = 0; i < paths.size(); i++) {
            const Box box = box_of(paths[i]);
            if (!paths[i].closed && box.high.y > lowest) {
                lowest = box.high.y;
                trunk = i;
            }
            if (box.low.y < highest) {
                highest = box.low.y;
                top = i;
            }
        }
        trunk_ = trunk;
        if (trunk == kNoTrunk) return;
        for (size_t i = 1; i < paths[trunk].arms.size(); i++)
            on_trunk_[node(paths[trunk].arms[i])] = true;
        const size_t count = paths.size();
        for (size_t i = 0; i < count; i++) {
            if (i == trunk || i == top || paths[i].closed) continue;
            for (size_t k = 1; k < paths[i].arms.size(); k++) {
                const Path path = paths[i];
                if (!on_trunk_[node(path.arms[k])]) continue;
                const double before = length_of(path, 0, k), after = length_of(path, k, path.arms.size());
                if (std::min(before, after) < kFarBothSides * std::max(before, after)) continue;
                mate(path.arms[k]) = mate(path.arms[k - 1].other()) = Arm();
                const auto middle = path.arms.begin() + static_cast<std::ptrdiff_t>(k);
                paths[i].arms.assign(path.arms.begin(), middle);
                paths.push_back({{middle, path.arms.end()}, false});
                break;
            }
        }
    }

    const LineGraph& graph_;
    Mates mates_;
    std::vector<bool> on_trunk_;
    size_t trunk_ = kNoTrunk;
    double diagonal_ = 0.0;
};

// Where a line that ends at a junction meets the one that goes through it: straight on from where it is as
// drawn. Nothing where none goes through, or it does not lead there.
std::optional<DVec2> meeting_place(const LineGraph& graph, const Mates& mates, const Arm& arm) {
    const LineNode& node = graph.nodes[graph.edges[arm.edge].nodes[arm.end]];
    const DVec2 from = place_along(graph.edges[arm.edge], arm, bent_length(graph, arm));
    const DVec2 way = -direction(graph, arm);
    std::optional<DVec2> nearest;
    double best = 4.0 * node.depth + 4.0;
    for (size_t i = 0; i < node.edges.size(); i++) {
        const Arm a{node.edges[i], node.ends[i]}, b = mates[a.edge][a.end];
        if (!b || a == arm || b == arm) continue;
        const DVec2 p = place_along(graph.edges[a.edge], a, bent_length(graph, a));
        const DVec2 across = place_along(graph.edges[b.edge], b, bent_length(graph, b)) - p;
        // from + t way = p + s across
        const double area = way.x * across.y - way.y * across.x;
        if (std::abs(area) < 0.2 * glm::length(across)) continue;
        const DVec2 to = p - from;
        const double t = (to.x * across.y - to.y * across.x) / area;
        if (t <= 0.0 || t >= best) continue;
        best = t;
        nearest = from + t * way;
    }
    return nearest;
}

// The pixels of a path, straight across the junctions on its way: there thinning draws it towards what meets
// it.
std::vector<DVec2> pixels_of(const LineGraph& graph, const Mates& mates, const Path& path) {
    std::vector<DVec2> all;
    for (size_t i = 0; i < path.arms.size(); i++) {
        const Arm arm = path.arms[i], out = arm.other();
        const LineEdge& edge = graph.edges[arm.edge];
        std::vector<DVec2> points = edge.points;
        if (arm.end == 1) std::reverse(points.begin(), points.end());
        const auto meets = [&](const Arm& at) {
            const size_t node = edge.nodes[at.end];
            return node == LineEdge::kNone || graph.nodes[node].edges.size() < 2
                       ? std::nullopt
                       : meeting_place(graph, mates, at);
        };
        const bool enters = path.closed || i > 0, leaves = path.closed || i + 1 < path.arms.size();
        const std::optional<DVec2> first = enters ? std::nullopt : meets(arm);
        const std::optional<DVec2> last = leaves ? std::nullopt : meets(out);
        const auto cut = [&](const Arm& at, bool wanted) {
            if (!wanted || edge.nodes[at.end] == LineEdge::kNone) return std::ptrdiff_t{0};
            return static_cast<std::ptrdiff_t>(
                std::min(bent_length(graph, at), static_cast<double>(points.size() / 3)));
        };
        if (first) all.push_back(*first);
        all.insert(all.end(), points.begin() + cut(arm, enters || first),
                   points.end() - cut(out, leaves || last));
        if (last) all.push_back(*last);
    }
    if (path.closed) all.push_back(all.front());
    return all;
}

// At even distances along: so many that each is `spacing` or a little less.
std::vector<DVec2> evenly(const std::vector<DVec2>& points, double spacing) {
    double length = 0.0;
    for (size_t i = 1; i < points.size(); i++)
        length += glm::length(points[i] - points[i - 1]);
    const auto pieces = static_cast<size_t>(std::max(1.0, std::ceil(length / spacing)));
    std::vector<DVec2> even = {points.front()};
    double along = 0.0;
    for (size_t i = 1; i < points.size(); i++) {
        const double step = glm::length(points[i] - points[i - 1]);
        while (even.size() < pieces) {
            const double next = length * static_cast<double>(even.size()) / static_cast<double>(pieces);
            if (next > along + step) break;
            even.push_back(points[i - 1] + (points[i] - points[i - 1]) * ((next - along) / step));
        }
        along += step;
    }
    even.push_back(points.back());
    return even;
}

// Without the staircase of pixels: means weighted by a Gaussian, over fewer towards the ends, which stay.
std::vector<DVec2> smoothed(const std::vector<DVec2>& points, bool closed, double deviation) {
    const size_t count = points.size(), around = closed ? count - 1 : count;
    const auto reach = static_cast<size_t>(std::ceil(2.5 * deviation));
    std::vector<double> weights;
    for (size_t k = 0; k <= reach; k++)
        weights.push_back(portable::exp(-0.5 * static_cast<double>(k * k) / (deviation * deviation)));
    std::vector<DVec2> smooth(count);
    for (size_t i = 0; i < around; i++) {
        const size_t most = std::min(reach, closed ? (around - 1) / 2 : std::min(i, count - 1 - i));
        DVec2 sum = points[i];
        double all = 1.0;
        for (size_t k = 1; k <= most; k++) {
            sum += weights[k] * (points[(i + k) % around] + points[(i + around - k) % around]);
            all += 2.0 * weights[k];
        }
        smooth[i] = sum / all;
    }
    if (closed) smooth.back() = smooth.front();
    return smooth;
}

}  // namespace

std::vector<TracedLine> trace_lines(const LineMask& thin, const std::vector<float>& depths, double spacing,
                                    double shortest, const std::string& who) {
    const LineGraph graph = graph_of_lines(thin, depths, who);
    std::vector<std::pair<double, TracedLine>> found;
    Joiner joiner(graph);
    const std::vector<Path> paths = joiner.run();
    for (const Path& path : paths) {
        std::vector<DVec2> points = pixels_of(graph, joiner.mates(), path);
        if (points.size() < 2) continue;
        if (!path.closed) {
            const int first = joiner.rank(path.arms.front()), last = joiner.rank(path.arms.back().other());
            const bool told = first != last && static_cast<size_t>(&path - paths.data()) != joiner.trunk();
            if (told ? last > first : points.back().y > points.front().y)
                std::reverse(points.begin(), points.end());
        }
        double length = 0.0;
        for (const Arm& arm : path.arms)
            length += graph.edges[arm.edge].length;
        if (length < shortest) continue;
        TracedLine line;
        line.closed = path.closed;
        line.points = evenly(smoothed(evenly(points, 1.0), path.closed, kSmoothing), spacing);
        found.emplace_back(length, std::move(line));
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<TracedLine> lines;
    for (auto& [length, line] : found)
        lines.push_back(std::move(line));
    return lines;
}

}  // namespace treerec
