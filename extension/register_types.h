#pragma once

#include <godot_cpp/godot.hpp>

// Called by the engine at each of its initialization levels, upwards and then downwards.
void initialize_tree_reconstruction(godot::ModuleInitializationLevel p_level);
void terminate_tree_reconstruction(godot::ModuleInitializationLevel p_level);
