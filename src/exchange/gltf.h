// Trees as glTF 2.0 models, for every tool that reads them.
#pragma once

#include "exchange/model_file.h"
#include "progress.h"

namespace treerec {

// Writes `path`: .glb in one file, or, with pictures_beside, its PNG pictures in the folder NAME_textures
// beside it; .gltf always has that, and a .bin. Node "Tree" holds the extras and, if anything has triangles,
// the child "Tree_LOD0": one mesh of the same name, whose primitives are bark and leaves. It names
// "Tree_LOD1", ... as its levels of detail (MSFT_lod, with MSFT_screencoverage), each such a node; a program
// that does not know the extension shows the finest level alone. Levels share materials. Attributes:
// POSITION, NORMAL, TANGENT (without it Khronos' validator warns), TEXCOORD_0 and _WIND (the wind channels of
// design.md as normalized bytes: in COLOR_0 they would be taken for colours). Metres, Y up. Throws Error,
// naming the path, where it cannot write or for another extension; or Cancelled.
void write_gltf(const std::string& path, const ModelFile& model, const Progress* progress = nullptr);

}  // namespace treerec
