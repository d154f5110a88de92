#include "tree_reconstruction/node_arrays.h"

#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/variant/color.hpp>
#include <godot_cpp/variant/packed_color_array.hpp>
#include <godot_cpp/variant/packed_vector2_array.hpp>

#include "convert.h"
#include "geometry/bounds.h"

using namespace godot;
using treerec::NodeId;
using treerec::Tree;

namespace node_arrays {

std::vector<NodeId> list_nodes(const Tree& p_tree) {
    return p_tree.empty() ? std::vector<NodeId>() : p_tree.depth_first();
}

PackedVector3Array positions(const Tree& p_tree) {
    PackedVector3Array positions;
    positions.resize(int64_t(p_tree.size()));
    Vector3* write = positions.ptrw();
    for (const NodeId id : list_nodes(p_tree)) {
        *write++ = to_godot(p_tree.node(id).position);
    }
    return positions;
}

PackedFloat32Array radii(const Tree& p_tree) {
    PackedFloat32Array radii;
    radii.resize(int64_t(p_tree.size()));
    float* write = radii.ptrw();
    for (const NodeId id : list_nodes(p_tree)) {
        *write++ = float(p_tree.node(id).radius);
    }
    return radii;
}

PackedInt32Array parents(const Tree& p_tree) {
    std::vector<NodeId> ids = list_nodes(p_tree);
    for (NodeId& id : ids) {
        id = p_tree.node(id).parent;
    }
    return to_godot(ids);
}

PackedInt32Array trunk(const Tree& p_tree) {
    std::vector<NodeId> ids = list_nodes(p_tree);
    std::erase_if(ids, [&](NodeId id) { return !p_tree.node(id).is_trunk(); });
    return to_godot(ids);
}

AABB box(const Tree& p_tree) {
    treerec::Bounds bounds;
    for (const NodeId id : list_nodes(p_tree)) {
        bounds.add(p_tree.node(id).position, p_tree.node(id).radius);
    }
    return bounds.empty() ? AABB() : AABB(to_godot(bounds.min), to_godot(bounds.size()));
}

// The colours of figure 3.7 of the paper: leaf, branch, common, trunk.
static const Color kKindColors[] = {Color(0.30f, 0.80f, 0.25f), Color(1.0f, 0.60f, 0.10f),
                                    Color(0.70f, 0.70f, 0.70f), Color(0.90f, 0.15f, 0.12f)};

Array lines(const Tree& p_tree) {
    Array arrays;
    if (p_tree.size() < 2) {
        return arrays;
    }
    PackedVector3Array points;
    PackedColorArray colors;
    PackedVector2Array radii;
    points.resize(int64_t(2 * (p_tree.size() - 1)));
    colors.resize(points.size());
    radii.resize(points.size());
    Vector3* write_point = points.ptrw();
    Color* write_color = colors.ptrw();
    Vector2* write_radius = radii.ptrw();
    for (const NodeId id : list_nodes(p_tree)) {
        const NodeId parent = p_tree.node(id).parent;
        if (parent == treerec::kNoNode) {
            continue;
        }
        for (const NodeId end : {parent, id}) {
            const treerec::Node& node = p_tree.node(end);
            *write_point++ = to_godot(node.position);
            *write_color++ = kKindColors[int(node.kind())];
            *write_radius++ = Vector2(float(node.radius), 0.0f);
        }
    }
    arrays.resize(Mesh::ARRAY_MAX);
    arrays[Mesh::ARRAY_VERTEX] = points;
    arrays[Mesh::ARRAY_COLOR] = colors;
    arrays[Mesh::ARRAY_TEX_UV] = radii;
    return arrays;
}

Array lines_of(const Tree& p_tree, const PackedInt32Array& p_ids) {
    PackedVector3Array points;
    points.resize(2 * p_ids.size());
    Vector3* write = points.ptrw();
    int64_t count = 0;
    for (int64_t i = 0; i < p_ids.size(); i++) {
        const NodeId id = p_ids[i];
        if (!p_tree.contains(id) || p_tree.node(id).parent == treerec::kNoNode) {
            continue;
        }
        write[count++] = to_godot(p_tree.node(p_tree.node(id).parent).position);
        write[count++] = to_godot(p_tree.node(id).position);
    }
    Array arrays;
    if (count == 0) {
        return arrays;
    }
    points.resize(count);
    arrays.resize(Mesh::ARRAY_MAX);
    arrays[Mesh::ARRAY_VERTEX] = points;
    return arrays;
}

}  // namespace node_arrays
