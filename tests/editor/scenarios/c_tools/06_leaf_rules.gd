@tool
extends "../../test_plugin/garden.gd"
## Some wood gets leaves of its own: a selected branch, end nodes, a branch that is clicked.

var _node: TreeInstance3D
var _of: TreeReconstruction


func run() -> void:
	await step("the Leaf rule tool gives the selected branch leaves of its own, as one step")
	_node = await open_garden("res://leaf_rules.tscn", own_tree("res://leaf_rules_tree.res"))
	if _node == null:
		return
	_of = _node.reconstruction
	var branch: int = clear_nodes(_node, large_branches(_of))[0]
	var above: PackedInt32Array = _of.select_nodes("below:%d" % branch)
	var before: PackedByteArray = bytes(_of)
	await user.click(node_on_screen(_node, branch))
	if not await until(
		func() -> bool: return _selected() == PackedInt32Array([branch]), "it is selected"
	):
		return
	if not await take_tool(&"leaf_rule", "F2"):
		return
	await press(_kinds())
	await choose("Maple")
	await until(
		func() -> bool: return _of.count_leaf_rules(above).keys() == ["maple"],
		"the branch is a maple's"
	)
	check_equal(_of.count_leaf_rules(_of.get_node_ids()).size(), 2, "rules on the tree")
	check(_of.edit_log.contains("leaves where=below:"), "The log does not tell of it.")
	if not session().get(&"view").leaves:
		await user.move(middle(view().get_parent() as Control))
		await user.key("l")
	await until(func() -> bool: return not _node.is_building_levels(), "the tree is built")
	await until(func() -> bool: return "maple_leaf.tres" in _shown(), "its leaves are shown")
	check("birch_leaf.tres" in _shown(), "The tree's own leaves are gone: %s." % _shown())
	await picture("a-branch-of-a-maple")

	await step("one undo takes it back, bit for bit, and one redo does it again")
	await user.move(middle(view().get_parent() as Control))
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(_of) == before, "it is undone")
	await user.key("ctrl+shift+z")
	await until(
		func() -> bool: return _of.count_leaf_rules(above).keys() == ["maple"], "it is done again"
	)

	await step("a click gives the leaves to the branch under the mouse")
	var other: int = TreeReconstruction.NO_NODE
	for id: int in clear_nodes(_node, large_branches(_of)):
		if not id in above and not branch in _of.select_nodes("below:%d" % id):
			other = id
			break
	if other != TreeReconstruction.NO_NODE:
		await user.move(node_on_screen(_node, other))
		await until(func() -> bool: return _has_ghosts(), "the branch is shown")
		await picture("before-the-click")
		await user.click(node_on_screen(_node, other))
		await until(
			func() -> bool: return _of.count_leaf_rules([other]).keys() == ["maple"], "it has them"
		)
		await until(func() -> bool: return not _node.is_rebuilding(), "the tree is built")
		await picture("two-branches-of-a-maple")
		await user.key("ctrl+z")
		await until(func() -> bool: return _of.count_leaf_rules([other]).keys() == [""], "undone")
	await save_scene()


func _selected() -> PackedInt32Array:
	return session().get(&"selection")


func _kinds() -> Control:
	for button: Node in EditorInterface.get_base_control().find_children(
		"*", "OptionButton", true, false
	):
		if (
			(button as Control).is_visible_in_tree()
			and (button as Control).tooltip_text.begins_with("The kind of leaves")
		):
			return button as Control
	check(false, "There is no list of kinds.")
	return null


# The materials of the leaves that are drawn.
func _shown() -> PackedStringArray:
	var names: PackedStringArray = []
	for child: Node in _node.get_children(true):
		var leaves: MultiMeshInstance3D = child as MultiMeshInstance3D
		if leaves != null and leaves.multimesh != null and leaves.material_override != null:
			names.append(leaves.material_override.resource_path.get_file())
	return names


func _has_ghosts() -> bool:
	@warning_ignore("unsafe_method_access")
	return not session().get(&"tool").get_ghosts().is_empty()
