// The lists that edit_commands() is put together from; each stands in the file of its topic.
#pragma once

#include <initializer_list>
#include <vector>

#include "edit/commands/commands.h"

namespace treerec {

inline std::vector<EditCommand> joined(std::initializer_list<std::vector<EditCommand>> lists) {
    std::vector<EditCommand> all;
    for (const std::vector<EditCommand>& list : lists)
        all.insert(all.end(), list.begin(), list.end());
    return all;
}

std::vector<EditCommand> prune_commands();
std::vector<EditCommand> shape_commands();
std::vector<EditCommand> graft_commands();
std::vector<EditCommand> lstring_commands();
std::vector<EditCommand> lighten_commands();
std::vector<EditCommand> leaf_commands();

}  // namespace treerec
