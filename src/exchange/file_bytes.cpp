#include "exchange/file_bytes.h"

#include <filesystem>
#include <fstream>

#include "error.h"

namespace treerec {

namespace fs = std::filesystem;

fs::path utf8_path(const std::string& path) {
    return fs::path(std::u8string(path.begin(), path.end()));
}

namespace {

std::ifstream open_file(const std::string& path) {
    std::error_code failure;
    const fs::path file = utf8_path(path);
    const fs::file_status status = fs::status(file, failure);
    if (!fs::exists(status)) throw Error("There is no file '" + path + "'.");
    if (fs::is_directory(status)) throw Error("'" + path + "' is a folder, not a file.");
    std::ifstream in(file, std::ios::binary);
    if (!in) throw Error("'" + path + "' cannot be read; check its permissions.");
    return in;
}

}  // namespace

std::string read_file_bytes(const std::string& path, size_t limit) {
    std::ifstream in = open_file(path);
    std::string bytes;
    constexpr size_t kBlock = size_t{1} << 20;
    // By blocks rather than by the size on disk: a pipe has none.
    while (in) {
        const size_t before = bytes.size();
        if (before > limit)
            throw Error("'" + path + "' is larger than " + std::to_string(limit >> 20) +
                        " MB, too large for a file of this kind.");
        bytes.resize(before + kBlock);
        in.read(bytes.data() + before, static_cast<std::streamsize>(kBlock));
        bytes.resize(before + static_cast<size_t>(in.gcount()));
    }
    if (in.bad()) throw Error("'" + path + "' could not be read to its end.");
    return bytes;
}

std::string read_file_head(const std::string& path, size_t count) {
    std::ifstream in = open_file(path);
    std::string bytes(count, '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<size_t>(in.gcount()));
    return bytes;
}

void write_file_bytes(const std::string& path, std::string_view bytes) {
    const fs::path target = utf8_path(path);
    const fs::path beside = utf8_path(path + ".part");
    std::error_code failure;
    {
        std::ofstream out(beside, std::ios::binary | std::ios::trunc);
        if (!out)
            throw Error("'" + path + "' cannot be written; check that the folder exists and is writable.");
        out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        out.close();
        if (!out) {
            fs::remove(beside, failure);
            throw Error("'" + path + "' could not be written to its end; is the disk full?");
        }
    }
    fs::rename(beside, target, failure);
    if (failure) {
        const std::string reason = failure.message();
        fs::remove(beside, failure);
        throw Error("'" + path + "' could not be put in place: " + reason + ".");
    }
}

std::string file_extension(const std::string& path) {
    std::string extension = utf8_path(path).extension().string();
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return extension;
}

}  // namespace treerec
