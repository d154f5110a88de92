// No file gets a number that is none. Internal to exchange/ and to the exporter.
#pragma once

#include <string>

#include "mesh/mesh.h"
#include "tree/tree.h"

namespace treerec {

// Throws Error where the tree's places and radii are more than a thousand kilometres, or are no numbers in
// the scan's coordinates: such a unit is a mistake, and what is computed from it may be no number either.
void require_sound_measures(const Tree& tree, const std::string& path);

// Throws Error where a number of the mesh is none. The last resort: what is to be drawn of a sound tree is
// finite.
void require_finite(const Mesh& mesh, const std::string& path);

}  // namespace treerec
