@tool
extends "../../test_plugin/garden.gd"
## A tree that is drawn right in the 3D view: over nothing, in a scan, and over a photo.

const PhotoModel: GDScript = preload("../../test_plugin/photo_model.gd")

# How fine the view is while strokes are drawn: each is hundreds of pictures.
const COARSE: float = 0.12

# Of each stroke, the box on the screen that it was drawn in.
var _drawn: Array[Rect2] = []


func run() -> void:
	var scale: float = view().scaling_3d_scale
	view().scaling_3d_scale = COARSE
	await _open()
	await _draw_over_nothing()
	await _undo()
	await _turn_on()
	await _draw_in_a_scan()
	await _draw_over_a_photo()
	EditorInterface.distraction_free_mode = false
	view().scaling_3d_scale = scale


func _window() -> AcceptDialog:
	return dialog("Sketch Tree")


func _root() -> Node:
	return EditorInterface.get_edited_scene_root()


# The tree that was drawn.
func _tree() -> TreeInstance3D:
	for child: Node in _root().get_children():
		var node: TreeInstance3D = child as TreeInstance3D
		if node != null and node.reconstruction.provenance.get("sketch") is TreeSketch:
			return node
	return null


func _strokes() -> int:
	if _tree() == null:
		return 0
	return (_tree().reconstruction.provenance["sketch"].get(&"strokes") as Array).size()


func _is_calm() -> bool:
	if not session().jobs.get_running().is_empty():
		return false
	return _tree() == null or not (_tree().is_rebuilding() or _tree().is_building_levels())


# Where the view is on the screen, without what the window hides.
func _free() -> Rect2:
	var container: Control = view().get_parent() as Control
	var box: Rect2 = container.get_global_rect()
	var left: float = _window().position.x + _window().size.x + 12.0
	return Rect2(left, box.position.y + 60.0, box.end.x - left - 20.0, box.size.y - 90.0)


func _stroke(points: PackedVector2Array) -> void:
	var box: Rect2 = Rect2(points[0], Vector2.ZERO)
	for point: Vector2 in points:
		box = box.expand(point)
	_drawn.append(box)
	await user.drag(points)
	await until(func() -> bool: return session().jobs.get_running().is_empty(), "it is read")


func _ring(around: Vector2, radii: Vector2) -> PackedVector2Array:
	var line: PackedVector2Array = []
	for i: int in 13:
		var angle: float = TAU * i / 12.0
		line.append(around + radii * Vector2(sin(angle), -cos(angle)))
	return line


# A trunk whose base is at a place of the screen, two branches and an outline: so high.
func _draw_tree(base: Vector2, high: float) -> void:
	await _stroke([base, base + Vector2(3.0, -0.4 * high), base + Vector2(0.0, -0.85 * high)])
	await _stroke(
		[
			base + Vector2(2.0, -0.4 * high),
			base + Vector2(0.15, -0.55) * high,
			base + Vector2(0.25, -0.72) * high
		]
	)
	await _stroke(
		[
			base + Vector2(2.0, -0.5 * high),
			base + Vector2(-0.13, -0.6) * high,
			base + Vector2(-0.22, -0.75) * high
		]
	)
	await _stroke(_ring(base + Vector2(0.0, -0.66 * high), Vector2(0.3, 0.34) * high))


# Where the wood of the tree is seen on the screen.
func _box_of_wood() -> Rect2:
	var box: Rect2 = Rect2(on_screen(_tree().global_position), Vector2.ZERO)
	for place: Vector3 in _tree().reconstruction.get_positions():
		box = box.expand(on_screen(_tree().global_transform * place))
	return box


# That the tree is seen where its strokes were drawn.
func _check_place() -> void:
	_check_box(_box_of_wood())


func _check_box(seen: Rect2) -> void:
	var wanted: Rect2 = _drawn[0]
	for box: Rect2 in _drawn:
		wanted = wanted.merge(box)
	var reach: float = 0.06 * wanted.size.y
	for side: Array in [
		[seen.position.x, wanted.position.x, "left"],
		[seen.position.y, wanted.position.y, "top"],
		[seen.end.x, wanted.end.x, "right"],
		[seen.end.y, wanted.end.y, "bottom"],
	]:
		check(
			absf(side[0] - side[1]) < reach,
			"Its %s is seen at %.0f, drawn at %.0f." % [side[2], side[0], side[1]]
		)


