// The lists that edit_commands() is put together from; each stands in the file of its topic.
#pragma once

#include <vector>

#include "edit/commands/commands.h"

namespace treerec {

std::vector<EditCommand> prune_commands();
std::vector<EditCommand> shape_commands();
std::vector<EditCommand> graft_commands();
std::vector<EditCommand> lstring_commands();
std::vector<EditCommand> lighten_commands();
std::vector<EditCommand> leaf_commands();

}  // namespace treerec
