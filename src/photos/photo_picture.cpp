#include "photos/photo_picture.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

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

namespace {

constexpr size_t kLargest = size_t{1} << 30;  // bytes

}  // namespace

std::optional<Image> decode_picture(std::string_view bytes, int channels) {
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

std::optional<std::array<int, 2>> picture_size(std::string_view bytes) {
    if (bytes.size() > kLargest) return {};
    int stored = 0;
    std::array<int, 2> size{};
    if (stbi_info_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()),
                              &size[0], &size[1], &stored) == 0)
        return {};
    return size;
}

Image read_photo(const std::string& path) {
    std::optional<Image> picture = decode_picture(read_file(path).view(), 3);
    if (!picture) throw Error("'" + path + "' is no photo that can be read here; save it as JPEG or PNG.");
    return std::move(*picture);
}

std::optional<Image> picture_of(const Photo& photo, const Camera& camera, const std::string& folder) {
    try {
        Image picture = read_photo(utf8_of(path_of(folder) / path_of(photo.name)));
        if (picture.width == camera.width && picture.height == camera.height) return picture;
    } catch (const Error&) {
        return {};
    }
    return {};
}

Image reduced(const Image& picture, int times) {
    if (times <= 1) return picture;
    Image small(picture.width / times, picture.height / times, picture.channels);
    const size_t channels = static_cast<size_t>(small.channels), width = static_cast<size_t>(small.width);
    const auto each = static_cast<size_t>(times);
    const auto count = static_cast<uint32_t>(times * times);
    std::vector<uint32_t> sums(width * channels);
    for (int y = 0; y < small.height; y++) {
        std::fill(sums.begin(), sums.end(), 0);
        for (int v = 0; v < times; v++) {
            const uint8_t* from = picture.at(0, y * times + v);
            for (size_t x = 0; x < width; x++)
                for (size_t u = 0; u < each; u++)
                    for (size_t k = 0; k < channels; k++)
                        sums[x * channels + k] += *from++;
        }
        for (size_t i = 0; i < sums.size(); i++)
            small.at(0, y)[i] = static_cast<uint8_t>((sums[i] + count / 2) / count);
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
