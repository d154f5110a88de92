// Commands in a row: scripts that users write, and the log of what was done to a tree.
//
// A script is lines of commands (edit/commands/command_text.h); # begins a comment. A text in quotes may run
// over several lines. A line
//     frame origin=x,y,z unit=0.01 up=z
// says in which frame the places and lengths that follow are written, so that they stay where they were in
// the scan; without it they are in the tree's own. A log is a script that begins with "# treerec edit log 1";
// what did not fit the tree when the log was last replayed stands in it as "#? command".
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "edit/commands/commands.h"

namespace treerec {

class EditLog {
  public:
    struct Entry {
        std::string command;
        ScanFrame frame;     // in which it is written
        std::string reason;  // why it does not fit; empty if it does
        bool fits() const { return reason.empty(); }
    };

    void add(const Edit& edit) { entries_.push_back({edit.command, edit.frame, ""}); }
    void add(Entry entry) { entries_.push_back(std::move(entry)); }
    // The last `count`, or as many as there are.
    void remove_last(size_t count);
    // One of them. Precondition: index < entries().size().
    void remove(size_t index) { entries_.erase(entries_.begin() + static_cast<std::ptrdiff_t>(index)); }
    void clear() { *this = EditLog(); }
    bool empty() const { return entries_.empty() && newer_.empty(); }

    const std::vector<Entry>& entries() const { return entries_; }
    std::string text() const;
    // Reads what text() writes. Commands are not looked at: what they mean is asked when they are replayed. A
    // log of a newer version is kept as it is, before what is added. Throws Error for a wrong frame line.
    static EditLog parse(std::string_view text);

  private:
    std::vector<Entry> entries_;
    std::string newer_;
};

struct ScriptOptions {
    double tolerance = 0.0;  // of addresses (find_node())
    // What does not fit is left out and told, instead of failing: a node of a list, or else the command. "#?"
    // lines are tried again.
    bool keep_going = false;
    Progress* progress = nullptr;
};

struct LeftOut {
    size_t line = 0;  // of the script, from 1
    std::string command;
    std::string reason;
};

struct ScriptResult {
    size_t done = 0;  // commands
    std::vector<LeftOut> left_out;
    // Those that were done, though not everywhere (keep_going): with how much of the nodes they name is gone.
    std::vector<LeftOut> in_part;
    EditLog log;                    // what was done, as found on this tree, and what was left out
    TreeDelta delta;                // of all together
    std::vector<std::string> said;  // a sentence of each command that was done
};

// Runs all commands. Throws Error with line and column, or Cancelled; the tree then is as it was. With
// keep_going only a script of a newer version, or a frame line that is wrong, throws.
ScriptResult run_script(Tree& tree, std::string_view script, const ScriptOptions& options = {});

}  // namespace treerec
