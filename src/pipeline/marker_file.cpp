#include "pipeline/marker_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "error.h"
#include "exchange/material_textures.h"
#include "file_bytes.h"
#include "photos/marker_page.h"
#include "pipeline/lettering.h"

namespace treerec {

namespace {

void append(std::vector<uint8_t>& bytes, uint32_t number) {
    for (int shift = 24; shift >= 0; shift -= 8)
        bytes.push_back(static_cast<uint8_t>(number >> shift));
}

// The remainder by PNG's polynomial (W3C, "Portable Network Graphics (PNG) Specification", annex D).
uint32_t crc_of(const std::vector<uint8_t>& bytes) {
    uint32_t crc = 0xffffffffU;
    for (const uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1U ? 0xedb88320U ^ (crc >> 1) : crc >> 1;
    }
    return crc ^ 0xffffffffU;
}

// How large a pixel is, after a PNG's first chunk, which has the same length in all.
void tell_size(std::vector<uint8_t>& png, int dpi) {
    constexpr size_t kHead = 8 + 25;  // the signature, and IHDR
    const auto per_metre = static_cast<uint32_t>(std::lround(dpi / 0.0254));
    std::vector<uint8_t> body = {'p', 'H', 'Y', 's'};
    append(body, per_metre);
    append(body, per_metre);
    body.push_back(1);
    std::vector<uint8_t> chunk;
    append(chunk, static_cast<uint32_t>(body.size() - 4));
    chunk.insert(chunk.end(), body.begin(), body.end());
    append(chunk, crc_of(body));
    png.insert(png.begin() + kHead, chunk.begin(), chunk.end());
}

// In the middle below the marker, smaller where the page is narrow.
void write_caption(Image& picture, const MarkerPage& page) {
    constexpr double kMostWidth = 0.9;  // of the page
    const std::string caption = marker_caption(page);
    const double wide = text_width(caption, 1.0);
    const double size = std::min<double>(marker_pixels(kMarkerLetters), kMostWidth * picture.width / wide);
    draw_text(picture, 0.5 * (picture.width - size * wide), marker_pixels(page.caption), caption, size,
              {0, 0, 0});
}

}  // namespace

void require_marker_format(const std::string& path) {
    const std::string ending = extension_of(path);
    if (ending != "svg" && ending != "png")
        throw Error("A marker is written to a file that ends in .svg or .png, not '" + path + "'.");
}

void write_marker(const std::string& path, int id, double side) {
    require_marker_format(path);
    const MarkerPage page = marker_page(id, side);
    if (extension_of(path) == "svg") {
        write_file(path, marker_svg(page));
        return;
    }
    Image picture = marker_picture(page);
    write_caption(picture, page);
    std::vector<uint8_t> png = encode_png(picture);
    tell_size(png, kMarkerPageDpi);
    write_file(path, std::string_view(reinterpret_cast<const char*>(png.data()), png.size()));
}

}  // namespace treerec
