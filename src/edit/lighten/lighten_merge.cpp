// The paper's merging (Zhang 2013, algorithms 8 and 9).
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "edit/lighten/lighten.h"
#include "edit/lighten/lighten_net.h"
#include "error.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

// Beyond so many leaves on one fork pairs are looked for in cells; both ways find the same.
constexpr size_t kFewTips = 48;

class Merger {
  public:
    // top: only what grows from it is merged.
    Merger(Tree& tree, NodeId top, const Progress* progress)
        : tree_(tree), top_(top), net_(tree), progress_(progress), reach_(net_.nodes.size(), 0.0) {}

    // Runs everything and hands the result over to the tree.
    Lightened run(double angle, double distance) {
        least_cosine_ = portable::cos(angle * std::numbers::pi / 180.0);
        distance_ = distance;
        const bool turns = angle > 0.0;
        std::vector<NodeId> forks;
        if (!tree_.empty())
            for (NodeId id : tree_.depth_first(top_))
                if (id == top_ || net_.nodes[id].child_count > 1) forks.push_back(id);
        if (turns)
            for (NodeId fork : forks)
                for (NodeId at = net_.nodes[fork].first_child; at != kNoNode;) {
                    // The run may hand its place among the children on to another node.
                    const NodeId first = merge_run(at);
                    at = net_.nodes[first].next_sibling;
                }
        // Merged leaves make runs, and merged runs put leaves on forks.
        while (distance_ > 0.0 && !forks.empty()) {
            std::vector<NodeId> joined, next;
            for (NodeId fork : forks) {
                check();
                const bool merged = merge_leaves_of(fork);
                if (merged && net_.nodes[fork].child_count == 1 && fork != top_) joined.push_back(fork);
            }
            if (!turns) break;
            for (NodeId fork : joined) {
                NodeId first = fork;
                while (!starts_run(first))
                    first = net_.nodes[first].parent;
                first = merge_run(first);
                if (net_.nodes[first].child_count == 0) next.push_back(net_.nodes[first].parent);
            }
            std::sort(next.begin(), next.end());
            next.erase(std::unique(next.begin(), next.end()), next.end());
            forks = std::move(next);
        }
        Lightened result = net_.hand_over(tree_, continuing_nodes(tree_));
        for (double reach : reach_)
            result.tip_distance = std::max(result.tip_distance, reach);
        return result;
    }

  private:
    void check() {
        if (progress_ && ++steps_ % 1024 == 0) progress_->check();
    }

    bool starts_run(NodeId id) const {
        const NodeId parent = net_.nodes[id].parent;
        return parent == top_ || net_.nodes[parent].child_count > 1;
    }

    // Returns the node that stands at the run's beginning now.
    NodeId merge_run(NodeId first) {
        NodeId at = first;
        while (net_.nodes[at].child_count == 1) {
            check();
            const Node& node = net_.nodes[at];
            const NodeId parent = node.parent, child = node.first_child;
            if (net_.turn_cosine(at) <= least_cosine_) {
                at = child;
                continue;
            }
            if (node.is_trunk() && !net_.nodes[child].is_trunk()) net_.set_flag(child, kTrunkFlag);
            net_.drop(at);
            // The node below has another neighbour now.
            const bool was_first = at == first;
            if (was_first) first = child;
            at = was_first ? child : parent;
        }
        return first;
    }

    // Joins leaf `j` of the fork to leaf `i`.
    void join(NodeId i, NodeId j) {
        Node &kept = net_.nodes[i], &gone = net_.nodes[j];
        const DVec3 middle = 0.5 * (kept.position + gone.position);
        reach_[i] = std::max(reach_[i], reach_[j]) + 0.5 * glm::distance(kept.position, gone.position);
        reach_[j] = 0.0;
        kept.position = middle;
        kept.radius = std::max(kept.radius, gone.radius);
        kept.flags = static_cast<uint8_t>(((kept.flags | gone.flags) & kTrunkFlag) |
                                          (kept.flags & gone.flags & ~kTrunkFlag));
        net_.mark_changed(i);
        net_.drop(j);
    }

    bool near(NodeId i, NodeId j) const {
        return glm::distance(net_.nodes[i].position, net_.nodes[j].position) < distance_;
    }

