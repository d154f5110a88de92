#include "exchange/material_textures.h"

#include "error.h"
#include "file_bytes.h"
#include "geometry/parallel.h"
#include "mesh/textures.h"

#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
#include <stb/stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace treerec {

std::vector<uint8_t> encode_png(const Image& image) {
    std::vector<uint8_t> png;
    const auto append = [](void* out, void* data, int size) {
        auto* bytes = static_cast<uint8_t*>(data);
        static_cast<std::vector<uint8_t>*>(out)->insert(static_cast<std::vector<uint8_t>*>(out)->end(), bytes,
                                                        bytes + size);
    };
    if (!stbi_write_png_to_func(append, &png, image.width, image.height, image.channels, image.pixels.data(),
                                image.width * image.channels))
        throw Error("A texture could not be turned into a PNG picture: out of memory.");
    return png;
}

std::vector<NamedPicture> make_pictures(const std::string& preset, int size, uint64_t seed) {
    const BarkTextures bark = make_bark_textures(preset, size, seed);
    const LeafTextures leaf = make_leaf_textures(preset, size, seed);
    std::vector<NamedPicture> pictures{{"bark_albedo", {}},
                                       {"bark_normal", {}},
                                       {"bark_roughness", {}},
                                       {"leaf_albedo", {}},
                                       {"leaf_normal", {}}};
    const Image* images[] = {&bark.albedo, &bark.normal, &bark.roughness, &leaf.albedo, &leaf.normal};
    parallel_for(pictures.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++)
            pictures[i].png = encode_png(*images[i]);
    });
    return pictures;
}

std::vector<std::string> write_pictures(const std::string& directory, const std::string& preset, int size,
                                        uint64_t seed) {
    make_folder(directory);
    std::vector<std::string> paths;
    for (const NamedPicture& picture : make_pictures(preset, size, seed)) {
        paths.push_back(utf8_of(path_of(directory) / path_of(preset + "_" + picture.name + ".png")));
        write_file(paths.back(), picture.bytes());
    }
    return paths;
}

}  // namespace treerec
