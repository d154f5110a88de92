@tool
extends "../../test_plugin/garden.gd"
## Nodes of a tree are found and selected with the mouse in the 3D view.

var _node: TreeInstance3D
var _of: TreeReconstruction


func run() -> void:
	await step("a tree whose node is selected shows its skeleton")
	_node = await open_garden("res://select.tscn", own_tree("res://select_tree.res"))
	if _node == null:
		return
	_of = _node.reconstruction
	check(session().get(&"node") == _node, "The addon does not edit it.")
	for entry: String in ["Select", "Tree"]:
		check(find_control("Button", entry) != null, "There is no '%s' button." % entry)
	await picture("tree-in-view")

	await step("the node under the mouse is shown")
	await _hide_leaves()
	var trunk: int = clear_nodes(_node, _of.select_nodes("trunk&height:2..6"))[0]
	await user.move(node_on_screen(_node, trunk))
	await until(
		func() -> bool: return session().get(&"hovered") == trunk, "the node below the mouse is lit"
	)
	await picture("hover")

	await step("a click selects it, another one with Shift adds")
	await user.click(node_on_screen(_node, trunk))
	await until(func() -> bool: return _selection().size() == 1, "a node is selected")
	check_equal(_selection(), PackedInt32Array([trunk]), "the selection")
	check_equal(is_unsaved(), false, "whether the scene has changes")
	var branch: int = clear_nodes(_node, large_branches(_of))[0]
	await user.click(node_on_screen(_node, branch), User.LEFT, "shift")
	await until(func() -> bool: return _selection().size() == 2, "two nodes are selected")
	await picture("two-selected")

	await step("a double click takes all that grows from it")
	await double_click(
		node_on_screen(_node, branch),
		func() -> bool: return _selection().size() > 2,
		"a branch is selected"
	)
	check_equal(
		_selection().size(),
		_of.select_nodes("below:%d" % session().call(&"get_active")).size(),
		"the number of selected nodes"
	)
	await picture("branch-selected")

	await step("Escape selects nothing, a drag over nothing what is in the box")
	await user.key("Escape")
	await until(func() -> bool: return _selection().is_empty(), "nothing is selected")
	check_equal(EditorInterface.get_selection().get_selected_nodes(), [_node], "the editor's node")
	var container: Control = view().get_parent() as Control
	var corner: Vector2 = container.get_screen_transform() * Vector2(40.0, 60.0)
	var across: Vector2 = container.get_screen_transform() * (container.size * Vector2(0.9, 0.45))
	await user.drag([corner, across])
	await until(func() -> bool: return not _selection().is_empty(), "a box is selected")
	var all_inside: bool = true
	var box: Rect2 = Rect2(corner, across - corner).grow(2.0)
	for id: int in _selection():
		all_inside = all_inside and box.has_point(node_on_screen(_node, id))
	check(all_inside, "Nodes outside the box are selected.")
	await picture("box-selected")

	await step("the keys of the views look at the whole tree")
	for key: String in ["KP_1", "KP_3", "KP_7", "KP_0"]:
		await user.key(key)
		await view_rests()
		check(_is_framed(), "Not the whole tree is seen after %s." % key)
		await picture("view-" + key.to_lower().replace("_", "-"))
	await user.key("Escape")
	await save_scene()


# Leaves would be in the way of what is to be seen in the pictures, not of the mouse.
func _hide_leaves() -> void:
	if session().get(&"view").leaves:
		await user.key("l")
	await until(func() -> bool: return not session().get(&"view").leaves, "the leaves are hidden")


func _is_framed() -> bool:
	var container: Control = view().get_parent() as Control
	var seen: Rect2 = container.get_screen_transform() * Rect2(Vector2.ZERO, container.size)
	for id: int in _of.get_leaves():
		if not seen.grow(4.0).has_point(node_on_screen(_node, id)):
			return false
	return true


func _selection() -> PackedInt32Array:
	return session().get(&"selection")
