@tool
extends "../../test_plugin/garden.gd"
## The tool Paint Bark: a burl and a post are put on the trunk, grow, are moved, and undone.

var _node: TreeInstance3D
var _of: TreeReconstruction
var _tool: RefCounted


func run() -> void:
	await step("the tool shows where a click would put a burl")
	_of = own_tree("res://paint_tree.res")
	_node = await open_garden("res://paint.tscn", _of)
	if _node == null or not await take_tool(&"select", "q"):
		return
	if session().get(&"view").leaves:
		await user.key("l")
	# Near enough to see the bark.
	session().call(&"select", _of.select_nodes("trunk&height:0.2..1.6"))
	await user.frames(2)
	await user.key("f")
	await view_rests()
	session().call(&"clear_selection")
	if not await take_tool(&"paint_bark", "F3"):
		return
	_tool = session().get(&"tool")
	# The edges as the dock has them, so that it is quick.
	_of.growth_recipe = "edges longest=0.06\n"
	await user.frames(3)
	var at: Vector2 = _trunk(0.9)
	await user.move(at)
	await until(
		func() -> bool: return not (_tool.get(&"_over") as Dictionary).is_empty(), "bark is found"
	)
	await picture("paint-where-a-burl-would-be")

	await step("a click places it, and it grows within that step")
	var version: int = _version()
	await user.click(at)
	if not await until(func() -> bool: return "burl" in _of.growth_recipe, "it is in the recipe"):
		return
	await picture("paint-a-burl-is-placed")
	await until(func() -> bool: return _of.has_grown_bark(), "it grows coarsely")
	await until(func() -> bool: return not _of.growth_pending, "it has grown")
	check_equal(_version(), version + 1, "steps")
	await until(func() -> bool: return not _node.is_building_levels(), "the tree is built")
	await fine_picture("paint-the-burl-has-grown")

	await step("a post is placed from the strip's choice, dragged, and made thicker by a key")
	_tool.call(&"set_setting", 3, &"kind")
	var beside: Vector2 = _trunk(0.5)
	await user.click(beside)
	if not await until(
		func() -> bool: return "shape=post" in _of.growth_recipe, "the post is in the recipe"
	):
		return
	await picture("paint-a-post-is-placed")
	var before: String = _of.growth_recipe
	var handle: Vector2 = _on_screen(_tool.call(&"get_handle", 1))
	var to: Vector2 = _trunk(0.7)
	await user.drag([handle, handle.lerp(to, 0.3), handle.lerp(to, 0.7), to])
	await until(func() -> bool: return _of.growth_recipe != before, "it was moved")
	before = _of.growth_recipe
	await user.key("bracketright")
	await until(func() -> bool: return _of.growth_recipe != before, "it is thicker")
	await until(func() -> bool: return not _of.growth_pending, "the bark has grown around it")
	await until(func() -> bool: return not _node.is_building_levels(), "the tree is built")
	await fine_picture("paint-the-post-is-swallowed")

	await step("Delete takes the post away, and undo brings back step by step")
	await user.key("Delete")
	await until(func() -> bool: return not "post" in _of.growth_recipe, "the post is gone")
	while _version() > version:
		var now: int = _version()
		await user.key("ctrl+z")
		if not await until(func() -> bool: return _version() != now, "a step is undone"):
			return
	await user.frames(4)
	check(not _of.has_grown_bark(), "Bark is left.")
	check_equal(_of.growth_recipe, "edges longest=0.06\n", "the recipe after all is undone")
	await take_tool(&"select", "q")
	session().get(&"view").leaves = true
	check(await save_scene(), "The scene can't be saved.")


# Where the trunk's middle is on the screen at about a height.
func _trunk(height: float) -> Vector2:
	var best: int = _of.get_root()
	for id: int in _of.select_nodes("trunk"):
		var now: float = absf(_of.get_node_position(id).y - height)
		if now < absf(_of.get_node_position(best).y - height):
			best = id
	return node_on_screen(_node, best)


func _on_screen(in_view: Vector2) -> Vector2:
	return (view().get_parent() as Control).get_screen_transform() * in_view


func _version() -> int:
	var manager: EditorUndoRedoManager = EditorInterface.get_editor_undo_redo()
	var scene: Node = EditorInterface.get_edited_scene_root()
	return manager.get_history_undo_redo(manager.get_object_history_id(scene)).get_version()
