extends "./session_suite.gd"
## A sketch that is drawn right in the 3D view: where its sheet stands, and that the tree stands
## where the strokes were drawn.

const SketchPanel := preload("res://addons/tree_reconstruction/editor/sketch/sketch_panel.gd")
const ViewPlane := preload("res://addons/tree_reconstruction/editor/sketch/view_plane.gd")
const Canvas := preload("res://addons/tree_reconstruction/editor/sketch/sketch_canvas.gd")
const TestSketch := preload("./test_sketch.gd")
const SIZE: Vector2 = Vector2(1280.0, 800.0)

var _session: Session
var _panel: SketchPanel
var _scene: Node3D
var _added: TreeInstance3D
var _viewport: SubViewport
var _camera: Camera3D
var _heard: PackedStringArray = []


func _open_view() -> void:
	_viewport = SubViewport.new()
	_viewport.size = Vector2i(SIZE)
	_camera = Camera3D.new()
	_camera.fov = 70.0
	_viewport.add_child(_camera)
	tree.root.add_child(_viewport)
	_camera.look_at_from_position(Vector3(4.0, 2.5, 9.0), Vector3(1.0, 3.0, 0.0))


func _open(over: TreeReconstruction = null) -> void:
	_open_view()
	_session = _session_with(over)
	_scene = _session.node
	if over == null:
		_session.edit_node(null)
	_panel = SketchPanel.new(_session)
	_panel.made.connect(_on_made)
	_panel.history_wanted.connect(_on_history_wanted)
	_panel.view.said.connect(func(sentence: String) -> void: _heard.append(sentence))
	_panel.view.find_ground = _find_ground
	tree.root.add_child(_panel)
	_heard = []
	_panel.bar.in_view.button_pressed = true
	await tree.process_frame


func _on_history_wanted(redo: bool) -> void:
	if redo:
		_undo.redo()
	else:
		_undo.undo()


func _on_made(made: TreeReconstruction) -> void:
	_added = TreeInstance3D.new()
	_added.reconstruction = made
	var is_told: bool = _panel.view.place is Transform3D
	check_equal(is_told, _panel.view.enabled, "whether it is told where the tree has to stand")
	_undo.create_action("Add Tree to Scene")
	_undo.add_do_method(tree.root.add_child.bind(_added))
	_undo.add_do_reference(_added)
	_undo.add_undo_method(tree.root.remove_child.bind(_added))
	_undo.commit_action()
	if is_told:
		_added.global_transform = _panel.view.place
	_session.edit_node(_added)
	_panel.set_node(_added)


func _find_ground(camera: Camera3D, _size: Vector2, at: Vector2) -> Variant:
	return Plane(Vector3.UP).intersects_ray(
		camera.project_ray_origin(at), camera.project_ray_normal(at)
	)


func _shut() -> void:
	_panel.close()
	_panel.free()
	_session.edit_node(null)
	_session.shut_down()
	_undo.clear_history()
	_undo.free()
	_scene.free()
	_viewport.free()
	_added = null
	_session = null


func _wait() -> void:
	for i: int in 3:
		_session.update()
		_panel.update()
		await tree.process_frame
		while not _session.jobs.get_running().is_empty():
			_session.update()
			_panel.update()
			await tree.process_frame


func _event(at: Vector2, pressed: bool) -> InputEventMouseButton:
	var event: InputEventMouseButton = InputEventMouseButton.new()
	event.button_index = MOUSE_BUTTON_LEFT
	event.pressed = pressed
	event.position = at
	return event


# A stroke through places of the screen, with more between them.
func _draw(corners: PackedVector2Array) -> PackedVector2Array:
	var places: PackedVector2Array = [corners[0]]
	for i: int in range(1, corners.size()):
		for k: int in range(1, 13):
			places.append(corners[i - 1].lerp(corners[i], k / 12.0))
	_panel.view.input(_camera, SIZE, _event(places[0], true))
	for at: Vector2 in places.slice(1):
		var motion: InputEventMouseMotion = InputEventMouseMotion.new()
		motion.position = at
		motion.pressure = 1.0
		motion.button_mask = MOUSE_BUTTON_MASK_LEFT
		_panel.view.input(_camera, SIZE, motion)
	_panel.view.input(_camera, SIZE, _event(places[-1], false))
	await _wait()
	return places


