// The type that everything meets in: a rooted tree of nodes with positions and radii.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/bounds.h"
#include "geometry/scan_frame.h"
#include "geometry/vec.h"
#include "tree/section_shape.h"

namespace treerec {

using NodeId = int32_t;
inline constexpr NodeId kNoNode = -1;
// The largest id that a file may name: it bounds what a damaged one can make us allocate (about 300 MB).
inline constexpr NodeId kLargestId = 1 << 22;
inline constexpr size_t kMostLeafRules = 250;

// The paper's four kinds (Chen 2025, table 3.2). A trunk node that forks is of kind kBranch and one that
// ends is of kind kLeaf, as figure 3.7 draws them; ask Node::is_trunk() for the trunk itself.
enum class NodeKind : uint8_t { kLeaf, kBranch, kCommon, kTrunk };

enum NodeFlag : uint8_t {
    kTrunkFlag = 1,           // lies on the trunk (mark_trunk)
    kMeasuredRadiusFlag = 2,  // the radius was fitted to points, not inferred
    kGuessFlag = 4,           // the segment to the parent bridges a gap of the scan
};

// position: metres, Y up, relative to the tree's frame. radius: metres. The segment parent -> node is the
// wood; the node's radius is that of its own end.
struct Node {
    DVec3 position{0.0};
    double radius = 0.0;
    NodeId parent = kNoNode;
    NodeId first_child = kNoNode;
    NodeId last_child = kNoNode;
    NodeId next_sibling = kNoNode;
    NodeId previous_sibling = kNoNode;
    int32_t depth = 0;  // 1 at the root (Chen 2025, algorithm 1); 0 marks a free slot
    int32_t child_count = 0;
    uint8_t flags = 0;
    uint8_t leaf_rule = 0;  // place in Tree::leaf_rules(), from 1; 0: the tree's own
    uint16_t section = 0;   // place in Tree::sections(), from 1; 0: not measured

    bool is_trunk() const { return (flags & kTrunkFlag) != 0; }
    bool is_measured() const { return (flags & kMeasuredRadiusFlag) != 0; }
    bool is_guess() const { return (flags & kGuessFlag) != 0; }
    NodeKind kind() const {
        if (child_count == 0) return NodeKind::kLeaf;
        if (child_count > 1) return NodeKind::kBranch;
        return is_trunk() ? NodeKind::kTrunk : NodeKind::kCommon;
    }
};

// An arena of nodes. An id is an index that stays the same until its node is removed, and is not given out
// again by this object. Copying a Tree copies plain memory. Kinds and depths are kept up to date by every
// call.
class Tree {
  public:
    // Iterates over a node's children, in order.
    class ChildRange {
      public:
        class Iterator {
          public:
            Iterator(const Tree* tree, NodeId id) : tree_(tree), id_(id) {}
            NodeId operator*() const { return id_; }
            Iterator& operator++() {
                id_ = tree_->node(id_).next_sibling;
                return *this;
            }
            bool operator!=(const Iterator& other) const { return id_ != other.id_; }

          private:
            const Tree* tree_;
            NodeId id_;
        };
        ChildRange(const Tree* tree, NodeId first) : tree_(tree), first_(first) {}
        Iterator begin() const { return {tree_, first_}; }
        Iterator end() const { return {tree_, kNoNode}; }

      private:
        const Tree* tree_;
        NodeId first_;
    };

    bool empty() const { return count_ == 0; }
    size_t size() const { return static_cast<size_t>(count_); }
    NodeId root() const { return root_; }
    // One past the largest id ever given out: the length of an array indexed by id.
    NodeId id_end() const { return static_cast<NodeId>(nodes_.size()); }
    bool contains(NodeId id) const { return id >= 0 && id < id_end() && nodes_[id].depth > 0; }
    // Precondition: contains(id).
    const Node& node(NodeId id) const { return nodes_[id]; }
    ChildRange children(NodeId id) const { return {this, nodes_[id].first_child}; }

    // Adds the root to an empty tree. Throws Error if there is one already, or for a bad position or radius.
    // A new node bears leaves by the rule of the wood that it grows from, or is put into.
    NodeId add_root(const DVec3& position, double radius, uint8_t flags = 0);
    // Adds a last child. Throws Error if there is no `parent`, or for a bad position or radius.
    NodeId add_child(NodeId parent, const DVec3& position, double radius, uint8_t flags = 0);
    // Throw Error for an unknown id, a position that is not finite, or a radius that is not positive.
    void set_position(NodeId id, const DVec3& position);
    void set_radius(NodeId id, double radius);
    void set_flag(NodeId id, NodeFlag flag, bool on);