    // Returns whether anything was merged.
    bool merge_leaves_of(NodeId fork) {
        tips_.clear();
        for (NodeId at = net_.nodes[fork].first_child; at != kNoNode; at = net_.nodes[at].next_sibling)
            if (net_.nodes[at].child_count == 0) tips_.push_back(at);
        if (tips_.size() < 2) return false;
        const size_t before = tips_.size();
        size_t left = before;
        if (before > kFewTips) fill_cells();
        const auto find = [&](size_t from, size_t to, size_t to_what) {
            return before > kFewTips ? find_in_cells(from, to, to_what) : find_among(from, to, to_what);
        };
        for (size_t i = 0; i < tips_.size(); i++) {
            if (tips_[i] == kNoNode) continue;
            size_t at = i;
            while (true) {
                check();
                // A moved leaf may have come near an earlier one, which then is the first of the pair.
                size_t other = find(0, at, at);
                if (other < at) {
                    std::swap(at, other);
                } else {
                    other = find(at + 1, tips_.size(), at);
                    if (other == tips_.size()) break;
                }
                if (before > kFewTips) {
                    cell_of(at).erase(at);
                    cell_of(other).erase(other);
                }
                join(tips_[at], tips_[other]);
                tips_[other] = kNoNode;
                left--;
                if (before > kFewTips) cell_of(at).insert(at);
            }
        }
        return left < before;
    }

    // The first of from..to-1 that is near tip `what`, or `to`.
    size_t find_among(size_t from, size_t to, size_t what) const {
        for (size_t i = from; i < to; i++)
            if (tips_[i] != kNoNode && near(tips_[i], tips_[what])) return i;
        return to;
    }

    using Cell = std::array<double, 3>;
    Cell key_of(const DVec3& p) const {
        return {std::floor(p.x / distance_), std::floor(p.y / distance_), std::floor(p.z / distance_)};
    }
    std::set<size_t>& cell_of(size_t i) { return cells_[key_of(net_.nodes[tips_[i]].position)]; }
    void fill_cells() {
        cells_.clear();
        for (size_t i = 0; i < tips_.size(); i++)
            cell_of(i).insert(cell_of(i).end(), i);
    }
    size_t find_in_cells(size_t from, size_t to, size_t what) const {
        const Cell middle = key_of(net_.nodes[tips_[what]].position);
        size_t found = to;
        for (int n = 0; n < 27; n++) {
            const auto cell =
                cells_.find({middle[0] + n % 3 - 1.0, middle[1] + n / 3 % 3 - 1.0, middle[2] + n / 9 - 1.0});
            if (cell == cells_.end()) continue;
            for (auto i = cell->second.lower_bound(from); i != cell->second.end() && *i < found; ++i)
                if (near(tips_[*i], tips_[what])) found = *i;
        }
        return found;
    }

    Tree& tree_;
    const NodeId top_;
    LooseTree net_;
    const Progress* progress_;
    std::vector<double> reach_;  // of a leaf: how far those lay that it stands for
    std::vector<NodeId> tips_;   // of the fork at hand; kNoNode once merged
    std::map<Cell, std::set<size_t>> cells_;
    double least_cosine_ = 1.0;
    double distance_ = 0.0;
    uint32_t steps_ = 0;
};

void require_angle(double angle) {
    if (!(angle >= 0.0 && angle <= 180.0)) throw Error("The angle must lie between 0 and 180 degrees.");
}

void require_distance(double distance) {
    if (!(distance >= 0.0 && std::isfinite(distance)))
        throw Error("The distance must be a number of metres that is not negative.");
}

}  // namespace

Lightened merge_turns(Tree& tree, double angle, const Progress* progress) {
    return merge_branches(tree, angle, 0.0, progress);
}

Lightened merge_tips(Tree& tree, double distance, const Progress* progress) {
    return merge_branches(tree, 0.0, distance, progress);
}

Lightened merge_branches(Tree& tree, double angle, double distance, const Progress* progress, NodeId below) {
    require_angle(angle);
    require_distance(distance);
    if (below != kNoNode && !tree.contains(below))
        throw Error("The tree has no node " + std::to_string(below) + ".");
    return Merger(tree, below != kNoNode ? below : tree.root(), progress).run(angle, distance);
}

}  // namespace treerec
