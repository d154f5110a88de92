#include "convert.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/variant/packed_byte_array.hpp>
#include <godot_cpp/variant/packed_color_array.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>
#include <godot_cpp/variant/packed_vector2_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>

#include "error.h"

using namespace godot;
using treerec::DVec3;
using treerec::NodeId;

const int64_t kSurfaceFlags = int64_t(Mesh::ARRAY_CUSTOM_RGBA_FLOAT) << Mesh::ARRAY_FORMAT_CUSTOM0_SHIFT;

std::string to_std(const String& p_text) {
    const CharString bytes = p_text.utf8();
    return std::string(bytes.get_data(), size_t(bytes.length()));
}

// Both sides lay their values out as the same floats or integers.
template <typename Packed, typename T>
static Packed copy_values(const std::vector<T>& p_values) {
    Packed packed;
    static_assert(sizeof(T) % sizeof(*packed.ptr()) == 0 && std::is_trivially_copyable_v<T>);
    packed.resize(int64_t(p_values.size() * (sizeof(T) / sizeof(*packed.ptr()))));
    if (!p_values.empty()) {
        std::memcpy(static_cast<void*>(packed.ptrw()), p_values.data(), p_values.size() * sizeof(T));
    }
    return packed;
}

PackedFloat32Array to_godot(const std::vector<float>& p_values) {
    return copy_values<PackedFloat32Array>(p_values);
}

PackedInt32Array to_godot(const std::vector<NodeId>& p_ids) {
    return copy_values<PackedInt32Array>(p_ids);
}

Array to_surface_arrays(const treerec::Mesh& p_mesh) {
    Array arrays;
    if (p_mesh.indices.empty()) {
        return arrays;
    }
    arrays.resize(Mesh::ARRAY_MAX);
    arrays[Mesh::ARRAY_VERTEX] = copy_values<PackedVector3Array>(p_mesh.positions);
    if (!p_mesh.normals.empty()) {
        arrays[Mesh::ARRAY_NORMAL] = copy_values<PackedVector3Array>(p_mesh.normals);
    }
    if (!p_mesh.tangents.empty()) {
        arrays[Mesh::ARRAY_TANGENT] = copy_values<PackedFloat32Array>(p_mesh.tangents);
    }
    if (!p_mesh.uvs.empty()) {
        arrays[Mesh::ARRAY_TEX_UV] = copy_values<PackedVector2Array>(p_mesh.uvs);
    }
    if (!p_mesh.colors.empty()) {
        arrays[Mesh::ARRAY_COLOR] = copy_values<PackedColorArray>(p_mesh.colors);
    }
    if (!p_mesh.custom0.empty()) {
        arrays[Mesh::ARRAY_CUSTOM0] = copy_values<PackedFloat32Array>(p_mesh.custom0);
    }
    PackedInt32Array indices;
    indices.resize(int64_t(p_mesh.indices.size()));
    int32_t* write = indices.ptrw();
    for (size_t i = 0; i + 2 < p_mesh.indices.size(); i += 3) {
        write[i] = int32_t(p_mesh.indices[i]);
        write[i + 1] = int32_t(p_mesh.indices[i + 2]);
        write[i + 2] = int32_t(p_mesh.indices[i + 1]);
    }
    arrays[Mesh::ARRAY_INDEX] = indices;
    return arrays;
}

Dictionary to_dictionary(const treerec::Tree& p_tree, int p_format_version) {
    // Depth first, so that the order of children comes back.
    const std::vector<NodeId> ids = p_tree.empty() ? std::vector<NodeId>() : p_tree.depth_first();
    const int64_t count = int64_t(ids.size());
    PackedInt32Array parents;
    PackedFloat64Array positions;
    PackedFloat64Array radii;
    PackedByteArray flags;
    parents.resize(count);
    positions.resize(3 * count);
    radii.resize(count);
    flags.resize(count);
    int32_t* write_parent = parents.ptrw();
    double* write_position = positions.ptrw();
    double* write_radius = radii.ptrw();
    uint8_t* write_flags = flags.ptrw();
    for (const NodeId id : ids) {
        const treerec::Node& node = p_tree.node(id);
        *write_parent++ = node.parent;
        *write_position++ = node.position.x;
        *write_position++ = node.position.y;
        *write_position++ = node.position.z;
        *write_radius++ = node.radius;
        *write_flags++ = node.flags;
    }
    const treerec::ScanFrame& frame = p_tree.frame();
    Dictionary data;
    data["format_version"] = p_format_version;
    data["ids"] = to_godot(ids);
    data["parents"] = parents;
    data["positions"] = positions;
    data["radii"] = radii;
    data["flags"] = flags;
    data["origin"] = PackedFloat64Array{frame.origin.x, frame.origin.y, frame.origin.z};
    data["metres_per_unit"] = frame.metres_per_unit;
    data["up_axis"] = treerec::up_axis_name(frame.up);
    return data;
}

