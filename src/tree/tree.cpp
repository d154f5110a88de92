#include "tree/tree.h"

#include <algorithm>

#include "error.h"

namespace treerec {

namespace {

void require_finite(const DVec3& position) {
    if (!is_finite(position)) throw Error("A node's position must be finite numbers.");
}

void require_radius(double radius) {
    if (!(radius > 0.0) || !std::isfinite(radius))
        throw Error("A node's radius must be positive and finite.");
}

constexpr size_t kMostNodes = size_t{1} << 24;

}  // namespace

void Tree::require(NodeId id) const {
    if (!contains(id)) throw Error("There is no node " + std::to_string(id) + " in this tree.");
}

NodeId Tree::new_node(const DVec3& position, double radius, uint8_t flags, uint8_t leaf_rule,
                      uint16_t section) {
    require_finite(position);
    require_radius(radius);
    Node node;
    node.position = position;
    node.radius = radius;
    node.flags = flags;
    node.leaf_rule = leaf_rule;
    node.section = section;
    node.depth = 1;
    nodes_.push_back(node);
    count_++;
    return id_end() - 1;
}

void Tree::link_last(NodeId id, NodeId parent) {
    Node& child = nodes_[id];
    Node& host = nodes_[parent];
    child.parent = parent;
    child.previous_sibling = host.last_child;
    child.next_sibling = kNoNode;
    if (host.last_child != kNoNode)
        nodes_[host.last_child].next_sibling = id;
    else
        host.first_child = id;
    host.last_child = id;
    host.child_count++;
}

void Tree::unlink(NodeId id) {
    Node& child = nodes_[id];
    if (child.parent == kNoNode) return;
    Node& host = nodes_[child.parent];
    if (child.previous_sibling != kNoNode)
        nodes_[child.previous_sibling].next_sibling = child.next_sibling;
    else
        host.first_child = child.next_sibling;
    if (child.next_sibling != kNoNode)
        nodes_[child.next_sibling].previous_sibling = child.previous_sibling;
    else
        host.last_child = child.previous_sibling;
    host.child_count--;
    child.parent = child.previous_sibling = child.next_sibling = kNoNode;
}

void Tree::update_depths(NodeId from) {
    for (NodeId id : depth_first(from)) {
        Node& node = nodes_[id];
        node.depth = node.parent == kNoNode ? 1 : nodes_[node.parent].depth + 1;
    }
}

NodeId Tree::add_root(const DVec3& position, double radius, uint8_t flags) {
    if (!empty()) throw Error("The tree has a root already.");
    root_ = new_node(position, radius, flags, 0);
    return root_;
}

NodeId Tree::add_child(NodeId parent, const DVec3& position, double radius, uint8_t flags) {
    require(parent);
    const NodeId id = new_node(position, radius, flags, nodes_[parent].leaf_rule);
    link_last(id, parent);
    nodes_[id].depth = nodes_[parent].depth + 1;
    return id;
}

void Tree::set_position(NodeId id, const DVec3& position) {
    require(id);
    require_finite(position);
    nodes_[id].position = position;
}

void Tree::set_radius(NodeId id, double radius) {
    require(id);
    require_radius(radius);
    nodes_[id].radius = radius;
}

void Tree::set_flag(NodeId id, NodeFlag flag, bool on) {
    require(id);
    uint8_t& flags = nodes_[id].flags;
    flags = on ? static_cast<uint8_t>(flags | flag) : static_cast<uint8_t>(flags & ~flag);
}

uint8_t Tree::name_leaf_rule(const std::string& rule) {
    if (rule.empty()) return 0;
    const auto found = std::find(leaf_rules_.begin(), leaf_rules_.end(), rule);
    const size_t number = static_cast<size_t>(found - leaf_rules_.begin()) + 1;
    if (found == leaf_rules_.end()) {
        if (number > kMostLeafRules)
            throw Error("A tree can have " + std::to_string(kMostLeafRules) +
                        " leaf rules beside its own, and this one has them.");
        leaf_rules_.push_back(rule);
    }
    return static_cast<uint8_t>(number);
}

void Tree::set_leaf_rule(NodeId id, uint8_t number) {
    require(id);
    if (number > leaf_rules_.size()) throw Error("The tree has no leaf rule " + std::to_string(number) + ".");
    nodes_[id].leaf_rule = number;
}

void Tree::drop_unused_leaf_rules() {
    std::vector<uint8_t> moved(leaf_rules_.size() + 1, 0);
    for (const Node& node : nodes_)
        moved[node.leaf_rule] = 1;
    uint8_t next = 0;
    for (size_t number = 1; number < moved.size(); number++) {
        if (!moved[number]) continue;
        moved[number] = ++next;
        if (next < number) leaf_rules_[next - 1u] = std::move(leaf_rules_[number - 1]);
    }
    moved[0] = 0;
    leaf_rules_.resize(next);
    for (Node& node : nodes_)
        node.leaf_rule = moved[node.leaf_rule];
}

std::vector<NodeId> Tree::remove_subtree(NodeId id) {
    require(id);
    std::vector<NodeId> removed = depth_first(id);
    unlink(id);
    for (NodeId gone : removed)
        nodes_[gone] = Node{};
    count_ -= static_cast<int32_t>(removed.size());
    if (id == root_) root_ = kNoNode;
    return removed;
}

void Tree::dissolve(NodeId id) {
    require(id);
    const Node gone = nodes_[id];
    if (id == root_) {
        if (gone.child_count != 1)
            throw Error("The root can be dissolved only while it has exactly one child.");
        const NodeId heir = gone.first_child;
        unlink(heir);
        root_ = heir;
        nodes_[id] = Node{};
        count_--;
        update_depths(root_);
        return;
    }
    splice_out(id);
    for (NodeId child = gone.first_child; child != gone.next_sibling && child != kNoNode;
         child = nodes_[child].next_sibling)
        update_depths(child);
}

void Tree::dissolve_all(const std::vector<NodeId>& ids) {
    std::vector<uint8_t> goes(nodes_.size(), 0);
    for (NodeId id : ids) {
        require(id);
        if (id == root_) throw Error("The root cannot be dissolved together with other nodes.");
        goes[id] = 1;
    }
    // From the root upwards, so that every node moves to its new parent once.
    for (NodeId id : depth_first())
        if (goes[id]) splice_out(id);
    if (!empty()) update_depths(root_);
}

// Removes a node that is not the root; its children stand where it stood. Depths above it are left as they
// are.
void Tree::splice_out(NodeId id) {
    const Node gone = nodes_[id];
    Node& host = nodes_[gone.parent];
    const NodeId before = gone.previous_sibling;
    const NodeId after = gone.next_sibling;
    for (NodeId child : children(id))
        nodes_[child].parent = gone.parent;
    const NodeId first = gone.first_child != kNoNode ? gone.first_child : after;
    const NodeId last = gone.last_child != kNoNode ? gone.last_child : before;
    if (before != kNoNode)
        nodes_[before].next_sibling = first;
    else
        host.first_child = first;
    if (after != kNoNode)
        nodes_[after].previous_sibling = last;
    else
        host.last_child = last;
    if (gone.first_child != kNoNode) {
        nodes_[gone.first_child].previous_sibling = before;
        nodes_[gone.last_child].next_sibling = after;
    }
    host.child_count += gone.child_count - 1;
    nodes_[id] = Node{};
    count_--;
}

NodeId Tree::insert_before(NodeId id, const DVec3& position, double radius, uint8_t flags) {
    require(id);
    if (id == root_) throw Error("Nothing can be inserted below the root.");
    const NodeId middle = new_node(position, radius, flags, nodes_[id].leaf_rule, nodes_[id].section);
    const Node lower = nodes_[id];
    Node& inserted = nodes_[middle];
    inserted.parent = lower.parent;
    inserted.previous_sibling = lower.previous_sibling;
    inserted.next_sibling = lower.next_sibling;
    inserted.first_child = inserted.last_child = id;
    inserted.child_count = 1;
    Node& host = nodes_[lower.parent];
    if (lower.previous_sibling != kNoNode)
        nodes_[lower.previous_sibling].next_sibling = middle;
    else
        host.first_child = middle;
    if (lower.next_sibling != kNoNode)
        nodes_[lower.next_sibling].previous_sibling = middle;
    else
        host.last_child = middle;
    Node& child = nodes_[id];
    child.parent = middle;
    child.previous_sibling = child.next_sibling = kNoNode;
    update_depths(middle);
    return middle;
}

void Tree::reparent(NodeId id, NodeId parent) {
    require(id);
    require(parent);
    for (NodeId at = parent; at != kNoNode; at = nodes_[at].parent)
        if (at == id) throw Error("A node cannot hang under itself.");
    unlink(id);
    link_last(id, parent);
    update_depths(id);
}

void Tree::make_first_child(NodeId id) {
    require(id);
    const NodeId parent = nodes_[id].parent;
    if (parent == kNoNode || nodes_[parent].first_child == id) return;
    unlink(id);
    Node& host = nodes_[parent];
    nodes_[id].parent = parent;
    nodes_[id].next_sibling = host.first_child;
    nodes_[host.first_child].previous_sibling = id;
    host.first_child = id;
    host.child_count++;
}

Tree Tree::compacted() const {
    Tree result;
    result.frame_ = frame_;
    result.leaf_rules_ = leaf_rules_;
    result.sections_ = sections_;
    result.nodes_.reserve(size());
    std::vector<NodeId> moved(nodes_.size(), kNoNode);
    for (NodeId id : depth_first()) {
        const Node& node = nodes_[id];
        moved[id] = node.parent == kNoNode
                        ? result.add_root(node.position, node.radius, node.flags)
                        : result.add_child(moved[node.parent], node.position, node.radius, node.flags);
        result.nodes_[moved[id]].leaf_rule = node.leaf_rule;
        result.nodes_[moved[id]].section = node.section;
    }
    return result;
}

void Tree::rebase(const DVec3& p) {
    require_finite(p);
    frame_.origin = frame_.to_scan(p);
    for (Node& node : nodes_)
        if (node.depth > 0) node.position -= p;
}

void Tree::scale(double factor) {
    require_radius(factor);
    frame_.metres_per_unit *= factor;
    for (Node& node : nodes_) {
        if (node.depth == 0) continue;
        node.position *= factor;
        node.radius *= factor;
    }
}

std::vector<NodeId> Tree::depth_first(NodeId from) const {
    std::vector<NodeId> order;
    if (!contains(from)) return order;
    if (from == root_) order.reserve(size());
    NodeId at = from;
    while (true) {
        order.push_back(at);
        if (nodes_[at].first_child != kNoNode) {
            at = nodes_[at].first_child;
            continue;
        }
        while (at != from && nodes_[at].next_sibling == kNoNode)
            at = nodes_[at].parent;
        if (at == from) return order;
        at = nodes_[at].next_sibling;
    }
}

std::vector<NodeId> Tree::depth_first() const {
    return depth_first(root_);
}

std::vector<NodeId> Tree::breadth_first() const {
    std::vector<NodeId> order;
    if (empty()) return order;
    order.reserve(size());
    order.push_back(root_);
    for (size_t i = 0; i < order.size(); i++)
        for (NodeId child : children(order[i]))
            order.push_back(child);
    return order;
}

std::vector<NodeId> Tree::nodes_of_kind(NodeKind kind) const {
    std::vector<NodeId> found;
    for (NodeId id : breadth_first())
        if (nodes_[id].kind() == kind) found.push_back(id);
    return found;
}

Bounds Tree::bounds() const {
    Bounds box;
    for (const Node& node : nodes_)
        if (node.depth > 0) box.add(node.position, node.radius);
    return box;
}

std::optional<std::string> Tree::check() const {
    const auto wrong = [](NodeId id, const char* what) { return "node " + std::to_string(id) + ": " + what; };
    int32_t alive = 0;
    for (NodeId id = 0; id < id_end(); id++) {
        const Node& node = nodes_[id];
        if (node.depth == 0) continue;
        alive++;
        if (!is_finite(node.position)) return wrong(id, "its position is not finite");
        if (!(node.radius > 0.0) || !std::isfinite(node.radius))
            return wrong(id, "its radius is not positive");
        if (node.leaf_rule > leaf_rules_.size()) return wrong(id, "its leaf rule does not exist");
        if (node.section > sections().size()) return wrong(id, "its section does not exist");
        if (node.parent == kNoNode) {
            if (id != root_) return wrong(id, "it has no parent and is not the root");
            if (node.depth != 1) return wrong(id, "the root's depth is not 1");
        } else {
            if (!contains(node.parent)) return wrong(id, "its parent does not exist");
            if (node.depth != nodes_[node.parent].depth + 1) return wrong(id, "its depth is wrong");
        }
        int32_t children_seen = 0;
        NodeId previous = kNoNode;
        for (NodeId child = node.first_child; child != kNoNode; child = nodes_[child].next_sibling) {
            if (!contains(child)) return wrong(id, "a child does not exist");
            if (nodes_[child].parent != id) return wrong(child, "it is listed under another parent");
            if (nodes_[child].previous_sibling != previous) return wrong(child, "its sibling link is wrong");
            if (++children_seen > node.child_count) return wrong(id, "its child count is wrong");
            previous = child;
        }
        if (children_seen != node.child_count) return wrong(id, "its child count is wrong");
        if (node.last_child != previous) return wrong(id, "its last child is wrong");
    }
    if (alive != count_) return "the node count is wrong";
    if (alive == 0) return root_ == kNoNode ? std::optional<std::string>() : "an empty tree has a root";
    if (!contains(root_)) return "the root does not exist";
    // Depths that grow by one along every parent link exclude cycles; the one root excludes orphans.
    return std::nullopt;
}

Tree Tree::from_arrays(const std::vector<NodeId>& parents, const std::vector<DVec3>& positions,
                       const std::vector<double>& radii, const std::vector<uint8_t>& flags,
                       const std::vector<NodeId>* ids) {
    const size_t count = parents.size();
    if (positions.size() != count || radii.size() != count || flags.size() != count ||
        (ids && ids->size() != count))
        throw Error("The tree's arrays differ in length; the file is damaged.");
    if (count > kMostNodes) throw Error("The tree has more than 16 million nodes.");
    Tree tree;
    if (count == 0) return tree;
    NodeId id_limit = static_cast<NodeId>(count);
    if (ids) {
        for (NodeId id : *ids)
            if (id < 0 || id > kLargestId) throw Error("A node id is out of range; the file is damaged.");
        id_limit = *std::max_element(ids->begin(), ids->end()) + 1;
    }
    const auto id_of = [&](size_t i) { return ids ? (*ids)[i] : static_cast<NodeId>(i); };
    tree.nodes_.resize(static_cast<size_t>(id_limit));
    for (size_t i = 0; i < count; i++) {
        require_finite(positions[i]);
        require_radius(radii[i]);
        Node& node = tree.nodes_[id_of(i)];
        if (node.depth != 0)
            throw Error("Two nodes have the id " + std::to_string(id_of(i)) + "; the file is damaged.");
        node.position = positions[i];
        node.radius = radii[i];
        node.flags = flags[i];
        node.depth = 1;
    }
    for (size_t i = 0; i < count; i++) {
        const NodeId parent = parents[i];
        if (parent == kNoNode) {
            if (tree.root_ != kNoNode) throw Error("The tree has several roots; the file is damaged.");
            tree.root_ = id_of(i);
        } else {
            if (parent < 0 || static_cast<size_t>(parent) >= count)
                throw Error("A node's parent is out of range; the file is damaged.");
            tree.link_last(id_of(i), id_of(static_cast<size_t>(parent)));
        }
    }
    if (tree.root_ == kNoNode) throw Error("The tree has no root; the file is damaged.");
    tree.count_ = static_cast<int32_t>(count);
    // A cycle cannot be reached from the root, so a shorter walk betrays it.
    const std::vector<NodeId> reached = tree.depth_first();
    if (reached.size() != count) throw Error("Not every node hangs on the root; the file is damaged.");
    tree.update_depths(tree.root_);
    return tree;
}

}  // namespace treerec
