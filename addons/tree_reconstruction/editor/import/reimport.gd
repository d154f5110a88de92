@tool
extends RefCounted
## What happens to trees that were edited when their scan is imported again: their edits are done
## again on the new import. What no longer fits is shown where it was; nothing is lost.
##
## A tree in an open scene changes as one step of its undo history, another one in its file.
## Before, the tree as it was is kept beside it, as [code]oak_tree.res.bak[/code].

const ScanFiles: GDScript = preload("./scan_files.gd")
const SceneAdder: GDScript = preload("./scene_adder.gd")
const OwnTrees: GDScript = preload("./own_trees.gd")

const _BACKUPS: int = 5
# What the editor may take to tell its plugins what is selected.
const _FRAMES: int = 5

var own_trees: OwnTrees = OwnTrees.new()

# The session of what is edited: its history, its trees, its voice.
var _session: RefCounted


func _init(session: RefCounted) -> void:
	_session = session


func enter() -> void:
	EditorInterface.get_resource_filesystem().resources_reimported.connect(_on_reimported)
	EditorInterface.get_file_system_dock().files_moved.connect(_on_file_moved)


func exit() -> void:
	EditorInterface.get_file_system_dock().files_moved.disconnect(_on_file_moved)
	EditorInterface.get_resource_filesystem().resources_reimported.disconnect(_on_reimported)


## Does the edits of all trees that were made of these imported ones again. Returns their paths.
func update_trees(imported_paths: PackedStringArray) -> PackedStringArray:
	var updated: PackedStringArray = []
	var report: PackedStringArray = []
	var unfit: Array[TreeReconstruction] = []
	for path: String in SceneAdder.tree_files(imported_paths):
		if not FileAccess.file_exists(path + ".import"):
			continue
		var fresh: TreeReconstruction = _load_fresh(path)
		if fresh == null:
			continue
		for local: TreeReconstruction in own_trees.find(
			_scan_of(path), fresh, _session.local_trees.get_loaded()
		):
			if _update(local, fresh, report, unfit):
				updated.append(local.resource_path)
		own_trees.note_followed(_scan_of(path))
	if report.size() + unfit.size() > 0:
		_show(report, unfit)
	elif not updated.is_empty():
		_session.say(tr("The edits were done again on the new import: %s") % ", ".join(updated), 0)
	return updated


# Where the imported tree says that it comes from, without loading it.
static func _scan_of(imported_path: String) -> String:
	if imported_path.get_extension().to_lower() != ScanFiles.STAND_IN:
		return imported_path
	return ScanFiles.read_stand_in(imported_path).get("scan", imported_path)


## A copy of the user's tree on the new import, with its edits, and what of them did not fit.
static func replayed(local: TreeReconstruction, fresh: TreeReconstruction) -> Dictionary:
	var made: TreeReconstruction = TreeReconstruction.new()
	made.skeleton = fresh.skeleton
	made.foliage = fresh.foliage
	made.provenance = fresh.provenance
	var result: Dictionary = {"tree": made, "done": 0, "left_out": [], "in_part": []}
	if not local.edit_log.is_empty():
		var replay: Dictionary = made.replay(local.edit_log)
		if replay["edit"] == null:
			return {}
		result["done"] = replay["done"]
		result["left_out"] = replay["left_out"]
		result["in_part"] = replay["in_part"]
	return result


func _on_reimported(paths: PackedStringArray) -> void:
	# The engine is in the middle of it.
	update_trees.call_deferred(paths)


func _update(
	local: TreeReconstruction,
	fresh: TreeReconstruction,
	report: PackedStringArray,
	unfit: Array[TreeReconstruction]
) -> bool:
	var path: String = local.resource_path
	var result: Dictionary = replayed(local, fresh)
	if result.is_empty():
		report.append(tr("%s stays as it is: its list of edits cannot be read.") % path)
		return false
	var made: TreeReconstruction = result["tree"]
	if local.skeleton == made.skeleton and local.foliage == made.foliage:
		_follow(local, made.provenance)
		return false
	var error: Error = _back_up(local, path)
	if error != OK:
		report.append(
			(
				tr("%s stays as it is, since no backup can be written: %s.")
				% [path, error_string(error)]
			)
		)
		return false
	_tell(local, result, unfit)
	var node: TreeInstance3D = _node_of(local)
	if node == null:
		var is_saved: bool = not _session.local_trees.is_changed(path)
		local.take_tree_of(made)
		if is_saved:
			error = _session.local_trees.save_tree(local)
			if error != OK:
				report.append(tr("%s can't be written: %s.") % [path, error_string(error)])
		return true
	_session.cancel_drag()
	# It is saved with the scene.
	_session.local_trees.watch(local)
	_session.history.begin(
		tr("Import Scan Again"),
		local if _session.local_trees.is_in_other_scenes(local, node) else node
	)
	_session.add_replacement(local, made)
	_session.history.commit()
	return true


