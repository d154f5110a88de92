// What a Tree keeps of the cross-sections of its wood.
#include <utility>

#include "error.h"
#include "tree/tree.h"

namespace treerec {

namespace {

const std::vector<SectionShape> kNone;

SectionTable table_of(std::vector<SectionShape> sections) {
    if (sections.empty()) return nullptr;
    return std::make_shared<const std::vector<SectionShape>>(std::move(sections));
}

}  // namespace

const std::vector<SectionShape>& Tree::sections() const {
    return sections_ ? *sections_ : kNone;
}

void Tree::set_section_table(SectionTable table) {
    const size_t count = table ? table->size() : 0;
    for (const Node& node : nodes_)
        if (node.section > count) throw Error("A node names a section that there is not.");
    sections_ = std::move(table);
}

size_t Tree::add_sections(const std::vector<SectionShape>& more) {
    if (more.empty()) return sections().size();
    if (sections().size() + more.size() > kMostSections) drop_unused_sections();
    std::vector<SectionShape> all = sections();
    const size_t before = all.size();
    if (before + more.size() > kMostSections)
        throw Error("A tree can have " + std::to_string(kMostSections) + " measured sections at most.");
    all.insert(all.end(), more.begin(), more.end());
    sections_ = table_of(std::move(all));
    return before;
}

void Tree::set_section(NodeId id, size_t number) {
    require(id);
    if (number > sections().size()) throw Error("The tree has no section " + std::to_string(number) + ".");
    nodes_[id].section = static_cast<uint16_t>(number);
}

void Tree::drop_unused_sections() {
    std::vector<uint16_t> moved(sections().size() + 1, 0);
    for (const Node& node : nodes_)
        moved[node.section] = 1;
    moved[0] = 0;
    std::vector<SectionShape> kept;
    for (size_t number = 1; number < moved.size(); number++) {
        if (moved[number] == 0) continue;
        kept.push_back(sections()[number - 1]);
        moved[number] = static_cast<uint16_t>(kept.size());
    }
    for (Node& node : nodes_)
        node.section = moved[node.section];
    sections_ = table_of(std::move(kept));
}

}  // namespace treerec
