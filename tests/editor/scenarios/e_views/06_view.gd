@tool
extends "../../test_plugin/garden.gd"
## What the user sees of trees that are added, of clicks beside them, and of what is undone.

var _status: Label


func run() -> void:
	await step("a tree that is added to a new scene is seen wholly, with its leaves")
	own_tree("res://view_tree.res")
	own_tree("res://view_second.res")
	if not await _open_empty("res://view.tscn"):
		return
	session().get(&"view").leaves = false
	var first: TreeInstance3D = await _add("res://view_tree.res", 1)
	if first == null:
		return
	check(session().get(&"view").leaves, "Its leaves are not shown.")
	check(_is_framed(first), "Not all of it is seen.")
	_status = EditorInterface.get_base_control().find_child("Status", true, false) as Label
	await fine_picture("first-view")

	await step("F shows all of it again, from where the view looks")
	await user.click(middle(view().get_parent() as Control), User.WHEEL_UP, "", 12)
	await view_rests()
	check(not _is_framed(first), "It is seen wholly from near by.")
	var turned: Basis = view().get_camera_3d().global_basis
	await user.key("f")
	await view_rests()
	check(_is_framed(first), "Not all of it is seen after F.")
	check(view().get_camera_3d().global_basis.is_equal_approx(turned), "The view has turned.")
	await picture("view-after-f")

	await step("a tree that is added later stands beside it, in view")
	var second: TreeInstance3D = await _add("res://view_second.res", 2)
	if second == null:
		return
	check(_is_framed(second), "Not all of it is seen.")
	var boxes: Array[AABB] = [_box_of(first), _box_of(second)]
	check(not boxes[0].intersects(boxes[1]), "They stand in each other.")
	var apart: float = boxes[0].get_center().distance_to(boxes[1].get_center())
	check(apart < 3.0 * boxes[0].get_longest_axis_size(), "It is %.1f m off." % apart)
	await fine_picture("second-tree")

	await step("the wheel of the Graft tool does not move the view")
	await frame_view()
	await take_tool(&"graft", "j")
	var of: TreeReconstruction = second.reconstruction
	var tip: int = clear_nodes(second, of.select_nodes("leaves&height:5.."))[0]
	await user.move(node_on_screen(second, tip))
	await until(func() -> bool: return _has_ghosts(), "the graft is shown")
	var camera: Transform3D = view().get_camera_3d().global_transform
	for turn: int in [User.WHEEL_UP, User.WHEEL_UP, User.WHEEL_DOWN]:
		var shown: Array = _ghosts()
		await user.click(node_on_screen(second, tip), turn)
		await until(func() -> bool: return _has_ghosts() and _ghosts() != shown, "another graft")
	await view_rests()
	check(
		view().get_camera_3d().global_transform.is_equal_approx(camera), "The wheel moved the view."
	)

	await step("a click or drag that misses the wood by a little leaves tool and tree as they are")
	await user.click(node_on_screen(second, tip))
	await until(func() -> bool: return not of.get_node_children(tip).is_empty(), "it is grafted")
	var before: PackedByteArray = bytes(of)
	var miss: Vector2 = _near_miss(second, of.select_nodes("leaves"))
	await user.click(miss)
	await user.drag([miss, miss + Vector2(30.0, 18.0)])
	await user.drag([miss, miss - Vector2(60.0, 30.0)])
	check_equal(session().get(&"tool"), session().get(&"tools")[&"graft"], "the tool")
	check_equal(session().get(&"node"), second, "the edited node")
	check_equal(EditorInterface.get_selection().get_selected_nodes(), [second], "the selection")
	check_equal(bytes(of), before, "the tree")
	await picture("near-miss")

	await step("the status line follows undo")
	await user.key("ctrl+z")
	await until(func() -> bool: return of.get_node_children(tip).is_empty(), "the graft is undone")
	await until(func() -> bool: return _status.text.begins_with("Undone: "), "that is said")
	await picture("undo-is-said")
	await user.key("ctrl+shift+z")
	await until(func() -> bool: return _status.text.begins_with("Done again: "), "and that")
	await user.key("ctrl+z")
	await until(func() -> bool: return of.get_node_children(tip).is_empty(), "it is undone again")

	await step("the Inspector is in front of the dock for all but trees")
	var dock: Control = EditorInterface.get_base_control().find_child("TreeDock", true, false)
	dock.get_parent().call(&"make_visible")
	await until(func() -> bool: return dock.is_visible_in_tree(), "the dock is seen")
	await click_node(EditorInterface.get_edited_scene_root())
	await until(
		func() -> bool: return EditorInterface.get_inspector().is_visible_in_tree(),
		"the Inspector is seen"
	)
	await picture("inspector-in-front")
	await click_node(first)
	await until(func() -> bool: return dock.is_visible_in_tree(), "the dock is seen again")
	await picture("dock-in-front")
	await save_scene()
	# Its strip takes much of the view.
	await take_tool(&"select", "q")


