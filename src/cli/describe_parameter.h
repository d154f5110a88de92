// What a command takes, for lists of commands.
#pragma once

#include <string>
#include <vector>

#include "edit/commands/arguments.h"

namespace treerec {

// "factor=1 (0 to 1000)  what it is", in brackets where it can be left out.
std::string describe_parameter(const Parameter& parameter);
// A command with all that it takes, to stdout.
void print_command(const std::string& name, const std::string& summary,
                   const std::vector<Parameter>& parameters);

}  // namespace treerec
