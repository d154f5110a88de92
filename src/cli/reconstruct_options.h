// What the commands that make a tree of a cloud share.
#pragma once

#include <string>
#include <vector>

#include "cli/arguments.h"
#include "pipeline/reconstruct.h"

namespace treerec {

// An option's wrong value is a matter of the command line, not of the file.
template <typename Call>
auto as_usage(Call call) {
    try {
        return call();
    } catch (const Error& error) {
        throw UsageError(error.what());
    }
}

// Throws UsageError.
ReconstructOptions reconstruct_options_from(const Arguments& arguments);

// "200mm", "8 in" or "0.2", which are metres: a length in metres; `otherwise` without the option. least,
// most: metres. Throws UsageError.
double length_from(const Arguments& arguments, const std::string& option, double otherwise, double least,
                   double most);

// The tree's figures on stdout, and the files that were written.
void print_summary(const Reconstruction& result, const std::vector<std::string>& outs, double seconds);

// Of the presets, with a blank after each.
std::string leaf_names();

}  // namespace treerec
