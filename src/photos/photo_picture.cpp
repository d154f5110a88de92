#include "photos/photo_picture.h"

#include <climits>
#include <memory>

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

PhotoPicture read_photo(const std::string& path) {
    const FileBytes bytes = read_file(path);
    if (bytes.size > INT_MAX) throw Error("'" + path + "' is too large for a photo.");
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> data(
        stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data.get()),
                              static_cast<int>(bytes.size), &width, &height, &channels, 3),
        stbi_image_free);
    if (!data)
        throw Error("'" + path + "' is no photo that can be read here (" + stbi_failure_reason() +
                    "); save it as JPEG or PNG.");
    PhotoPicture picture{width, height, {}};
    picture.pixels.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
    for (size_t i = 0; i < picture.pixels.size(); i++)
        picture.pixels[i] = {data.get()[3 * i], data.get()[3 * i + 1], data.get()[3 * i + 2]};
    return picture;
}

PhotoPicture reduced(const PhotoPicture& picture, int times) {
    if (times <= 1) return picture;
    PhotoPicture small{picture.width / times, picture.height / times, {}};
    small.pixels.resize(static_cast<size_t>(small.width) * static_cast<size_t>(small.height));
    const int count = times * times;
    for (int y = 0; y < small.height; y++)
        for (int x = 0; x < small.width; x++) {
            std::array<int, 3> sum{};
            for (int v = 0; v < times; v++)
                for (int u = 0; u < times; u++)
                    for (size_t k = 0; k < 3; k++)
                        sum[k] += picture.at(x * times + u, y * times + v)[k];
            auto& mean = small.pixels[static_cast<size_t>(y) * static_cast<size_t>(small.width) +
                                      static_cast<size_t>(x)];
            for (size_t k = 0; k < 3; k++)
                mean[k] = static_cast<uint8_t>((sum[k] + count / 2) / count);
        }
    return small;
}

}  // namespace treerec
