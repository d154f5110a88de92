#pragma once

#include <godot_cpp/classes/ref_counted.hpp>
#include <godot_cpp/core/class_db.hpp>
#include <godot_cpp/variant/packed_int32_array.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <utility>
#include <vector>

#include "edit/commands/script.h"
#include "tree_reconstruction/tree_reconstruction.h"

// What one edit did to a TreeReconstruction: a value that undoes it and does it again. Made by
// TreeReconstruction; it does not change.
class TreeEdit : public godot::RefCounted {
    GDCLASS(TreeEdit, godot::RefCounted)

  public:
    // For TreeReconstruction. entries: what the log gets, unless the edit is one command that changed
    // nothing: an editor makes no undo step of it, so the log must not wait for its undo.
    void set_edit(treerec::TreeDelta p_delta, treerec::EditOutcome p_outcome,
                  std::vector<treerec::EditLog::Entry> p_entries);
    const treerec::TreeDelta& get_delta() const { return delta_; }
    // Those of the tree, which the wood that it loses keeps.
    void set_leaf_setting(const LeafSetting& p_setting) { leaves_ = p_setting; }
    std::vector<treerec::EditLog::Entry> get_log_entries() const;

    godot::String get_command() const;
    godot::String get_message() const;
    bool is_empty() const;
    int64_t get_byte_count() const;
    godot::PackedInt32Array get_added_nodes() const;
    godot::PackedInt32Array get_removed_nodes() const;
    godot::PackedInt32Array get_changed_nodes() const;
    godot::PackedInt32Array get_result_nodes() const;
    godot::Array get_removed_wood() const;
    godot::Ref<TreeEdit> merged_with(const godot::Ref<TreeEdit>& p_next) const;

  protected:
    static void _bind_methods();

  private:
    treerec::TreeDelta delta_;
    LeafSetting leaves_;
    treerec::EditOutcome outcome_;
    std::vector<treerec::EditLog::Entry> entries_;
};
