// What an editor shows of a TreeReconstruction and asks about it: what lies under the pointer, what an edit
// would do, how the tree looks in a list.
#include <algorithm>
#include <cmath>
#include <utility>

#include "convert.h"
#include "edit/pick.h"
#include "edit/preview.h"
#include "error.h"
#include "foliage/foliage_twigs.h"
#include "foliage/leaves.h"
#include "mesh/tree_picture.h"
#include "tree/branches.h"
#include "tree_reconstruction/node_arrays.h"
#include "tree_reconstruction/tree_reconstruction.h"

using namespace godot;
using treerec::NodeId;

static treerec::ScreenView to_view(const Projection& p_to_screen, const Vector2& p_viewport) {
    treerec::ScreenView view;
    for (int i = 0; i < 4; i++) {
        const Vector4& column = p_to_screen.columns[i];
        view.to_clip[i] = {column.x, column.y, column.z, column.w};
    }
    view.width = p_viewport.x;
    view.height = p_viewport.y;
    return view;
}

int TreeReconstruction::pick_node(const Projection& p_to_screen, const Vector2& p_viewport,
                                  const Vector2& p_position, double p_distance) const {
    return treerec::pick_node(*get_tree(), to_view(p_to_screen, p_viewport), {p_position.x, p_position.y},
                              p_distance);
}

PackedInt32Array TreeReconstruction::pick_nodes(const Projection& p_to_screen, const Vector2& p_viewport,
                                                const Rect2& p_rect) const {
    const Vector2 end = p_rect.position + p_rect.size;
    return to_godot(treerec::pick_nodes(*get_tree(), to_view(p_to_screen, p_viewport),
                                        {p_rect.position.x, p_rect.position.y}, {end.x, end.y}));
}

int TreeReconstruction::get_node_order(int64_t p_id) const {
    const std::shared_ptr<const treerec::Tree> tree = get_tree();
    ERR_FAIL_COND_V_MSG(!holds_node(*tree, p_id), -1, vformat("The tree has no node %d.", p_id));
    const treerec::BranchList list = treerec::list_branches(*tree);
    return list.branches[size_t(list.branch_of[size_t(p_id)])].order;
}

Array TreeReconstruction::build_selection_lines(const PackedInt32Array& p_ids) const {
    return node_arrays::lines_of(*get_tree(), p_ids);
}

static PackedVector3Array to_lines(const std::vector<treerec::DVec3>& p_ends) {
    PackedVector3Array lines;
    lines.resize(int64_t(p_ends.size()));
    Vector3* write = lines.ptrw();
    for (const treerec::DVec3& end : p_ends) {
        *write++ = to_godot(end);
    }
    return lines;
}

Dictionary TreeReconstruction::preview_edit(const String& p_command) const {
    treerec::EditPreview preview;
    try {
        preview = treerec::preview_edit(*_editable_tree(), to_std(p_command));
    } catch (const std::exception& error) {
        preview.error = error.what();
    }
    PackedFloat32Array radii;
    radii.resize(int64_t(preview.added_radii.size()));
    float* write = radii.ptrw();
    for (const double radius : preview.added_radii) {
        *write++ = float(radius);
    }
    Dictionary result;
    result["added"] = to_lines(preview.added);
    result["removed"] = to_lines(preview.removed);
    result["added_radii"] = radii;
    result["message"] = to_godot(preview.message);
    result["error"] = to_godot(preview.error);
    return result;
}

// What the season makes of a colour (0..255): alpha says how far.
static treerec::DVec3 turned(const treerec::DVec3& p_color, const Color& p_tint) {
    return glm::mix(p_color, 230.0 * treerec::DVec3(p_tint.r, p_tint.g, p_tint.b), double(p_tint.a));
}

PackedByteArray TreeReconstruction::draw(int p_size) const {
    return guarded(PackedByteArray(), [&] {
        const std::shared_ptr<const treerec::Tree> tree = get_tree();
        const std::shared_ptr<const treerec::Foliage> foliage = get_leaf_density();
        const std::vector<treerec::LeafKind> kinds = make_leaf_kinds(*tree);
        std::vector<std::vector<treerec::LeafPlacement>> placed = _place_foliage(*tree, kinds, 0);
        std::vector<treerec::PicturedLeaves> pictured;
        for (size_t i = 0; i < kinds.size(); i++) {
            const Dictionary seen = _describe_kind(kinds[i], 0.0);
            treerec::TreeColors colors = treerec::tree_colors(to_std(String(seen["look"])));
            const PackedColorArray tints = seen["tints"];
            if (!tints.is_empty()) {
                colors.leaf = turned(colors.leaf, tints[0]);
                colors.other = turned(colors.other, tints[1]);
            }
            pictured.push_back({std::move(placed[i]), colors.leaf, colors.other});
        }
        const treerec::Image image =
            treerec::draw_leafy_tree(treerec::leafy_tree(*tree, kinds, *foliage), pictured,
                                     treerec::tree_colors(to_std(get_leaf_look())), p_size);
        PackedByteArray pixels;
        pixels.resize(int64_t(image.pixels.size()));
        std::copy(image.pixels.begin(), image.pixels.end(), pixels.ptrw());
        return pixels;
    });
}

void TreeReconstruction::_bind_viewing() {
    ClassDB::bind_method(D_METHOD("pick_node", "to_screen", "viewport", "position", "distance"),
                         &TreeReconstruction::pick_node, DEFVAL(8.0));
    ClassDB::bind_method(D_METHOD("pick_nodes", "to_screen", "viewport", "rect"),
                         &TreeReconstruction::pick_nodes);
    ClassDB::bind_method(D_METHOD("get_node_order", "id"), &TreeReconstruction::get_node_order);
    ClassDB::bind_method(D_METHOD("build_selection_lines", "ids"),
                         &TreeReconstruction::build_selection_lines);
    ClassDB::bind_method(D_METHOD("preview_edit", "command"), &TreeReconstruction::preview_edit);
    ClassDB::bind_method(D_METHOD("draw", "size"), &TreeReconstruction::draw, DEFVAL(128));
}
