// Trees as glTF 2.0 models, for every tool that reads them.
#pragma once

#include "exchange/model_file.h"
#include "progress.h"

namespace treerec {

// Writes `path`: .glb in one file, .gltf with a .bin and PNG pictures beside it. Node "Tree" holds the extras
// and the children "Bark" and "Leaves", each only if it has triangles. With coarser levels its child is
// "Tree_LOD0", which has these as children, and which names "Tree_LOD1", ... as its levels of detail
// (MSFT_lod, with MSFT_screencoverage); a program that does not know the extension shows the finest level
// alone. Levels share materials. Attributes: POSITION, NORMAL, TANGENT
// (without it Khronos' validator warns), TEXCOORD_0 and _WIND (the wind channels of design.md as normalized
// bytes). Metres, Y up. Throws Error, naming the path, where it cannot write or for another extension; or
// Cancelled.
void write_gltf(const std::string& path, const ModelFile& model, const Progress* progress = nullptr);

}  // namespace treerec
