// Libraries of twigs as files.
#pragma once

#include <string>
#include <vector>

namespace treerec {

// The L-strings of a Godot text resource (.tres) of a TwigLibrary or a Twig, in the file's order, with their
// dialects in their headings; of any other text file the whole text as one. Throws Error, naming the file,
// where it cannot be read or holds no twig.
std::vector<std::string> read_twig_strings(const std::string& path);

// The L-string with a heading that says its dialect, as Godot's Twig counts them: 0 a turtle's, 1 the
// paper's; any other leaves it to the string.
std::string with_dialect(std::string string, int dialect);

}  // namespace treerec
