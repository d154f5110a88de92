#include "edit/leaves_of.h"

#include <string>

#include "edit/node_sets.h"
#include "foliage/leaf_rule_text.h"

namespace treerec {

std::vector<NodeId> set_leaves_of(Tree& tree, const std::vector<NodeId>& ids, std::string_view rule) {
    const std::string text = plain_leaf_rule(rule);
    std::vector<uint8_t> chosen(static_cast<size_t>(tree.id_end()), 0);
    for (NodeId id : ids) {
        require_node(tree, id);
        chosen[id] = 1;
        if (tree.node(id).child_count > 0) continue;
        for (NodeId below = tree.node(id).parent; below != kNoNode && tree.node(below).child_count == 1;
             below = tree.node(below).parent)
            chosen[below] = 1;
    }
    const auto text_of = [&](NodeId id) {
        const uint8_t number = tree.node(id).leaf_rule;
        return number == 0 ? std::string_view() : std::string_view(tree.leaf_rules()[number - 1u]);
    };
    std::vector<NodeId> changed;
    for (NodeId id = 0; id < tree.id_end(); id++)
        if (chosen[id] && text_of(id) != text) changed.push_back(id);
    for (const NodeId id : changed)
        tree.set_leaf_rule(id, 0);
    tree.drop_unused_leaf_rules();
    if (changed.empty()) return changed;
    const uint8_t number = tree.name_leaf_rule(text);
    for (const NodeId id : changed)
        tree.set_leaf_rule(id, number);
    return changed;
}

}  // namespace treerec
