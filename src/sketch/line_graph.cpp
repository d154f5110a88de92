#include "sketch/line_graph.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>
#include <utility>

#include "error.h"
#include "sketch/flat_line.h"

namespace treerec {

namespace {

constexpr size_t kMostEdges = 20000;    // before spurs go
constexpr double kNearJunctions = 2.0;  // pixels beyond the ink of both

class Builder {
  public:
    Builder(const LineMask& thin, const std::vector<float>& depths, const std::string& who)
        : thin_(thin), depths_(depths), who_(who) {}

    LineGraph build() {
        find_pixels();
        find_nodes();
        walk_edges();
        walk_rings();
        return std::move(graph_);
    }

  private:
    static constexpr uint32_t kNoNode = UINT32_MAX;

    // The neighbours in the sense of m-adjacency: across a corner only where no side leads there, so that a
    // staircase is a line and no row of junctions.
    template <typename Look>
    void each_neighbour(size_t place, const Look& look) const {
        const int x = static_cast<int>(place % static_cast<size_t>(thin_.width));
        const int y = static_cast<int>(place / static_cast<size_t>(thin_.width));
        constexpr std::array<std::pair<int, int>, 4> kSides = {{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};
        for (const auto& [u, v] : kSides)
            if (thin_.at(x + u, y + v)) look(thin_.place(x + u, y + v));
        for (const auto& [u, v] : {std::pair{1, -1}, {1, 1}, {-1, 1}, {-1, -1}})
            if (thin_.at(x + u, y + v) && !thin_.at(x + u, y) && !thin_.at(x, y + v))
                look(thin_.place(x + u, y + v));
    }

    void find_pixels() {
        degree_.assign(thin_.ink.size(), 0);
        node_of_.assign(thin_.ink.size(), kNoNode);
        walked_.assign(thin_.ink.size(), 0);
        for (size_t place = 0; place < thin_.ink.size(); place++) {
            if (thin_.ink[place] == 0) continue;
            pixels_.push_back(place);
            each_neighbour(place, [&](size_t) { degree_[place]++; });
        }
    }

    // Junctions side by side are one.
    void find_nodes() {
        std::vector<size_t> members;
        for (const size_t first : pixels_) {
            if (node_of_[first] != kNoNode || (degree_[first] != 1 && degree_[first] < 3)) continue;
            const auto node = static_cast<uint32_t>(graph_.nodes.size());
            LineNode made;
            members.assign(1, first);
            node_of_[first] = node;
            for (size_t i = 0; i < members.size(); i++) {
                made.depth = std::max(made.depth, static_cast<double>(depths_[members[i]]));
                if (degree_[members[i]] < 3) continue;
                each_neighbour(members[i], [&](size_t next) {
                    if (degree_[next] < 3 || node_of_[next] != kNoNode) return;
                    node_of_[next] = node;
                    members.push_back(next);
                });
            }
            graph_.nodes.push_back(std::move(made));
        }
    }

    void walk_edges() {
        for (const size_t first : pixels_) {
            if (node_of_[first] == kNoNode) continue;
            each_neighbour(first, [&](size_t next) {
                if (walked_[next] != 0 || node_of_[next] == node_of_[first]) return;
                // Two nodes side by side: once, and not from both.
                if (node_of_[next] != kNoNode && node_of_[next] < node_of_[first]) return;
                walk(first, next);
            });
        }
    }

    void walk_rings() {
        for (const size_t first : pixels_) {
            if (node_of_[first] != kNoNode || walked_[first] != 0 || degree_[first] != 2) continue;
            size_t next = first;
            each_neighbour(first, [&](size_t at) { next = at; });
            walked_[first] = 1;
            walk(first, next);
        }
    }

    void walk(size_t first, size_t next) {
        LineEdge edge;
        edge.points = {middle(first)};
        edge.nodes[0] = node_of_[first] == kNoNode ? LineEdge::kNone : node_of_[first];
        size_t before = first, at = next;
        while (node_of_[at] == kNoNode && at != first) {
            walked_[at] = 1;
            edge.points.push_back(middle(at));
            size_t onward = at;
            each_neighbour(at, [&](size_t other) {
                if (other != before) onward = other;
            });
            before = at;
            at = onward;
        }
        edge.points.push_back(middle(at));
        edge.nodes[1] = node_of_[at] == kNoNode ? LineEdge::kNone : node_of_[at];
        edge.length = line_length(edge.points);
        if (graph_.edges.size() == kMostEdges)
            throw Error(
                who_ +
                " shows more lines than a drawing of a tree has. Draw a few dark lines on light paper.");
        graph_.edges.push_back(std::move(edge));
    }

    DVec2 middle(size_t place) const {
        return {static_cast<double>(place % static_cast<size_t>(thin_.width)) + 0.5,
                static_cast<double>(place / static_cast<size_t>(thin_.width)) + 0.5};
    }

    const LineMask& thin_;
    const std::vector<float>& depths_;
    const std::string& who_;
    LineGraph graph_;
    std::vector<size_t> pixels_;
    std::vector<uint8_t> degree_, walked_;
    std::vector<uint32_t> node_of_;
};

void link(LineGraph& graph) {
    for (LineNode& node : graph.nodes) {
        node.edges.clear();
        node.ends.clear();
    }
    for (size_t e = 0; e < graph.edges.size(); e++)
        for (size_t end = 0; end < 2; end++) {
            const LineEdge& edge = graph.edges[e];
            if (!edge.alive || edge.nodes[end] == LineEdge::kNone) continue;
            graph.nodes[edge.nodes[end]].edges.push_back(e);
            graph.nodes[edge.nodes[end]].ends.push_back(end);
        }
}

// Takes spurs away, the shortest first: the next one may be the end of a line by then.
class Pruner {
  public:
    explicit Pruner(LineGraph& graph) : graph_(graph) {}

