// The pictures of a tree's materials as PNG, in memory and in files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/image.h"

namespace treerec {

inline constexpr int kTextureSize = 512;  // pixels along an edge of the textures in model files

std::vector<uint8_t> encode_png(const Image& image);

struct NamedPicture {
    std::string name;  // "bark_albedo", "bark_normal", "bark_roughness", "leaf_albedo" or "leaf_normal"
    std::vector<uint8_t> png;

    std::string_view bytes() const { return {reinterpret_cast<const char*>(png.data()), png.size()}; }
};

// The five pictures of a preset, in the order of the list above.
std::vector<NamedPicture> make_pictures(const std::string& preset, int size, uint64_t seed);

// Writes <directory>/<preset>_<name>.png for each picture and returns the paths; makes the directory. Throws
// Error, naming the path, where it cannot write.
std::vector<std::string> write_pictures(const std::string& directory, const std::string& preset, int size,
                                        uint64_t seed);

}  // namespace treerec
