// A small picture of a scion, for a list to choose from.
#pragma once

#include "mesh/image.h"
#include "tree/tree.h"

namespace treerec {

// size x size pixels of red, green, blue and alpha on nothing: the scion as it stands on a branch that rises
// at 30 degrees, seen from the side and a little above, bark-brown. Throws Error for no scion, or for a size
// that is not 16 to 512.
Image draw_twig(const Tree& scion, int size);

}  // namespace treerec
