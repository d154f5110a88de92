// Programs on this machine. Internal to photos/.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace treerec {

#ifdef _WIN32
inline constexpr char kPathSeparator = ';';
#else
inline constexpr char kPathSeparator = ':';
#endif

// UTF-8; "" where it is not set.
std::string environment_value(const char* name);

// Whether it is a file that can be run.
bool is_program(const std::filesystem::path& path);

// Those that PATH names, in its order.
std::vector<std::filesystem::path> folders_on_path();

// The program `name` (without ".exe"): where the environment's `variable` says, that one, or the one in that
// folder; else on PATH, in `beside`, and where package managers put programs. "" where there is none. Throws
// Error where the variable is set and there is none.
std::string find_program(const std::string& name, const char* variable,
                         const std::vector<std::filesystem::path>& beside = {});

}  // namespace treerec
