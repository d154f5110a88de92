// How many cases the longest tests try.
#pragma once

#include <cstdlib>

namespace treerec::test {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

// Of so many random cases, a sanitized program tries the first quarter: each takes several times as long
// there, what it looks for is how memory is used, and the plain program tries them all.
constexpr int cases(int all) {
    return kSanitized ? (all + 3) / 4 : all;
}

// './dev test --long': what takes longest, too.
inline bool is_long_run() {
    return std::getenv("TREEREC_LONG") != nullptr;
}

// Of so many trees or angles that a slow test looks for the same in, one after another, it takes the first
// third; all in a long run.
inline int repeats(int all) {
    return is_long_run() ? all : (all + 2) / 3;
}

}  // namespace treerec::test
