#include "edit/preview.h"

#include <algorithm>

#include "edit/commands/commands.h"
#include "error.h"

namespace treerec {

EditPreview preview_edit(const Tree& tree, std::string_view line) {
    EditPreview preview;
    Tree result;
    try {
        preview.message = perform_on_copy(tree, line, result).outcome.said;
    } catch (const Error& error) {
        preview.error = error.what();
        return preview;
    }
    const auto has_wood = [](const Tree& of, NodeId id) {
        return of.contains(id) && of.node(id).parent != kNoNode;
    };
    for (NodeId id = 0; id < std::max(tree.id_end(), result.id_end()); id++) {
        const bool before = has_wood(tree, id), after = has_wood(result, id);
        const Node* was = before ? &tree.node(id) : nullptr;
        const Node* is = after ? &result.node(id) : nullptr;
        if (before && after && was->position == is->position &&
            tree.node(was->parent).position == result.node(is->parent).position)
            continue;
        if (before) {
            preview.removed.push_back(tree.node(was->parent).position);
            preview.removed.push_back(was->position);
        }
        if (after) {
            preview.added.push_back(result.node(is->parent).position);
            preview.added.push_back(is->position);
            preview.added_radii.push_back(is->radius);
        }
    }
    return preview;
}

}  // namespace treerec