# How far at most strokes are seen from where they were drawn, in pixels.
func _error_of(drawn: Array[PackedVector2Array]) -> float:
	var sketch: TreeSketch = _panel.get_sketch()
	var plane: ViewPlane = _panel.view.plane_of(sketch)
	if not _holds(plane != null and sketch.strokes.size() == drawn.size(), "There are others."):
		return INF
	var worst: float = 0.0
	for i: int in drawn.size():
		var seen: PackedVector2Array = plane.line_to_screen(
			_camera, SIZE, sketch.strokes[i]["points"]
		)
		check_equal(seen.size(), drawn[i].size(), "points of a stroke")
		for k: int in mini(seen.size(), drawn[i].size()):
			worst = maxf(worst, seen[k].distance_to(drawn[i][k]))
	return worst


func _outline(around: Vector2, radii: Vector2) -> PackedVector2Array:
	var line: PackedVector2Array = []
	for i: int in 25:
		var angle: float = TAU * i / 24.0
		line.append(around + radii * Vector2(sin(angle), -cos(angle)))
	return line


# Where the wood is seen.
func _seen_box(node: TreeInstance3D) -> Rect2:
	var box: Rect2 = Rect2()
	var first: bool = true
	for place: Vector3 in node.reconstruction.get_positions():
		var at: Vector2 = _camera.unproject_position(node.global_transform * place)
		box = Rect2(at, Vector2.ZERO) if first else box.expand(at)
		first = false
	return box


func test_what_is_drawn_comes_back_from_any_camera() -> void:
	_open_view()
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 20
	var worst: float = 0.0
	var worst_ray: float = 0.0
	var tried: int = 0
	for i: int in 400:
		var size: Vector2 = Vector2(random.randi_range(200, 2500), random.randi_range(200, 1600))
		_viewport.size = Vector2i(size)
		var stem_base: Vector3 = (
			Vector3(
				random.randf_range(-1, 1),
				random.randf_range(-0.05, 0.05),
				random.randf_range(-1, 1)
			)
			* [1.0, 30.0, 2000.0][i % 3]
		)
		var away: float = exp(random.randf_range(log(1.0), log(60.0)))
		_camera.global_transform = Transform3D(
			Basis.from_euler(
				Vector3(random.randf_range(-1.0, 1.0), random.randf_range(-PI, PI), 0.0)
			),
			stem_base
		)
		_camera.translate_object_local(Vector3(0.0, 0.0, away))
		match random.randi_range(0, 2):
			0:
				_camera.set_perspective(random.randf_range(15.0, 100.0), 0.05, 500.0)
			1:
				_camera.set_orthogonal(random.randf_range(1.0, 40.0), 0.05, 500.0)
			2:
				# A photo's lens, near a part of it.
				var off: Vector2 = Vector2(random.randf_range(-1, 1), random.randf_range(-1, 1))
				_camera.set_frustum(random.randf_range(0.01, 0.1), off * 0.05, 0.05, 500.0)
		if ViewPlane.is_steep(_camera.global_transform):
			continue
		var frame: Transform3D = ViewPlane.facing(_camera.global_transform, stem_base)
		check(frame.basis.y == Vector3.UP, "The sheet isn't upright.")
		check(
			frame.basis.z.dot(_camera.global_position - stem_base) > 0.0,
			"The sheet turns its back to the camera."
		)
		var plane: ViewPlane = ViewPlane.new(
			frame, Vector2(random.randf_range(0, 1000), random.randf_range(500, 1000)), away / 700.0
		)
		for k: int in 20:
			var at: Vector2 = Vector2(random.randf() * size.x, random.randf() * size.y)
			var point: Vector2 = plane.to_canvas(_camera, size, at)
			# What lies beyond all that is drawn has no pixel to be true to.
			if not point.is_finite() or absf(point.x) > 3000.0 or absf(point.y) > 3000.0:
				continue
			tried += 1
			var seen: Vector2 = plane.to_screen(_camera, size, point)
			worst = maxf(worst, seen.distance_to(at))
			worst = maxf(worst, plane.to_canvas(_camera, size, seen).distance_to(point))
			var world: Vector3 = plane.to_world(point)
			check(absf((frame.affine_inverse() * world).z) < 1e-3, "It is off the sheet.")
			if _camera.projection == Camera3D.PROJECTION_PERSPECTIVE and i % 3 < 2:
				worst_ray = maxf(worst_ray, _camera.unproject_position(world).distance_to(at))
	check(tried > 2000, "Only %d places were tried." % tried)
	check(worst < 0.5, "A place comes back %.3f pixels off." % worst)
	check(worst_ray < 0.5, "The engine sees a place %.3f pixels off." % worst_ray)
	_viewport.free()


