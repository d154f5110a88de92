#pragma once

namespace godot {

using real_t = float; // The engine's official builds; the generator refuses a dump of a double precision engine.

} // namespace godot
