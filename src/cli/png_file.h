// Pictures as files of their own. Internal to cli/.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments.h"
#include "exchange/material_textures.h"
#include "file_bytes.h"
#include "mesh/image.h"

namespace treerec {

// Throws UsageError for a name that does not end in .png, or where no file can be written: to be asked before
// the long work.
inline void require_png(const std::string& path) {
    if (extension_of(path) != "png")
        throw UsageError("A sheet is a PNG: '" + path + "' does not end in .png.");
    try {
        require_writable(path);
    } catch (const Error& error) {
        throw UsageError(error.what());
    }
}

inline void write_png(const std::string& path, const Image& picture) {
    const std::vector<uint8_t> bytes = encode_png(picture);
    write_file(path, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

}  // namespace treerec
