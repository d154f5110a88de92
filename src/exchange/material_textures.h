// The pictures of a tree's materials as files have them, in memory and in files: bark as JPEG, a third as
// large, and leaves, which have transparent parts, and what is grey as PNG.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/image.h"
#include "textures/textures.h"

namespace treerec {

// What model files carry. A kind of tree has one look: the seed of a tree's leaves does not change it.
inline constexpr int kTextureSize = 512;  // pixels along an edge, of leaves
// Bark is seen from as near, and its pictures cover more: so many pixels around, and bark_rows() along.
inline constexpr int bark_size(int size) {
    return (size + size / 2) & ~1;
}
inline constexpr uint64_t kTextureSeed = 1;

std::vector<uint8_t> encode_png(const Image& image);
// Opaque. Three channels keep their own colours at every pixel, for normals.
std::vector<uint8_t> encode_jpeg(const Image& image);
// A PNG as a file. Throws Error where it can't be written.
void write_png(const std::string& path, const Image& image);

struct NamedPicture {
    // "bark_albedo", "bark_normal", "bark_roughness" (textures/textures.h), "bark_roughness_grey" (the
    // roughness alone, for formats that want it so), "bark_young_albedo", "bark_young_normal",
    // "bark_young_roughness", "bark_young_roughness_grey" (half as large, as is what they cover),
    // "leaf_albedo", "leaf_normal" (a spray), "blade_albedo" or "blade_normal" (one leaf, half as large).
    std::string name;
    std::string_view bytes;                             // of its file
    std::shared_ptr<const std::vector<uint8_t>> drawn;  // what holds them; null for the build's own
};

// A picture that the build drew, of kTextureSize and kTextureSeed.
struct ReadyPicture {
    std::string_view preset;
    std::string_view name;
    std::string_view bytes;
};

// Takes pictures that need no drawing any more; they must outlive all use. Not while others make pictures.
void set_ready_pictures(std::span<const ReadyPicture> pictures);

// What these are called, whatever the preset.
std::vector<std::string> picture_names();

// The ending of the file of a picture of this name, ".jpg" or ".png".
const char* picture_ending(std::string_view name);

// The twelve pictures of a preset, in this order: the build's, where it drew these.
std::vector<NamedPicture> make_pictures(const std::string& preset, int size = kTextureSize,
                                        uint64_t seed = kTextureSeed);

// The same bytes, always drawn anew; it takes seconds.
std::vector<NamedPicture> draw_pictures(const std::string& preset, int size, uint64_t seed);
// "sprays_albedo" and "sprays_normal": make_spray_textures(), for the addon's shader alone.
std::vector<NamedPicture> draw_sprays(const std::string& preset, int size, uint64_t seed);

// The four pictures of a bark, with these names.
std::vector<NamedPicture> encode_bark(const BarkTextures& bark);

// Those that the model file of one tree needs: the leaf's are of a spray or, with `blade`, of one leaf, and
// the bark's of the young one with `young`; all by the names of the others.
std::vector<NamedPicture> pictures_of_model(std::vector<NamedPicture> pictures, bool blade,
                                            bool young = false);

// Writes <directory>/<preset>_<name>.jpg or .png for each picture and returns the paths; makes the directory.
// Throws Error, naming the path, where it cannot write.
std::vector<std::string> write_pictures(const std::string& directory, const std::string& preset,
                                        const std::vector<NamedPicture>& pictures);

}  // namespace treerec
