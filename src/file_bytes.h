// Whole files in and out of memory.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace treerec {

// A file's contents, owned and writable.
struct FileBytes {
    std::unique_ptr<char[]> data;
    size_t size = 0;

    std::string_view view() const { return {data.get(), size}; }
};

// path: UTF-8. Throws Error where the file is missing, a folder, unreadable, or too large for memory.
FileBytes read_file(const std::string& path);

// Writes beside `path` and renames, so that a failure leaves the old file as it was. Throws Error.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace treerec