func test_a_drawing_is_moved_on_its_canvas_and_not_in_the_scene() -> void:
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 21
	for i: int in 300:
		var plane: ViewPlane = ViewPlane.new(
			Transform3D(Basis(Vector3.UP, random.randf() * TAU), Vector3(3.0, 1.0, -2.0)),
			Vector2(random.randf_range(-500, 1500), random.randf_range(0, 2000)),
			0.01
		)
		var box: Rect2 = Rect2(
			Vector2(random.randf_range(-900, 900), random.randf_range(-900, 900)),
			Vector2(exp(random.randf_range(0, 8)), exp(random.randf_range(0, 8)))
		)
		var by: Transform2D = ViewPlane.fit(box)
		var fitted: ViewPlane = plane.fitted(by)
		check(Rect2(0, 0, 1000, 1000).encloses(by * box), "%s leaves the canvas." % box)
		check(ViewPlane.fit(by * box) == Transform2D.IDENTITY, "%s is moved twice." % box)
		for point: Vector2 in [box.position, box.end, Vector2(500.0, 960.0)]:
			var off: float = plane.to_world(point).distance_to(fitted.to_world(by * point))
			check(off < 1e-3 * maxf(1.0, box.size.length() * 0.01), "It is moved by %f m." % off)


func test_the_tree_stands_where_its_strokes_were_drawn() -> void:
	await _open()
	var drawn: Array[PackedVector2Array] = []
	for line: PackedVector2Array in [
		[Vector2(600, 640), Vector2(604, 480), Vector2(600, 240)] as PackedVector2Array,
		[Vector2(602, 460), Vector2(690, 390), Vector2(740, 330)] as PackedVector2Array,
		[Vector2(602, 420), Vector2(520, 350), Vector2(470, 300)] as PackedVector2Array,
		_outline(Vector2(600, 310), Vector2(190, 150)),
	]:
		drawn.append(await _draw(line))
	if not _holds(_added != null and _added.is_inside_tree(), "No tree stands in the scene."):
		_shut()
		return
	check_equal(
		_panel.view.understood.values().map(_role_of),
		["trunk", "branch", "branch", "outline"],
		"roles"
	)
	check(_error_of(drawn) < 0.5, "A stroke is seen %.2f pixels off." % _error_of(drawn))
	var frame: Transform3D = _added.global_transform
	var stem_base: Vector2 = _camera.unproject_position(frame.origin)
	check(stem_base.distance_to(Vector2(600, 640)) < 3.0, "The base is seen at %s." % stem_base)
	check(absf(frame.origin.y) < 0.02, "The base is %.3f m above the ground." % frame.origin.y)
	var back: Vector3 = _camera.global_basis.z
	back.y = 0.0
	check(frame.basis.z.angle_to(back) < 1e-3, "The tree doesn't face the camera.")
	var box: Rect2 = _seen_box(_added)
	check(absf(box.position.y - 160.0) < 25.0, "The top is seen at %.0f." % box.position.y)
	check(
		box.position.x > 385.0 and box.position.x < 460.0,
		"Left it begins at %.0f." % box.position.x
	)
	check(box.end.x > 740.0 and box.end.x < 815.0, "Right it ends at %.0f." % box.end.x)
	# All of it in the history, stroke by stroke, and from another side.
	_camera.global_transform = (
		frame.rotated_local(Vector3.UP, 0.6) * Transform3D(Basis(), Vector3(0.0, 2.0, 9.0))
	)
	var plane: ViewPlane = _panel.view.plane_of(_panel.get_sketch())
	var from: Vector2 = plane.to_screen(
		_camera, SIZE, plane.stem_base + (Vector2(0.0, -1.5) / plane.pixel)
	)
	var more: PackedVector2Array = await _draw([from, from + Vector2(60.0, -90.0)])
	check_equal(_panel.get_sketch().strokes.size(), 5, "strokes")
	plane = _panel.view.plane_of(_panel.get_sketch())
	var last: PackedVector2Array = plane.line_to_screen(
		_camera, SIZE, _panel.get_sketch().strokes[-1]["points"]
	)
	check(last[-1].distance_to(more[-1]) < 0.5, "From the side it is %s off." % last[-1])
	check(_added.global_transform.is_equal_approx(frame), "The tree moved.")
	_undo.undo()
	await _wait()
	check_equal(_panel.get_sketch().strokes.size(), 4, "strokes after an undo")
	_shut()


