// The pixels of a photo.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace treerec {

struct PhotoPicture {
    int width = 0;
    int height = 0;
    std::vector<std::array<uint8_t, 3>> pixels;  // rows from the top; sRGB

    const std::array<uint8_t, 3>& at(int x, int y) const {
        return pixels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
};

// Reads a JPEG, PNG, BMP or TGA as it is stored: a turn that its EXIF data ask for is left alone, as COLMAP
// does. Throws Error with a sentence for what is none, or is damaged.
PhotoPicture read_photo(const std::string& path);

// Each pixel the mean of times x times ones; what is left over at the right and below goes. times: 1 or more.
PhotoPicture reduced(const PhotoPicture& picture, int times);

}  // namespace treerec
