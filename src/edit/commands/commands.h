// Every edit by its name: what it takes, what it does. The editor, scripts, the log and the tests all know
// edits from here alone.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "edit/commands/arguments.h"
#include "edit/delta.h"
#include "edit/prune/removed.h"
#include "tree/tree.h"

namespace treerec {

// What a command tells beside what it changed.
struct EditOutcome {
    Removed removed;            // the wood that it cut away
    std::vector<NodeId> nodes;  // those to go on with: a new tip, the nodes that moved
    std::string said;           // a sentence for the user, or empty
};

struct EditCommand {
    std::string name;
    std::string group;    // of a menu: "prune", "shape", ...
    std::string summary;  // one sentence
    std::vector<Parameter> parameters;
    // Changes the tree and keeps Tree::check() true; throws Error (Misfit where only this tree is to blame).
    // What it then leaves of the tree is thrown away. The same tree and arguments give the same bytes.
    EditOutcome (*run)(Tree& tree, const EditArguments& arguments);
};

// In the order of a menu; names are distinct.
const std::vector<EditCommand>& edit_commands();
// Throws CommandError, naming the nearest ones.
const EditCommand& find_edit_command(const CommandLine& line);

// One edit as a value, to be undone and done again.
struct Edit {
    std::string command;  // as a log keeps it
    ScanFrame frame;      // in which its places are written: the tree's before the edit
    TreeDelta delta;
    EditOutcome outcome;
    size_t named = 0;    // what its lists of nodes name
    size_t missing = 0;  // and how much of it was left out (BindOptions::keep_going)
};

// Runs one line of text. The tree is changed wholly or, when anything is thrown, not at all. Throws
// CommandError for a line that makes no command, Misfit for nodes that are not there, Error for what cannot
// be done, Cancelled. Costs what the command does and a copy of the tree.
Edit perform(Tree& tree, std::string_view line, const BindOptions& options = {});
// The same in place, for one who keeps a copy or gives the tree up: costs what the command does, and there is
// no way back. Edit::delta stays empty; when anything is thrown the tree may be changed in part.
Edit perform_for_good(Tree& tree, std::string_view line, const BindOptions& options = {});
// The same on a copy; `result` gets the edited tree.
Edit perform_on_copy(const Tree& tree, std::string_view line, Tree& result, const BindOptions& options = {});

}  // namespace treerec