    // The rules of leaves that wood of this tree has of its own, as text (foliage/leaf_rule_text.h); nodes
    // name them by their place, from 1. Which of them are in use, only the nodes say.
    const std::vector<std::string>& leaf_rules() const { return leaf_rules_; }
    // The number by which nodes name the rule, which is added if it is new; 0 for an empty text. Throws Error
    // for more than kMostLeafRules.
    uint8_t name_leaf_rule(const std::string& rule);
    // Throws Error for an unknown id, or a number that names no rule.
    void set_leaf_rule(NodeId id, uint8_t number);
    // Forgets the rules that no node names; the others move up.
    void drop_unused_leaf_rules();

    // Cross-sections that were measured; nodes name them by their place, from 1. They are of the wood at the
    // node, relative to its radius and direction, so what moves, bends, scales or thickens wood leaves them,
    // and new wood has none but for what is put between two nodes.
    const std::vector<SectionShape>& sections() const;
    const SectionTable& section_table() const { return sections_; }
    // Of a tree whose nodes are copies of another's. Throws Error where a node names none of these.
    void set_section_table(SectionTable table);
    // Adds them all and returns the number before that of the first. Throws Error for more than kMostSections
    // that nodes name.
    size_t add_sections(const std::vector<SectionShape>& more);
    // Throws Error for an unknown id, or a number that names no section.
    void set_section(NodeId id, size_t number);
    // Null where none was measured. Precondition: contains(id).
    const SectionShape* section_of(NodeId id) const {
        const uint16_t number = nodes_[id].section;
        return number > 0 ? &(*sections_)[number - 1u] : nullptr;
    }
    // Forgets the sections that no node names; the others move up.
    void drop_unused_sections();

    // Removes the node and all below it and returns their ids, parents first. Removing the root empties the
    // tree.
    std::vector<NodeId> remove_subtree(NodeId id);
    // Removes one node; its children take its place among its siblings. The root can go only if it has
    // exactly one child. Throws Error otherwise.
    void dissolve(NodeId id);
    // dissolve() for many nodes at once, in time that grows with the tree alone. The root must not be among
    // them. Throws Error for an unknown id or the root, before anything is changed.
    void dissolve_all(const std::vector<NodeId>& ids);
    // Puts a new node between `id` and its parent, in id's place. Throws Error for the root.
    NodeId insert_before(NodeId id, const DVec3& position, double radius, uint8_t flags = 0);
    // Hangs the subtree at `id` under `parent` as its last child. Throws Error where that would make a cycle.
    void reparent(NodeId id, NodeId parent);
    // Makes `id` its parent's first child: the continuation comes first in the order of children.
    void make_first_child(NodeId id);
    // The same tree with ids 0..size()-1 in depth-first order.
    Tree compacted() const;

    const ScanFrame& frame() const { return frame_; }
    void set_frame(const ScanFrame& frame) { frame_ = frame; }
    // Moves the frame's origin to tree-space point `p`, so that `p` becomes (0,0,0); the tree keeps its place
    // in the scan.
    void rebase(const DVec3& p);
    // Scales positions and radii; the frame follows, so that the tree keeps its place in the scan.
    void scale(double factor);

    // Ids, parents before children, children in order.
    std::vector<NodeId> depth_first(NodeId from) const;
    std::vector<NodeId> depth_first() const;
    std::vector<NodeId> breadth_first() const;
    std::vector<NodeId> nodes_of_kind(NodeKind kind) const;
    Bounds bounds() const;

    // What is wrong with the structure, or nothing: one root, links that agree, no cycle, no orphan, right
    // depths and counts, finite positions, positive finite radii, rules of leaves and sections that there
    // are.
    std::optional<std::string> check() const;

    // Builds a tree from parallel arrays: parents[i] is an index into the arrays or -1, for exactly one i.
    // Parents may come after their children. ids[i], when given, become the node ids (distinct,
    // 0..kLargestId). Throws Error if the arrays do not describe a tree; nothing else can go wrong with
    // hostile values.
    static Tree from_arrays(const std::vector<NodeId>& parents, const std::vector<DVec3>& positions,
                            const std::vector<double>& radii, const std::vector<uint8_t>& flags,
                            const std::vector<NodeId>* ids = nullptr);

  private:
    friend class TreeDelta;  // edit/delta.h: puts back a tree's exact state

    NodeId new_node(const DVec3& position, double radius, uint8_t flags, uint8_t leaf_rule,
                    uint16_t section = 0);
    void require(NodeId id) const;
    void link_last(NodeId id, NodeId parent);
    void splice_out(NodeId id);
    void unlink(NodeId id);
    void update_depths(NodeId from);

    std::vector<Node> nodes_;
    NodeId root_ = kNoNode;
    int32_t count_ = 0;
    ScanFrame frame_;
    std::vector<std::string> leaf_rules_;
    SectionTable sections_;
};

}  // namespace treerec
