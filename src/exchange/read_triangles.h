// Meshes of other programs as triangles: what bark grows around, or starts from.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/vec.h"

namespace treerec {

// Counter-clockwise from outside; metres. Of a Wavefront OBJ file its v and f lines, others are passed over.
// Of .glb and .gltf (by tinygltf) the triangles of the scene that it shows, where its nodes put them; of our
// own models the finest level. Throws Error, naming the file, for what can't be read.
std::vector<std::array<DVec3, 3>> read_triangles(const std::string& path);

}  // namespace treerec
