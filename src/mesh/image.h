// A picture in memory: 8 bits per channel, rows from the top.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace treerec {

struct Image {
    int width = 0;
    int height = 0;
    int channels = 0;             // 1, 3 or 4
    std::vector<uint8_t> pixels;  // height * width * channels

    Image() = default;
    Image(int w, int h, int c)
        : width(w), height(h), channels(c), pixels(static_cast<size_t>(w) * h * c, 0) {}

    uint8_t* at(int x, int y) { return pixels.data() + (static_cast<size_t>(y) * width + x) * channels; }
    const uint8_t* at(int x, int y) const {
        return pixels.data() + (static_cast<size_t>(y) * width + x) * channels;
    }
};

}  // namespace treerec
