@tool
extends "../../test_plugin/garden.gd"
## The dock "Tree": a twig dragged onto the tree, a stage done again, variants, baking.

var _node: TreeInstance3D
var _dock: Control


func run() -> void:
	await step("the dock shows the tree that is selected")
	var sample_tree: TreeReconstruction = own_tree("res://dock_tree.res")
	_node = await open_garden("res://dock.tscn", sample_tree)
	_dock = EditorInterface.get_base_control().find_child("TreeDock", true, false) as Control
	if _node == null or not check(_dock != null, "There is no dock."):
		return
	@warning_ignore("unsafe_method_access")
	_dock.get_parent().make_visible()
	await _open(&"measurements")
	var nodes: String = str(sample_tree.get_node_count())
	await until(func() -> bool: return _shows(nodes), "the number of nodes is shown")
	await picture("dock")

	await step("a twig that is dragged onto a branch is grafted")
	await _open(&"twigs")
	var list: ItemList = find_control("ItemList", "Drag a twig", _dock)
	if not check(list != null, "There is no list of twigs."):
		return
	var before: PackedByteArray = bytes(sample_tree)
	var tip: int = clear_nodes(_node, sample_tree.select_nodes("leaves&height:5.."))[0]
	var from: Vector2 = list.get_global_rect().position + list.get_item_rect(0).get_center()
	var to: Vector2 = node_on_screen(_node, tip)
	await user.drag(PackedVector2Array([from, from.lerp(to, 0.2), from.lerp(to, 0.7), to, to]))
	await until(
		func() -> bool: return not sample_tree.get_node_children(tip).is_empty(), "it is grafted"
	)
	await picture("dock-twig-dropped")
	await _undo()
	check_equal(bytes(sample_tree), before, "the tree after undo")

	await step("a stage is done again with another option, with its progress shown")
	await _open(&"stages")
	@warning_ignore("unsafe_method_access")
	var row: Control = _section(&"stages").rows[&"skeleton"]
	@warning_ignore("unsafe_method_access")
	row.get_field(&"simplify_distance").set_value(0.03)
	var count: int = sample_tree.get_node_count()
	await press(find_control("Button", "Finds the branches again", _dock))
	if not await until(
		func() -> bool: return sample_tree.get_node_count() < count, "the tree has fewer nodes"
	):
		return
	check_equal(_node.reconstruction, sample_tree, "the resource")
	await picture("dock-stage-done-again")
	await _undo()
	check_equal(bytes(sample_tree), before, "the tree after undo")

	await step("a click on a variant puts it beside the tree")
	await _open(&"variants")
	if not await until(
		func() -> bool: return find_control("Button", "The variant", _dock) != null,
		"they are drawn"
	):
		return
	await press(find_control("Button", "The variant", _dock))
	var scene: Node = EditorInterface.get_edited_scene_root()
	await until(func() -> bool: return scene.get_child_count() == 2, "it is in the scene")
	await picture("dock-variant")
	var path_of_variant: String = (
		(scene.get_child(1) as TreeInstance3D).reconstruction.resource_path
	)
	await _undo()
	check_equal(scene.get_child_count(), 1, "trees after undo")
	check(await save_scene(), "The scene can't be saved.")
	check(not FileAccess.file_exists(path_of_variant), "A variant that was undone left its file.")
	await user.key("ctrl+shift+z")
	await until(func() -> bool: return scene.get_child_count() == 2, "it comes back")
	check(await save_scene(), "The scene can't be saved.")
	check(
		path_of_variant in str(ResourceLoader.get_dependencies(scene.scene_file_path)),
		"The scene does without its variant."
	)
	check(FileAccess.file_exists(path_of_variant), "The variant was not saved.")
	await _undo()

	await step("the tree is baked to a scene that needs no addon")
	await _open(&"export")
	await press(find_control("Button", "Bake to scene", _dock))
	if not await until(func() -> bool: return dialog("Bake to Scene") != null, "a dialog asks"):
		return
	await picture("dock-bake")
	await user.key("Return")
	var path: String = "res://dock_tree_baked.scn"
	if await until(func() -> bool: return ResourceLoader.exists(path), "the scene is there"):
		check_equal(ResourceLoader.get_dependencies(path), PackedStringArray(), "what it needs")
	await save_scene()

	await step("a tree is baked again while its scene is saved, and keeps its name for scenes")
	var uid: int = ResourceLoader.get_resource_uid(path)
	check(uid != ResourceUID.INVALID_ID, "The baked scene has no UID.")
	for i: int in 3:
		var written: int = FileAccess.get_modified_time(path)
		await until(
			func() -> bool: return Time.get_unix_time_from_system() > written + 1.0, "a second"
		)
		_section(&"export").call(&"bake_to", path)
		await until(
			func() -> bool: return FileAccess.get_modified_time(path) != written, "it is written"
		)
		EditorInterface.mark_scene_as_unsaved()
		EditorInterface.save_scene()
		await files_rest()
	check_equal(ResourceLoader.get_resource_uid(path), uid, "its UID")
	check_equal(ResourceUID.get_id_path(uid), path, "what has its UID")

	await _save_cleaned_cloud()


func _save_cleaned_cloud() -> void:
	await step(
		"the cleaned cloud is saved outside of the project, and a file that is there asked for"
	)
	var cleaned: String = OS.get_environment("TREE_EDITOR_TEST").path_join("cleaned.ply")
	for time: int in 2:
		var modified: int = FileAccess.get_modified_time(cleaned)
		await press(find_control("Button", "Save cleaned cloud", _dock))
		var asks: Callable = func() -> bool: return dialog("Save Cleaned Cloud") != null
		if not await until(asks, "a dialog asks"):
			return
		await user.key("ctrl+a")
		await user.type(cleaned)
		await picture("dock-cleaned-cloud")
		await user.key("Return")
		if time == 1:
			if not await until(
				func() -> bool: return dialog("already exists") != null,
				"it asks before it writes over the file"
			):
				return
			check_equal(FileAccess.get_modified_time(cleaned), modified, "the file meanwhile")
			await picture("dock-cleaned-cloud-again")
			await user.key("Escape")
			await user.key("Escape")
		elif not await until(
			func() -> bool: return FileAccess.file_exists(cleaned), "the cloud is there"
		):
			return
	var head: String = FileAccess.get_file_as_bytes(cleaned).slice(0, 100).get_string_from_ascii()
	check("comment cleaned by treerec" in head, head)
	await picture("dock-cleaned-cloud-saved")


# Opens a section of the dock, and folds all others.
func _open(id: StringName) -> void:
	@warning_ignore("unsafe_property_access", "unsafe_method_access")
	var ids: Array = _dock.sections.keys()
	ids.erase(id)
	@warning_ignore("unsafe_method_access")
	_dock.set_folded(PackedStringArray(ids))
	await user.frames(4)


func _section(id: StringName) -> Control:
	@warning_ignore("unsafe_property_access")
	return _dock.sections[id]


func _shows(text: String) -> bool:
	for label: Node in _dock.find_children("*", "Label", true, false):
		if (label as Label).text.replace(",", "") == text:
			return true
	return false


func _undo() -> void:
	var version: int = _version()
	await user.move(middle(view().get_parent() as Control))
	await user.key("ctrl+z")
	await until(func() -> bool: return _version() != version, "it is undone")
	await user.frames(4)


func _version() -> int:
	var manager: EditorUndoRedoManager = EditorInterface.get_editor_undo_redo()
	var scene: Node = EditorInterface.get_edited_scene_root()
	return manager.get_history_undo_redo(manager.get_object_history_id(scene)).get_version()
