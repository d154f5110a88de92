#include "photos/photo_picture.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "error.h"
#include "file_bytes.h"

#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_MAX_DIMENSIONS 65536
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wsign-compare"
#endif
#include <stb/stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace treerec {

std::optional<Image> decode_picture(std::string_view bytes, int channels) {
    constexpr size_t kLargest = size_t{1} << 30;
    if (bytes.size() > kLargest) return {};
    int width = 0, height = 0, stored = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> data(
        stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()),
                              &width, &height, &stored, channels),
        stbi_image_free);
    if (!data) return {};
    Image picture(width, height, channels);
    std::copy(data.get(), data.get() + picture.pixels.size(), picture.pixels.begin());
    return picture;
}

Image read_photo(const std::string& path) {
    std::optional<Image> picture = decode_picture(read_file(path).view(), 3);
    if (!picture) throw Error("'" + path + "' is no photo that can be read here; save it as JPEG or PNG.");
    return std::move(*picture);
}

Image reduced(const Image& picture, int times) {
    if (times <= 1) return picture;
    Image small(picture.width / times, picture.height / times, picture.channels);
    const int count = times * times;
    for (int y = 0; y < small.height; y++)
        for (int x = 0; x < small.width; x++)
            for (int k = 0; k < small.channels; k++) {
                int sum = 0;
                for (int v = 0; v < times; v++)
                    for (int u = 0; u < times; u++)
                        sum += picture.at(x * times + u, y * times + v)[k];
                small.at(x, y)[k] = static_cast<uint8_t>((sum + count / 2) / count);
            }
    return small;
}

double level_between(const Image& picture, double x, double y, int channel) {
    const int left = static_cast<int>(x), top = static_cast<int>(y);
    const int right = std::min(left + 1, picture.width - 1), below = std::min(top + 1, picture.height - 1);
    const double s = x - left, t = y - top;
    return (1 - t) * ((1 - s) * picture.at(left, top)[channel] + s * picture.at(right, top)[channel]) +
           t * ((1 - s) * picture.at(left, below)[channel] + s * picture.at(right, below)[channel]);
}

}  // namespace treerec