# A scene without anything in it, and nobody has moved its view.
func _open_empty(path: String) -> bool:
	var root: Node3D = Node3D.new()
	root.name = "Glade"
	EditorInterface.set_main_screen_editor("3D")
	return await open_scene(root, path)


# By the menu of the FileSystem dock. Returns the tree that is the last of so many, once it is seen.
func _add(path: String, count: int) -> TreeInstance3D:
	if not await until(func() -> bool: return file_item(path) != null, "the file is in the dock"):
		return null
	await click_file(path, User.RIGHT)
	await until(func() -> bool: return open_menu() != null, "a menu opens")
	if not await choose("Add Tree to Scene"):
		return null
	var root: Node = EditorInterface.get_edited_scene_root()
	if not await until(func() -> bool: return root.get_child_count() == count, "the tree is there"):
		return null
	var node: TreeInstance3D = root.get_child(count - 1) as TreeInstance3D
	await until(func() -> bool: return session().get(&"node") == node, "it is edited")
	await until(func() -> bool: return not node.is_rebuilding(), "the tree is built")
	await view_rests()
	return node


func _box_of(node: TreeInstance3D) -> AABB:
	return node.global_transform * node.reconstruction.get_aabb()


func _is_framed(node: TreeInstance3D) -> bool:
	var container: Control = view().get_parent() as Control
	var seen: Rect2 = container.get_screen_transform() * Rect2(Vector2.ZERO, container.size)
	var across: Rect2 = Rect2(node_on_screen(node, node.reconstruction.get_root()), Vector2.ZERO)
	for id: int in node.reconstruction.get_node_ids():
		var at: Vector2 = node_on_screen(node, id)
		if not seen.has_point(at):
			return false
		across = across.expand(at)
	return across.size.y > 0.25 * seen.size.y


# A place beside a tip that no click finds, though it is close to it.
func _near_miss(node: TreeInstance3D, tips: PackedInt32Array) -> Vector2:
	var picker: RefCounted = session().get(&"picker")
	var camera: Camera3D = view().get_camera_3d()
	var container: Control = view().get_parent() as Control
	var to_view: Transform2D = container.get_screen_transform().affine_inverse()
	for tip: int in tips:
		for turn: int in 8:
			var off: Vector2 = Vector2.from_angle(turn * TAU / 8.0) * 12.0
			var at: Vector2 = (node_on_screen(node, tip) + off).round()
			var found: int = picker.call(&"pick", camera, to_view * at)
			if found == TreeReconstruction.NO_NODE:
				return at
	check(false, "There is no place beside the wood.")
	return Vector2.ZERO


func _ghosts() -> Array:
	@warning_ignore("unsafe_method_access")
	return session().get(&"tool").get_ghosts()


func _has_ghosts() -> bool:
	return not _ghosts().is_empty()
