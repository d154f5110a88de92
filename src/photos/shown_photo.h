// A photo as it is laid over a scene that is seen from where it was taken.
#pragma once

#include <string>

#include "mesh/image.h"
#include "photos/colmap_model.h"
#include "photos/pinhole_view.h"
#include "progress.h"

namespace treerec {

// What the view shows of the photo in a file, without its lens's distortion: red, green, blue, and a fourth
// channel that is 255 where the photo shows something, else 0. Throws Error with a sentence where the file
// can't be read or has other proportions than its camera, as a photo that was turned or cropped has, or
// Cancelled.
Image shown_photo(const std::string& path, const Camera& camera, const PinholeView& view,
                  const Progress* progress = nullptr);

}  // namespace treerec
