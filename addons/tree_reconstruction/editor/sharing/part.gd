@tool
extends RefCounted
## The plugin's part for trees that several nodes or scenes show: it asks, once for each tree, what
## an edit should change, and marks all scenes that show a changed tree.

const Session: GDScript = preload("../session.gd")

# So many names are told.
const _LISTED: int = 6

var _plugin: EditorPlugin
var _session: Session
var _dialog: ConfirmationDialog
# The scenes that could not be marked, since another one was shown.
var _to_mark: Dictionary[String, bool] = {}


func enter(plugin: EditorPlugin, session: Session) -> void:
	_plugin = plugin
	_session = session
	_session.consent.ask = ask
	EditorInterface.get_resource_filesystem().filesystem_changed.connect(
		_session.local_trees.scene_index.look_again
	)
	_session.local_trees.changed.connect(_on_trees_changed)
	plugin.scene_changed.connect(_on_scene_changed)
	plugin.scene_closed.connect(_on_scene_closed)
	plugin.scene_saved.connect(_on_scene_saved)


func exit() -> void:
	_plugin.scene_saved.disconnect(_on_scene_saved)
	_plugin.scene_closed.disconnect(_on_scene_closed)
	_plugin.scene_changed.disconnect(_on_scene_changed)
	_session.local_trees.changed.disconnect(_on_trees_changed)
	EditorInterface.get_resource_filesystem().filesystem_changed.disconnect(
		_session.local_trees.scene_index.look_again
	)
	_session.consent.ask = Callable()
	_close()
	_session = null
	_plugin = null


## Asks what an edit of the edited tree, which [param others] show too, should change, and calls
## [param again] with it settled. For a copy in the same scene the default is a tree of its own.
func ask(others: Array[Node], again: Callable) -> void:
	_close()
	var here: Node = _session.node.owner if _session.node.owner != null else _session.node
	var names: PackedStringArray = []
	var is_copied: bool = false
	for other: Node in others:
		var scene: Node = other.owner if other.owner != null else other
		is_copied = is_copied or (scene == here and other is TreeInstance3D)
		names.append(
			String(other.name) if scene == here else "%s (%s)" % [other.name, scene.scene_file_path]
		)
	if names.size() > _LISTED:
		var more: int = names.size() - _LISTED
		names.resize(_LISTED)
		names.append(tr("… and %d more.") % more)
	_dialog = ConfirmationDialog.new()
	_dialog.title = tr("This Tree Is Shared")
	_dialog.dialog_text = (
		tr("'%s' shows the same tree as these nodes, which an edit would change, too:")
		% _session.node.name
	)
	_dialog.dialog_text += "\n\n" + "\n".join(names)
	var unique: Callable = _answer.bind(true, again)
	var all: Callable = _answer.bind(false, again)
	if is_copied:
		_dialog.ok_button_text = tr("Make Unique")
		_dialog.confirmed.connect(unique)
		_dialog.add_button(tr("Change All"), true).pressed.connect(all)
	else:
		_dialog.ok_button_text = tr("Change All")
		_dialog.confirmed.connect(all)
		_dialog.add_button(tr("Make Unique"), true).pressed.connect(unique)
	_dialog.canceled.connect(_close)
	EditorInterface.popup_dialog_centered(_dialog)


func _answer(is_unique: bool, again: Callable) -> void:
	_close()
	if _session.tree == null:
		return
	if is_unique:
		_session.make_unique()
	else:
		_session.consent.agree(_session.tree, _session.node)
	if again.is_valid():
		again.call()


func _close() -> void:
	if is_instance_valid(_dialog):
		_dialog.hide()
		_dialog.queue_free()
	_dialog = null


# A tree that other scenes show, too, has its steps in no scene's history.
func _on_trees_changed() -> void:
	for path: String in _session.local_trees.get_unsaved():
		var tree: TreeReconstruction = _session.local_trees.get_changed(path)
		if not _session.local_trees.is_in_other_scenes(tree):
			continue
		for holder: Node in Session.LocalTrees.get_holders(tree):
			_mark(holder.owner if holder.owner != null else holder)


func _mark(scene: Node) -> void:
	if scene == EditorInterface.get_edited_scene_root():
		EditorInterface.mark_scene_as_unsaved()
	elif not scene.scene_file_path.is_empty() and not _mark_unseen(scene.scene_file_path):
		_to_mark[scene.scene_file_path] = true


# The engine marks the shown scene alone. But another one's history, if there is nothing in it, may
# be cleared, which marks its scene.
func _mark_unseen(path: String) -> bool:
	var part: Resource = Resource.new()
	part.resource_path = path + "::tree_reconstruction"
	var undo: EditorUndoRedoManager = _plugin.get_undo_redo()
	var id: int = undo.get_object_history_id(part)
	if id == EditorUndoRedoManager.GLOBAL_HISTORY or id == EditorUndoRedoManager.INVALID_HISTORY:
		return false
	var history: UndoRedo = undo.get_history_undo_redo(id)
	if history.has_undo() or history.has_redo():
		return false
	undo.clear_history(id, true)
	return true


func _on_scene_changed(scene: Node) -> void:
	if scene != null and _to_mark.erase(scene.scene_file_path):
		for path: String in _session.local_trees.get_unsaved_of(scene):
			if _session.local_trees.is_in_other_scenes(_session.local_trees.get_changed(path)):
				EditorInterface.mark_scene_as_unsaved()


func _on_scene_saved(_path: String) -> void:
	_session.local_trees.scene_index.look_again()


func _on_scene_closed(path: String) -> void:
	_to_mark.erase(path)
	_drop_unused.call_deferred()


# What was not saved with its last scene is not kept behind its user's back.
func _drop_unused() -> void:
	if _session != null:
		_session.local_trees.drop_unused()
