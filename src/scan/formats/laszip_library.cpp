#include "scan/formats/laszip_library.h"

#include <cstdlib>
#include <vector>

#include "error.h"
#include "file_bytes.h"

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

namespace treerec {

namespace {

#ifdef _WIN32
using Handle = HMODULE;
constexpr const char* kNames[] = {"laszip3.dll", "laszip.dll", "liblaszip.dll", "laszip64.dll"};

Handle open_library(const std::string& name) {
    return LoadLibraryW(path_of(name).c_str());
}
void* find_symbol(Handle library, const char* name) {
    return reinterpret_cast<void*>(GetProcAddress(library, name));
}
void close_library(Handle library) {
    FreeLibrary(library);
}
#else
using Handle = void*;
#ifdef __APPLE__
constexpr const char* kNames[] = {"liblaszip.8.dylib", "liblaszip.dylib", "/opt/homebrew/lib/liblaszip.dylib",
                                  "/usr/local/lib/liblaszip.dylib"};
#else
constexpr const char* kNames[] = {"liblaszip.so.8", "liblaszip.so.9", "liblaszip.so"};
#endif

Handle open_library(const std::string& name) {
    return dlopen(name.c_str(), RTLD_LAZY | RTLD_LOCAL);
}
void* find_symbol(Handle library, const char* name) {
    return dlsym(library, name);
}
void close_library(Handle library) {
    dlclose(library);
}
#endif

template <typename Function>
bool bind(Handle library, const char* name, Function*& function) {
    function = reinterpret_cast<Function*>(find_symbol(library, name));
    return function != nullptr;
}

bool bind_all(Handle library, LaszipLibrary& laszip) {
    return bind(library, "laszip_get_version", laszip.get_version) &&
           bind(library, "laszip_create", laszip.create) && bind(library, "laszip_destroy", laszip.destroy) &&
           bind(library, "laszip_get_error", laszip.get_error) &&
           bind(library, "laszip_decompress_selective", laszip.decompress_selective) &&
           bind(library, "laszip_open_reader", laszip.open_reader) &&
           bind(library, "laszip_get_point_pointer", laszip.get_point_pointer) &&
           bind(library, "laszip_read_point", laszip.read_point) &&
           bind(library, "laszip_close_reader", laszip.close_reader);
}

struct Search {
    LaszipLibrary laszip;
    std::string failure;  // empty: found
};

Search search() {
    Search result;
    std::vector<std::string> names(std::begin(kNames), std::end(kNames));
    const char* wanted = std::getenv("TREEREC_LASZIP");
    if (wanted && *wanted) names = {wanted};
    result.failure =
        wanted && *wanted
            ? std::string("LASzip, which unpacks it, cannot be loaded from '") + wanted +
                  "', which TREEREC_LASZIP names."
            : "LASzip, which unpacks it, is not installed: install the package liblaszip8 (Debian 13, "
              "Ubuntu), "
              "laszip (Fedora, Arch, Homebrew, vcpkg, conda-forge) or mingw-w64-x86_64-laszip (MSYS2), or "
              "name "
              "its library in the environment variable TREEREC_LASZIP. Or unpack the scan to .las first.";
    for (const std::string& name : names) {
        const Handle library = open_library(name);
        if (!library) continue;
        uint8_t major = 0;
        uint8_t minor = 0;
        uint16_t revision = 0;
        uint32_t build = 0;
        if (bind_all(library, result.laszip) &&
            result.laszip.get_version(&major, &minor, &revision, &build) == 0 && major == 3) {
            result.failure.clear();
            return result;
        }
        close_library(library);
        result.failure = "LASzip, which unpacks it, is installed as '" + name +
                         "', but not in version 3, which is needed. Or unpack the scan to .las first.";
    }
    return result;
}

}  // namespace

const LaszipLibrary& laszip_library() {
    static const Search found = search();
    if (!found.failure.empty()) throw Error(found.failure);
    return found.laszip;
}

}  // namespace treerec
