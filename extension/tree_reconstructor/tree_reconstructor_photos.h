// Where the photos of a tree are.
#pragma once

#include <string>

#include "tree_reconstruction/tree_reconstruction.h"

// A folder of COLMAP's model: the one that is named, one in it, or one beside the tree's scan. Throws
// treerec::Error with a sentence where there is none.
std::string find_photo_model(const TreeReconstruction& p_tree, const godot::String& p_model);
