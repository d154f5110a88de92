#pragma once

#if defined(_WIN32)
#define GDE_EXPORT __declspec(dllexport)
#else
#define GDE_EXPORT __attribute__((visibility("default")))
#endif

namespace godot {

using real_t = float;  // The engine's official builds; the generator refuses the description of another.

}  // namespace godot
