#include "tree_reconstruction/edit_history.h"

#include <godot_cpp/variant/packed_float32_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>

#include "convert.h"
#include "edit/commands/address.h"
#include "error.h"

using namespace godot;
using treerec::EditLog;

void EditHistory::add(const std::vector<EditLog::Entry>& p_entries) {
    for (const EditLog::Entry& entry : p_entries) {
        log_.add(entry);
    }
}

void EditHistory::set_text(const String& p_log) {
    const EditLog none;
    log_ = guarded(none, [&] { return EditLog::parse(to_std(p_log)); });
}

String EditHistory::get_text() const {
    return log_.empty() ? String() : to_godot(log_.text());
}

String EditHistory::get_text_without(int64_t p_index) const {
    ERR_FAIL_INDEX_V_MSG(p_index, int64_t(log_.entries().size()), get_text(),
                         "The log has no edit of that number.");
    EditLog log = log_;
    log.remove(size_t(p_index));
    return log.empty() ? String() : to_godot(log.text());
}

TypedArray<Dictionary> EditHistory::describe_unfit(const treerec::ScanFrame& p_frame) const {
    TypedArray<Dictionary> list;
    const std::vector<EditLog::Entry>& entries = log_.entries();
    for (size_t i = 0; i < entries.size(); i++) {
        if (entries[i].fits()) {
            continue;
        }
        PackedVector3Array places;
        PackedVector3Array directions;
        PackedFloat32Array radii;
        for (const treerec::NamedPlace& named : treerec::places_named(p_frame, entries[i].command)) {
            places.push_back(to_godot(named.place));
            directions.push_back(to_godot(named.direction));
            radii.push_back(float(named.radius));
        }
        Dictionary entry;
        entry["index"] = int64_t(i);
        entry["command"] = to_godot(entries[i].command);
        entry["reason"] = to_godot(entries[i].reason);
        entry["places"] = places;
        entry["directions"] = directions;
        entry["radii"] = radii;
        list.push_back(entry);
    }
    return list;
}
