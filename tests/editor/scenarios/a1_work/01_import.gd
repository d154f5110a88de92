@tool
extends "../../test_plugin/garden.gd"
## A scan is dropped into the project, and stands as a tree in a scene.

const SCAN: String = "res://sample.ply"


func run() -> void:
	await step("a scan that is copied into the project imports by itself")
	await drop_file(sample, SCAN)
	var made: TreeReconstruction = await imported(SCAN)
	if made == null:
		return
	check(made.get_node_count() > 100, "It has %d nodes only." % made.get_node_count())
	check_equal(made.provenance.get("source"), SCAN, "the source")
	if not await until(func() -> bool: return file_item(SCAN) != null, "the file is in the dock"):
		return
	await picture("imported")

	await step("its parameters in the Import dock tell what they do")
	await click_file(SCAN)
	await _read_parameters()

	await step("its menu adds it to a scene that is begun for it")
	await click_file(SCAN, User.RIGHT)
	await until(func() -> bool: return open_menu() != null, "a menu opens")
	await picture("menu-of-a-scan")
	if not await choose("Add Tree to Scene"):
		return
	if not await until(func() -> bool: return _tree_in_scene() != null, "the tree is in the scene"):
		return
	var node: TreeInstance3D = _tree_in_scene()
	check_equal(node.reconstruction, made, "the node's tree")
	check_equal(node.name, &"Sample", "the node's name")
	await until(func() -> bool: return not node.is_rebuilding(), "the tree is built")
	check(node.get_triangle_count() > 1000, "It has no bark.")
	await picture("added-to-scene")

	await step("that is one step of the scene's history")
	await user.move(middle(view().get_parent() as Control))
	await user.key("ctrl+z")
	await until(func() -> bool: return _tree_in_scene() == null, "the tree is gone again")
	await user.key("ctrl+shift+z")
	await until(func() -> bool: return _tree_in_scene() != null, "the tree is back")
	check_equal(_tree_in_scene(), node, "the node that came back")

	await step("it is taken to the 3D view with the mouse")
	var from: Vector2 = await item_place(file_list(), file_item(SCAN))
	var to: Vector2 = middle(view().get_parent() as Control) + Vector2(200.0, 60.0)
	var container: Control = view().get_parent() as Control
	var in_view: Vector2 = container.get_screen_transform().affine_inverse() * to
	var camera: Camera3D = view().get_camera_3d()
	# Taken before: with the tree come its tools, and the view becomes smaller.
	var ground: Vector3 = Plane(Vector3.UP).intersects_ray(
		camera.project_ray_origin(in_view), camera.project_ray_normal(in_view)
	)
	await user.drag([from, from + Vector2(30.0, 5.0), to])
	await until(func() -> bool: return _trees().size() == 2, "there is a second tree")
	if _trees().size() == 2:
		var place: Vector3 = _trees()[1].global_position
		check(place.distance_to(ground) < 0.05, "It stands at %s, not at %s" % [place, ground])
	await picture("dragged-into-view")
	await _save_scene_as("res://first.tscn")

	await step("a real scan imports")
	var scan: String = real_scan("vezy_A1B2.asc")
	if scan.is_empty():
		await user.say("        Skipped: there are no real scans here.")
		return
	await drop_file(scan, "res://vezy.asc")
	var real: TreeReconstruction = await imported("res://vezy.asc")
	check(real != null and real.get_node_count() > 100, "It has too few nodes.")
	scan = real_scan("wytham_Tf18_birch.txt")
	await drop_file(scan, "res://birch.txt")
	real = await imported("res://birch.treescan")
	check(real != null and real.get_node_count() > 100, "It has too few nodes.")
	await picture("real-scans")


func _save_scene_as(path: String) -> void:
	# The file dialog is the engine's own matter.
	EditorInterface.save_scene_as(path)
	await until(func() -> bool: return scene_path() == path and not is_unsaved(), "it is saved")


func _trees() -> Array[Node]:
	var root: Node = EditorInterface.get_edited_scene_root()
	return [] if root == null else root.find_children("*", "TreeInstance3D", false, false)


func _tree_in_scene() -> TreeInstance3D:
	var found: Array[Node] = _trees()
	return null if found.is_empty() else found[0] as TreeInstance3D


func _read_parameters() -> void:
	var docks: Array[Node] = EditorInterface.get_base_control().find_children(
		"*", "ImportDock", true, false
	)
	if not check(docks.size() == 1, "There are %d Import docks." % docks.size()):
		return
	var dock: Control = docks[0] as Control
	dock.call(&"make_visible")
	if not await until(
		func() -> bool: return _parameter(dock, "scan/up_axis") != null, "the parameters are shown"
	):
		return
	var field: EditorProperty = _parameter(dock, "scan/up_axis")
	await until(func() -> bool: return "axis" in field.tooltip_text, "they have tooltips")
	var seen: int = 0
	for node: Node in dock.find_children("*", "EditorProperty", true, false):
		seen += int("description" in (node as EditorProperty).tooltip_text)
	check(seen > 10, "Only %d parameters have a tooltip." % seen)
	await user.move(field.get_screen_transform() * Vector2(30.0, field.size.y / 2.0))
	await until(func() -> bool: return _tooltip() != null, "a tooltip is shown")
	await user.frames(2)
	if _tooltip() != null:
		var title: Node = _tooltip().find_children("*", "RichTextLabel", true, false)[0]
		check_equal((title as RichTextLabel).get_parsed_text(), "Up Axis", "the tooltip's title")
	await picture("tooltip-of-a-parameter")
	await user.move(middle(view().get_parent() as Control))
	# The Scene dock comes back where they share a place.
	for node: Node in EditorInterface.get_base_control().find_children(
		"*", "SceneTreeDock", true, false
	):
		node.call(&"make_visible")


func _parameter(dock: Control, name: String) -> EditorProperty:
	for node: Node in dock.find_children("*", "EditorProperty", true, false):
		var field: EditorProperty = node as EditorProperty
		if field.get_edited_property() == name and field.is_visible_in_tree():
			return field
	return null


func _tooltip() -> Window:
	for node: Node in EditorInterface.get_base_control().find_children(
		"*", "EditorHelpBitTooltip", true, false
	):
		if (node as Window).visible:
			return node as Window
	return null
