// Leaf pictures in the colours that photos gave.
#pragma once

#include "geometry/vec.h"
#include "mesh/image.h"
#include "photos/leaf_colours.h"

namespace treerec {

// What each channel of the picture's stored levels has to be multiplied by so that the opaque part's mean is
// `mean` (linear light); 16 where that is not enough. picture: RGBA, sRGB.
DVec3 picture_gain(const Image& picture, const DVec3& mean);

// Multiplies them: the picture keeps its veins and shades.
void recolour(Image& picture, const DVec3& mean);

// What leaves at a height (metres above the root) are multiplied by: the course of the colours.
DVec3 course_at(const LeafColours& colours, double height);

// The largest factor of the course, by channel: with pictures that are by it lighter, factors are 0..1.
DVec3 course_peak(const LeafColours& colours);

}  // namespace treerec
