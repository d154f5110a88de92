// The shader globals of the wind (addons/tree_reconstruction/shaders/tree_wind.gdshaderinc).
#pragma once

#include <godot_cpp/variant/dictionary.hpp>

// By name: what they are where a project does not say otherwise.
godot::Dictionary get_wind_globals();
// Adds those that the project's settings lack, so that a shader finds them always. To be called once the
// engine has started.
void add_wind_globals();
