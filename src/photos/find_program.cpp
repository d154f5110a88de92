#include "photos/find_program.h"

#include <algorithm>
#include <cstdlib>

#include "error.h"
#include "file_bytes.h"

#ifdef _WIN32
#include <windows.h>
#else
#include <unistd.h>
#endif

namespace treerec {

namespace fs = std::filesystem;

std::string environment_value(const char* name) {
#ifdef _WIN32
    const wchar_t* const value = _wgetenv(path_of(name).c_str());
    return value ? utf8_of(fs::path(value)) : "";
#else
    const char* const value = std::getenv(name);
    return value ? value : "";
#endif
}

bool is_program(const fs::path& path) {
    std::error_code failure;
    if (!fs::is_regular_file(path, failure)) return false;
#ifdef _WIN32
    return true;
#else
    return access(path.c_str(), X_OK) == 0;
#endif
}

std::vector<fs::path> folders_on_path() {
    std::vector<fs::path> folders;
    const std::string all = environment_value("PATH");
    for (size_t at = 0; at <= all.size();) {
        const size_t end = std::min(all.find(kPathSeparator, at), all.size());
        if (end > at) folders.push_back(path_of(all.substr(at, end - at)));
        at = end + 1;
    }
    return folders;
}

std::string find_program(const std::string& name, const char* variable, const std::vector<fs::path>& beside) {
#ifdef _WIN32
    const std::string file = name + ".exe";
#else
    const std::string file = name;
#endif
    const std::string wanted = environment_value(variable);
    if (!wanted.empty()) {
        for (const fs::path& place : {path_of(wanted), path_of(wanted) / file})
            if (is_program(place)) return utf8_of(place);
        throw Error("There is no program " + name + " at '" + wanted + "', which $" + variable + " names.");
    }
    std::vector<fs::path> folders = folders_on_path();
    folders.insert(folders.end(), beside.begin(), beside.end());
#ifndef _WIN32
    // What is begun from a desktop may have a shorter PATH than a shell.
    for (const char* folder : {"/usr/local/bin", "/opt/homebrew/bin", "/opt/local/bin", "/snap/bin"})
        folders.emplace_back(folder);
#endif
    for (const fs::path& folder : folders)
        if (is_program(folder / file)) return utf8_of(folder / file);
    return "";
}

}  // namespace treerec