func test_a_crown_that_is_drawn_first_comes_to_the_ground_with_its_trunk() -> void:
	await _open()
	var drawn: Array[PackedVector2Array] = [
		await _draw(_outline(Vector2(600, 310), Vector2(190, 150)))
	]
	check(_error_of(drawn) < 0.5, "The outline is off.")
	drawn.append(await _draw([Vector2(600, 660), Vector2(604, 480), Vector2(600, 260)]))
	check(_error_of(drawn) < 0.5, "A stroke is seen %.2f pixels off." % _error_of(drawn))
	if _holds(_added != null and _added.is_inside_tree(), "No tree stands in the scene."):
		var stem_base: Vector3 = _added.global_position
		check(absf(stem_base.y) < 0.02, "The base is %.3f m above the ground." % stem_base.y)
		check(
			_camera.unproject_position(stem_base).distance_to(Vector2(600, 660)) < 3.0,
			"It is elsewhere."
		)
	_shut()


func test_over_a_scan_the_sheet_goes_through_its_base() -> void:
	var scanned: TreeReconstruction = TreeReconstructor.new().sketch_tree(TestSketch.small_sketch())
	scanned.provenance = {"source": "res://a_scan.ply"}
	await _open(scanned)
	_scene.global_transform = Transform3D(Basis(Vector3.UP, 1.0), Vector3(2.0, 0.7, -3.0))
	var at: Vector2 = _camera.unproject_position(_scene.global_position)
	await _draw([at + Vector2(20.0, 30.0), at + Vector2(20.0, -200.0)])
	await _draw(_outline(at + Vector2(20.0, -240.0), Vector2(90.0, 110.0)))
	if _holds(_added != null and _added.is_inside_tree(), "No tree stands in the scene."):
		var off: Vector3 = _added.global_transform.affine_inverse() * _scene.global_position
		check(absf(off.z) < 1e-3, "The scan's base is %.3f m off the sheet." % off.z)
		check(_panel.view.get_over() == _scene, "The scan is forgotten.")
		check(
			is_same((_scene as TreeInstance3D).reconstruction, scanned),
			"The scan's tree is another one."
		)
	_shut()


func test_a_height_that_is_told_scales_the_tree_about_its_base() -> void:
	await _open()
	await _draw([Vector2(600, 640), Vector2(604, 480), Vector2(600, 240)])
	await _draw(_outline(Vector2(600, 310), Vector2(190, 150)))
	if not _holds(_added != null, "No tree stands in the scene."):
		_shut()
		return
	var frame: Transform3D = _added.global_transform
	var before: ViewPlane = _panel.view.plane_of(_panel.get_sketch())
	_panel.options.height.value = 2.0 * _panel.get_sketch().height
	_panel.settle()
	await _wait()
	var after: ViewPlane = _panel.view.plane_of(_panel.get_sketch())
	check(
		absf(after.pixel / before.pixel - 2.0) < 0.02,
		"It is %.3f times as large." % (after.pixel / before.pixel)
	)
	check(_added.global_transform.is_equal_approx(frame), "Its base moved.")
	_shut()


func test_what_cannot_be_drawn_is_said() -> void:
	await _open()
	_camera.look_at_from_position(Vector3(0.0, 9.0, 1.0), Vector3.ZERO)
	await _draw([Vector2(600, 640), Vector2(600, 240)])
	check("steeply" in "".join(_heard), "It isn't said that the view looks down: %s" % _heard)
	_heard = []
	_camera.look_at_from_position(Vector3(0.0, 2.0, 9.0), Vector3(0.0, 2.0, 0.0))
	await _draw([Vector2(600, 640), Vector2(600, 240)])
	_camera.look_at_from_position(Vector3(9.0, 2.0, 0.0), Vector3(0.0, 2.0, 0.0))
	await _draw([Vector2(600, 340), Vector2(700, 240)])
	check("from the side" in "".join(_heard), "It isn't said that the sheet is seen from the side.")
	check_equal(_panel.get_sketch().strokes.size(), 1, "strokes")
	_panel.view.tool = Canvas.Tool.ERASE
	_heard = []
	await _draw([Vector2(600, 340), Vector2(700, 240)])
	check("paper" in "".join(_heard), "It isn't said where strokes are erased.")
	_shut()


