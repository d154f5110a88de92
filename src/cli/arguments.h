// A small parser of command lines, and the help text that belongs to it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "error.h"

namespace treerec {

// The command line cannot be understood: exit code 2.
class UsageError : public Error {
  public:
    explicit UsageError(const std::string& sentence) : Error(sentence) {}
};

struct Option {
    std::string name;   // "--seed", or "-o"
    std::string value;  // what the help calls its value; empty for a switch
    std::string help;
    bool repeated = false;
};

struct Command {
    std::string name;
    std::string usage;    // after "treerec "
    std::string summary;  // one line
    std::vector<Option> options;
    std::string notes;  // after the options in the help
};

class Arguments {
  public:
    // words: what follows the command's name. Options and positional words may come in any order; an option's
    // value is the next word, whatever it starts with, or follows a '='; after "--" all is positional. Throws
    // UsageError naming the offending word and, for an unknown option, the nearest known one.
    Arguments(const Command& command, const std::vector<std::string>& words);

    bool has(const std::string& option) const { return values_.count(option) > 0; }
    std::string text(const std::string& option, const std::string& otherwise) const;
    const std::vector<std::string>& all(const std::string& option) const;
    // Throw UsageError for what is no number, or outside least..most.
    double number(const std::string& option, double otherwise, double least, double most) const;
    uint64_t whole(const std::string& option, uint64_t otherwise, uint64_t least, uint64_t most) const;

    const std::vector<std::string>& positional() const { return positional_; }

  private:
    std::map<std::string, std::vector<std::string>> values_;
    std::vector<std::string> positional_;
};

std::string help_text(const Command& command);

// The one of `known` that is the least edits away from `word`; nothing where none is near.
std::optional<std::string> nearest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace treerec
