// Trees as glTF 2.0 models, for every tool that reads them.
#pragma once

#include "exchange/model_file.h"
#include "progress.h"

namespace treerec {

// Writes `path`: .glb in one file, .gltf with a .bin and PNG pictures beside it. Node "Tree" holds the extras
// and the children "Bark" and "Leaves", each only if it has triangles. Attributes: POSITION, NORMAL, TANGENT
// (without it Khronos' validator warns), TEXCOORD_0 and _WIND (the wind channels of design.md as normalized
// bytes). Metres, Y up. Throws Error, naming the path, where it cannot write or for another extension; or
// Cancelled.
void write_gltf(const std::string& path, const ModelFile& model, const Progress* progress = nullptr);

}  // namespace treerec
