// The log of a TreeReconstruction's edits (src/edit/commands/script.h), as the engine asks for it.
#pragma once

#include <godot_cpp/variant/dictionary.hpp>
#include <godot_cpp/variant/string.hpp>
#include <godot_cpp/variant/typed_array.hpp>
#include <vector>

#include "edit/commands/script.h"
#include "geometry/scan_frame.h"

class EditHistory {
  public:
    void add(const std::vector<treerec::EditLog::Entry>& p_entries);
    void remove_last(size_t p_count) { log_.remove_last(p_count); }
    // Of a file; nothing, and an error, for what is none.
    void set_text(const godot::String& p_log);
    godot::String get_text() const;
    // Without one of its edits.
    godot::String get_text_without(int64_t p_index) const;
    // What did not fit the tree when the log was replayed: index, command, reason, and the places, directions
    // and radii that the command names, in the tree's space.
    godot::TypedArray<godot::Dictionary> describe_unfit(const treerec::ScanFrame& p_frame) const;

  private:
    treerec::EditLog log_;
};
