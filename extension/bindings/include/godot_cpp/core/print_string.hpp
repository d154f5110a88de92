#pragma once

#include <godot_cpp/variant/utility_functions.hpp>

namespace godot {

template <typename... Args>
void print_line(const Variant& p_first, const Args&... p_rest) {
    UtilityFunctions::print(p_first, p_rest...);
}

}  // namespace godot
