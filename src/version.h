// The version of the library, the program and the addon: the one that CHANGELOG.md names first.
#pragma once

namespace treerec {

inline constexpr const char* kVersion = "0.1.0";

}  // namespace treerec
