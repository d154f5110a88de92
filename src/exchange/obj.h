// Trees as Wavefront OBJ, with an MTL and PNG pictures beside it.
#pragma once

#include "exchange/model_file.h"
#include "progress.h"

namespace treerec {

// Writes `path`, and <stem>.mtl and <stem>_*.png in the same folder. Groups and materials "bark" and
// "leaves", each only if it has triangles. Metres, Y up; the wind channels have no place in this format.
// Throws Error, naming the path, where it cannot write; or Cancelled.
void write_obj(const std::string& path, const ModelFile& model, const Progress* progress = nullptr);

}  // namespace treerec
