// The pixels of photos, and of pictures that belong to them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "mesh/image.h"
#include "photos/colmap_model.h"

namespace treerec {

// A JPEG, PNG, BMP or TGA from its bytes, as grey (1 channel) or as red, green and blue (3), with opacity
// (4), as it is stored: a turn that its EXIF data ask for is left alone, as COLMAP does. Nothing for what is
// none, or is damaged.
std::optional<Image> decode_picture(std::string_view bytes, int channels);

// The width and height, in pixels, of what decode_picture() would decode; nothing for what is none.
std::optional<std::array<int, 2>> picture_size(std::string_view bytes);

// A photo with 3 channels. Throws Error with a sentence for a file that is none.
Image read_photo(const std::string& path);

// The photo of a model, in `folder`. Nothing for one that can't be read, or that has other pixels than its
// camera: what was turned or cropped since shows other places. densify() says so.
std::optional<Image> picture_of(const Photo& photo, const Camera& camera, const std::string& folder);

// Each pixel the mean of times x times ones; what is left over at the right and below goes. times: 1 or more.
Image reduced(const Image& picture, int times);

// A channel of the picture between the middles of four pixels: x, y in pixels from the middle of the upper
// left one, inside of the picture or at its border.
double level_between(const Image& picture, double x, double y, int channel);

}  // namespace treerec
