// L-strings in files: the string of lsystem/lstring.h below a comment that says where in the scan it stands
// and how it is to be read:
//   # L-string; treerec 1 up z metres_per_unit 1 origin 443210.25 5431234.5 312.125 dialect turtle ...
#pragma once

#include <string>
#include <string_view>

#include "lsystem/lstring.h"

namespace treerec {

// The file's text: long strings broken into lines between symbols. options: what read_lstring() needs for it.
std::string lstring_file_text(std::string_view string, const ScanFrame& frame, const LStringOptions& options);
// The whole tree, as write_lstring() writes it. Read back it lies at its own place in the scan.
void write_lstring_file(const std::string& path, const Tree& tree, const LStringOptions& options = {},
                        const Progress* progress = nullptr);

// The tree and its leaves; options that heed the heading are told by it. Without a place in it the tree's
// axes are the scan's. Throws Error that names the file, line and column, and Cancelled.
LStringTree read_lstring_file(const std::string& path, const LStringOptions& options = {},
                              const Progress* progress = nullptr);
LStringTree parse_lstring_file(std::string_view bytes, const std::string& path,
                               const LStringOptions& options = {}, const Progress* progress = nullptr);

// Whether the bytes begin with that comment, or with turtle commands alone.
bool is_lstring_file(std::string_view bytes);

}  // namespace treerec
