@tool
extends "../../test_plugin/scenario.gd"
## A tree that is drawn: strokes with the mouse, a tree in the scene, and its steps undone by keys.

# Whether the first stroke makes no tree yet.
var _no_tree_of_one: bool


func run() -> void:
	await _open()
	await _draw()
	await _undo()
	await _bend()
	await _take_twigs()
	await _end()


func _window() -> AcceptDialog:
	return dialog("Sketch Tree")


func _canvas() -> Control:
	for node: Node in _window().find_children("*", "Control", true, false):
		if node.has_signal(&"drawn"):
			return node as Control
	return null


# A place of the paper on the screen.
func _place(x: float, y: float) -> Vector2:
	var canvas: Control = _canvas()
	return canvas.get_screen_transform() * (canvas.call(&"to_control", Vector2(x, y)) as Vector2)


func _stroke(points: PackedVector2Array) -> void:
	var places: PackedVector2Array = []
	for point: Vector2 in points:
		places.append(_place(point.x, point.y))
	await user.drag(places)


func _root() -> Node:
	return EditorInterface.get_edited_scene_root()


func _tree() -> TreeInstance3D:
	return _root().get_child(0) as TreeInstance3D if _root().get_child_count() > 0 else null


# The strokes that the tree in the scene was made of.
func _strokes() -> int:
	if _tree() == null:
		return 0
	return (_tree().reconstruction.provenance["sketch"].get(&"strokes") as Array).size()


# Whether the tree in the scene is made of so many strokes, all of them drawn, and the paper shows
# them: while a stroke is under way, the tree follows it.
func _has(count: int) -> bool:
	var paper: int = _canvas().get(&"strokes").size()
	return _strokes() == count and paper == count and session().jobs.get_running().is_empty()


func _is_calm() -> bool:
	return session().jobs.get_running().is_empty() and (_tree() == null or not _is_built())


func _is_built() -> bool:
	return _tree().is_rebuilding() or _tree().is_building_levels()


func _open() -> void:
	await step("the dock leads to a sheet where no tree is selected")
	EditorInterface.set_main_screen_editor("3D")
	await user.key("ctrl+n")
	if not await until(func() -> bool: return _root() == null, "a new scene"):
		return
	EditorInterface.add_root_node(Node3D.new())
	EditorInterface.get_selection().clear()
	session().sketch_wanted.emit()
	if not await until(func() -> bool: return _window() != null, "the window opens"):
		return
	await user.frames(10)
	check_fits()
	check(not session().view.get(&"skeleton"), "Lines lie over the leaves.")
	await picture("sketch-empty")


func _draw() -> void:
	await step("a trunk, three branches and an outline become a tree in the scene")
	if not check(_window() != null, "There is no window."):
		return
	await _stroke([Vector2(500, 960), Vector2(498, 700), Vector2(505, 480), Vector2(500, 240)])
	await until(func() -> bool: return session().jobs.get_running().is_empty(), "it is read")
	_no_tree_of_one = _tree() == null
	await _stroke([Vector2(502, 620), Vector2(600, 540), Vector2(690, 420)])
	await _stroke([Vector2(500, 560), Vector2(400, 470), Vector2(330, 350)])
	await _stroke([Vector2(503, 440), Vector2(570, 350), Vector2(620, 240)])
	var outline: PackedVector2Array = []
	for i: int in 25:
		var angle: float = TAU * i / 24.0
		var wave: float = 1.0 + 0.05 * sin(7.0 * angle)
		outline.append(
			Vector2(500, 360) + Vector2(300, 290) * wave * Vector2(sin(angle), -cos(angle))
		)
	await _stroke(outline)
	if not await until(_has.bind(5), "a tree of all strokes stands there"):
		await picture("sketch-FAILED")
		return
	await until(_is_calm, "it is built")
	check(_tree().get_leaf_count() > 100, "It has only %d leaves." % _tree().get_leaf_count())
	await view_rests()
	await picture("sketch-made")
	# For docs/sketch.md: the tree beside the window.
	EditorInterface.distraction_free_mode = true
	await user.frames(5)
	var aside: Vector3 = view().get_camera_3d().global_basis.x * 10.0
	var box: AABB = AABB(Vector3(0.0, 5.5, 0.0) - aside, Vector3.ZERO).grow(4.5)
	session().view_wanted.emit(box)
	await view_rests()
	EditorInterface.get_selection().clear()
	await user.frames(5)
	await picture("tour-sketch")
	check_equal(_canvas().get(&"strokes").size(), 5, "strokes while nothing is selected")
	EditorInterface.get_selection().add_node(_tree())
	EditorInterface.distraction_free_mode = false
	await user.frames(5)


func _undo() -> void:
	await step("Ctrl+Z in the window undoes stroke by stroke, Ctrl+Y draws them again")
	if not check(_tree() != null, "There is no tree."):
		return
	var made: PackedByteArray = bytes(_tree().reconstruction)
	await _stroke([Vector2(500, 500), Vector2(420, 380), Vector2(400, 260)])
	if not await until(_has.bind(6), "it has one more branch"):
		return
	await user.key("ctrl+z")
	if not await until(_has.bind(5), "the branch is undone"):
		return
	check(bytes(_tree().reconstruction) == made, "The tree is another one.")
	await user.key("ctrl+y" if OS.get_name() == "Windows" else "ctrl+shift+z")
	await until(_has.bind(6), "the branch is there again")
	check(is_unsaved(), "The scene takes itself for saved.")
	var node: TreeInstance3D = _tree()
	for i: int in 8:
		if _tree() == null:
			break
		await _go_through_history("ctrl+z")
	check(_tree() == null, "The tree does not go.")
	await until(
		func() -> bool: return _canvas().get(&"strokes").is_empty() != _no_tree_of_one,
		"strokes that make no tree are left, and no others"
	)
	for i: int in 9:
		if _strokes() == 6:
			break
		await _go_through_history("ctrl+shift+z")
	check_equal(_strokes(), 6, "strokes after all was done again")
	check(_tree() == node, "It is another node.")
	await user.key("ctrl+z")
	await until(_has.bind(5), "the branch is undone")