# The scan was renamed or moved, and nothing else: what is in the file stays as it was saved.
func _follow(local: TreeReconstruction, provenance: Dictionary) -> void:
	var path: String = local.resource_path
	if local.provenance.get("source", "") == provenance.get("source", ""):
		return
	var is_saved: bool = not _session.local_trees.is_changed(path)
	local.provenance = provenance
	_session.say(
		tr("%s follows its scan, which is %s now.") % [path, provenance.get("source", "")], 0
	)
	if is_saved and FileAccess.file_exists(path):
		var error: Error = _session.local_trees.save_tree(local)
		if error != OK:
			_session.say(tr("%s can't be written: %s.") % [path, error_string(error)], 2)


func _on_file_moved(from: String, to: String) -> void:
	own_trees.note_move(from, to)
	_session.local_trees.note_move(from, to)


# What was done in part, or not at all.
func _tell(local: TreeReconstruction, result: Dictionary, unfit: Array[TreeReconstruction]) -> void:
	var in_part: Array = result["in_part"]
	if not in_part.is_empty():
		var sentence: String = tr(
			"%s: %d of its edits were done on what is still there of their wood."
		)
		_session.say(sentence % [local.resource_path, in_part.size()], 0)
	if not (result["left_out"] as Array).is_empty():
		unfit.append(local)


# A node of an open scene that shows the tree: first the one that is edited.
func _node_of(local: TreeReconstruction) -> TreeInstance3D:
	if is_instance_valid(_session.node) and _session.node.reconstruction == local:
		return _session.node
	if not Engine.is_editor_hint():
		return null
	for root: Node in EditorInterface.get_open_scene_roots():
		var nodes: Array[Node] = root.find_children("*", "MeshInstance3D", true, false)
		nodes.push_front(root)
		for node: Node in nodes:
			if node is TreeInstance3D and (node as TreeInstance3D).reconstruction == local:
				return node
	return null


# What could not be done, and the edits that fit nowhere: the latter are shown in the view.
func _show(report: PackedStringArray, unfit: Array[TreeReconstruction]) -> void:
	var text: PackedStringArray = report.duplicate()
	var node: TreeInstance3D = null
	for local: TreeReconstruction in unfit:
		(
			text
			. append(
				(
					tr(
						"%s: %d of its edits no longer fit the scan. They are kept, and tried again next time."
					)
					% [local.resource_path, local.get_unfit_edits().size()]
				)
			)
		)
		node = _node_of(local) if node == null else node
	print("\n".join(text))
	if not Engine.is_editor_hint():
		return
	var dialog: AcceptDialog = AcceptDialog.new() if node == null else ConfirmationDialog.new()
	if node != null:
		dialog.ok_button_text = tr("Show Them")
		(dialog as ConfirmationDialog).cancel_button_text = tr("Later")
		dialog.confirmed.connect(_show_edits.bind(weakref(node)))
	dialog.title = tr("Edits That No Longer Fit")
	dialog.dialog_text = "\n".join(text)
	dialog.dialog_autowrap = true
	dialog.min_size = Vector2i(Vector2(480, 0) * EditorInterface.get_editor_scale())
	dialog.visibility_changed.connect(_free_hidden.bind(dialog))
	EditorInterface.popup_dialog_centered(dialog)


# Goes to the node, with the tool that goes through them.
func _show_edits(of: WeakRef) -> void:
	var node: TreeInstance3D = of.get_ref() as TreeInstance3D
	if node == null:
		return
	var scene: Node = node.owner if node.owner != null else node
	if scene != EditorInterface.get_edited_scene_root():
		EditorInterface.open_scene_from_path(scene.scene_file_path)
	EditorInterface.set_main_screen_editor("3D")
	EditorInterface.get_selection().clear()
	EditorInterface.get_selection().add_node(node)
	EditorInterface.edit_node(node)
	# The editor tells its plugins a little later.
	for frame: int in _FRAMES:
		await (Engine.get_main_loop() as SceneTree).process_frame
	if _session.node == node:
		_session.view.editing = true
		_session.choose(&"unfit")


static func _free_hidden(dialog: AcceptDialog) -> void:
	if not dialog.visible:
		dialog.queue_free()


# The import as it is on disk now, whatever is in memory.
static func _load_fresh(path: String) -> TreeReconstruction:
	return ResourceLoader.load(path, "", ResourceLoader.CACHE_MODE_IGNORE) as TreeReconstruction


# As it is in memory, saved or not. The last few are kept.
static func _back_up(local: TreeReconstruction, path: String) -> Error:
	var part: String = path.get_base_dir().path_join(".saving_" + path.get_file())
	var error: Error = ResourceSaver.save(local, part, ResourceSaver.FLAG_COMPRESS)
	if error != OK:
		return error
	for i: int in range(_BACKUPS - 1, 0, -1):
		if FileAccess.file_exists(_backup(path, i)):
			DirAccess.rename_absolute(_backup(path, i), _backup(path, i + 1))
	error = DirAccess.rename_absolute(part, _backup(path, 1))
	if Engine.is_editor_hint():
		# The engine lists what is saved.
		EditorInterface.get_resource_filesystem().update_file(part)
	return error


static func _backup(path: String, number: int) -> String:
	return path + ".bak" + ("" if number == 1 else str(number))
