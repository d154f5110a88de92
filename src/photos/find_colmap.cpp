#include "photos/find_colmap.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "error.h"
#include "file_bytes.h"
#include "photos/find_program.h"

namespace treerec {

namespace {

namespace fs = std::filesystem;

// It tells its options within one second; from a slow disk, with its libraries, within some.
constexpr double kMostSeconds = 60.0;

#ifdef _WIN32
constexpr const char* kName = "colmap.exe";
#else
constexpr const char* kName = "colmap";
#endif

// The program in a folder in which COLMAP was unpacked or installed, or the program itself; a COLMAP.bat
// stands for the program beside it.
std::optional<fs::path> program_at(const fs::path& place) {
    const std::string ending = extension_of(utf8_of(place));
    if (ending != "bat" && ending != "cmd" && is_program(place)) return place;
    const fs::path folder = ending == "bat" || ending == "cmd" ? place.parent_path() : place;
    for (const fs::path& inside : {fs::path("bin") / kName, fs::path(kName), fs::path("MacOS") / kName,
                                   fs::path("Contents") / "MacOS" / kName})
        if (is_program(folder / inside)) return folder / inside;
    return std::nullopt;
}

// Where it is installed by itself, by package managers and by those who unpack it.
std::vector<fs::path> usual_folders() {
    std::vector<fs::path> folders;
    const auto add = [&](const std::string& above, const char* below) {
        if (!above.empty()) folders.push_back(path_of(above) / below);
    };
#ifdef _WIN32
    // It comes as an archive, whose folder is called after its version: COLMAP-3.8-windows-no-cuda.
    for (const char* name : {"ProgramFiles", "LOCALAPPDATA", "USERPROFILE", "SystemDrive"}) {
        std::string above = environment_value(name);
        if (above.empty()) continue;
        if (above.back() == ':') above += '\\';
        std::vector<fs::path> versions;
        std::error_code failure;
        for (fs::directory_iterator at(path_of(above), failure), end; !failure && at != end;
             at.increment(failure)) {
            if (lower_case(utf8_of(at->path().filename())).starts_with("colmap"))
                versions.push_back(at->path());
        }
        std::sort(versions.rbegin(), versions.rend());
        folders.insert(folders.end(), versions.begin(), versions.end());
    }
    add(environment_value("LOCALAPPDATA"), "Programs\\COLMAP");
#else
    const std::string home = environment_value("HOME");
    for (const char* folder :
         {"/usr/bin", "/usr/local/bin", "/opt/colmap/bin", "/opt/colmap", "/opt/homebrew/bin",
          "/opt/local/bin", "/snap/bin", "/Applications/COLMAP.app"})
        folders.emplace_back(folder);
    add(home, ".local/bin");
    add(home, "Applications/COLMAP.app");
    add(home, "miniconda3/bin");
    add(home, "colmap");
#endif
    return folders;
}

std::optional<fs::path> find_colmap_program(const std::string& asked) {
    if (!asked.empty()) {
        if (const auto found = program_at(path_of(asked))) return found;
        // A bare word is looked for as a shell would.
        if (path_of(asked).has_parent_path()) return std::nullopt;
        for (const fs::path& folder : folders_on_path())
            if (is_program(folder / path_of(asked))) return folder / path_of(asked);
        return std::nullopt;
    }
    for (const fs::path& folder : folders_on_path())
        if (is_program(folder / kName)) return folder / kName;
    for (const fs::path& folder : usual_folders())
        if (const auto found = program_at(folder)) return found;
    return std::nullopt;
}

const char* how_to_install() {
#ifdef _WIN32
    return "Unpack COLMAP for Windows from its releases page (github.com/colmap/colmap) into a folder "
           "C:\\COLMAP, or name its folder.";
#elif defined(__APPLE__)
    return "Install it with 'brew install colmap', or name the program.";
#else
    return "Install it ('sudo apt install colmap' on Debian and Ubuntu), or name the program.";
#endif
}

// Adds what an archive of COLMAP has beside its program, as its own COLMAP.bat does.
void add_libraries(const fs::path& program, ChildCommand& command) {
#ifdef _WIN32
    const fs::path folder = program.parent_path();
    const bool in_bin = utf8_of(folder.filename()) == "bin";
    const fs::path root = in_bin ? folder.parent_path() : folder;
    std::error_code failure;
    std::string libraries, plugins;
    for (const fs::path& place : {root / "lib", root / "bin", root / "plugins"})
        if (fs::is_directory(place, failure))
            (place.filename() == "plugins" ? plugins : libraries) += utf8_of(place) + kPathSeparator;
    plugins += utf8_of(root / "lib") + kPathSeparator;
    command.environment.emplace_back("PATH", libraries + environment_value("PATH"));
    command.environment.emplace_back("QT_PLUGIN_PATH", plugins + environment_value("QT_PLUGIN_PATH"));
#else
    (void)program;
    (void)command;
#endif
}

// "  --Mapper.min_num_matches arg (=15)" has one, at its beginning.
std::string option_in(const std::string& line) {
    const size_t begin = line.find_first_not_of(' ');
    // -h is told with --help in brackets: of no interest.
    if (begin == std::string::npos || line.compare(begin, 2, "--") != 0) return "";
    return line.substr(begin, line.find_first_of(" =[", begin) - begin);
}

}  // namespace

Colmap::Colmap(const std::string& program, const Progress* progress) : program_(program) {
    ChildCommand asking = call("-h");
    asking.most_seconds = kMostSeconds;
    bool ours = false, cuda_told = false;
    std::string last;
    const ChildEnd end = run_child(
        asking,
        [&](const std::string& line) {
            last = line;
            const size_t at = line.find("COLMAP ");
            if (at != std::string::npos && !ours) {
                const size_t begin = at + 7;
                const std::string word = line.substr(begin, line.find(' ', begin) - begin);
                ours = true;
                if (!word.empty() && word[0] >= '0' && word[0] <= '9') version_ = word;
            }
            if (line.find("without CUDA") != std::string::npos) cuda_told = true;
            if (line.find("with CUDA") != std::string::npos) cuda_ = true;
        },
        progress);
    cuda_ = cuda_ && !cuda_told;
    if (!ours)
        throw Error("'" + program + "' does not answer as COLMAP does" +
                    (end.overdue    ? ": it did not answer at all"
                     : last.empty() ? ""
                                    : " (it says: " + quote_word(last) + ")") +
                    ". " + how_to_install());
}

bool Colmap::knows(const std::string& command, const std::string& option, const Progress* progress) {
    auto known = options_.find(command);
    if (known == options_.end()) {
        std::set<std::string> options;
        ChildCommand asking = call(command);
        asking.arguments.emplace_back("-h");
        asking.most_seconds = kMostSeconds;
        run_child(
            asking,
            [&](const std::string& line) {
                const std::string found = option_in(line);
                if (!found.empty()) options.insert(found);
            },
            progress);
        if (options.empty())
            throw Error("'" + program_ + " " + command +
                        " -h' does not tell its options; is it a whole COLMAP? " + how_to_install());
        known = options_.emplace(command, std::move(options)).first;
    }
    return known->second.count(option) > 0;
}

ChildCommand Colmap::call(const std::string& command) const {
    ChildCommand result;
    result.program = program_;
    result.arguments.push_back(command);
    add_libraries(path_of(program_), result);
#ifdef __linux__
    // Without a screen, too.
    result.environment.emplace_back("QT_QPA_PLATFORM", "offscreen");
#endif
    // Its log comes to us, and goes to no folder of its own.
    result.environment.emplace_back("GLOG_logtostderr", "1");
    return result;
}

Colmap find_colmap(const std::string& asked, const Progress* progress) {
    const std::string wanted = asked.empty() ? environment_value("COLMAP") : asked;
    const std::optional<fs::path> found = find_colmap_program(wanted);
    if (!found && !wanted.empty())
        throw Error("There is no program COLMAP at '" + wanted + "'. " + how_to_install());
    if (!found)
        throw Error("COLMAP, which finds out where photos were taken from, is not on this machine. " +
                    std::string(how_to_install()));
    std::error_code failure;
    const fs::path whole = fs::absolute(*found, failure);
    return Colmap(utf8_of(failure ? *found : whole), progress);
}

std::string vocabulary_tree_of(const Colmap& colmap) {
    // Since 3.12 they are of another kind.
    int major = 0, minor = 0;
    const bool told = std::sscanf(colmap.version().c_str(), "%d.%d", &major, &minor) == 2;
    const bool newer = told && (major > 3 || minor >= 12);
    const fs::path folder = path_of(colmap.program()).parent_path();
    std::vector<std::string> found;
    for (const fs::path& place : {folder, folder.parent_path() / "share" / "colmap"}) {
        std::error_code failure;
        for (fs::directory_iterator at(place, failure), end; !failure && at != end; at.increment(failure)) {
            const std::string name = utf8_of(at->path().filename());
            if (name.starts_with("vocab_tree") && name.ends_with(".bin") &&
                (name.find("faiss") != std::string::npos) == newer)
                found.push_back(utf8_of(at->path()));
        }
    }
    return found.empty() ? "" : *std::min_element(found.begin(), found.end());
}

}  // namespace treerec
