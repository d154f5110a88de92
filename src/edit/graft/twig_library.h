// The twigs that ship with us: scions as L-strings (lsystem/lstring.h), carried in every library.
#pragma once

#include <span>
#include <string_view>

namespace treerec {

struct LibraryTwig {
    std::string_view name;    // "maple"
    std::string_view title;   // a line for a list
    std::string_view string;  // metres and degrees; read_lstring() makes a scion of it
};

// By name: apple, birch, cherry, dead, generic, maple, oak, pine, spruce, willow; and of ginkgo, magnolia,
// maple and poplar NAME_short, NAME_medium and NAME_long, which fill the crown of a sketch
// (sketch/species.h).
std::span<const LibraryTwig> twig_library();

// Throws Error for another name, listing these.
const LibraryTwig& find_library_twig(std::string_view name);

}  // namespace treerec
