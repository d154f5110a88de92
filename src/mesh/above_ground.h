// What of a tree's bark is seen where it stands.
#pragma once

#include "mesh/mesh.h"
#include "tree/tree.h"

namespace treerec {

// The bark of a tree whose trunk stands, without what of its foot lies below the root, which the ground
// hides: for pictures that draw no ground. Vertices that no triangle is left of go, the others keep their
// order. Bark of a branch without a trunk stays as it is.
Mesh above_ground(const Mesh& bark, const Tree& tree);

}  // namespace treerec
