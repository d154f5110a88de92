// How TreeReconstruction is edited: by commands (src/edit/commands/commands.h), undone by values, kept in a
// log.
#include <godot_cpp/variant/typed_array.hpp>
#include <utility>

#include "convert.h"
#include "edit/commands/script.h"
#include "edit/select.h"
#include "error.h"
#include "tree_edit.h"
#include "tree_reconstruction/tree_reconstruction.h"

using namespace godot;

// Throws where there is nothing that could be edited.
std::shared_ptr<const treerec::Tree> TreeReconstruction::_editable_tree() const {
    if (!newer_skeleton_.is_empty()) {
        throw treerec::Error(
            "This tree was saved by a newer version of the addon, so it can't be edited here. Update the "
            "addon.");
    }
    std::shared_ptr<const treerec::Tree> tree = get_tree();
    if (tree->empty()) {
        throw treerec::Error("The tree is empty: there is nothing to edit.");
    }
    return tree;
}

Ref<TreeEdit> TreeReconstruction::_edit(const String& p_command) {
    const std::shared_ptr<const treerec::Tree> tree = _editable_tree();
    treerec::Tree result;
    treerec::Edit done = treerec::perform_on_copy(*tree, to_std(p_command), result);
    Ref<TreeEdit> edit;
    edit.instantiate();
    edit->set_edit(std::move(done.delta), std::move(done.outcome), {{done.command, done.frame, ""}});
    edit->set_leaf_setting(get_leaf_setting());
    edit_history_.add(edit->get_log_entries());
    set_tree(std::move(result));
    return edit;
}

Ref<TreeEdit> TreeReconstruction::edit(const String& p_command) {
    return guarded(Ref<TreeEdit>(), [&] { return _edit(p_command); });
}

void TreeReconstruction::take_tree_of(const Ref<TreeReconstruction>& p_other) {
    ERR_FAIL_COND_MSG(p_other.is_null(), "There is no tree to take over.");
    if (p_other.ptr() == this) {
        return;
    }
    const SharedParts::Parts theirs = p_other->parts_.get();
    parts_.replace([&](SharedParts::Parts& r_parts) {
        r_parts.tree = theirs.tree;
        r_parts.foliage = theirs.foliage;
    });
    newer_skeleton_ = p_other->newer_skeleton_;
    newer_foliage_ = p_other->newer_foliage_;
    edit_history_ = p_other->edit_history_;
    provenance_ = p_other->provenance_;
    emit_changed();
}

Variant TreeReconstruction::try_edit(const String& p_command) {
    try {
        return _edit(p_command);
    } catch (const std::exception& error) {
        return to_godot(std::string(error.what()));
    }
}

String TreeReconstruction::check_edit(const String& p_command) const {
    try {
        treerec::Tree result;
        treerec::perform_on_copy(*_editable_tree(), to_std(p_command), result);
        return String();
    } catch (const std::exception& error) {
        return to_godot(std::string(error.what()));
    }
}

Error TreeReconstruction::apply_edit(const Ref<TreeEdit>& p_edit) {
    ERR_FAIL_COND_V_MSG(p_edit.is_null(), ERR_INVALID_PARAMETER, "There is no edit to apply.");
    return guarded(ERR_INVALID_DATA, [&] {
        treerec::Tree tree = *get_tree();
        p_edit->get_delta().apply(tree);
        edit_history_.add(p_edit->get_log_entries());
        set_tree(std::move(tree));
        return OK;
    });
}

Error TreeReconstruction::revert_edit(const Ref<TreeEdit>& p_edit) {
    ERR_FAIL_COND_V_MSG(p_edit.is_null(), ERR_INVALID_PARAMETER, "There is no edit to revert.");
    return guarded(ERR_INVALID_DATA, [&] {
        treerec::Tree tree = *get_tree();
        p_edit->get_delta().revert(tree);
        edit_history_.remove_last(p_edit->get_log_entries().size());
        set_tree(std::move(tree));
        return OK;
    });
}

static TypedArray<Dictionary> to_godot(const std::vector<treerec::LeftOut>& p_left_out) {
    TypedArray<Dictionary> list;
    for (const treerec::LeftOut& one : p_left_out) {
        Dictionary entry;
        entry["line"] = int64_t(one.line);
        entry["command"] = to_godot(one.command);
        entry["reason"] = to_godot(one.reason);
        list.push_back(entry);
    }
    return list;
}

