#include "exchange/skeleton_graph.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "error.h"

namespace treerec {

namespace {

constexpr double kLowest = 0.02;  // of the height, where a tree begins

// Neighbours of every node, by number.
struct Neighbours {
    std::vector<size_t> begin;
    std::vector<NodeId> ids;

    Neighbours(size_t count, const std::vector<std::pair<NodeId, NodeId>>& edges)
        : begin(count + 1, 0), ids(2 * edges.size()) {
        for (const auto& [a, b] : edges) {
            begin[static_cast<size_t>(a) + 1]++;
            begin[static_cast<size_t>(b) + 1]++;
        }
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        std::vector<size_t> next = begin;
        for (const auto& [a, b] : edges) {
            ids[next[static_cast<size_t>(a)]++] = b;
            ids[next[static_cast<size_t>(b)]++] = a;
        }
        for (size_t i = 0; i < count; i++)
            std::sort(ids.begin() + static_cast<ptrdiff_t>(begin[i]),
                      ids.begin() + static_cast<ptrdiff_t>(begin[i + 1]));
    }
    size_t degree(NodeId id) const {
        return begin[static_cast<size_t>(id) + 1] - begin[static_cast<size_t>(id)];
    }
};

// By vertex, the first one at its place.
std::vector<NodeId> first_at_place(const std::vector<DVec3>& positions) {
    std::vector<NodeId> order(positions.size()), first(positions.size());
    std::iota(order.begin(), order.end(), 0);
    const auto before = [&](NodeId a, NodeId b) {
        const DVec3 &p = positions[a], &q = positions[b];
        if (p.x != q.x) return p.x < q.x;
        if (p.y != q.y) return p.y < q.y;
        return p.z != q.z ? p.z < q.z : a < b;
    };
    std::sort(order.begin(), order.end(), before);
    for (size_t i = 0; i < order.size(); i++)
        first[order[i]] =
            i > 0 && positions[order[i]] == positions[order[i - 1]] ? first[order[i - 1]] : order[i];
    return first;
}

// The nodes that hang together with `from`, nearest first, each after the one it is reached by.
std::vector<NodeId> reach(NodeId from, const Neighbours& neighbours, std::vector<NodeId>& reached_by) {
    std::vector<NodeId> found{from};
    reached_by[from] = from;
    for (size_t i = 0; i < found.size(); i++)
        for (size_t k = neighbours.begin[found[i]]; k < neighbours.begin[static_cast<size_t>(found[i]) + 1];
             k++) {
            NodeId& by = reached_by[neighbours.ids[k]];
            if (by != kNoNode) continue;
            by = found[i];
            found.push_back(neighbours.ids[k]);
        }
    return found;
}

}  // namespace

size_t choose_tree(const std::vector<size_t>& sizes, const SkeletonChoice& choice, const std::string& path,
                   SkeletonReport* report) {
    const size_t count = sizes.size();
    const auto nodes = [&](size_t i) {
        return std::to_string(sizes[i]) + (sizes[i] == 1 ? " node" : " nodes");
    };
    if (choice.tree > count)
        throw Error("'" + path + "' holds " + (count == 1 ? "one tree" : std::to_string(count) + " trees") +
                    "; there is no tree " + std::to_string(choice.tree) + ".");
    const size_t largest = static_cast<size_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    const size_t taken = choice.tree > 0 ? choice.tree - 1 : largest;
    if (!report) return taken;
    report->trees = count;
    report->taken = taken + 1;
    if (count > 1 && choice.tree == 0)
        report->warnings.push_back("'" + path + "' holds " + std::to_string(count) +
                                   " trees; the largest, tree " + std::to_string(taken + 1) + " with " +
                                   nodes(taken) + ", was taken. Ask for another one by its number (--tree).");
    return taken;
}

SkeletonTable tree_of_graph(const SkeletonTable& table, const std::vector<std::pair<NodeId, NodeId>>& edges,
                            const SkeletonChoice& choice, const std::string& path, SkeletonReport* report) {
    const size_t count = table.positions.size();
    for (size_t i = 0; i < count; i++)
        if (!is_finite(table.positions[i]) || !(table.radii[i] >= 0.0))
            throw Error("'" + path + "' is damaged: a vertex has no place or a radius below zero.");
    const std::vector<NodeId> first = first_at_place(table.positions);
    std::vector<double> radii(count, 0.0);
    for (size_t i = 0; i < count; i++)
        radii[first[i]] = std::max(radii[first[i]], table.radii[i]);
    std::vector<std::pair<NodeId, NodeId>> joined;
    for (const auto& [a, b] : edges)
        if (first[a] != first[b]) joined.emplace_back(first[a], first[b]);
    const Neighbours neighbours(count, joined);
    std::vector<NodeId> reached_by(count, kNoNode);
    std::vector<size_t> sizes;
    std::vector<NodeId> firsts;
    for (size_t i = 0; i < count; i++) {
        const NodeId id = static_cast<NodeId>(i);
        if (reached_by[i] != kNoNode || neighbours.degree(id) == 0) continue;
        sizes.push_back(reach(id, neighbours, reached_by).size());
        firsts.push_back(id);
    }
    if (sizes.empty()) throw Error("'" + path + "' holds no skeleton: no edge joins two nodes.");

    std::fill(reached_by.begin(), reached_by.end(), kNoNode);
    const std::vector<NodeId> piece =
        reach(firsts[choose_tree(sizes, choice, path, report)], neighbours, reached_by);
    ScanFrame frame;
    frame.up = choice.up;
    frame.origin = table.positions[piece[0]];
    const auto height = [&](NodeId id) { return frame.to_tree(table.positions[id]).y; };
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (NodeId id : piece) {
        low = std::min(low, height(id));
        high = std::max(high, height(id));
    }
    NodeId root = kNoNode;
    for (const bool ends_only : {true, false}) {
        for (NodeId id : piece) {
            if ((ends_only && neighbours.degree(id) != 1) || height(id) > low + kLowest * (high - low))
                continue;
            if (root == kNoNode || radii[id] > radii[root] ||
                (radii[id] == radii[root] &&
                 (height(id) < height(root) || (height(id) == height(root) && id < root))))
                root = id;
        }
        if (root != kNoNode) break;
    }

    for (NodeId id : piece)
        reached_by[id] = kNoNode;
    const std::vector<NodeId> order = reach(root, neighbours, reached_by);
    std::vector<NodeId> row(count, kNoNode);
    SkeletonTable tree;
    for (NodeId id : order) {
        row[id] = static_cast<NodeId>(tree.positions.size());
        tree.positions.push_back(table.positions[id]);
        tree.radii.push_back(radii[id]);
        tree.flags.push_back(table.flags[id]);
        tree.parents.push_back(id == root ? kNoNode : row[reached_by[id]]);
    }
    return tree;
}

SkeletonTable chosen_tree(const SkeletonTable& table, const SkeletonChoice& choice, const std::string& path,
                          SkeletonReport* report) {
    const size_t count = table.parents.size();
    std::vector<NodeId> root(count, kNoNode);
    std::vector<NodeId> way;
    for (size_t i = 0; i < count; i++) {
        NodeId at = static_cast<NodeId>(i);
        way.clear();
        while (root[at] == kNoNode && table.parents[at] != kNoNode) {
            way.push_back(at);
            if (way.size() > count) throw Error("'" + path + "' is damaged: its nodes hang in a ring.");
            at = table.parents[at];
        }
        const NodeId found = root[at] == kNoNode ? at : root[at];
        root[at] = found;
        for (NodeId id : way)
            root[id] = found;
    }
    std::vector<NodeId> roots;
    std::vector<size_t> sizes, number(count, 0);
    for (size_t i = 0; i < count; i++) {
        if (table.parents[i] != kNoNode) continue;
        number[i] = roots.size();
        roots.push_back(static_cast<NodeId>(i));
        sizes.push_back(0);
    }
    for (size_t i = 0; i < count; i++)
        sizes[number[root[i]]]++;
    const NodeId wanted = roots[choose_tree(sizes, choice, path, report)];
    SkeletonTable tree;
    std::vector<NodeId> row(count, kNoNode);
    for (size_t i = 0; i < count; i++) {
        if (root[i] != wanted) continue;
        row[i] = static_cast<NodeId>(tree.positions.size());
        tree.positions.push_back(table.positions[i]);
        tree.radii.push_back(table.radii[i]);
        tree.flags.push_back(table.flags[i]);
        tree.parents.push_back(table.parents[i]);
    }
    for (NodeId& parent : tree.parents)
        if (parent != kNoNode) parent = row[parent];
    return tree;
}

}  // namespace treerec
