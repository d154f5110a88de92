// What an edit did to a tree, as a value: the exact states before and after of what it changed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tree/tree.h"

namespace treerec {

// Holds only the nodes that changed, and of them only what changed: 52 bytes for a node that moved. Going
// back and forth restores the arena bit for bit, its length included: an edit made again after an undo gives
// its nodes the ids that they had the first time, so that what was said about them still holds.
class TreeDelta {
  public:
    TreeDelta() = default;

    // Linear in the ids of the longer tree.
    static TreeDelta between(const Tree& before, const Tree& after);
    // One delta that does what `first` and then `second` do. Linear in their changes. Throws Error if
    // `second` did not begin where `first` ended.
    static TreeDelta compose(const TreeDelta& first, const TreeDelta& second);

    // Linear in the changes. Throw Error, and leave the tree alone, if it is not in the state that the delta
    // leads from; only what the delta changes is compared.
    void apply(Tree& tree) const { move(tree, true); }
    void revert(Tree& tree) const { move(tree, false); }

    bool empty() const;
    size_t bytes() const;

    // Ids in rising order: nodes that the edit added, removed, or kept but moved, resized, marked or linked
    // otherwise.
    std::vector<NodeId> added() const;
    std::vector<NodeId> removed() const;
    std::vector<NodeId> changed() const;

    // Parts of a node that change together; bits of Change::parts.
    enum Part : uint8_t {
        kPosition = 1,
        kRadius = 2,
        kLinks = 4,
        kDepth = 8,
        kChildCount = 16,
        kFlags = 32,
        kLeafRule = 64,
        kSection = 128
    };
    // The kept nodes of which any of `parts` changed.
    std::vector<NodeId> changed(uint8_t parts) const;

  private:
    struct Change {
        NodeId id;
        uint8_t parts;
        uint64_t at;  // of its bytes in values_: what was, then what is, part by part
    };
    // All that is not in a node.
    struct Whole {
        NodeId root = kNoNode;
        int32_t count = 0;
        NodeId id_end = 0;
        ScanFrame frame;
        std::vector<std::string> leaf_rules;
        SectionTable sections;

        bool operator==(const Whole& other) const;
    };

    static Whole whole_of(const Tree& tree);
    void record(NodeId id, const Node& before, const Node& after);
    void move(Tree& tree, bool forwards) const;
    bool lived(const Change& change, bool after) const;

    Whole before_, after_;
    std::vector<Change> changes_;  // by rising id
    std::vector<char> values_;
};

// Whether two trees are the same bit for bit: ids, links, order, numbers, frame.
bool identical(const Tree& a, const Tree& b);

}  // namespace treerec
