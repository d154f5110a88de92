#include <godot_cpp/classes/mesh.hpp>
#include <godot_cpp/variant/packed_color_array.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/packed_vector2_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>

#include "tree_reconstruction/tree_reconstruction.h"

using namespace godot;

// Lines are one pixel wide in the engine; a shader draws these as wide as it likes.
Array TreeReconstruction::widen_lines(const Array& p_lines) {
    Array arrays;
    if (p_lines.size() <= Mesh::ARRAY_TEX_UV) {
        return arrays;
    }
    const PackedVector3Array ends = p_lines[Mesh::ARRAY_VERTEX];
    const PackedColorArray colors = p_lines[Mesh::ARRAY_COLOR];
    const PackedVector2Array radii = p_lines[Mesh::ARRAY_TEX_UV];
    const int64_t count = ends.size() / 2;
    ERR_FAIL_COND_V_MSG(!colors.is_empty() && colors.size() != ends.size(), arrays,
                        "Each end of a line needs one color.");
    ERR_FAIL_COND_V_MSG(!radii.is_empty() && radii.size() != ends.size(), arrays,
                        "Each end of a line needs one UV.");
    if (count == 0) {
        return arrays;
    }
    PackedVector3Array points;
    PackedVector3Array directions;
    PackedColorArray new_colors;
    PackedVector2Array places;
    PackedInt32Array indices;
    points.resize(4 * count);
    directions.resize(4 * count);
    new_colors.resize(colors.is_empty() ? 0 : 4 * count);
    places.resize(4 * count);
    indices.resize(6 * count);
    const Vector3* from = ends.ptr();
    const Color* from_color = colors.ptr();
    const Vector2* from_radius = radii.ptr();
    Vector3* point = points.ptrw();
    Vector3* direction = directions.ptrw();
    Color* color = new_colors.ptrw();
    Vector2* place = places.ptrw();
    int32_t* index = indices.ptrw();
    for (int64_t i = 0; i < count; ++i) {
        const Vector3 way = (from[2 * i + 1] - from[2 * i]).normalized();
        for (int corner = 0; corner < 4; ++corner) {
            const int64_t end = 2 * i + corner / 2;
            *point++ = from[end];
            *direction++ = way;
            *place++ = Vector2(from_radius ? from_radius[end].x : 0.0f, corner % 2 == 0 ? -1.0f : 1.0f);
            if (from_color) {
                *color++ = from_color[end];
            }
        }
        for (const int corner : {0, 1, 2, 2, 1, 3}) {
            *index++ = int32_t(4 * i + corner);
        }
    }
    arrays.resize(Mesh::ARRAY_MAX);
    arrays[Mesh::ARRAY_VERTEX] = points;
    arrays[Mesh::ARRAY_NORMAL] = directions;
    if (!colors.is_empty()) {
        arrays[Mesh::ARRAY_COLOR] = new_colors;
    }
    arrays[Mesh::ARRAY_TEX_UV] = places;
    arrays[Mesh::ARRAY_INDEX] = indices;
    return arrays;
}
