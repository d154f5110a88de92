#include "file_bytes.h"

#include <filesystem>
#include <fstream>
#include <new>
#include <system_error>

#include "error.h"

namespace treerec {

namespace fs = std::filesystem;

namespace {

fs::path path_of(const std::string& utf8) {
    return fs::path(std::u8string(utf8.begin(), utf8.end()));
}

}  // namespace

FileBytes read_file(const std::string& path) {
    if (path.empty()) throw Error("No file was named.");
    if (path.find('\0') != std::string::npos) throw Error("The file's name contains a null character.");
    std::error_code code;
    const fs::file_status status = fs::status(path_of(path), code);
    if (!fs::exists(status)) throw Error("'" + path + "' does not exist or cannot be reached.");
    if (fs::is_directory(status)) throw Error("'" + path + "' is a folder; name a file in it.");
    if (!fs::is_regular_file(status)) throw Error("'" + path + "' is not a regular file.");
    const uintmax_t size = fs::file_size(path_of(path), code);
    std::ifstream stream(path_of(path), std::ios::binary);
    if (code || !stream) throw Error("'" + path + "' cannot be opened; check that you may read it.");

    FileBytes bytes;
    try {
        bytes.data = std::make_unique_for_overwrite<char[]>(static_cast<size_t>(size) + 1);
    } catch (const std::bad_alloc&) {
        throw Error("'" + path + "' is too large for this machine's memory (" + std::to_string(size >> 20) +
                    " MiB); thin it first.");
    }
    stream.read(bytes.data.get(), static_cast<std::streamsize>(size));
    if (static_cast<uintmax_t>(stream.gcount()) != size)
        throw Error("'" + path + "' could not be read to its end; check the disk it is on.");
    bytes.size = static_cast<size_t>(size);
    bytes.data[bytes.size] = '\0';
    return bytes;
}

void write_file(const std::string& path, std::string_view bytes) {
    const fs::path target = path_of(path);
    std::error_code code;
    if (fs::is_directory(target, code)) throw Error("'" + path + "' is a folder; name a file to write.");
    const fs::path beside = path_of(path + ".part");
    bool written = false;
    {
        std::ofstream stream(beside, std::ios::binary | std::ios::trunc);
        if (!stream)
            throw Error("'" + path +
                        "' cannot be written; check that its folder exists and is yours to write.");
        stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        stream.close();
        written = !stream.fail();
    }
    if (written) fs::rename(beside, target, code);
    if (!written || code) {
        std::error_code ignored;
        fs::remove(beside, ignored);
        throw Error("'" + path + "' could not be written; check the disk's free space and the rights.");
    }
}

}  // namespace treerec
