// What `treerec grow` makes of an L-string or a grammar.
#pragma once

#include <string>

#include "cli/arguments.h"
#include "foliage/foliage.h"
#include "lsystem/lstring.h"
#include "progress.h"

namespace treerec {

struct Grown {
    LStringTree read;
    std::string string;      // as it was drawn; empty for one that was read from a file
    LStringOptions options;  // by which it was drawn
    std::string leaf_preset;
};

// The text of a file, or of a grammar that ships with the program. Throws Error.
std::string grammar_source(const std::string& name);

// name: of the text, in sentences. arguments: of grow_command(). Throws Error, UsageError, or Cancelled.
Grown grow_from(const std::string& name, const std::string& text, const Arguments& arguments,
                Progress& progress);

// Of the leaves that the string drew itself; none where there are none.
Foliage foliage_of(const Grown& grown, const Progress* progress = nullptr);

}  // namespace treerec
