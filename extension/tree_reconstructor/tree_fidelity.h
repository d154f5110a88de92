#pragma once

#include <godot_cpp/classes/ref_counted.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/packed_color_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <memory>
#include <mutex>

#include "fidelity/fidelity.h"
#include "fidelity/photo_fidelity.h"
#include "tree_reconstruction/tree_reconstruction.h"

// What each photo says of a cloud: {name, inside, outside}, points that fall on the tree and beside it.
godot::TypedArray<godot::Dictionary> list_hits(const treerec::PhotoFidelity& p_found);

// Keeps measuring how faithful a tree is to its scan while it is edited. Any thread may call it; calls wait
// for each other.
class TreeFidelity : public godot::RefCounted {
    GDCLASS(TreeFidelity, godot::RefCounted)

  public:
    bool set_cloud(const godot::Ref<TreeReconstruction>& p_tree, const godot::PackedVector3Array& p_points,
                   double p_tolerance);
    godot::Dictionary update(const godot::Ref<TreeReconstruction>& p_tree);
    godot::Dictionary get_current() const;
    godot::Dictionary get_previous() const;
    int64_t get_points_measured() const;
    godot::PackedFloat32Array get_point_errors() const;
    godot::PackedInt32Array get_point_nodes() const;
    godot::PackedColorArray get_point_colors() const;
    godot::PackedFloat32Array get_node_errors() const;
    godot::PackedColorArray get_node_colors() const;
    godot::Array build_heat_mesh_arrays(int p_lod) const;
    godot::TypedArray<godot::Dictionary> get_branches() const;
    godot::TypedArray<godot::Dictionary> get_levels(int p_count) const;
    godot::TypedArray<godot::Dictionary> get_unexplained() const;
    godot::TypedArray<godot::Dictionary> get_doubtful() const;
    godot::Dictionary measure_photos(const godot::String& p_model, const godot::String& p_masks) const;

  protected:
    static void _bind_methods();

  private:
    const treerec::Fidelity& _current() const;

    // Guards all of it.
    mutable std::mutex mutex_;
    treerec::PointCloud cloud_;
    treerec::FidelityOptions options_;
    std::unique_ptr<treerec::FidelityTracker> tracker_;
    std::shared_ptr<const treerec::Tree> tree_;  // of the last update
};
