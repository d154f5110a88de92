#include "edit/commands/commands.h"

#include <algorithm>

#include "edit/commands/command_lists.h"

namespace treerec {

const std::vector<EditCommand>& edit_commands() {
    static const std::vector<EditCommand> all =
        joined({prune_commands(), shape_commands(), graft_commands(), lstring_commands(), lighten_commands(),
                leaf_commands()});
    return all;
}

const EditCommand& find_edit_command(const CommandLine& line) {
    for (const EditCommand& command : edit_commands())
        if (command.name == line.name) return command;
    std::string near;
    for (const EditCommand& command : edit_commands()) {
        const size_t shared = static_cast<size_t>(
            std::mismatch(line.name.begin(), line.name.end(), command.name.begin(), command.name.end())
                .first -
            line.name.begin());
        if (shared >= std::min<size_t>(3, line.name.size())) near += (near.empty() ? "" : " ") + command.name;
    }
    throw CommandError(
        "There is no command " + quote_word(line.name) + (near.empty() ? "." : "; there are: " + near + "."),
        line.column);
}

Edit perform_for_good(Tree& tree, std::string_view text, const BindOptions& options) {
    const std::optional<CommandLine> line = parse_command_line(text);
    if (!line) throw CommandError("There is no command in this line.", 1);
    const EditCommand& command = find_edit_command(*line);
    const EditArguments arguments(tree, *line, command.parameters, options);
    Edit edit;
    edit.command = arguments.line();
    edit.named = arguments.named();
    edit.missing = arguments.missing();
    edit.frame = tree.frame();
    edit.outcome = command.run(tree, arguments);
    return edit;
}

Edit perform_on_copy(const Tree& tree, std::string_view line, Tree& result, const BindOptions& options) {
    Tree changed = tree;
    Edit edit = perform_for_good(changed, line, options);
    edit.delta = TreeDelta::between(tree, changed);
    result = std::move(changed);
    return edit;
}

Edit perform(Tree& tree, std::string_view line, const BindOptions& options) {
    Tree result;
    Edit edit = perform_on_copy(tree, line, result, options);
    tree = std::move(result);
    return edit;
}

}  // namespace treerec
