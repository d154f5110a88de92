// Bark out of the photos that a tree was made of.
#pragma once

#include <optional>
#include <string>

#include "photos/colmap_model.h"
#include "photos/seen_bark.h"
#include "progress.h"
#include "textures/textures.h"
#include "tree/tree.h"

namespace treerec {

struct BarkOptions {
    double repeat_width = 0.6;   // metres around the branch that one repeat covers: as trees are built for
    double repeat_length = 1.0;  // metres along it
    double coarsest = 0.006;     // metres on the bark: larger pixels, or as unsharp ones, give no picture
    int size = 0;  // pixels of the pictures' edges; 0: 512, or 1024 where the photos are that fine
};

struct PhotoBark {
    std::optional<BarkTextures> textures;
    std::string why_not;  // a sentence, where there are none
    size_t photos = 0;    // that show the bark that was taken
    double pixel = 0.0;   // metres on the bark that a pixel of these is wide
    double detail = 0.0;  // metres: the same with regard to their sharpness
    double area = 0.0;    // square metres of the trunk that were seen
    int pieces = 0;       // a side, that the picture was put together of
};

// Unrolls the trunk's clear part out of the photos (photos/seen_bark.h), takes the light's slow changes off
// it, and puts a seamless picture together of its best pieces (photos/quilt.h). Height is guessed from
// lightness, dark is deep (Glencross et al., "A Perceptually Validated Model for Surface Depth
// Hallucination", 2008), normals, occlusion and roughness follow from it. Lengths are in the tree's metres,
// in which the picture is laid on it again: a tree whose size is a guess has its bark guessed as much.
// model: whose photos lie in `folder`; the tree's scan coordinates are the model's. The same bytes whatever
// the number of threads. Throws Cancelled; what photos can't give is no error but told in `why_not`.
PhotoBark bark_of_photos(const Tree& tree, const PhotoModel& model, const std::string& folder,
                         const SeenThings& things = {}, const BarkOptions& options = {},
                         Progress* progress = nullptr);

}  // namespace treerec
