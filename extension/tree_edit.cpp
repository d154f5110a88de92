#include "tree_edit.h"

#include "convert.h"
#include "error.h"
#include "tree_reconstruction/tree_reconstruction.h"

using namespace godot;

void TreeEdit::set_edit(treerec::TreeDelta p_delta, treerec::EditOutcome p_outcome,
                        std::vector<treerec::EditLog::Entry> p_entries) {
    delta_ = std::move(p_delta);
    outcome_ = std::move(p_outcome);
    entries_ = std::move(p_entries);
}

std::vector<treerec::EditLog::Entry> TreeEdit::get_log_entries() const {
    const bool counts = !delta_.empty() || entries_.size() != 1 || !entries_.front().fits();
    return counts ? entries_ : std::vector<treerec::EditLog::Entry>();
}

String TreeEdit::get_command() const {
    std::string text;
    for (const treerec::EditLog::Entry& entry : entries_) {
        text += (text.empty() ? "" : "\n") + entry.command;
    }
    return to_godot(text);
}

String TreeEdit::get_message() const {
    return to_godot(outcome_.said);
}

bool TreeEdit::is_empty() const {
    return delta_.empty();
}

int64_t TreeEdit::get_byte_count() const {
    return int64_t(delta_.bytes());
}

PackedInt32Array TreeEdit::get_added_nodes() const {
    return to_godot(delta_.added());
}

PackedInt32Array TreeEdit::get_removed_nodes() const {
    return to_godot(delta_.removed());
}

PackedInt32Array TreeEdit::get_changed_nodes() const {
    return to_godot(delta_.changed());
}

PackedInt32Array TreeEdit::get_result_nodes() const {
    return to_godot(outcome_.nodes);
}

Array TreeEdit::get_removed_wood() const {
    return guarded(Array(), [&] {
        Array pieces;
        const treerec::ScanFrame frame = entries_.empty() ? treerec::ScanFrame() : entries_.front().frame;
        for (size_t i = 0; i < outcome_.removed.pieces.size(); i++) {
            Ref<TreeReconstruction> piece;
            piece.instantiate();
            piece->set_tree(outcome_.removed.piece(i, frame));
            piece->set_leaf_setting(leaves_);
            pieces.push_back(piece);
        }
        return pieces;
    });
}

Ref<TreeEdit> TreeEdit::merged_with(const Ref<TreeEdit>& p_next) const {
    ERR_FAIL_COND_V_MSG(p_next.is_null(), Ref<TreeEdit>(), "There is no edit to merge with.");
    return guarded(Ref<TreeEdit>(), [&] {
        treerec::EditOutcome outcome = outcome_;
        outcome.removed.append(p_next->outcome_.removed);
        outcome.nodes = p_next->outcome_.nodes;
        outcome.said = p_next->outcome_.said;
        std::vector<treerec::EditLog::Entry> entries = get_log_entries();
        for (const treerec::EditLog::Entry& entry : p_next->get_log_entries()) {
            entries.push_back(entry);
        }
        Ref<TreeEdit> both;
        both.instantiate();
        both->set_edit(treerec::TreeDelta::compose(delta_, p_next->delta_), std::move(outcome),
                       std::move(entries));
        both->set_leaf_setting(leaves_);
        return both;
    });
}

void TreeEdit::_bind_methods() {
    ClassDB::bind_method(D_METHOD("get_command"), &TreeEdit::get_command);
    ClassDB::bind_method(D_METHOD("get_message"), &TreeEdit::get_message);
    ClassDB::bind_method(D_METHOD("is_empty"), &TreeEdit::is_empty);
    ClassDB::bind_method(D_METHOD("get_byte_count"), &TreeEdit::get_byte_count);
    ClassDB::bind_method(D_METHOD("get_added_nodes"), &TreeEdit::get_added_nodes);
    ClassDB::bind_method(D_METHOD("get_removed_nodes"), &TreeEdit::get_removed_nodes);
    ClassDB::bind_method(D_METHOD("get_changed_nodes"), &TreeEdit::get_changed_nodes);
    ClassDB::bind_method(D_METHOD("get_result_nodes"), &TreeEdit::get_result_nodes);
    ClassDB::bind_method(D_METHOD("get_removed_wood"), &TreeEdit::get_removed_wood);
    ClassDB::bind_method(D_METHOD("merged_with", "next"), &TreeEdit::merged_with);
}