# One step of the history, of the tree's or of the paper's. Some change neither.
func _go_through_history(key: String) -> void:
	var before: Array = _state()
	await user.key(key)
	for i: int in 20:
		if _state() != before and session().jobs.get_running().is_empty():
			return
		await user.frames(1)


func _state() -> Array:
	return [_tree(), _strokes(), _canvas().get(&"strokes").size()]


func _bend() -> void:
	await step("a stroke is bent by its handles, and the tree follows")
	if not check(_tree() != null, "There is no tree."):
		return
	await user.key("r")
	await user.click(_place(690, 420))
	await user.frames(5)
	check(_canvas().get(&"curve") != null, "The branch has no handles.")
	await picture("sketch-handles")
	var before: PackedByteArray = bytes(_tree().reconstruction)
	await user.drag([_place(690, 420), _place(740, 440), _place(760, 470)])
	await until(func() -> bool: return bytes(_tree().reconstruction) != before, "it is bent")
	await until(func() -> bool: return session().jobs.get_running().is_empty(), "all is done")
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(_tree().reconstruction) == before, "it is undone")
	await step("another species keeps the strokes")
	var species: OptionButton = find_control("OptionButton", "Whose twigs", _window())
	var other: int = 1 if species.selected == 0 else 0
	species.select(other)
	species.item_selected.emit(other)
	await until(
		func() -> bool: return _tree().reconstruction.leaf_preset != "maple", "it has other leaves"
	)
	check_equal(_strokes(), 5, "strokes of another species")
	await until(_is_calm, "it is built")
	await user.frames(5)
	await picture("sketch-species")


# Of a second tree in the scene, and with what is folded away.
func _take_twigs() -> void:
	await step("a sketch takes the twigs of another tree in the scene, and gives them back")
	if not check(_tree() != null, "There is no tree."):
		return
	var other: TreeInstance3D = TreeInstance3D.new()
	other.name = "MyOak"
	other.reconstruction = _tree().reconstruction.duplicate()
	other.reconstruction.provenance = {}
	other.reconstruction.leaf_preset = "oak"
	other.position.x = -12.0
	_root().add_child(other)
	var before: PackedByteArray = bytes(_tree().reconstruction)
	var species: OptionButton = find_control("OptionButton", "Whose twigs", _window())
	await press(species)
	await user.frames(10)
	await picture("sketch-whose-twigs")
	var last: int = species.item_count - 1
	check("MyOak" in species.get_item_text(last), "It offers %s." % species.get_item_text(last))
	# Upwards from the first one is the last.
	species.get_popup().set_focused_item(last)
	await user.key("Return")
	await until(
		func() -> bool: return _tree().reconstruction.leaf_preset == "oak",
		"it has the oak's leaves"
	)
	await until(_is_calm, "it is built")
	check_equal(_strokes(), 5, "strokes with other twigs")
	check("MyOak" in species.text, "It shows %s." % species.text)
	var twigs: String = _tree().reconstruction.provenance["sketch"].get(&"twigs")
	check(twigs.length() > 100, "The sketch has no twigs of its own.")
	for more: Node in _window().find_children("*", "FoldableContainer", true, false):
		(more as FoldableContainer).folded = false
	await user.frames(10)
	check_fits()
	await picture("sketch-own-twigs")
	for more: Node in _window().find_children("*", "FoldableContainer", true, false):
		(more as FoldableContainer).folded = true
	await user.click(_place(30, 990))
	await user.key("ctrl+z")
	await until(func() -> bool: return bytes(_tree().reconstruction) == before, "it is undone")
	other.free()


func _end() -> void:
	await step("Escape closes the window, and the dock opens the strokes again")
	if not check(_window() != null, "There is no window."):
		return
	await user.click(_place(30, 990))
	await user.key("Escape")
	if not await until(func() -> bool: return _window() == null, "it closes"):
		return
	check(session().view.get(&"skeleton") as bool, "The skeleton stays hidden.")
	if _tree() == null:
		return
	EditorInterface.get_selection().clear()
	EditorInterface.get_selection().add_node(_tree())
	await user.frames(10)
	await picture("sketch-dock")
	await press(find_control("Button", "Edit Sketch"))
	if await until(func() -> bool: return _window() != null, "the window opens"):
		check_equal(_canvas().get(&"strokes").size(), 5, "strokes on the paper")
		await user.key("Escape")
		await until(func() -> bool: return _window() == null, "it closes again")
	# The scene is nothing to keep, but it holds the strokes.
	EditorInterface.save_scene_as("res://sketch_scene.tscn", false)
	await user.frames(10)
	var saved: PackedScene = (
		ResourceLoader.load("res://sketch_scene.tscn", "", ResourceLoader.CACHE_MODE_IGNORE_DEEP)
		as PackedScene
	)
	var root: Node = saved.instantiate()
	var kept: TreeReconstruction = (root.get_child(0) as TreeInstance3D).reconstruction
	check_equal(kept.provenance["sketch"].get(&"strokes").size(), 5, "strokes in the scene's file")
	check(bytes(kept) == bytes(_tree().reconstruction), "The file has another tree.")
	root.free()
