// No file gets a number that is none. Internal to exchange/ and to the exporter.
#pragma once

#include <string>

#include "mesh/mesh.h"
#include "tree/tree.h"

namespace treerec {

// Throws Error where the tree's places and radii are more than a thousand kilometres, or are no numbers in
// the scan's coordinates: such a unit is a mistake, and what is computed from it may be no number either.
void require_sound_measures(const Tree& tree, const std::string& path);

// What a skeleton file may hold; readers take anything beyond for damage. In the file's units, from zero and
// from the root, as in clouds (scan/formats/read_cloud.cpp). The second is a radius' limit too.
inline constexpr double kLargestCoordinate = 1e12;
inline constexpr double kLargestOffset = 1e9;
// And its unit, in metres.
inline constexpr double kSmallestUnit = 1e-12;
inline constexpr double kLargestUnit = 1e12;

// Throws Error where a skeleton file of the tree could not be read again: a single node, no wood or
// next to none, a unit or a place beyond the above, or a place in the scan so far away that its coordinates
// round the tree's nodes together. places: whether the file has the nodes' own.
void require_readable(const Tree& tree, const std::string& path, bool places = true);

// Throws Error where a number of the mesh is none. The last resort: what is to be drawn of a sound tree is
// finite.
void require_finite(const Mesh& mesh, const std::string& path);

}  // namespace treerec
