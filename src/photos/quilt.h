// A seamless picture out of pieces of a larger, ragged one.
#pragma once

#include <optional>
#include <vector>

#include "mesh/image.h"
#include "progress.h"

namespace treerec {

struct QuiltOptions {
    int width = 512;  // pixels of the picture that is made
    int height = 512;
    double overlap = 0.3;  // of the pieces, of the step from one to the next
};

// The least number of pieces a side for which the source has room for many different ones, 3 to 8; nothing
// where it has not even for 8. fault: as below.
std::optional<int> pieces_of(const Image& source, const std::vector<float>& fault,
                             const QuiltOptions& options = {});

// Image quilting (Efros and Freeman, "Image Quilting for Texture Synthesis and Transfer", 2001), pieces x
// pieces of them, that overlap around the picture's borders, too: it repeats without a seam both ways. Each
// piece is the one that is most like what lies there already, in all of the source, where it has no fault and
// was not taken before; they part along the path of the least difference. source: 3 channels. fault: by
// pixel, 0 for the best ones, from 1 on for those that must not be used. pieces: as pieces_of() gives, or
// more. Deterministic. Throws Error where there is no room for a piece, or Cancelled.
Image quilt(const Image& source, const std::vector<float>& fault, int pieces,
            const QuiltOptions& options = {}, const Progress* progress = nullptr);

}  // namespace treerec
