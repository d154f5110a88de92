// A tree's nodes as arrays of the engine, parents before children.
#pragma once

#include <godot_cpp/variant/aabb.hpp>
#include <godot_cpp/variant/array.hpp>
#include <godot_cpp/variant/packed_float32_array.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <vector>

#include "tree/tree.h"

namespace node_arrays {

std::vector<treerec::NodeId> list_nodes(const treerec::Tree& p_tree);
godot::PackedVector3Array positions(const treerec::Tree& p_tree);  // metres
godot::PackedFloat32Array radii(const treerec::Tree& p_tree);      // metres
godot::PackedInt32Array parents(const treerec::Tree& p_tree);
godot::PackedInt32Array trunk(const treerec::Tree& p_tree);
// Around the wood; empty without nodes.
godot::AABB box(const treerec::Tree& p_tree);
// A surface of lines from parent to child, coloured by the nodes' kinds, radii in UV; empty without any.
godot::Array lines(const treerec::Tree& p_tree);
// Lines from these nodes to their parents alone.
godot::Array lines_of(const treerec::Tree& p_tree, const godot::PackedInt32Array& p_ids);

}  // namespace node_arrays
