#include "edit/turn_sections.h"

#include "tree/turned_section.h"

namespace treerec {

void turn_sections(Tree& tree, const std::vector<NodeId>& ids, const DMat3& turn) {
    if (tree.sections().empty()) return;
    const DMat3 back = glm::transpose(turn);
    std::vector<NodeId> measured;
    std::vector<SectionShape> turned;
    for (const NodeId id : ids) {
        const SectionShape* const section = tree.section_of(id);
        if (!section) continue;
        const Node& node = tree.node(id);
        const NodeId other = node.parent != kNoNode ? node.parent : node.first_child;
        DVec3 way(0.0);
        if (other != kNoNode) way = node.position - tree.node(other).position;
        if (node.parent == kNoNode) way = -way;
        measured.push_back(id);
        turned.push_back(turned_section(*section, back * normalized_or(way, DVec3(0, 1, 0)), turn));
    }
    // Those that they had may be nobody's now.
    for (const NodeId id : measured)
        tree.set_section(id, 0);
    tree.drop_unused_sections();
    const size_t before = tree.add_sections(turned);
    for (size_t i = 0; i < measured.size(); i++)
        tree.set_section(measured[i], before + i + 1);
}

}  // namespace treerec