// The entry of p_data, whose type must be p_type.
static Variant require_entry(const Dictionary& p_data, const char* p_key, Variant::Type p_type) {
    const Variant value = p_data.get(p_key, Variant());
    if (value.get_type() != p_type) {
        throw treerec::Error("The saved tree is damaged: its \"" + std::string(p_key) +
                             "\" is missing or of the wrong type. Reconstruct the tree again.");
    }
    return value;
}

treerec::Tree tree_from_dictionary(const Dictionary& p_data) {
    const PackedInt32Array ids = require_entry(p_data, "ids", Variant::PACKED_INT32_ARRAY);
    const PackedInt32Array parents = require_entry(p_data, "parents", Variant::PACKED_INT32_ARRAY);
    const PackedFloat64Array positions = require_entry(p_data, "positions", Variant::PACKED_FLOAT64_ARRAY);
    const PackedFloat64Array radii = require_entry(p_data, "radii", Variant::PACKED_FLOAT64_ARRAY);
    const PackedByteArray flags = require_entry(p_data, "flags", Variant::PACKED_BYTE_ARRAY);
    const PackedFloat64Array origin = require_entry(p_data, "origin", Variant::PACKED_FLOAT64_ARRAY);
    const double unit = require_entry(p_data, "metres_per_unit", Variant::FLOAT);
    const String up = require_entry(p_data, "up_axis", Variant::STRING);

    const int64_t count = ids.size();
    if (parents.size() != count || positions.size() != 3 * count || radii.size() != count ||
        flags.size() != count) {
        throw treerec::Error(
            "The saved tree is damaged: its lists differ in length. Reconstruct the tree again.");
    }
    treerec::ScanFrame frame;
    if (origin.size() == 3) {
        frame.origin = DVec3(origin[0], origin[1], origin[2]);
    }
    frame.metres_per_unit = unit;
    frame.up = treerec::parse_up_axis(to_std(up));
    if (origin.size() != 3 || !treerec::is_finite(frame.origin) || !std::isfinite(unit) || unit <= 0.0) {
        throw treerec::Error(
            "The saved tree is damaged: its place in the scan isn't finite. Reconstruct the tree again.");
    }
    treerec::Tree tree;
    if (count > 0) {
        const int32_t* id = ids.ptr();
        const int32_t* parent = parents.ptr();
        const double* position = positions.ptr();
        // The arrays name parents by id, Tree::from_arrays() by place in the arrays.
        constexpr NodeId kLargestId = 1 << 24;
        NodeId largest = 0;
        for (int64_t i = 0; i < count; i++) {
            if (id[i] < 0 || id[i] > kLargestId) {
                throw treerec::Error(
                    "The saved tree is damaged: a node's id is out of range. Reconstruct the tree again.");
            }
            largest = std::max(largest, id[i]);
        }
        std::vector<NodeId> place(size_t(largest) + 1, treerec::kNoNode);
        for (int64_t i = 0; i < count; i++) {
            place[size_t(id[i])] = NodeId(i);
        }
        std::vector<NodeId> parent_places(static_cast<size_t>(count));
        std::vector<DVec3> points(static_cast<size_t>(count));
        for (int64_t i = 0; i < count; i++) {
            NodeId& parent_place = parent_places[size_t(i)];
            parent_place = treerec::kNoNode;
            if (parent[i] != treerec::kNoNode) {
                parent_place =
                    parent[i] >= 0 && parent[i] <= largest ? place[size_t(parent[i])] : treerec::kNoNode;
                if (parent_place == treerec::kNoNode) {
                    throw treerec::Error(
                        "The saved tree is damaged: a node's parent is missing. Reconstruct the tree again.");
                }
            }
            points[size_t(i)] = DVec3(position[3 * i], position[3 * i + 1], position[3 * i + 2]);
        }
        const std::vector<NodeId> node_ids(id, id + count);
        tree = treerec::Tree::from_arrays(parent_places, points,
                                          std::vector<double>(radii.ptr(), radii.ptr() + count),
                                          std::vector<uint8_t>(flags.ptr(), flags.ptr() + count), &node_ids);
    }
    tree.set_frame(frame);
    return tree;
}
