// Whole files in and out: what every reader and writer of small files shares.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace treerec {

// Paths are UTF-8 everywhere in the library.
std::filesystem::path utf8_path(const std::string& path);

// The bytes of the file. Throws Error with a sentence if there is no such file, it is a directory, cannot be
// read, or is larger than `limit` bytes.
std::string read_file_bytes(const std::string& path, size_t limit = size_t{1} << 31);

// At most the first `count` bytes of the file. Throws as read_file_bytes() does.
std::string read_file_head(const std::string& path, size_t count);

// Writes beside the target and renames, so that a failure leaves no half-written file. Throws Error.
void write_file_bytes(const std::string& path, std::string_view bytes);

// The extension in lower case with its dot (".glb"), or "" where there is none.
std::string file_extension(const std::string& path);

}  // namespace treerec
