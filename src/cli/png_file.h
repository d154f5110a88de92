// Names of pictures to write. Internal to cli/.
#pragma once

#include <string>

#include "cli/arguments.h"
#include "file_bytes.h"

namespace treerec {

// Throws UsageError for a name that does not end in .png, or where no file can be written: to be asked before
// the long work.
inline void require_png(const std::string& path) {
    if (extension_of(path) != "png")
        throw UsageError("A picture is a PNG: '" + path + "' does not end in .png.");
    try {
        require_writable(path);
    } catch (const Error& error) {
        throw UsageError(error.what());
    }
}

}  // namespace treerec
