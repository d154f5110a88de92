#pragma once

#include <exception>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/packed_float32_array.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <string>
#include <vector>

#include "edit/commands/arguments.h"
#include "foliage/foliage.h"
#include "foliage/leaves.h"
#include "geometry/vec.h"
#include "mesh/joined_leaves.h"
#include "mesh/mesh.h"
#include "tree/tree.h"

// Gives `r_held` another value. godot-cpp's assignment of a temporary leaves what was held there in memory,
// with the objects in it.
template <typename T>
void replace(T& r_held, const T& p_value) {
    r_held = p_value;
}

// Values of the core as values of the engine.

inline godot::Vector3 to_godot(const treerec::DVec3& p_vector) {
    return godot::Vector3(float(p_vector.x), float(p_vector.y), float(p_vector.z));
}

// An id that a script gives may be any number.
inline bool holds_node(const treerec::Tree& p_tree, int64_t p_id) {
    return p_id >= 0 && p_id < p_tree.id_end() && p_tree.contains(treerec::NodeId(p_id));
}

// Throws treerec::Error where the tree has no such node.
treerec::NodeId node_of(const treerec::Tree& p_tree, int64_t p_id);

inline godot::String to_godot(const std::string& p_text) {
    return godot::String::utf8(p_text.c_str(), int64_t(p_text.size()));
}

std::string to_std(const godot::String& p_text);

godot::PackedFloat32Array to_godot(const std::vector<float>& p_values);
godot::PackedInt32Array to_godot(const std::vector<treerec::NodeId>& p_ids);
// What a command takes, as TreeReconstruction.get_edit_commands() tells it.
godot::TypedArray<godot::Dictionary> to_godot(const std::vector<treerec::Parameter>& p_parameters);

// Arguments for ArrayMesh::add_surface_from_arrays(), with kSurfaceFlags where there are CUSTOM values;
// empty for an empty mesh. Turns the triangles, since the engine's front faces are clockwise.
godot::Array to_surface_arrays(const treerec::Mesh& p_mesh);
extern const int64_t kSurfaceFlags;
// The same for leaves in one mesh (mesh/joined_leaves.h).
extern const int64_t kJoinedLeafFlags;
godot::Array to_surface_arrays(const treerec::JoinedLeaves& p_leaves);

// The core's trees keep what a file or a Dictionary holds. Throws treerec::Error for what is no such
// skeleton.
godot::Dictionary to_dictionary(const treerec::Tree& p_tree, int p_format_version);
treerec::Tree tree_from_dictionary(const godot::Dictionary& p_data);

// Likewise what a scan saw of the leaves: "place" holds the bits of the origin's x, y, z, the cells' edge and
// the reach, "cells" 11 bytes for each: x, y, z and the number of points as 16-bit numbers, low byte first,
// and the colour.
godot::Dictionary to_dictionary(const treerec::Foliage& p_foliage, int p_format_version);
treerec::Foliage foliage_from_dictionary(const godot::Dictionary& p_data);

// Runs what may throw; the engine gets the error's sentence and the caller gets p_fallback.
template <typename F, typename T>
T guarded(T p_fallback, const F& p_function) {
    try {
        return p_function();
    } catch (const std::exception& error) {
        ERR_PRINT(to_godot(std::string(error.what())));
        return p_fallback;
    }
}
