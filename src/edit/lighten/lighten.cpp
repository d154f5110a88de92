#include "edit/lighten/lighten.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <queue>
#include <string>

#include "edit/lighten/lighten_net.h"
#include "error.h"
#include "geometry/portable_math.h"
#include "geometry/segment.h"

namespace treerec {

namespace {

// Runs of more dropped nodes are judged by what was found for their halves, so that no step takes long.
constexpr int32_t kLongRun = 64;
// A leaf looks at so many siblings on either side for one that stands for it.
constexpr int kNeighbours = 8;
// Square metres, far below what can be seen.
constexpr double kPerNode = 1e-15;

class Lightener {
  public:
    Lightener(Tree& tree, const LightenOptions& options, const Progress* progress)
        : tree_(tree),
          net_(tree),
          original_(net_.nodes),
          continues_(continuing_nodes(tree)),
          progress_(progress),
          options_(options),
          bounded_(options.nodes == 0),
          least_cosine_(portable::cos(options.angle * std::numbers::pi / 180.0)),
          state_(net_.nodes.size()) {
        if (options.below == kNoNode) return;
        const std::vector<NodeId> branch = tree.depth_first(options.below);
        left_ = branch.size();
        stays_.assign(net_.nodes.size(), 1);
        for (NodeId id : branch)
            stays_[id] = 0;
        stays_[options.below] = 1;
    }

    Lightened run() {
        size_t left = left_;
        std::vector<Step> first;
        first.reserve(left);
        for (NodeId id = 0; id < tree_.id_end(); id++)
            if (original_[id].depth > 0)
                if (const std::optional<Step> step = step_at(id)) first.push_back(*step);
        steps_ = Steps(std::greater<Step>(), std::move(first));
        double tip_distance = 0.0;
        while (!steps_.empty() && (bounded_ || left > options_.nodes)) {
            check();
            const Step step = steps_.top();
            steps_.pop();
            if (step.version != state_[step.id].version || net_.nodes[step.id].depth == 0) continue;
            if (net_.nodes[step.id].child_count == 1) {
                drop_node(step.id);
            } else {
                // Siblings come and go without a word to it.
                const std::optional<Step> now = step_at(step.id);
                if (!now) continue;
                if (*now > step) {
                    steps_.push(*now);
                    continue;
                }
                tip_distance = std::max(tip_distance, drop_leaf(step.id));
            }
            left--;
        }
        Lightened result = net_.hand_over(tree_, continues_);
        result.tip_distance = tip_distance;
        return result;
    }

  private:
    // One thing that can be done: the node goes. The least comes first.
    struct Step {
        double cost;  // square metres of silhouette
        NodeId id;
        uint32_t version;  // of the node when this was found

        bool operator>(const Step& other) const {
            return cost != other.cost ? cost > other.cost : id > other.id;
        }
    };
    using Steps = std::priority_queue<Step, std::vector<Step>, std::greater<Step>>;

    // Of the segment from a node to its parent, and of a leaf.
    struct State {
        RunError run;
        RunError joined;     // once the node goes; of a node with one child that has a step
        double reach = 0.0;  // of the tips that this wood stands for
        uint32_t version = 0;
    };

    // The wood beside a leaf that stands for it once it has gone.
    struct Stand {
        NodeId sibling = kNoNode;
        double distance = std::numeric_limits<double>::infinity();  // of the leaf's tip from it
    };

    void check() {
        if (progress_ && ++count_ % 1024 == 0) progress_->check();
    }

    bool is_leaf(NodeId id) const { return net_.nodes[id].child_count == 0; }
    const DVec3& place(NodeId id) const { return net_.nodes[id].position; }

    // The error of one segment in place of those at `id` and at its child.
    RunError joined_error(NodeId id) const {
        const Node& node = net_.nodes[id];
        const RunError &lower = state_[id].run, &upper = state_[node.first_child].run;
        const int32_t count = lower.count + upper.count + 1;
        if (count <= kLongRun)
            return run_error(original_, continues_, node.parent, node.first_child, place(node.parent),
                             place(node.first_child));
        const double off = distance_to_segment(node.position, place(node.parent), place(node.first_child));
        const double length = glm::distance(place(node.parent), place(node.first_child));
        return {std::max(lower.deviation, upper.deviation) + off,
                lower.area + upper.area + length * std::min(off, 4.0 * node.radius), count};
    }

    // What can be done at a node, if anything.
    std::optional<Step> step_at(NodeId id) {
        const Node& node = net_.nodes[id];
        if (node.parent == kNoNode || node.child_count > 1) return std::nullopt;
        if (!stays_.empty() && stays_[id]) return std::nullopt;
        if (node.child_count == 0) return leaf_step(id);
        if (node.is_trunk() && !net_.nodes[node.first_child].is_trunk()) return std::nullopt;
        if (bounded_ && net_.turn_cosine(id) <= least_cosine_) return std::nullopt;
        const RunError error = joined_error(id);
        if (bounded_ && error.deviation > options_.deviation) return std::nullopt;
        const double spent = state_[id].run.area + state_[node.first_child].run.area;
        state_[id].joined = error;
        // Of equals the one with the fewest nodes in its run, so that runs of a straight chain grow evenly.
        return Step{std::max(error.area - spent, 0.0) + kPerNode * error.count, id, state_[id].version};
    }