    void run() {
        link(graph_);
        for (size_t e = 0; e < graph_.edges.size(); e++)
            wait(e);
        while (!waiting_.empty()) {
            const size_t e = waiting_.begin()->second;
            waiting_.erase(waiting_.begin());
            if (is_spur(graph_.edges[e])) remove(e);
        }
    }

  private:
    size_t degree(size_t node) const { return graph_.nodes[node].edges.size(); }

    bool is_spur(const LineEdge& edge) const {
        if (!edge.alive || edge.nodes[0] == LineEdge::kNone) return false;
        for (size_t end = 0; end < 2; end++) {
            const size_t tip = edge.nodes[end], junction = edge.nodes[1 - end];
            if (degree(tip) == 1 && degree(junction) >= 3)
                return edge.length <= 2.0 * graph_.nodes[junction].depth;
        }
        return false;
    }

    void wait(size_t e) {
        if (is_spur(graph_.edges[e])) waiting_.insert({graph_.edges[e].length, e});
    }

    void unlink(size_t node, size_t e, size_t end) {
        LineNode& from = graph_.nodes[node];
        for (size_t i = 0; i < from.edges.size(); i++)
            if (from.edges[i] == e && from.ends[i] == end) {
                from.edges.erase(from.edges.begin() + static_cast<std::ptrdiff_t>(i));
                from.ends.erase(from.ends.begin() + static_cast<std::ptrdiff_t>(i));
                return;
            }
    }

    void remove(size_t e) {
        graph_.edges[e].alive = false;
        const std::array<size_t, 2> nodes = graph_.edges[e].nodes;
        for (size_t end = 0; end < 2; end++)
            unlink(nodes[end], e, end);
        for (const size_t node : nodes)
            if (degree(node) == 2) join(node);
    }

    // Makes one line of the two at a node, or a ring of a loop.
    void join(size_t node) {
        const std::vector<size_t> both = graph_.nodes[node].edges, ends = graph_.nodes[node].ends;
        graph_.nodes[node].edges.clear();
        graph_.nodes[node].ends.clear();
        LineEdge& first = graph_.edges[both[0]];
        if (both[0] == both[1]) {
            first.points.push_back(first.points.front());
            first.nodes = {LineEdge::kNone, LineEdge::kNone};
            return;
        }
        LineEdge& second = graph_.edges[both[1]];
        // Into the node, and out of it.
        if (ends[0] == 0) std::reverse(first.points.begin(), first.points.end());
        if (ends[1] == 1) std::reverse(second.points.begin(), second.points.end());
        LineEdge whole;
        whole.points = std::move(first.points);
        whole.points.insert(whole.points.end(), second.points.begin(), second.points.end());
        whole.length = line_length(whole.points);
        first.alive = second.alive = false;
        const size_t made = graph_.edges.size();
        const std::array<size_t, 2> old_ends = {1 - ends[0], 1 - ends[1]};
        for (size_t i = 0; i < 2; i++) {
            const size_t far = graph_.edges[both[i]].nodes[old_ends[i]];
            unlink(far, both[i], old_ends[i]);
            graph_.nodes[far].edges.push_back(made);
            graph_.nodes[far].ends.push_back(i);
            whole.nodes[i] = far;
        }
        graph_.edges.push_back(std::move(whole));
        wait(made);
    }

    LineGraph& graph_;
    std::set<std::pair<double, size_t>> waiting_;
};

// Junctions so near to one another that their ink is one: where thick lines cross, thinning leaves two.
void unite_junctions(LineGraph& graph) {
    link(graph);
    std::vector<size_t> parent(graph.nodes.size());
    std::iota(parent.begin(), parent.end(), size_t{0});
    const auto root = [&](size_t node) {
        while (parent[node] != node)
            node = parent[node] = parent[parent[node]];
        return node;
    };
    for (LineEdge& edge : graph.edges) {
        if (!edge.alive || edge.nodes[0] == LineEdge::kNone) continue;
        const LineNode &a = graph.nodes[edge.nodes[0]], &b = graph.nodes[edge.nodes[1]];
        if (a.edges.size() < 3 || b.edges.size() < 3 ||
            edge.length > kNearJunctions + 1.2 * (a.depth + b.depth))
            continue;
        edge.alive = false;
        const size_t into = root(edge.nodes[0]), from = root(edge.nodes[1]);
        parent[std::max(into, from)] = std::min(into, from);
    }
    for (size_t i = 0; i < graph.nodes.size(); i++)
        graph.nodes[root(i)].depth = std::max(graph.nodes[root(i)].depth, graph.nodes[i].depth);
    for (LineEdge& edge : graph.edges)
        for (size_t& node : edge.nodes)
            if (node != LineEdge::kNone) node = root(node);
    link(graph);
}

}  // namespace

LineGraph graph_of_lines(const LineMask& thin, const std::vector<float>& depths, const std::string& who) {
    LineGraph graph = Builder(thin, depths, who).build();
    Pruner(graph).run();
    unite_junctions(graph);
    return graph;
}

}  // namespace treerec
