@tool
extends "../../test_plugin/garden.gd"
## The dock's Bark Growth: an obstacle that is a node of the scene, and how the bark grew, scrubbed
## through and played. The mouth of a hollow is seen while it is dragged.

var _node: TreeInstance3D
var _of: TreeReconstruction
var _dock: Control


func run() -> void:
	await step("a node of the scene becomes an obstacle by a drag onto the list")
	_of = own_tree("res://timeline_tree.res")
	_node = await open_garden("res://timeline.tscn", _of)
	_dock = EditorInterface.get_base_control().find_child("TreeDock", true, false) as Control
	if _node == null or not check(_dock != null, "There is no dock."):
		return
	if not await take_tool(&"select", "q"):
		return
	@warning_ignore("unsafe_method_access")
	_dock.get_parent().make_visible()
	if session().get(&"view").leaves:
		await user.key("l")
	_of.growth_recipe = "edges longest=0.06\n"
	var scene: Node = EditorInterface.get_edited_scene_root()
	var wall: MeshInstance3D = MeshInstance3D.new()
	wall.name = "Wall"
	var box: BoxMesh = BoxMesh.new()
	box.size = Vector3(0.1, 0.5, 0.8)
	wall.mesh = box
	scene.add_child(wall)
	wall.owner = scene
	var radius: float = _of.get_node_radius(_of.get_root())
	wall.position = _of.get_node_position(_of.get_root()) + Vector3(0.8 * radius + 0.05, 0.9, 0.0)
	session().call(&"select", _of.select_nodes("trunk&height:0.2..1.8"))
	await user.frames(2)
	await user.move(middle(view().get_parent() as Control))
	await user.key("f")
	await view_rests()
	session().call(&"clear_selection")
	await _open()
	# What the Scene dock's drag carries.
	var data: Dictionary = {"type": "nodes", "nodes": [wall.get_path()]}
	var list: ItemList = _section().get(&"list")
	list.force_drag(data, Label.new())
	await user.frames(2)
	await user.move(middle(list))
	await user.click(middle(list))
	if not await until(func() -> bool: return list.item_count == 1, "the wall is in the list"):
		return

	await step("it grows around it, and the slider shows how")
	await press(_section().get(&"grow") as Control)
	if not await until(func() -> bool: return _of.has_grown_bark(), "the bark has grown"):
		return
	await until(func() -> bool: return not _node.is_building_levels(), "the tree is built")
	var timeline: Control = _section().get(&"timeline")
	var slider: HSlider = timeline.get(&"slider")
	if not await until(func() -> bool: return slider.is_visible_in_tree(), "there is a slider"):
		return
	check("mesh=wall" in _of.growth_recipe, _of.growth_recipe)
	await picture("timeline-at-its-end")
	var version: int = _version()
	# By its keys: it has the focus after a click.
	await user.click(middle(slider))
	await until(func() -> bool: return session().get(&"view").growing, "a step is shown")
	await until(func() -> bool: return slider.value < slider.max_value, "the slider was moved")
	await user.frames(4)
	await fine_picture("timeline-half-way")
	await press(timeline.get(&"play") as Control)
	await until(func() -> bool: return not session().get(&"view").growing, "it plays to the end")
	check_equal(slider.value, slider.max_value, "where the slider is")
	await user.frames(4)
	await picture("timeline-the-tree-again")
	check_equal(_version(), version, "the history's version")

	await step("the wall is moved: the dock says so")
	wall.position.x += 0.03
	await until(
		func() -> bool: return "has moved" in (_section().get(&"_notice") as Label).text,
		"the dock says so"
	)
	await picture("timeline-the-wall-has-moved")

	await step("the mouth of a hollow is seen while it is dragged")
	if not await take_tool(&"paint_bark", "F3"):
		return
	var tool: RefCounted = session().get(&"tool")
	tool.call(&"set_setting", 2, &"kind")
	tool.call(&"set_setting", false, &"grow")
	session().get(&"bark").set(&"automatic", false)
	var recipe: String = _of.growth_recipe
	await user.click(_trunk(1.3))
	await until(func() -> bool: return _of.growth_recipe != recipe, "it is in the recipe")
	await user.move(_trunk(0.4))
	await user.frames(4)
	check((tool.get(&"_preview").get_triangle_count() as int) > 0, "Nothing is seen of it.")
	await fine_picture("timeline-a-hollow-before-it-grows")
	await user.key("ctrl+z")
	await user.frames(4)
	tool.call(&"set_setting", true, &"grow")
	session().get(&"bark").set(&"automatic", true)
	await take_tool(&"select", "q")
	session().get(&"view").leaves = true
	check(await save_scene(), "The scene can't be saved.")


func _section() -> Control:
	@warning_ignore("unsafe_property_access")
	return _dock.sections[&"bark"]


# Opens the section, and folds all others.
func _open() -> void:
	@warning_ignore("unsafe_property_access", "unsafe_method_access")
	var ids: Array = _dock.sections.keys()
	ids.erase(&"bark")
	@warning_ignore("unsafe_method_access")
	_dock.set_folded(PackedStringArray(ids))
	await user.frames(4)


# Where the trunk's middle is on the screen at about a height.
func _trunk(height: float) -> Vector2:
	var best: int = _of.get_root()
	for id: int in _of.select_nodes("trunk"):
		var now: float = absf(_of.get_node_position(id).y - height)
		if now < absf(_of.get_node_position(best).y - height):
			best = id
	return node_on_screen(_node, best)


func _version() -> int:
	var manager: EditorUndoRedoManager = EditorInterface.get_editor_undo_redo()
	var scene: Node = EditorInterface.get_edited_scene_root()
	return manager.get_history_undo_redo(manager.get_object_history_id(scene)).get_version()