    std::optional<Step> leaf_step(NodeId id) const {
        const Node& node = net_.nodes[id];
        if (node.is_trunk() || net_.nodes[node.parent].child_count < 2) return std::nullopt;
        const Stand stand = stand_for(id);
        if (stand.sibling == kNoNode) return std::nullopt;
        // What is not hidden by the wood beside it: the two part as they go up.
        const double length = glm::distance(node.position, place(node.parent));
        const double cost = length * std::min(2.0 * node.radius, 0.5 * stand.distance);
        return Step{std::max(cost - state_[id].run.area, 0.0), id, state_[id].version};
    }

    Stand stand_for(NodeId id) const {
        Stand best;
        const auto look = [&](NodeId sibling) {
            const double distance =
                distance_to_segment(place(id), place(net_.nodes[id].parent), place(sibling));
            if (bounded_ && state_[id].reach + distance > options_.distance) return;
            if (distance < best.distance || (distance == best.distance && sibling < best.sibling))
                best = {sibling, distance};
        };
        NodeId before = net_.nodes[id].previous_sibling, after = net_.nodes[id].next_sibling;
        for (int i = 0; i < kNeighbours && before != kNoNode; i++) {
            look(before);
            before = net_.nodes[before].previous_sibling;
        }
        for (int i = 0; i < kNeighbours && after != kNoNode; i++) {
            look(after);
            after = net_.nodes[after].next_sibling;
        }
        return best;
    }

    void find_again(NodeId id) {
        state_[id].version++;
        if (const std::optional<Step> step = step_at(id)) steps_.push(*step);
    }

    // The leaf's siblings within its sight, for which it may stand.
    void find_beside(NodeId leaf) {
        NodeId at = net_.nodes[leaf].previous_sibling;
        for (int i = 0; i < kNeighbours && at != kNoNode; i++, at = net_.nodes[at].previous_sibling)
            if (is_leaf(at)) find_again(at);
        at = net_.nodes[leaf].next_sibling;
        for (int i = 0; i < kNeighbours && at != kNoNode; i++, at = net_.nodes[at].next_sibling)
            if (is_leaf(at)) find_again(at);
    }

    void drop_node(NodeId id) {
        const RunError error = state_[id].joined;
        const NodeId parent = net_.nodes[id].parent, child = net_.nodes[id].first_child;
        // The longer part says whether the whole is a guess.
        const bool lower_is_longer =
            glm::distance(place(parent), place(id)) > glm::distance(place(id), place(child));
        if (net_.nodes[id].is_guess() != net_.nodes[child].is_guess() && lower_is_longer) {
            net_.nodes[child].flags ^= kGuessFlag;
            net_.mark_changed(child);
        }
        net_.drop(id);
        state_[child].run = error;
        state_[child].reach = std::max(state_[child].reach, state_[id].reach);
        if (net_.nodes[parent].child_count == 1) find_again(parent);
        find_again(child);
        if (is_leaf(child)) find_beside(child);
    }

    // Returns how far the one that stands for it lies from all that it stood for.
    double drop_leaf(NodeId id) {
        const Stand stand = stand_for(id);
        const NodeId parent = net_.nodes[id].parent;
        const double reach = state_[id].reach + stand.distance;
        state_[stand.sibling].reach = std::max(state_[stand.sibling].reach, reach);
        net_.drop(id);
        if (is_leaf(stand.sibling)) find_again(stand.sibling);
        if (net_.nodes[parent].child_count == 1) find_again(parent);
        return reach;
    }

    Tree& tree_;
    LooseTree net_;
    const std::vector<Node> original_;
    const std::vector<uint8_t> continues_;
    const Progress* progress_;
    const LightenOptions options_;
    const bool bounded_;
    const double least_cosine_;
    std::vector<State> state_;
    std::vector<uint8_t> stays_;  // by id; empty: any node may go
    size_t left_ = tree_.size();  // nodes of what becomes lighter
    Steps steps_;
    uint32_t count_ = 0;
};

}  // namespace

Lightened lighten(Tree& tree, const LightenOptions& options, const Progress* progress) {
    if (!(options.angle >= 0.0 && options.angle <= 180.0))
        throw Error("The angle must lie between 0 and 180 degrees.");
    for (double length : {options.distance, options.deviation})
        if (!(length >= 0.0 && std::isfinite(length)))
            throw Error("Distance and deviation must be numbers of metres that are not negative.");
    if (options.below != kNoNode && !tree.contains(options.below))
        throw Error("The tree has no node " + std::to_string(options.below) + ".");
    if (options.nodes == 1) throw Error("A tree is left with 2 nodes at least.");
    return Lightener(tree, options, progress).run();
}

}  // namespace treerec
