// COLMAP on this machine: where it is, and what it understands.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "photos/child_process.h"
#include "progress.h"

namespace treerec {

class Colmap {
  public:
    // Asks the program at `program` for its version. Throws Error where that is not COLMAP, or Cancelled.
    Colmap(const std::string& program, const Progress* progress);

    const std::string& program() const { return program_; }
    const std::string& version() const { return version_; }  // "3.8"; "unknown" where it does not tell
    bool cuda() const { return cuda_; }

    // Whether its command has the option, such as "--SiftMatching.use_gpu". The command is asked once. Throws
    // Error where it can't be, or Cancelled.
    bool knows(const std::string& command, const std::string& option, const Progress* progress);

    // One of its commands, with the libraries that lie beside the program. To be completed by arguments.
    ChildCommand call(const std::string& command) const;

  private:
    std::string program_;
    std::string version_ = "unknown";
    bool cuda_ = false;
    std::map<std::string, std::set<std::string>> options_;  // by command
};

// asked: the program that the user named, or a folder with it in it; "": $COLMAP, then PATH, then where it is
// usually installed. Throws Error with a sentence that says what to install, or Cancelled.
Colmap find_colmap(const std::string& asked, const Progress* progress = nullptr);

// A vocabulary tree of COLMAP (vocab_tree*.bin) beside the program; "" without one.
std::string vocabulary_tree_of(const Colmap& colmap);

}  // namespace treerec