func _open() -> void:
	await step("the button of the sketch's window leads into the 3D view")
	EditorInterface.set_main_screen_editor("3D")
	await user.key("ctrl+n")
	if not await until(func() -> bool: return _root() == null, "a new scene"):
		return
	EditorInterface.add_root_node(Node3D.new())
	EditorInterface.get_selection().clear()
	# So that the editor's own menus for what is selected do not make the view lower.
	EditorInterface.distraction_free_mode = true
	await user.frames(5)
	# From so far off that what is drawn is a tree, and no bonsai.
	await user.click(middle(view().get_parent() as Control), User.WHEEL_DOWN, "", 9)
	await view_rests()
	await until(_is_unhidden, "the notes of scenarios before are gone")
	if not await _open_window():
		return
	check_fits()
	await picture("view-sketch-empty")


# The editor's notes lie over the lower end of the view.
func _is_unhidden() -> bool:
	for note: Node in EditorInterface.get_editor_toaster().find_children(
		"*", "PanelContainer", true, false
	):
		if (note as Control).is_visible_in_tree():
			return false
	return true


# With the button pressed.
func _open_window() -> bool:
	session().sketch_wanted.emit()
	if not await until(func() -> bool: return _window() != null, "the window opens"):
		return false
	await user.frames(5)
	await press(find_control("Button", "Draw in the 3D View", _window()))
	return await until(
		func() -> bool: return session().view.get(&"drawing"), "strokes go to the view"
	)


func _draw_over_nothing() -> void:
	await step("a trunk, two branches and an outline in the 3D view become a tree right there")
	if not check(_window() != null, "There is no window."):
		return
	var camera: Transform3D = view().get_camera_3d().global_transform
	_drawn = []
	var free: Rect2 = _free()
	var base: Vector2 = Vector2(free.get_center().x, free.end.y - 40.0)
	await _draw_tree(base, free.size.y * 0.75)
	if not await until(
		func() -> bool: return _strokes() == 4, "a tree of all strokes stands there"
	):
		await picture("view-sketch-FAILED")
		return
	await until(_is_calm, "it is built")
	check(view().get_camera_3d().global_transform == camera, "The view moved.")
	check(absf(_tree().global_position.y) < 0.02, "It stands at %s." % _tree().global_position)
	check_equal(str(_tree().name), "Maple", "its name")
	_check_place()
	await fine_picture("view-sketch-made")


func _undo() -> void:
	await step("Ctrl+Z in the view undoes a stroke, and the other buttons move the view")
	if not check(_tree() != null, "There is no tree."):
		return
	var made: PackedByteArray = bytes(_tree().reconstruction)
	var place: Transform3D = _tree().global_transform
	var base: Vector2 = on_screen(_tree().global_position)
	await _stroke(
		[base + Vector2(0.0, -150.0), base + Vector2(60.0, -210.0), base + Vector2(80.0, -260.0)]
	)
	if not await until(func() -> bool: return _strokes() == 5, "it has one more branch"):
		return
	await user.move(base + Vector2(150.0, -20.0))
	await user.key("ctrl+z")
	if not await until(func() -> bool: return _strokes() == 4, "the branch is undone"):
		return
	check(bytes(_tree().reconstruction) == made, "The tree is another one.")
	check(_tree().global_transform.is_equal_approx(place), "It stands elsewhere.")
	await user.key("ctrl+shift+z")
	await until(func() -> bool: return _strokes() == 5, "the branch is there again")
	await user.key("ctrl+z")
	await until(func() -> bool: return _strokes() == 4, "the branch is undone again")


func _turn_on() -> void:
	await step("the middle button and the wheel move the view, and the strokes stay on their tree")
	if not check(_tree() != null, "There is no tree."):
		return
	var camera: Camera3D = view().get_camera_3d()
	var before: Transform3D = camera.global_transform
	var middle: Vector2 = _free().get_center()
	await user.drag(
		[middle, middle + Vector2(60.0, 10.0), middle + Vector2(120.0, 20.0)], User.MIDDLE
	)
	await view_rests()
	check(not camera.global_basis.is_equal_approx(before.basis), "The view did not turn.")
	var distance: float = camera.global_position.length()
	await user.click(middle, User.WHEEL_DOWN, "", 4)
	await view_rests()
	var away: float = camera.global_position.length()
	check(away > 1.3 * distance, "The wheel goes no farther: %.1f m." % away)
	check_equal(_strokes(), 4, "strokes after the view was turned")
	await fine_picture("view-sketch-turned")