Dictionary TreeReconstruction::replay(const String& p_log, double p_tolerance) {
    Dictionary result;
    result["edit"] = Ref<TreeEdit>();
    result["done"] = 0;
    result["left_out"] = TypedArray<Dictionary>();
    result["in_part"] = TypedArray<Dictionary>();
    return guarded(result, [&] {
        treerec::Tree tree = *_editable_tree();
        treerec::ScriptOptions options;
        options.keep_going = true;
        options.tolerance = p_tolerance;
        treerec::ScriptResult replayed = treerec::run_script(tree, to_std(p_log), options);
        Ref<TreeEdit> edit;
        edit.instantiate();
        edit->set_edit(std::move(replayed.delta), {}, replayed.log.entries());
        edit->set_leaf_setting(get_leaf_setting());
        edit_history_.add(edit->get_log_entries());
        set_tree(std::move(tree));
        result["edit"] = edit;
        result["done"] = int64_t(replayed.done);
        result["left_out"] = to_godot(replayed.left_out);
        result["in_part"] = to_godot(replayed.in_part);
        return result;
    });
}

Ref<TreeEdit> TreeReconstruction::run_script(const String& p_script) {
    return guarded(Ref<TreeEdit>(), [&] {
        treerec::Tree tree = *_editable_tree();
        treerec::ScriptResult done = treerec::run_script(tree, to_std(p_script));
        treerec::EditOutcome outcome;
        for (const std::string& sentence : done.said) {
            outcome.said += (outcome.said.empty() ? "" : "\n") + sentence;
        }
        Ref<TreeEdit> edit;
        edit.instantiate();
        edit->set_edit(std::move(done.delta), std::move(outcome), done.log.entries());
        edit->set_leaf_setting(get_leaf_setting());
        edit_history_.add(edit->get_log_entries());
        set_tree(std::move(tree));
        return edit;
    });
}

void TreeReconstruction::set_edit_log(const String& p_log) {
    edit_history_.set_text(p_log);
    emit_changed();
}

String TreeReconstruction::get_edit_log() const {
    return edit_history_.get_text();
}

TypedArray<Dictionary> TreeReconstruction::get_unfit_edits() const {
    return edit_history_.describe_unfit(get_tree()->frame());
}

String TreeReconstruction::get_edit_log_without(int64_t p_index) const {
    return edit_history_.get_text_without(p_index);
}

PackedInt32Array TreeReconstruction::select_nodes(const String& p_selection) const {
    return guarded(PackedInt32Array(),
                   [&] { return to_godot(treerec::select(*_editable_tree(), to_std(p_selection)).ids); });
}

String TreeReconstruction::check_selection(const String& p_selection) const {
    try {
        treerec::select(*_editable_tree(), to_std(p_selection));
        return String();
    } catch (const std::exception& error) {
        return to_godot(std::string(error.what()));
    }
}

TypedArray<Dictionary> TreeReconstruction::get_edit_commands() {
    TypedArray<Dictionary> list;
    for (const treerec::EditCommand& command : treerec::edit_commands()) {
        Dictionary entry;
        entry["name"] = to_godot(command.name);
        entry["group"] = to_godot(command.group);
        entry["description"] = to_godot(command.summary);
        entry["parameters"] = to_godot(command.parameters);
        list.push_back(entry);
    }
    return list;
}

void TreeReconstruction::_bind_editing() {
    ClassDB::bind_method(D_METHOD("edit", "command"), &TreeReconstruction::edit);
    ClassDB::bind_method(D_METHOD("take_tree_of", "other"), &TreeReconstruction::take_tree_of);
    ClassDB::bind_method(D_METHOD("try_edit", "command"), &TreeReconstruction::try_edit);
    ClassDB::bind_method(D_METHOD("check_edit", "command"), &TreeReconstruction::check_edit);
    ClassDB::bind_method(D_METHOD("apply_edit", "edit"), &TreeReconstruction::apply_edit);
    ClassDB::bind_method(D_METHOD("revert_edit", "edit"), &TreeReconstruction::revert_edit);
    ClassDB::bind_method(D_METHOD("replay", "log", "tolerance"), &TreeReconstruction::replay, DEFVAL(0.0));
    ClassDB::bind_method(D_METHOD("run_script", "script"), &TreeReconstruction::run_script);
    ClassDB::bind_method(D_METHOD("get_unfit_edits"), &TreeReconstruction::get_unfit_edits);
    ClassDB::bind_method(D_METHOD("get_edit_log_without", "index"),
                         &TreeReconstruction::get_edit_log_without);
    ClassDB::bind_method(D_METHOD("select_nodes", "selection"), &TreeReconstruction::select_nodes);
    ClassDB::bind_method(D_METHOD("check_selection", "selection"), &TreeReconstruction::check_selection);
    ClassDB::bind_static_method("TreeReconstruction", D_METHOD("get_edit_commands"),
                                &TreeReconstruction::get_edit_commands);
    ClassDB::bind_method(D_METHOD("set_edit_log", "log"), &TreeReconstruction::set_edit_log);
    ClassDB::bind_method(D_METHOD("get_edit_log"), &TreeReconstruction::get_edit_log);
    ADD_PROPERTY(
        PropertyInfo(Variant::STRING, "edit_log", PROPERTY_HINT_MULTILINE_TEXT, "", PROPERTY_USAGE_STORAGE),
        "set_edit_log", "get_edit_log");
}
