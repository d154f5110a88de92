#include "edit/delta.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "error.h"

namespace treerec {

namespace {

static_assert(std::is_trivially_copyable_v<Node> && std::is_standard_layout_v<Node>);

struct PartPlace {
    uint8_t part;
    size_t offset;
    size_t size;
};

constexpr size_t kLinksSize = 5 * sizeof(NodeId);
static_assert(offsetof(Node, previous_sibling) - offsetof(Node, parent) == kLinksSize - sizeof(NodeId));

constexpr PartPlace kParts[] = {
    {TreeDelta::kPosition, offsetof(Node, position), sizeof(DVec3)},
    {TreeDelta::kRadius, offsetof(Node, radius), sizeof(double)},
    {TreeDelta::kLinks, offsetof(Node, parent), kLinksSize},
    {TreeDelta::kDepth, offsetof(Node, depth), sizeof(int32_t)},
    {TreeDelta::kChildCount, offsetof(Node, child_count), sizeof(int32_t)},
    {TreeDelta::kFlags, offsetof(Node, flags), sizeof(uint8_t)},
    {TreeDelta::kLeafRule, offsetof(Node, leaf_rule), sizeof(uint8_t)},
    {TreeDelta::kSection, offsetof(Node, section), sizeof(uint16_t)},
};

const char* bytes_of(const Node& node) {
    return reinterpret_cast<const char*>(&node);
}

char* bytes_of(Node& node) {
    return reinterpret_cast<char*>(&node);
}

// The fields lie without gaps.
bool same(const Node& a, const Node& b) {
    static_assert(offsetof(Node, flags) == sizeof(DVec3) + sizeof(double) + kLinksSize + 2 * sizeof(int32_t));
    static_assert(offsetof(Node, leaf_rule) == offsetof(Node, flags) + 1);
    static_assert(offsetof(Node, section) == offsetof(Node, leaf_rule) + 1);
    static_assert(sizeof(Node) == offsetof(Node, section) + sizeof(uint16_t));
    return std::memcmp(&a, &b, sizeof(Node)) == 0;
}

bool same_bits(double a, double b) {
    return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b);
}

bool same_bits(const DVec3& a, const DVec3& b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

}  // namespace

bool TreeDelta::Whole::operator==(const Whole& other) const {
    return root == other.root && count == other.count && id_end == other.id_end &&
           frame.up == other.frame.up && same_bits(frame.metres_per_unit, other.frame.metres_per_unit) &&
           same_bits(frame.origin, other.frame.origin) && same_bits(frame.tilt, other.frame.tilt) &&
           leaf_rules == other.leaf_rules &&
           (sections == other.sections || (sections && other.sections && *sections == *other.sections));
}

TreeDelta::Whole TreeDelta::whole_of(const Tree& tree) {
    return {tree.root_, tree.count_, tree.id_end(), tree.frame_, tree.leaf_rules_, tree.sections_};
}

void TreeDelta::record(NodeId id, const Node& before, const Node& after) {
    Change change{id, 0, values_.size()};
    for (const PartPlace& place : kParts) {
        const char* const was = bytes_of(before) + place.offset;
        const char* const is = bytes_of(after) + place.offset;
        if (std::memcmp(was, is, place.size) == 0) continue;
        change.parts |= place.part;
        values_.insert(values_.end(), was, was + place.size);
        values_.insert(values_.end(), is, is + place.size);
    }
    if (change.parts != 0) changes_.push_back(change);
}

TreeDelta TreeDelta::between(const Tree& before, const Tree& after) {
    TreeDelta delta;
    delta.before_ = whole_of(before);
    delta.after_ = whole_of(after);
    const Node none;
    const NodeId end = std::max(before.id_end(), after.id_end());
    const NodeId shared = std::min(before.id_end(), after.id_end());
    for (NodeId id = 0; id < shared; id++)
        if (!same(before.nodes_[id], after.nodes_[id])) delta.record(id, before.nodes_[id], after.nodes_[id]);
    for (NodeId id = shared; id < end; id++)
        delta.record(id, id < before.id_end() ? before.nodes_[id] : none,
                     id < after.id_end() ? after.nodes_[id] : none);
    delta.changes_.shrink_to_fit();
    delta.values_.shrink_to_fit();
    return delta;
}

TreeDelta TreeDelta::compose(const TreeDelta& first, const TreeDelta& second) {
    if (!(first.after_ == second.before_))
        throw Error("These two edits do not follow each other, so they cannot become one.");
    TreeDelta both;
    both.before_ = first.before_;
    both.after_ = second.after_;
    size_t a = 0, b = 0;
    while (a < first.changes_.size() || b < second.changes_.size()) {
        const Change* one = a < first.changes_.size() ? &first.changes_[a] : nullptr;
        const Change* two = b < second.changes_.size() ? &second.changes_[b] : nullptr;
        const NodeId id = !two || (one && one->id <= two->id) ? one->id : two->id;
        if (one && one->id != id) one = nullptr;
        if (two && two->id != id) two = nullptr;
        a += one != nullptr;
        b += two != nullptr;
        Node before, after;
        const char* from = one ? first.values_.data() + one->at : nullptr;
        const char* to = two ? second.values_.data() + two->at : nullptr;
        for (const PartPlace& place : kParts) {
            const bool in_first = one && (one->parts & place.part);
            const bool in_second = two && (two->parts & place.part);
            if (!in_first && !in_second) continue;
            if (in_first && in_second && std::memcmp(from + place.size, to, place.size) != 0)
                throw Error("These two edits do not follow each other, so they cannot become one.");
            const char* const was = in_first ? from : to;
            const char* const is = in_second ? to + place.size : from + place.size;
            std::memcpy(bytes_of(before) + place.offset, was, place.size);
            std::memcpy(bytes_of(after) + place.offset, is, place.size);
            if (in_first) from += 2 * place.size;
            if (in_second) to += 2 * place.size;
        }
        both.record(id, before, after);
    }
    both.changes_.shrink_to_fit();
    both.values_.shrink_to_fit();
    return both;
}

void TreeDelta::move(Tree& tree, bool forwards) const {
    const Whole& from = forwards ? before_ : after_;
    const Whole& to = forwards ? after_ : before_;
    const Node none;
    bool fits = whole_of(tree) == from;
    for (size_t i = 0; fits && i < changes_.size(); i++) {
        const Change& change = changes_[i];
        const Node& node = change.id < tree.id_end() ? tree.nodes_[change.id] : none;
        const char* value = values_.data() + change.at;
        for (const PartPlace& place : kParts) {
            if (!(change.parts & place.part)) continue;
            const char* const expected = forwards ? value : value + place.size;
            fits = fits && std::memcmp(bytes_of(node) + place.offset, expected, place.size) == 0;
            value += 2 * place.size;
        }
    }
    if (!fits)
        throw Error(forwards ? "The tree is not as it was before this edit, so the edit cannot be done again."
                             : "The tree is not as this edit left it, so the edit cannot be undone.");
    tree.nodes_.resize(static_cast<size_t>(std::max(from.id_end, to.id_end)));
    for (const Change& change : changes_) {
        const char* value = values_.data() + change.at;
        for (const PartPlace& place : kParts) {
            if (!(change.parts & place.part)) continue;
            std::memcpy(bytes_of(tree.nodes_[change.id]) + place.offset,
                        forwards ? value + place.size : value, place.size);
            value += 2 * place.size;
        }
    }
    tree.nodes_.resize(static_cast<size_t>(to.id_end));
    tree.root_ = to.root;
    tree.count_ = to.count;
    tree.frame_ = to.frame;
    tree.leaf_rules_ = to.leaf_rules;
    tree.sections_ = to.sections;
}

bool TreeDelta::empty() const {
    return changes_.empty() && before_ == after_;
}

size_t TreeDelta::bytes() const {
    return sizeof *this + changes_.capacity() * sizeof(Change) + values_.capacity();
}

// A free slot has depth 0; a node that lives on may have kept its depth.
bool TreeDelta::lived(const Change& change, bool after) const {
    if (!(change.parts & kDepth)) return true;
    size_t at = change.at;
    for (const PartPlace& place : kParts) {
        if (!(change.parts & place.part)) continue;
        if (place.part == kDepth) break;
        at += 2 * place.size;
    }
    int32_t depth = 0;
    std::memcpy(&depth, values_.data() + at + (after ? sizeof depth : 0), sizeof depth);
    return depth > 0;
}

std::vector<NodeId> TreeDelta::added() const {
    std::vector<NodeId> ids;
    for (const Change& change : changes_)
        if (!lived(change, false) && lived(change, true)) ids.push_back(change.id);
    return ids;
}

std::vector<NodeId> TreeDelta::removed() const {
    std::vector<NodeId> ids;
    for (const Change& change : changes_)
        if (lived(change, false) && !lived(change, true)) ids.push_back(change.id);
    return ids;
}

std::vector<NodeId> TreeDelta::changed() const {
    return changed(0xff);
}

std::vector<NodeId> TreeDelta::changed(uint8_t parts) const {
    std::vector<NodeId> ids;
    for (const Change& change : changes_)
        if ((change.parts & parts) && lived(change, false) && lived(change, true)) ids.push_back(change.id);
    return ids;
}

bool identical(const Tree& a, const Tree& b) {
    return TreeDelta::between(a, b).empty();
}

}  // namespace treerec
