@tool
extends "../../test_plugin/garden.gd"
## The other tools of the viewport, by mouse and keys: each shows what it would do, does it as one
## step, and is undone.

var _node: TreeInstance3D
var _of: TreeReconstruction
var _before: PackedByteArray


func run() -> void:
	await step("a branch is moved by a drag")
	_of = own_tree("res://shape_tree.res")
	_node = await open_garden("res://shape.tscn", _of)
	if _node == null:
		return
	_before = bytes(_of)
	await user.key("l")
	await _drag_from_branch(&"move", "w", "moved")
	await step("a branch is drawn with the Grow tool")
	await _drag_from_branch(&"grow", "n", "grown")
	for words: Array in [[&"cut", "c"], [&"smooth", "m"], [&"simplify", "i"]]:
		await step("a click with the tool %s does what was shown" % words[0])
		await _click_branch(words[0], words[1])
	await step("a tool's settings are remembered")
	await _remember_settings()
	await step("a twig grows at once on the selected node")
	await _grow_twig()
	await step("a line is drawn, and what lies beyond it cut away")
	await _slice()
	await step("the doubtful places are gone through, and the missing branch found")
	await _find_missing()
	await user.key("l")


func _branch() -> int:
	return clear_nodes(_node, large_branches(_of))[0]


func _has_ghosts() -> bool:
	return not (session().get(&"tool").call(&"get_ghosts") as Array).is_empty()


# Undoes with the keyboard.
func _undo() -> void:
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(_of) == _before, "Ctrl+Z has undone it")


func _drag_from_branch(tool: StringName, key: String, shot: String) -> void:
	if not await take_tool(tool, key):
		return
	var from: Vector2 = node_on_screen(_node, _branch())
	await user.drag([from, from + Vector2(60, -40)])
	await until(func() -> bool: return bytes(_of) != _before, "the drag did something")
	await picture(shot)
	await _undo()


func _click_branch(tool: StringName, key: String) -> void:
	if not await take_tool(tool, key):
		return
	var at: Vector2 = node_on_screen(_node, _branch())
	# The mouse may be there already, at rest.
	await user.move(at + Vector2(60, 0))
	await user.move(at)
	if not await until(_has_ghosts, "what would be done is shown"):
		return
	check_equal(bytes(_of), _before, "the tree before the click")
	await picture("%s-before-the-click" % tool)
	await user.click(at)
	await until(func() -> bool: return bytes(_of) != _before, "it is done")
	await _undo()


func _remember_settings() -> void:
	if not await take_tool(&"cut", "c"):
		return
	var cut: RefCounted = session().get(&"tool")
	cut.call(&"set_setting", 0.125, &"stub")
	if not await take_tool(&"select", "q"):
		return
	# As a new start of the editor makes it.
	var again: RefCounted = (cut.get_script() as GDScript).new()
	var strip: Control = again.call(&"make_settings")
	check_equal((again.get(&"values") as Dictionary)[&"stub"], 0.125, "the stub")
	strip.free()
	cut.call(&"set_setting", 0.0, &"stub")


func _grow_twig() -> void:
	if not await take_tool(&"select", "q"):
		return
	var host: int = _branch()
	await user.click(node_on_screen(_node, host))
	await user.key("bracketleft")
	if not await until(func() -> bool: return bytes(_of) != _before, "the twig has grown"):
		return
	var twig: int = session().call(&"get_active")
	check_equal(_of.get_node_parent(twig), host, "what the twig grows from")
	check(
		node_on_screen(_node, twig).x < node_on_screen(_node, host).x, "It went to the right side."
	)
	await _undo()


func _slice() -> void:
	if not await take_tool(&"slice", "b"):
		return
	var middle_of: Vector2 = on_screen(_node.global_transform * _of.get_aabb().get_center())
	await user.drag([middle_of + Vector2(-200, -40), middle_of + Vector2(200, -70)])
	if not await until(_has_ghosts, "what would go is shown"):
		return
	await picture("line-before-enter")
	check_equal(bytes(_of), _before, "the tree before Enter")
	await user.key("Return")
	await until(func() -> bool: return bytes(_of) != _before, "it is cut")
	await _undo()
	await step("a box is drawn, one of its faces dragged, and it cuts as one step")
	var tool: RefCounted = session().get(&"tool")
	tool.call(&"set_setting", 2, &"shape")
	await user.key("KP_1")
	await view_rests()
	middle_of = on_screen(_node.global_transform * _of.get_aabb().get_center())
	await user.drag([middle_of + Vector2(-120, -120), middle_of + Vector2(120, 40)])
	var handles: RefCounted = tool.get(&"_handles")
	if not await until(func() -> bool: return handles.call(&"has_box"), "the box is there"):
		return
	var low: float = (handles.get(&"box") as AABB).position.y
	var container: Control = view().get_parent() as Control
	var at: Vector2 = handles.call(&"get_seen", tool, 2)
	var handle: Vector2 = container.get_screen_transform() * at
	await user.move(handle)
	await picture("box-with-handles")
	await user.drag([handle, handle + Vector2(0, -20), handle + Vector2(0, -60)])
	await until(
		func() -> bool: return (handles.get(&"box") as AABB).position.y > low + 0.1, "a face moves"
	)
	await picture("box-with-a-dragged-face")
	check_equal(bytes(_of), _before, "the tree before Enter")
	await user.key("Return")
	await until(func() -> bool: return bytes(_of) != _before, "the box is cut out")
	await picture("box-cut-out")
	await _undo()
	tool.call(&"set_setting", 0, &"shape")


func _find_missing() -> void:
	_of.edit("remove nodes=%d" % large_branches(_of)[0])
	_before = bytes(_of)
	await user.key("p")
	if not await take_tool(&"doubt", "y"):
		return
	var tool: RefCounted = session().get(&"tool")
	if not await until(func() -> bool: return tool.call(&"get_left") > 0, "places are found"):
		return
	# From so far off no branch can be judged.
	await user.move(middle(view().get_parent() as Control))
	for i: int in 12:
		await user.click(middle(view().get_parent() as Control), User.WHEEL_DOWN)
	await view_rests()
	for i: int in tool.call(&"get_left"):
		await user.key("y")
		await user.frames(2)
		# What no branch explains comes after the doubtful branches.
		if not tool.call(&"get_place").points.is_empty():
			break
	await until(_has_ghosts, "the place is shown")
	await view_rests()
	_check_brought(tool)
	await picture("missing-branch")
	await user.key("Return")
	await until(func() -> bool: return bytes(_of) != _before, "the missing branch is found")
	await picture("missing-branch-found")
	await user.key("p")
	await _undo()
	check(await save_scene(), "The scene can't be saved.")


# The camera has gone to the place at hand by itself.
func _check_brought(tool: RefCounted) -> void:
	var place: RefCounted = tool.call(&"get_place")
	var box: AABB = tool.call(&"get_box", place)
	var seen: Rect2 = Rect2(on_screen(_node.global_transform * box.get_center()), Vector2.ZERO)
	for i: int in 8:
		seen = seen.expand(on_screen(_node.global_transform * box.get_endpoint(i)))
	var viewport: Rect2 = (view().get_parent() as Control).get_global_rect()
	check(viewport.encloses(seen), "The place is at %s of %s." % [seen, viewport])
	var share: float = maxf(seen.size.x, seen.size.y) / minf(viewport.size.x, viewport.size.y)
	check(share > 0.15, "The place takes %.2f of the view." % share)