func test_the_view_is_drawn_in_whatever_tool_the_paper_had() -> void:
	await _open()
	for tool: int in [SketchPanel.Canvas.Tool.RESHAPE, SketchPanel.Canvas.Tool.ERASE]:
		var button: Button = _panel.bar.get_tool_button(tool)
		button.button_pressed = true
		button.pressed.emit()
		check_equal(_panel.view.tool, tool, "the tool of the view")
		_panel.bar.in_view.button_pressed = false
		_panel.bar.in_view.button_pressed = true
		check_equal(_panel.view.tool, SketchPanel.Canvas.Tool.DRAW, "the tool in the view")
		check_equal(_panel.canvas.tool, SketchPanel.Canvas.Tool.DRAW, "the tool on the paper")
		check(not button.button_pressed, "The button of another tool stays pressed.")
	# On an empty sheet there is nothing to erase or reshape.
	_panel.bar.get_tool_button(SketchPanel.Canvas.Tool.RESHAPE).button_pressed = true
	_panel.bar.get_tool_button(SketchPanel.Canvas.Tool.RESHAPE).pressed.emit()
	_panel.set_node(null)
	check_equal(_panel.view.tool, SketchPanel.Canvas.Tool.DRAW, "the tool of an empty sheet")
	_shut()


func test_a_stroke_under_way_is_given_up() -> void:
	await _open()
	_panel.view.input(_camera, SIZE, _event(Vector2(600, 640), true))
	check(_panel.view.is_busy(), "Nothing is under way.")
	var other: InputEventMouseButton = _event(Vector2(600, 640), true)
	other.button_index = MOUSE_BUTTON_RIGHT
	check(_panel.view.input(_camera, SIZE, other), "The right button moves the view.")
	check(not _panel.view.is_busy(), "It is still under way.")
	for button: MouseButton in [MOUSE_BUTTON_RIGHT, MOUSE_BUTTON_MIDDLE, MOUSE_BUTTON_WHEEL_UP]:
		other.button_index = button
		check(not _panel.view.input(_camera, SIZE, other), "Button %d is taken." % button)
	var held: InputEventMouseButton = _event(Vector2(600, 640), true)
	held.alt_pressed = true
	check(not _panel.view.input(_camera, SIZE, held), "Alt and the left button are taken.")
	_panel.bar.in_view.button_pressed = false
	check(not _panel.view.input(_camera, SIZE, _event(Vector2(600, 640), true)), "It draws on.")
	check(not _session.view.drawing, "The camera is still left alone.")
	_shut()


func _holds(condition: bool, message: String) -> bool:
	check(condition, message)
	return condition


func test_a_file_keeps_what_it_tells_under_any_name() -> void:
	await _open()
	var sketch: TreeSketch = TestSketch.small_sketch()
	sketch.species = "poplar"
	sketch.height = 7.5
	sketch.seed = 42
	_panel.files.write(sketch, folder.path_join("strokes.json"))
	var text: String = FileAccess.get_file_as_string(folder.path_join("strokes.json"))
	_panel.bar.in_view.button_pressed = false
	for name: String in ["strokes.txt", "strokes", "marked.svg"]:
		var file: FileAccess = FileAccess.open(folder.path_join(name), FileAccess.WRITE)
		if name == "marked.svg":
			# As some editors write it.
			file.store_buffer([0xEF, 0xBB, 0xBF])
			file.store_string(" \n\t")
		file.store_string(text)
		file.close()
		_panel.set_node(null)
		_panel.view.place = null
		_panel.files.read(folder.path_join(name))
		for i: int in 200:
			_session.update()
			_panel.update()
			await tree.process_frame
			if _panel.get_sketch().species == "poplar":
				break
		var read: TreeSketch = _panel.get_sketch()
		check_equal([read.species, read.height, read.seed], ["poplar", 7.5, 42], "of " + name)
	_shut()


static func _role_of(stroke: Dictionary) -> String:
	return stroke["role"]
