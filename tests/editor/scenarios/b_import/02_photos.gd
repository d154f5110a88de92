@tool
extends "../../test_plugin/scenario.gd"
## A tree from photos, with a program that stands in for COLMAP.

const PhotoFiles: GDScript = preload("../../test_plugin/photo_files.gd")
const TREE: String = "res://my_photos.res"
const SETTING: String = "tree_reconstruction/photos/colmap"

var _files: RefCounted


func run() -> void:
	await _open()
	await _make()
	await _compare()
	await _end()


# The window, by its title.
func _window() -> AcceptDialog:
	return dialog("Photos")


func _button(text: String) -> Control:
	return find_control("Button", text, _window())


func _open() -> void:
	await step("the dock leads to photos where no tree is selected")
	_files = PhotoFiles.new(OS.get_environment("TREE_EDITOR_TEST").path_join("phone"))
	EditorInterface.get_editor_settings().set_setting(SETTING, _files.colmap)
	EditorInterface.set_main_screen_editor("3D")
	await user.key("ctrl+n")
	if not await until(
		func() -> bool: return EditorInterface.get_edited_scene_root() == null, "a new scene"
	):
		return
	EditorInterface.add_root_node(Node3D.new())
	EditorInterface.get_selection().clear()
	session().photos_wanted.emit()
	if not await until(func() -> bool: return _window() != null, "the window opens"):
		return
	await user.frames(10)
	check((_button("Make Tree") as Button).disabled, "It begins without photos.")
	await picture("photos-window")


func _make() -> void:
	await step("a folder that is dropped is worked on while the editor is used, and can be ended")
	if not check(_window() != null, "There is no window."):
		return
	_window().files_dropped.emit(PackedStringArray([_files.photos]))
	_files.hold("exhaustive_matcher")
	await user.frames(20)
	check_fits()
	await press(_button("Make Tree"))
	if not await until(
		func() -> bool: return _button("Cancel") != null and _button("Cancel").is_visible_in_tree(),
		"it works"
	):
		return
	await user.frames(60)
	await picture("photos-compared")
	await press(_button("Cancel"))
	if not await until(func() -> bool: return _button("Make Tree") != null, "it has ended"):
		return
	check(not FileAccess.file_exists(TREE), "A tree was made.")
	await step("it goes on from there, and the tree stands in the scene as one step")
	_files.let_go("exhaustive_matcher")
	var root: Node = EditorInterface.get_edited_scene_root()
	await press(_button("Make Tree"))
	if not await until(func() -> bool: return root.get_child_count() == 1, "a tree stands there"):
		return
	var node: TreeInstance3D = root.get_child(0) as TreeInstance3D
	check_equal(node.name, &"MyPhotos", "its name")
	check_equal(node.reconstruction.resource_path, TREE, "its file")
	await user.frames(30)
	await picture("photos-made")
	check_equal(
		DirAccess.dir_exists_absolute("res://my_photos_photos/colmap"), true, "the work is there"
	)
	var log: String = FileAccess.get_file_as_string("res://my_photos_photos/photos.log")
	check_equal(log.count("Processed file [9/9]"), 1, "times that features were found")


func _compare() -> void:
	await step("the tree is seen over its photos, by the menu above the view")
	if _window() != null:
		await press(_button("Close"))
		await until(func() -> bool: return _window() == null, "the window closes")
	await press(find_control("MenuButton", "What is shown of the tree"))
	if not await choose("Compare with Photos"):
		return
	var base: Control = EditorInterface.get_base_control()
	var found: Callable = func() -> Node: return base.find_child("PhotoCompare", true, false)
	if not await until(func() -> bool: return found.call() != null, "the photos are there"):
		return
	var modes: BaseButton = base.find_child("Modes", true, false) as BaseButton
	await until(func() -> bool: return not modes.disabled, "the photo is seen")
	var message: Label = base.find_child("Message", true, false) as Label
	check(not message.is_visible_in_tree(), "It says: " + message.text)
	await picture("photos-compared-with")
	await press(base.find_child("Leave", true, false) as Control)
	await until(func() -> bool: return found.call() == null, "the photos are gone")


func _end() -> void:
	await step("the tree goes with undo, and its file stays")
	var root: Node = EditorInterface.get_edited_scene_root()
	await user.move(middle(view().get_parent() as Control))
	await user.key("ctrl+z")
	check_equal(root.get_child_count(), 0, "trees after undo")
	await user.key("ctrl+shift+z")
	check_equal(root.get_child_count(), 1, "trees after redo")
	check(FileAccess.file_exists(TREE), "The tree's file is gone.")
	# The scene is nothing to keep.
	EditorInterface.save_scene_as("res://photo_scene.tscn", false)
	await user.frames(10)
	EditorInterface.get_editor_settings().set_setting(SETTING, "")
