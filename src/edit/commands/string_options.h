// How the commands that take an L-string read it.
#pragma once

#include "edit/commands/arguments.h"
#include "lsystem/lstring.h"

namespace treerec {

inline Parameter dialect_parameter() {
    return word_parameter(
        "dialect", {"told", "turtle", "paper"},
        "the string's; told: as its first line says, else turtle; paper: absolute yaw and pitch");
}

inline LStringOptions string_options(const EditArguments& given) {
    LStringOptions options;
    options.dialect_is_told = given.text("dialect") != "told";
    if (options.dialect_is_told) options.dialect = parse_lstring_dialect(given.text("dialect"));
    return options;
}

}  // namespace treerec
