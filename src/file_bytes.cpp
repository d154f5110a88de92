#include "file_bytes.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <new>
#include <random>
#include <system_error>

#include "error.h"

namespace treerec {

namespace fs = std::filesystem;

FileBytes read_file(const std::string& path, Progress* progress) {
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
    // In pieces, so that a slow disk can be given up.
    constexpr uintmax_t kPiece = uintmax_t{4} << 20;
    for (uintmax_t at = 0; at < size; at += kPiece) {
        if (progress) progress->check();
        const uintmax_t piece = std::min(kPiece, size - at);
        stream.read(bytes.data.get() + at, static_cast<std::streamsize>(piece));
        if (static_cast<uintmax_t>(stream.gcount()) != piece)
            throw Error("'" + path + "' could not be read to its end; check the disk it is on.");
        if (progress)
            progress->update(static_cast<double>(at + piece) / static_cast<double>(size), "Reading");
    }
    bytes.size = static_cast<size_t>(size);
    bytes.data[bytes.size] = '\0';
    return bytes;
}

namespace {

// Pipes, terminals, /dev/stdout: nothing can be renamed onto them.
bool is_special(const fs::path& path) {
    std::error_code code;
    const fs::file_status status = fs::status(path, code);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

constexpr size_t kBytesBetweenChecks = size_t{8} << 20;

bool write_stream(const fs::path& path, std::span<const std::string_view> parts, const Progress* progress) {
    std::ofstream stream(path, std::ios::binary | std::ios::trunc);
    for (std::string_view part : parts) {
        while (!part.empty() && stream) {
            if (progress) progress->check();
            const std::string_view piece = part.substr(0, kBytesBetweenChecks);
            stream.write(piece.data(), static_cast<std::streamsize>(piece.size()));
            part.remove_prefix(piece.size());
        }
    }
    stream.close();
    return !stream.fail();
}

// Removes what was written beside a file unless it has been renamed.
struct Leftover {
    fs::path path;
    ~Leftover() {
        std::error_code ignored;
        fs::remove(path, ignored);
    }
};

// Where the bytes go in the end: for a link, what it points to.
fs::path target_of(const std::string& path) {
    const fs::path target = path_of(path);
    std::error_code code;
    if (!fs::is_symlink(target, code)) return target;
    const fs::path pointed_to = fs::canonical(target, code);
    return code ? target : pointed_to;
}

// What is written before it takes the target's place: no other process, and no other write of this one, has
// that name, so that two that write the same file at once each leave a whole one.
fs::path part_of(const fs::path& target) {
    static std::atomic<uint64_t> writes{0};
    static const uint64_t ours = [] {
        std::random_device device;
        return static_cast<uint64_t>(device()) << 32 | device();
    }();
    char id[17];
    std::snprintf(id, sizeof id, "%016llx", static_cast<unsigned long long>(ours + writes++));
    // File systems take 255 bytes for a name.
    constexpr size_t kLongest = 200;
    fs::path name = target.filename();
    if (utf8_of(name).size() > kLongest) name = "treerec";
    name += std::string(".") + id + ".part";
    return target.parent_path() / name;
}

}  // namespace

void write_file(const std::string& path, std::string_view bytes, const Progress* progress) {
    write_file(path, std::span(&bytes, 1), progress);
}

void write_file(const std::string& path, std::span<const std::string_view> parts, const Progress* progress) {
    require_writable(path);
    const Error failed("'" + path + "' could not be written; check the disk's free space and the rights.");
    if (is_special(path_of(path))) {
        if (!write_stream(path_of(path), parts, progress)) throw failed;
        return;
    }
    const fs::path target = target_of(path);
    const Leftover beside{part_of(target)};
    std::error_code code;
    if (!write_stream(beside.path, parts, progress)) throw failed;
    fs::rename(beside.path, target, code);
    if (code) throw failed;
}

void require_writable(const std::string& path) {
    if (path.empty()) throw Error("No file to write was named.");
    if (path.find('\0') != std::string::npos) throw Error("The file's name contains a null character.");
    std::error_code code;
    if (fs::is_directory(path_of(path), code)) throw Error("'" + path + "' is a folder; name a file in it.");
    if (is_special(path_of(path))) return;
    const fs::path target = target_of(path);
    const fs::path folder = target.parent_path();
    if (!folder.empty() && !fs::is_directory(folder, code))
        throw Error("'" + path + "' cannot be written: there is no folder '" + utf8_of(folder) + "'.");
    const fs::path beside = part_of(target);
    // A name that is too long for the file system is none.
    const bool named = fs::status(target, code).type() != fs::file_type::none;
    const bool writable =
        named && static_cast<bool>(std::ofstream(beside, std::ios::binary | std::ios::trunc));
    fs::remove(beside, code);
    if (!writable)
        throw Error("'" + path +
                    "' cannot be written; check its name and that its folder is yours to write.");
}

void make_folder(const std::string& path) {
    std::error_code failure;
    fs::create_directories(path_of(path), failure);
    if (failure) throw Error("The folder '" + path + "' cannot be made: " + failure.message() + ".");
}

fs::path path_of(const std::string& utf8) {
    return fs::path(std::u8string(utf8.begin(), utf8.end()));
}

std::string utf8_of(const fs::path& path) {
    const std::u8string utf8 = path.u8string();
    return {utf8.begin(), utf8.end()};
}

std::string lower_case(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

std::string extension_of(const std::string& path) {
    const size_t dot = path.find_last_of("./\\");
    if (dot == std::string::npos || path[dot] != '.') return {};
    return lower_case(path.substr(dot + 1));
}

std::string stem_of(const std::string& path) {
    return utf8_of(path_of(path).stem());
}

std::string sibling_of(const std::string& path, const std::string& name) {
    return utf8_of(path_of(path).parent_path() / path_of(name));
}

}  // namespace treerec
