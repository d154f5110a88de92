#include "exchange/material_textures.h"

#include <algorithm>
#include <iterator>

#include "error.h"
#include "file_bytes.h"
#include "geometry/parallel.h"

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

namespace {

constexpr const char* kNames[] = {
    "bark_albedo",       "bark_normal",       "bark_roughness",       "bark_roughness_grey",
    "bark_young_albedo", "bark_young_normal", "bark_young_roughness", "bark_young_roughness_grey",
    "leaf_albedo",       "leaf_normal",       "blade_albedo",         "blade_normal"};
constexpr size_t kOldBark = 4;  // of these come first
// Of 100; above 90 the encoder keeps colours at every pixel, which normals need.
constexpr int kJpegQuality = 91;
std::span<const ReadyPicture> ready_pictures;

Image channel_of(const Image& image, int channel) {
    Image grey(image.width, image.height, 1);
    for (size_t i = 0; i < grey.pixels.size(); i++)
        grey.pixels[i] = image.pixels[i * static_cast<size_t>(image.channels) + static_cast<size_t>(channel)];
    return grey;
}

// Takes what the encoder has ready to the vector that it was given.
void append(void* out, void* data, int size) {
    auto* bytes = static_cast<uint8_t*>(data);
    auto* all = static_cast<std::vector<uint8_t>*>(out);
    all->insert(all->end(), bytes, bytes + size);
}

bool is_bark(std::string_view name) {
    return name.starts_with("bark");
}

// The encoder makes three channels of a grey one.
bool is_jpeg(std::string_view name) {
    return is_bark(name) && !name.ends_with("_grey");
}

}  // namespace

std::vector<uint8_t> encode_png(const Image& image) {
    std::vector<uint8_t> png;
    if (!stbi_write_png_to_func(append, &png, image.width, image.height, image.channels, image.pixels.data(),
                                image.width * image.channels))
        throw Error("A texture could not be turned into a PNG picture: out of memory.");
    return png;
}

std::vector<uint8_t> encode_jpeg(const Image& image) {
    std::vector<uint8_t> jpeg;
    if (!stbi_write_jpg_to_func(append, &jpeg, image.width, image.height, image.channels, image.pixels.data(),
                                kJpegQuality))
        throw Error("A texture could not be turned into a JPEG picture: out of memory.");
    return jpeg;
}

void write_png(const std::string& path, const Image& image) {
    const std::vector<uint8_t> bytes = encode_png(image);
    write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

namespace {

std::vector<NamedPicture> encode_all(std::span<const char* const> names,
                                     std::span<const Image* const> images) {
    std::vector<NamedPicture> pictures(names.size());
    parallel_for(pictures.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) {
            auto bytes = std::make_shared<const std::vector<uint8_t>>(
                is_jpeg(names[i]) ? encode_jpeg(*images[i]) : encode_png(*images[i]));
            pictures[i] = {names[i], {reinterpret_cast<const char*>(bytes->data()), bytes->size()}, bytes};
        }
    });
    return pictures;
}

}  // namespace

std::vector<NamedPicture> draw_pictures(const std::string& preset, int size, uint64_t seed) {
    const BarkTextures bark = make_bark_textures(preset, bark_size(size), seed);
    const BarkTextures young =
        make_bark_textures(preset, std::max(16, bark_size(size) / 4 * 2), seed, BarkAge::kYoung);
    const LeafTextures leaf = make_leaf_textures(preset, size, seed);
    const LeafTextures blade = make_blade_textures(preset, std::max(16, size / 2), seed);
    const Image grey = channel_of(bark.roughness, 1), young_grey = channel_of(young.roughness, 1);
    const Image* images[] = {&bark.albedo,  &bark.normal,  &bark.roughness,  &grey,
                             &young.albedo, &young.normal, &young.roughness, &young_grey,
                             &leaf.albedo,  &leaf.normal,  &blade.albedo,    &blade.normal};
    return encode_all(kNames, images);
}

std::vector<NamedPicture> draw_sprays(const std::string& preset, int size, uint64_t seed) {
    constexpr const char* kSprayNames[] = {"sprays_albedo", "sprays_normal"};
    const LeafTextures sprays = make_spray_textures(preset, size, seed);
    const Image* images[] = {&sprays.albedo, &sprays.normal};
    return encode_all(kSprayNames, images);
}

std::vector<NamedPicture> encode_bark(const BarkTextures& bark) {
    const Image grey = channel_of(bark.roughness, 1);
    const Image* images[] = {&bark.albedo, &bark.normal, &bark.roughness, &grey};
    return encode_all(std::span(kNames).first(kOldBark), images);
}

void set_ready_pictures(std::span<const ReadyPicture> pictures) {
    ready_pictures = pictures;
}

std::vector<std::string> picture_names() {
    return {std::begin(kNames), std::end(kNames)};
}

const char* picture_ending(std::string_view name) {
    return is_jpeg(name) ? ".jpg" : ".png";
}

std::vector<NamedPicture> make_pictures(const std::string& preset, int size, uint64_t seed) {
    std::vector<NamedPicture> pictures;
    if (size == kTextureSize && seed == kTextureSeed)
        for (const char* name : kNames)
            for (const ReadyPicture& ready : ready_pictures)
                if (ready.preset == preset && ready.name == name) pictures.push_back({name, ready.bytes, {}});
    return pictures.size() == std::size(kNames) ? pictures : draw_pictures(preset, size, seed);
}

std::vector<NamedPicture> pictures_of_model(std::vector<NamedPicture> pictures, bool blade, bool young) {
    const std::string_view dropped = blade ? "leaf_" : "blade_";
    std::erase_if(pictures, [&](const NamedPicture& picture) {
        return picture.name.starts_with(dropped) ||
               (is_bark(picture.name) && picture.name.starts_with("bark_young_") != young);
    });
    for (NamedPicture& picture : pictures) {
        if (picture.name.starts_with("blade_")) picture.name.replace(0, 5, "leaf");
        if (picture.name.starts_with("bark_young_")) picture.name.replace(0, 10, "bark");
    }
    return pictures;
}

std::vector<std::string> write_pictures(const std::string& directory, const std::string& preset,
                                        const std::vector<NamedPicture>& pictures) {
    make_folder(directory);
    std::vector<std::string> paths;
    for (const NamedPicture& picture : pictures) {
        paths.push_back(utf8_of(path_of(directory) /
                                path_of(preset + "_" + picture.name + picture_ending(picture.name))));
        write_file(paths.back(), picture.bytes);
    }
    return paths;
}

}  // namespace treerec
