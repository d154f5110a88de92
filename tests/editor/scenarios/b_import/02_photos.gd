@tool
extends "../../test_plugin/scenario.gd"
## A tree from photos, with a program that stands in for COLMAP.

const LeafyPhotos: GDScript = preload("../../test_plugin/leafy_photos.gd")
const ADDER: String = "res://addons/tree_reconstruction/editor/import/scene_adder.gd"
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
	_files = LeafyPhotos.new(OS.get_environment("TREE_EDITOR_TEST").path_join("phone"))
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
	await press(_button("Choose Photos…"))
	if await until(
		func() -> bool: return dialog("Choose Photos") != null, "a dialog says what it is for"
	):
		await user.key("Escape")
		await until(func() -> bool: return dialog("Choose Photos") == null, "it closes")
	await picture("photos-window")
	await step("a marker to print is saved where the user says")
	var page: String = OS.get_environment("TREE_EDITOR_TEST").path_join("to print.svg")
	await press(_button("Save Marker to Print…"))
	if await until(
		func() -> bool: return dialog("Save Marker to Print") != null, "a dialog asks for a file"
	):
		(dialog("Save Marker to Print") as EditorFileDialog).current_path = page
		await user.frames(5)
		await user.key("Return")
		await until(func() -> bool: return FileAccess.file_exists(page), "the page is there")
		await user.frames(10)
		await picture("photos-marker")


func _make() -> void:
	await step("a folder that is dropped is worked on while the editor is used, and can be ended")
	if not check(_window() != null, "There is no window."):
		return
	_window().files_dropped.emit(PackedStringArray([_files.photos]))
	_files.hold("exhaustive_matcher")
	await user.frames(20)
	check_fits()
	# The least that there is to do.
	var time: OptionButton = find_control("OptionButton", "How much is found", _window())
	time.select(0)
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
	await step("it has the bark of its photos, by a file beside its own")
	var bark: ShaderMaterial = node.bark_material as ShaderMaterial
	if check(bark != null, "It has drawn bark."):
		check_equal(bark.resource_path, TREE.get_basename() + "_bark.res", "the bark's file")
		var again: ShaderMaterial = (
			ResourceLoader.load(bark.resource_path, "", ResourceLoader.CACHE_MODE_IGNORE_DEEP)
			as ShaderMaterial
		)
		var texture: Texture2D = again.get_shader_parameter(&"albedo_texture") as Texture2D
		check_equal(texture.get_size(), Vector2(512, 512), "the size of its picture")
		check(texture.get_image().is_compressed(), "It takes up video memory.")
		check_equal(
			EditorInterface.get_resource_filesystem().get_file_type(bark.resource_path),
			"ShaderMaterial",
			"what the FileSystem dock takes it for"
		)
	await step("its leaves have the colors of its photos, by another file")
	var leaves: ShaderMaterial = node.leaf_material as ShaderMaterial
	if check(leaves != null, "It has drawn leaves."):
		check_equal(leaves.resource_path, TREE.get_basename() + "_leaves.res", "the leaves' file")
		check(
			leaves.get_shader_parameter(&"picture_gain") != Vector3.ONE, "They have drawn colors."
		)
	await user.frames(30)
	await picture("photos-made")
	check_equal(
		DirAccess.dir_exists_absolute("res://my_photos_photos/colmap"), true, "the work is there"
	)
	var log: String = FileAccess.get_file_as_string("res://my_photos_photos/photos.log")
	check_equal(log.count("Processed file [13/13]"), 1, "times that features were found")


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


# Other leaves get the same colors, and undo gives back the first.
func _choose_leaves(node: TreeInstance3D) -> void:
	await step("other leaves have the colors of the photos, too")
	var selection: EditorSelection = EditorInterface.get_selection()
	selection.clear()
	selection.add_node(node)
	if not await until(func() -> bool: return session().node == node, "the tree is edited"):
		return
	var leaves: ShaderMaterial = node.leaf_material as ShaderMaterial
	if not check(leaves != null, "It has drawn leaves."):
		return
	var first: String = _picture_of(leaves)
	session().set_value("Leaf Preset", session().tree, &"leaf_preset", "birch")
	await until(
		func() -> bool: return _picture_of(leaves).ends_with("/birch_sprays_albedo.png"),
		"the birch's picture has them"
	)
	await user.move(middle(view().get_parent() as Control))
	await user.key("ctrl+z")
	await until(func() -> bool: return _picture_of(leaves) == first, "undo brings the first back")


static func _picture_of(material: ShaderMaterial) -> String:
	return (material.get_shader_parameter(&"albedo_texture") as Texture2D).resource_path


func _end() -> void:
	await step("the tree goes with undo, and its file stays")
	var root: Node = EditorInterface.get_edited_scene_root()
	await user.move(middle(view().get_parent() as Control))
	await user.key("ctrl+z")
	await until(func() -> bool: return root.get_child_count() == 0, "undo takes the tree away")
	await user.key("ctrl+shift+z")
	if not await until(func() -> bool: return root.get_child_count() == 1, "redo brings it again"):
		return
	check((root.get_child(0) as TreeInstance3D).bark_material != null, "Redo has lost its bark.")
	check((root.get_child(0) as TreeInstance3D).leaf_material != null, "Redo has lost its leaves.")
	check(FileAccess.file_exists(TREE), "The tree's file is gone.")
	await _choose_leaves(root.get_child(0) as TreeInstance3D)
	await step("from the FileSystem dock it comes with its bark, too")
	await user.key("ctrl+z")
	var adder: RefCounted = (load(ADDER) as GDScript).new(EditorInterface.get_editor_undo_redo())
	var trees: Array[TreeReconstruction] = [load(TREE) as TreeReconstruction]
	adder.add(trees, Vector3.ZERO)
	if check_equal(root.get_child_count(), 1, "trees"):
		check((root.get_child(0) as TreeInstance3D).bark_material != null, "It has drawn bark.")
		check((root.get_child(0) as TreeInstance3D).leaf_material != null, "It has drawn leaves.")
	# The scene is nothing to keep.
	EditorInterface.save_scene_as("res://photo_scene.tscn", false)
	await user.frames(10)
	EditorInterface.get_editor_settings().set_setting(SETTING, "")