func _draw_in_a_scan() -> void:
	await step("over a scan the new tree stands in the scan, which stays in sight")
	if _window() != null:
		_window().hide()
	await user.frames(10)
	check(not session().view.get(&"drawing"), "Closing the window leaves the view drawn on.")
	var made: TreeReconstruction = own_tree("res://view_sketch_tree.res")
	if made == null:
		return
	made.provenance = {"source": sample}
	ResourceSaver.save(made, "res://view_sketch_tree.res")
	EditorInterface.distraction_free_mode = false
	var node: TreeInstance3D = await open_garden("res://view_sketch.tscn", made)
	if node == null:
		return
	EditorInterface.distraction_free_mode = true
	await user.frames(5)
	session().view.set(&"points", true)
	session().view.set(&"mesh", false)
	session().view.set(&"leaves", false)
	if not await until(
		func() -> bool: return not session().scan.get(&"points").is_empty(), "the scan is there"
	):
		return
	if not await _open_window():
		return
	await user.frames(5)
	var state: PackedByteArray = bytes(made)
	_drawn = []
	var base: Vector2 = on_screen(node.global_position)
	var free: Rect2 = _free()
	check(free.has_point(base), "The window hides the scan's base.")
	await picture("view-sketch-scan-empty")
	await _draw_tree(base, (base.y - free.position.y) * 0.8)
	if not await until(func() -> bool: return _strokes() == 4, "a tree stands in the scan"):
		await picture("view-sketch-FAILED")
		return
	await until(_is_calm, "it is built")
	var off: Vector3 = _tree().global_position - node.global_position
	check(off.length() < 0.1, "It stands %s off the scan's base." % off)
	check(bytes(made) == state, "The scan's own tree was changed.")
	_check_scan_alone()
	check(session().node == _tree(), "The new tree isn't selected.")
	_check_place()
	await fine_picture("view-sketch-scan")
	_window().hide()
	await user.frames(5)
	await picture("view-sketch-scan-closed")
	session().view.set(&"points", false)
	await save_scene()


# That the scan stays in sight, and what was hidden of its own tree stays hidden.
func _check_scan_alone() -> void:
	for part: RefCounted in addon().get(&"_parts"):
		if part.has_method(&"draw_always"):
			var scan: RefCounted = part.get(&"_host").get(&"_scan")
			check(scan.call(&"is_shown"), "The scan's points are gone.")
			check(not scan.get(&"_leaves") and not scan.get(&"_bark"), "Its own tree came back.")


# --- over a photo ---------------------------------------------------------------------------------


func _stage() -> Control:
	return EditorInterface.get_base_control().find_child("PhotoStage", true, false) as Control


# A place of the scene on the photo on the screen.
func _on_stage(place: Vector3) -> Vector2:
	var camera: Camera3D = _stage().get(&"camera")
	return _stage().get_screen_transform() * camera.unproject_position(place)


func _draw_over_a_photo() -> void:
	await step("over a photo it is drawn through the photo's lens, near by, and the photo stays")
	var made: TreeReconstruction = own_tree("res://view_sketch_photo.res")
	if made == null:
		return
	PhotoModel.new(OS.get_environment("TREE_EDITOR_TEST").path_join("drawn"), made)
	ResourceSaver.save(made, "res://view_sketch_photo.res")
	EditorInterface.distraction_free_mode = false
	var node: TreeInstance3D = await open_garden("res://view_sketch_photo.tscn", made)
	if node == null:
		return
	EditorInterface.distraction_free_mode = true
	node.transform = Transform3D(Basis(Vector3.UP, 0.7), Vector3(2.0, 0.5, -1.0))
	await user.move(middle(view().get_parent() as Control))
	await user.key("F4")
	if not await until(
		func() -> bool: return _stage() != null and _stage().get(&"_picture") != null,
		"the photo is seen"
	):
		return
	await user.click(middle(_stage()), User.WHEEL_UP, "", 1)
	if not await _open_window():
		return
	await user.frames(5)
	_drawn = []
	var shown: Rect2 = _stage().call(&"get_shown")
	var base: Vector2 = _on_stage(node.global_position)
	var high: float = 0.8 * (base.y - (_stage().get_global_rect().position.y + 10.0))
	await _draw_tree(base, high)
	if not await until(func() -> bool: return _strokes() == 4, "a tree stands over the photo"):
		await picture("view-sketch-FAILED")
		return
	await until(_is_calm, "it is built")
	if not check(_stage() != null, "The photo is gone."):
		return
	check_equal(_stage().call(&"get_shown"), shown, "what is seen of the photo")
	var off: Vector3 = _tree().global_transform.affine_inverse() * node.global_position
	check(off.length() < 0.15, "It stands %s off the base." % off)
	var box: Rect2 = Rect2(_on_stage(_tree().global_position), Vector2.ZERO)
	for place: Vector3 in _tree().reconstruction.get_positions():
		box = box.expand(_on_stage(_tree().global_transform * place))
	_check_box(box)
	# For docs/sketch.md.
	await fine_picture("tour-sketch_view", _stage().get(&"_viewport") as SubViewport)
	_window().hide()
	await until(func() -> bool: return _stage() == null, "the other tree's photos are gone")
	await save_scene()
