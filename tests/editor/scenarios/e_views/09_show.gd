@tool
extends "../../test_plugin/garden.gd"
## What is shown of a tree: the keys P V S T L E X G, the turntable, pictures of the viewport.
## Nothing of it is saved or left over.

var _node: TreeInstance3D


func run() -> void:
	# What is drawn is counted.
	user.seldom.end()
	await _go_through()
	user.seldom.begin()


func _go_through() -> void:
	await step("the keys show and hide, and the scene knows nothing of it")
	_node = await open_garden("res://show.tscn", own_tree("res://show_tree.res"))
	if _node == null:
		return
	var view_state: RefCounted = session().get(&"view")
	var keys: Dictionary[String, StringName] = {
		"l": &"leaves", "t": &"mesh", "x": &"axes", "g": &"grid", "s": &"skeleton", "e": &"wind"
	}
	for key: String in keys:
		await _press_and_see(view_state, key, keys[key])
		if key in ["t", "g", "s"]:
			await picture("shown-" + keys[key])
	for key: String in keys:
		await _press_and_see(view_state, key, keys[key])
	check_equal(is_unsaved(), false, "whether the scene has changes")
	check(_node.leaves and _node.wind and _node.visible, "A property of the node was changed.")

	await _show_scan(view_state)
	await _show_voxels(view_state)
	await _turn()
	await _take_pictures()

	await step("with nothing selected nothing of the editing is left")
	var busy: int = drawn_objects()
	EditorInterface.get_selection().clear()
	await until(func() -> bool: return session().get(&"node") == null, "it is edited no more")
	await user.frames(3)
	check(drawn_objects() < busy, "The skeleton is still drawn.")
	check(find_control("Button", "Select (") == null, "The tools are still shown.")
	await picture("left")


func _press_and_see(view_state: RefCounted, key: String, property: StringName) -> void:
	var before: bool = view_state.get(property)
	await user.key(key)
	await until(
		func() -> bool: return view_state.get(property) != before,
		"'%s' changes %s" % [key, property]
	)


func _show_scan(view_state: RefCounted) -> void:
	await step("the scan's points come from its file, and a legend says what their colors mean")
	await _press_and_see(view_state, "p", &"points")
	var scan: RefCounted = session().get(&"scan")
	await until(func() -> bool: return not scan.get(&"points").is_empty(), "the points are there")
	var before: int = drawn_objects()
	view_state.set(&"point_colors", 2)
	await until(func() -> bool: return scan.get(&"fidelity") != null, "the fidelity is measured")
	await user.frames(3)
	await fine_picture("points-by-fidelity")
	view_state.set(&"point_colors", 1)
	view_state.set(&"channel", TreeWind.Channel.LEVEL)
	await user.frames(3)
	await picture("points-by-height")
	view_state.set(&"channel", 0)
	await _press_and_see(view_state, "p", &"points")
	await user.frames(3)
	check(drawn_objects() < before, "The points are still drawn.")


func _show_voxels(view_state: RefCounted) -> void:
	await step("V shows the voxels of the scan, and hides them again")
	var before: int = drawn_objects()
	await _press_and_see(view_state, "v", &"voxels")
	await until(func() -> bool: return drawn_objects() > before, "the voxels are drawn")
	await _press_and_see(view_state, "t", &"mesh")
	await _press_and_see(view_state, "l", &"leaves")
	await fine_picture("voxels")
	await _press_and_see(view_state, "t", &"mesh")
	await _press_and_see(view_state, "l", &"leaves")
	await _press_and_see(view_state, "v", &"voxels")
	await user.frames(3)
	check_equal(drawn_objects(), before, "objects drawn without the voxels")
	check_equal(is_unsaved(), false, "whether the scene has changes")


func _turn() -> void:
	await step("the turntable turns until a key is pressed, and the camera is where it was")
	var camera: Camera3D = view().get_camera_3d()
	var place: Transform3D = camera.global_transform
	await user.key("o")
	await until(
		func() -> bool: return not camera.global_transform.is_equal_approx(place), "it turns"
	)
	await user.frames(4)
	await picture("turntable")
	await user.key("Escape")
	await until(
		func() -> bool: return camera.global_transform.is_equal_approx(place), "it has ended"
	)
	check(session().get(&"node") == _node, "Escape did more than end it.")


func _take_pictures() -> void:
	await step("a picture is saved where it says")
	var said: PackedStringArray = []
	var listen: Callable = func(sentence: String, _kind: int) -> void: said.append(sentence)
	session().connect(&"said", listen)
	await user.key("F9")
	await until(func() -> bool: return not said.is_empty(), "something is said")
	session().disconnect(&"said", listen)
	var files: PackedStringArray = DirAccess.get_files_at("res://screenshots")
	var pictures: int = 0
	for file: String in files:
		if file.ends_with(".png"):
			pictures += 1
			check(said[0].contains(file), "It says '%s' of %s." % [said[0], file])
			var seen: Image = Image.load_from_file("res://screenshots".path_join(file))
			check_equal(seen.get_size(), view().size, "the picture's size")
	check_equal(pictures, 1, "pictures")
