@tool
extends "../../test_plugin/garden.gd"
## Tools of the viewport: prune, graft with variation, leaves.

var _node: TreeInstance3D
var _of: TreeReconstruction


func run() -> void:
	await step("the Prune tool shows what would go, and a click cuts it away")
	_node = await open_garden("res://tools.tscn", own_tree("res://tools_tree.res"))
	if _node == null or not await take_tool(&"prune", "d"):
		return
	_of = _node.reconstruction
	var branch: int = clear_nodes(_node, large_branches(_of))[0]
	var before: PackedByteArray = bytes(_of)
	await user.move(node_on_screen(_node, branch))
	if not await until(func() -> bool: return _has_ghosts(), "what would go is shown"):
		return
	check_equal(bytes(_of), before, "the tree before the click")
	await picture("prune-before-the-click")
	await user.click(node_on_screen(_node, branch))
	await until(func() -> bool: return _of.get_node_children(branch).is_empty(), "it is pruned")
	await picture("pruned")
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(_of) == before, "the pruning is undone")

	await step("the Graft tool shows the branch, the wheel another one, a click grafts it")
	if not await take_tool(&"graft", "j"):
		return
	# A tip, against the sky.
	var tip: int = clear_nodes(_node, _of.select_nodes("leaves&height:5.."))[0]
	await user.move(node_on_screen(_node, tip))
	if not await until(func() -> bool: return _has_ghosts(), "the graft is shown"):
		return
	var shown: Array = _ghosts()
	await picture("graft-before-the-click")
	await user.click(node_on_screen(_node, tip), User.WHEEL_UP)
	await until(func() -> bool: return _has_ghosts() and _ghosts() != shown, "another one is shown")
	check_equal(bytes(_of), before, "the tree before the click")
	await picture("graft-another-seed")
	await user.click(node_on_screen(_node, tip))
	await until(func() -> bool: return not _of.get_node_children(tip).is_empty(), "it is grafted")
	check(_of.edit_log.contains("graft"), "The log does not tell of it.")
	await until(func() -> bool: return not _node.is_rebuilding(), "the tree is built")
	await picture("grafted")
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(_of) == before, "the graft is undone")

	await step("one of the tree's own branches is chosen from the list, and grafted")
	await _graft_own(tip, before)

	await step("the leaf rule changes the leaves at once")
	if not await take_tool(&"leaf_rule", "F2"):
		return
	var look: String = _of.get_leaf_look()
	var kinds: Control = null
	for button: Node in EditorInterface.get_base_control().find_children(
		"*", "OptionButton", true, false
	):
		if (
			(button as Control).is_visible_in_tree()
			and (button as Control).tooltip_text.begins_with("The kind of leaves")
		):
			kinds = button as Control
	await press(kinds)
	await choose("Cherry")
	await until(func() -> bool: return _of.get_leaf_look() == "cherry", "the leaves are cherry's")
	check(look != "cherry", "They were before.")
	if not session().get(&"view").leaves:
		await user.move(middle(view().get_parent() as Control))
		await user.key("l")
	await until(func() -> bool: return not _node.is_rebuilding(), "the tree is built")
	await picture("leaves-of-a-cherry")
	await user.move(middle(view().get_parent() as Control))
	await user.key("ctrl+z")
	await until(func() -> bool: return _of.get_leaf_look() == look, "the leaves are as before")

	await step("Escape puts the tool away")
	await user.key("Escape")
	await until(
		func() -> bool: return session().get(&"tool") == session().get(&"tools")[&"select"],
		"the Select tool is back"
	)
	await save_scene()


func _ghosts() -> Array:
	@warning_ignore("unsafe_method_access")
	return session().get(&"tool").get_ghosts()


func _has_ghosts() -> bool:
	return not _ghosts().is_empty()


func _graft_own(tip: int, before: PackedByteArray) -> void:
	await press(find_control("OptionButton", "What is grafted"))
	if not await until(func() -> bool: return open_menu() != null, "the list opens"):
		return
	await picture("graft-list")
	var own: String = ""
	var popup: PopupMenu = open_menu()
	for item: int in popup.item_count - 1:
		if popup.get_item_text(item) == "Of this tree":
			own = popup.get_item_text(item + 1)
	if not check(not own.is_empty(), "None of its own is offered.") or not await choose(own):
		return
	await user.move(node_on_screen(_node, tip))
	await until(func() -> bool: return _has_ghosts(), "the branch is shown")
	await user.click(node_on_screen(_node, tip))
	await until(func() -> bool: return not _of.get_node_children(tip).is_empty(), "it is grafted")
	check(_of.edit_log.contains("string="), "Another one was grafted.")
	await until(func() -> bool: return not _node.is_rebuilding(), "the tree is built")
	await picture("grafted-of-its-own")
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(_of) == before, "the graft is undone")
