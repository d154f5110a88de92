// Whole files in and out of memory, and their names. Paths are UTF-8 throughout.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "progress.h"

namespace treerec {

// A file's contents, owned and writable.
struct FileBytes {
    std::unique_ptr<char[]> data;
    size_t size = 0;

    std::string_view view() const { return {data.get(), size}; }
};

// Throws Error where the file is missing, a folder, unreadable, or too large for memory.
FileBytes read_file(const std::string& path, Progress* progress = nullptr);

// Writes beside `path`, under a name of its own, and renames: a failure leaves the old file, and of several
// writers one wins. Links stay; a pipe or a device is written to straight. Throws Error, or Cancelled.
void write_file(const std::string& path, std::string_view bytes, const Progress* progress = nullptr);
// The parts one after the other.
void write_file(const std::string& path, std::span<const std::string_view> parts,
                const Progress* progress = nullptr);

// Throws Error if a file at `path` could not be written: its folder is not there or not ours to write, or it
// is a folder itself. To be asked before the long work.
void require_writable(const std::string& path);

// Makes the folder and those above it. Throws Error.
void make_folder(const std::string& path);

// To what the operating system takes, and back.
std::filesystem::path path_of(const std::string& utf8);
std::string utf8_of(const std::filesystem::path& path);

// With the letters A to Z as a to z; all others stay, whatever the language.
std::string lower_case(std::string text);
// What follows the last dot of the file's name, in lower case: "ply". Empty without a dot.
std::string extension_of(const std::string& path);
// The file's name without folder and extension.
std::string stem_of(const std::string& path);
// The file called `name` in the folder of `path`.
std::string sibling_of(const std::string& path, const std::string& name);

}  // namespace treerec
