extends "./session_suite.gd"
## The window 'Sketch Tree', drawn on by mouse, pen and keys.

const SketchPanel := preload("res://addons/tree_reconstruction/editor/sketch/sketch_panel.gd")
const Canvas := preload("res://addons/tree_reconstruction/editor/sketch/sketch_canvas.gd")
const Dock := preload("res://addons/tree_reconstruction/editor/dock/dock.gd")
const TestSketch := preload("./test_sketch.gd")

var _session: Session
var _panel: SketchPanel
var _scene: Node3D
var _added: TreeInstance3D
var _asked: Array[bool] = []


# As the plugin's part does it in the editor: the first tree is a step of the same history.
func _open() -> void:
	_session = _session_with(null)
	_scene = _session.node
	_session.edit_node(null)
	_panel = SketchPanel.new(_session)
	_panel.size = Vector2(800.0, 700.0)
	_panel.made.connect(_on_made)
	_panel.history_wanted.connect(_on_history_wanted)
	_panel.node_wanted.connect(func(node: TreeInstance3D) -> void: _session.edit_node(node))
	tree.root.add_child(_panel)
	await tree.process_frame
	await tree.process_frame


func _on_made(made: TreeReconstruction) -> void:
	_added = TreeInstance3D.new()
	_added.reconstruction = made
	_undo.create_action("Add Tree to Scene")
	_undo.add_do_method(_scene.add_child.bind(_added))
	_undo.add_do_reference(_added)
	_undo.add_undo_method(_scene.remove_child.bind(_added))
	_undo.commit_action()
	_session.edit_node(_added)
	_panel.set_node(_added)


func _on_history_wanted(redo: bool) -> void:
	_asked.append(redo)
	if redo:
		_undo.redo()
	else:
		_undo.undo()
	if _added != null and not _added.is_inside_tree():
		_session.edit_node(null)


func _shut() -> void:
	_panel.close()
	_panel.free()
	_session.edit_node(null)
	_session.shut_down()
	_undo.clear_history()
	_undo.free()
	_scene.free()
	_session = null


func _frame() -> void:
	_session.update()
	_panel.update()
	await tree.process_frame


func _wait() -> void:
	await _frame()
	while not _session.jobs.get_running().is_empty() or _panel._due > 0:
		await _frame()
	await _frame()
	await _frame()


# --- a user's hands -------------------------------------------------------------------------------


func _button(at: Vector2, pressed: bool, button: MouseButton = MOUSE_BUTTON_LEFT) -> void:
	var event: InputEventMouseButton = InputEventMouseButton.new()
	event.button_index = button
	event.pressed = pressed
	event.position = _panel.canvas.get_global_transform() * _panel.canvas.to_control(at)
	event.global_position = event.position
	tree.root.push_input(event, true)


func _motion(at: Vector2, pressure: float, inverted: bool = false, held: bool = true) -> void:
	var event: InputEventMouseMotion = InputEventMouseMotion.new()
	event.position = _panel.canvas.get_global_transform() * _panel.canvas.to_control(at)
	event.global_position = event.position
	event.pressure = pressure
	event.pen_inverted = inverted
	event.button_mask = MOUSE_BUTTON_MASK_LEFT if held else 0
	tree.root.push_input(event, true)


# Strokes are drawn in fewer points than they have, for the events take their time.
func _draw(points: PackedVector2Array, pressure: Callable = Callable()) -> void:
	_motion(points[0], 0.0, false, false)
	_button(points[0], true)
	for i: int in range(1, points.size()):
		_motion(points[i], pressure.call(i) if pressure.is_valid() else 1.0)
	_button(points[-1], false)


func _key(key: Key, ctrl: bool = false, shift: bool = false) -> void:
	for pressed: bool in [true, false]:
		var event: InputEventKey = InputEventKey.new()
		event.keycode = key
		event.physical_keycode = key
		event.ctrl_pressed = ctrl
		event.shift_pressed = shift
		event.pressed = pressed
		tree.root.push_input(event, true)


func _strokes() -> Array[Dictionary]:
	return TestSketch.small_sketch().strokes


func _draw_whole() -> void:
	for stroke: Dictionary in _strokes():
		_draw(stroke["points"])
		await _wait()


func _ids() -> Array:
	return _panel.get_sketch().strokes.map(func(stroke: Dictionary) -> int: return stroke["id"])


# What stands in the scene, with what the paper shows of it.
func _check_tree(count: int, what: String) -> void:
	check_equal(_panel.get_sketch().strokes.size(), count, "strokes on the paper " + what)
	check_equal(_panel.canvas.strokes.size(), count, "strokes that are drawn " + what)
	if not check_there(what):
		return
	var kept: TreeSketch = _added.reconstruction.provenance["sketch"]
	check_equal(kept.strokes, _panel.get_sketch().strokes, "strokes of the tree " + what)
	var again: TreeReconstruction = TreeReconstructor.new().sketch_tree(kept)
	check_equal(_added.reconstruction.skeleton, again.skeleton, "the wood " + what)


func check_there(what: String) -> bool:
	var there: bool = _added != null and _added.is_inside_tree()
	check(there, "No tree stands in the scene " + what)
	return there


# --- tests ----------------------------------------------------------------------------------------


func test_strokes_become_a_tree_and_every_stroke_is_a_step() -> void:
	await _open()
	_draw(_strokes()[0]["points"])
	await _wait()
	check_equal(_panel.get_sketch().strokes.size(), 1, "strokes after the outline")
	var given: PackedVector2Array = _strokes()[0]["points"]
	var drawn: PackedVector2Array = _panel.get_sketch().strokes[0]["points"]
	check_equal(drawn.size(), given.size(), "points of the outline")
	for i: int in mini(drawn.size(), given.size()):
		check(drawn[i].distance_to(given[i]) < 0.1, "A point lies at %s." % drawn[i])
	check_equal(_panel.get_sketch().strokes[0]["pressure"].size(), 0, "pressures of a mouse")
	_draw(_strokes()[1]["points"])
	await _wait()
	_draw(_strokes()[2]["points"])
	_draw(_strokes()[3]["points"])
	await _wait()
	_check_tree(4, "after all")
	for left: int in [3, 2]:
		_key(KEY_Z, true)
		await _wait()
		_check_tree(left, "after an undo")
	for more: int in [3, 4]:
		_key(KEY_Z, true, true)
		await _wait()
		_check_tree(more, "after a redo")
	# Keys that come before a stroke is made wait for it.
	_draw([Vector2(503.0, 480.0), Vector2(560.0, 380.0), Vector2(650.0, 250.0)])
	_key(KEY_Z, true)
	await _wait()
	await _wait()
	_check_tree(4, "after a stroke and an undo at once")
	_key(KEY_Z, true, true)
	_key(KEY_Z, true)
	await _wait()
	await _wait()
	_check_tree(4, "after a redo and an undo at once")
	_draw([Vector2(503.0, 480.0), Vector2(560.0, 380.0), Vector2(650.0, 250.0)])
	_key(KEY_Z, true)
	while _panel.maker.is_busy():
		_session.update()
		await tree.process_frame
	_key(KEY_Z, true, true)
	await _wait()
	_check_tree(5, "after a redo that came before the undo's turn")
	_key(KEY_Z, true)
	await _wait()
	var roles: Array = _panel.canvas.understood.values().map(
		func(stroke: Dictionary) -> String: return stroke["role"]
	)
	check_equal(roles, ["outline", "trunk", "branch", "branch"], "what the strokes are taken for")
	check(
		"outline" in _panel.canvas._get_tooltip(_panel.canvas.to_control(Vector2(500, 60))), "No."
	)
	_shut()


func test_strokes_that_make_no_tree_are_kept_and_undone_on_the_paper() -> void:
	await _open()
	await _draw_whole()
	var first: int = _undo.get_version()
	_panel.bar.clear.pressed.emit()
	await _wait()
	check_equal(_panel.get_sketch().strokes.size(), 0, "strokes after Clear")
	check_equal(_undo.get_version(), first, "steps of the history after Clear")
	check_there("after Clear")
	_key(KEY_Z, true)
	await _wait()
	_check_tree(4, "after Clear was undone")
	check_equal(_asked, [] as Array[bool], "what was asked of the history")
	_key(KEY_Z, true, true)
	await _wait()
	check_equal(_panel.get_sketch().strokes.size(), 0, "strokes after Clear was done again")
	_shut()


func test_a_tree_that_is_undone_leaves_its_earlier_strokes() -> void:
	await _open()
	await _draw_whole()
	var steps: int = 0
	while _added.is_inside_tree() and steps < 10:
		_key(KEY_Z, true)
		await _wait()
		steps += 1
	check(steps < 10, "The tree is never undone.")
	var left: int = _panel.get_sketch().strokes.size()
	check_equal(left + steps, 4, "strokes left and steps undone")
	for i: int in left:
		_key(KEY_Z, true)
		await _wait()
	check_equal(_panel.get_sketch().strokes.size(), 0, "strokes after all was undone")
	for i: int in 4:
		_key(KEY_Z, true, true)
		await _wait()
	_check_tree(4, "after all was done again")
	check_equal(_session.node, _added, "what is edited")
	_shut()


func test_strokes_are_rubbed_out() -> void:
	await _open()
	await _draw_whole()
	_button(Vector2(690.0, 400.0), true, MOUSE_BUTTON_RIGHT)
	_button(Vector2(690.0, 400.0), false, MOUSE_BUTTON_RIGHT)
	await _wait()
	_check_tree(3, "after the right button")
	check_equal(_ids(), [1, 2, 4], "ids left")
	_key(KEY_E)
	check_equal(_panel.canvas.tool, Canvas.Tool.ERASE, "the tool of the key E")
	_draw([Vector2(330.0, 300.0), Vector2(310.0, 370.0)])
	await _wait()
	_check_tree(2, "after Erase")
	_key(KEY_Z, true)
	_key(KEY_Z, true)
	await _wait()
	await _wait()
	_check_tree(4, "after both were undone")
	_key(KEY_D)
	_button(Vector2(690.0, 400.0), true)
	_motion(Vector2(685.0, 405.0), 0.5, true)
	_button(Vector2(685.0, 405.0), false)
	await _wait()
	_check_tree(3, "after the pen's other end")
	_shut()


func test_a_stroke_is_bent_by_its_handles() -> void:
	await _open()
	await _draw_whole()
	_key(KEY_R)
	var before: PackedVector2Array = _panel.get_sketch().strokes[2]["points"]
	_button(Vector2(690.0, 400.0), true)
	_button(Vector2(690.0, 400.0), false)
	check_equal(_panel.canvas.selected, 3, "the selected stroke")
	if _panel.canvas.curve == null:
		check(false, "It has no handles.")
		_shut()
		return
	check_equal(_panel.canvas.curve.get_count(), 4, "handles of a straight branch")
	_button(before[-1], true)
	_motion(before[-1] + Vector2(30.0, 20.0), 1.0)
	_motion(before[-1] + Vector2(60.0, 40.0), 1.0)
	_button(before[-1] + Vector2(60.0, 40.0), false)
	await _wait()
	_check_tree(4, "after it was bent")
	var after: PackedVector2Array = _panel.get_sketch().strokes[2]["points"]
	check(after[-1].distance_to(before[-1] + Vector2(60.0, 40.0)) < 1.0, "Its end stays.")
	check(after[0].distance_to(before[0]) < 0.1, "Its base moves.")
	_key(KEY_Z, true)
	await _wait()
	check_equal(_panel.get_sketch().strokes[2]["points"], before, "its points after an undo")
	_shut()


func test_other_values_keep_the_strokes_and_the_edits() -> void:
	await _open()
	await _draw_whole()
	var made: TreeReconstruction = _added.reconstruction
	var drawn: Array[Dictionary] = _panel.get_sketch().strokes
	_session.run("Prune", "prune factor=0.5")
	await _wait()
	var log: String = made.edit_log
	check(not log.is_empty(), "Nothing was pruned.")
	made.leaf_size = 0.31
	_panel.options.seed_field.value = 9
	await _wait()
	check_equal(made.provenance["sketch"].seed, 9, "the seed")
	check_near(made.leaf_size, 0.31, 1e-6, "the leaves' size")
	var names: Array = TreeReconstructor.get_sketch_species().map(
		func(known: Dictionary) -> String: return known["name"]
	)
	names.erase("maple")
	for i: int in _panel.options.species.item_count:
		if _panel.options.species.get_item_metadata(i) == names[0]:
			_panel.options.species.select(i)
			_panel.options.species.item_selected.emit(i)
	await _wait()
	check_equal(made.provenance["sketch"].species, names[0], "the species")
	check_equal(made.leaf_preset, names[0], "the leaves")
	check_equal(_panel.get_sketch().strokes, drawn, "the strokes")
	check("prune" in made.edit_log, "The edits are gone: " + made.edit_log)
	for height: float in [5.0, 5.5, 6.0]:
		_panel.options.height.value = height
	await _wait()
	check_near(made.get_aabb().size.y, 6.0, 1.5, "the height")
	_key(KEY_Z, true)
	await _wait()
	check_equal(made.provenance["sketch"].height, 0.0, "the height before it was turned")
	_key(KEY_Z, true)
	await _wait()
	check_equal(made.provenance["sketch"].species, "", "the species after an undo")
	check_near(made.leaf_size, 0.31, 1e-6, "the leaves' size after an undo")
	check_equal(_panel.options.species.get_selected_metadata(), "maple", "the species shown")
	_key(KEY_Z, true)
	await _wait()
	check_equal(made.edit_log, log, "the log after all was undone")
	check_equal(_panel.options.seed_field.value, 1.0, "the seed shown")
	_shut()


func test_a_role_is_told() -> void:
	await _open()
	await _draw_whole()
	_draw([Vector2(690.0, 400.0), Vector2(690.5, 400.0)])
	check_equal(_panel.canvas.selected, 3, "a click selects the stroke")
	check(not _panel.options.role.disabled, "Its role can't be told.")
	_panel.options.role.select(3)
	_panel.options.role.item_selected.emit(3)
	await _wait()
	check_equal(_panel.get_sketch().strokes[2]["role"], TreeSketch.ROLE_BRANCH, "the role")
	_check_tree(4, "after it was told")
	_key(KEY_DELETE)
	await _wait()
	check_equal(_ids(), [1, 2, 4], "strokes after Delete")
	_shut()


func test_the_tree_follows_the_pen_and_is_restored() -> void:
	await _open()
	await _draw_whole()
	var made: TreeReconstruction = _added.reconstruction
	var before: Dictionary = made.skeleton
	var version: int = _undo.get_version()
	for ending: String in ["escape", "right"]:
		_button(Vector2(503.0, 480.0), true)
		for i: int in 20:
			_motion(Vector2(503.0, 480.0).lerp(Vector2(650.0, 250.0), i / 19.0), 1.0)
		for frame: int in 2000:
			if made.skeleton != before and not _added.is_rebuilding():
				break
			await _frame()
		check(made.skeleton != before, "The tree does not follow.")
		if ending == "escape":
			_key(KEY_ESCAPE)
		else:
			_button(Vector2(650.0, 250.0), true, MOUSE_BUTTON_RIGHT)
			_button(Vector2(650.0, 250.0), false, MOUSE_BUTTON_RIGHT)
		_button(Vector2(650.0, 250.0), false)
		await _wait()
		check_equal(made.skeleton, before, "the wood after " + ending)
		check_equal(_undo.get_version(), version, "steps after " + ending)
		_check_tree(4, "after " + ending)
	check(Input.use_accumulated_input, "Events are not gathered any more.")
	_draw([Vector2(503.0, 480.0), Vector2(560.0, 380.0), Vector2(650.0, 250.0)])
	await _wait()
	_check_tree(5, "after a stroke that the tree followed")
	_key(KEY_Z, true)
	await _wait()
	check_equal(made.skeleton, before, "the wood after an undo")
	_shut()


func test_a_fault_is_red_and_has_its_sentence() -> void:
	await _open()
	await _draw_whole()
	var sketch: TreeSketch = _panel.get_sketch()
	var fault: String = "This branch meets no trunk."
	var strokes: Array[Dictionary] = []
	for role: String in ["outline", "trunk", "branch", "branch"]:
		strokes.append({"role": role, "fault": "", "repairs": [], "attach": null})
	strokes[2].merge({"fault": fault, "repairs": ["gap"], "attach": [502.0, 600.0]}, true)
	var report: Dictionary = {"strokes": strokes, "remarks": []}
	_panel._known.add(sketch, report, _session)
	_panel._put_on_paper()
	check_equal(_panel.message.text, fault, "what stands below the paper")
	var place: Vector2 = _panel.canvas.to_control(Vector2(690.0, 400.0))
	check_equal(_panel.canvas._get_tooltip(place), fault, "the tooltip")
	_shut()


func test_a_pen_gives_its_pressure() -> void:
	await _open()
	_draw(_strokes()[1]["points"], func(i: int) -> float: return 0.2 + 0.01 * i)
	await _wait()
	var stroke: Dictionary = _panel.get_sketch().strokes[0]
	check_equal(stroke["pressure"].size(), stroke["points"].size(), "pressures")
	check_near(stroke["pressure"][20], 0.4, 0.02, "a pressure")
	_shut()


func test_strokes_go_through_files() -> void:
	await _open()
	await _draw_whole()
	var path: String = folder.path_join("strokes.json")
	_panel.files.write(_panel.get_sketch(), path)
	if FileAccess.get_file_as_string(path).is_empty():
		check(false, "Nothing was saved.")
		_shut()
		return
	var drawn: Array[Dictionary] = _panel.get_sketch().strokes
	_panel.bar.begin.pressed.emit()
	check_equal(_panel.get_sketch().strokes.size(), 0, "strokes of a new sketch")
	var other: TreeInstance3D = _added
	_panel.files.read(path)
	await _wait()
	check(_added != other, "The other tree was drawn over.")
	check_equal(_panel.get_sketch().strokes.size(), drawn.size(), "strokes that were read")
	_panel.files.read(folder.path_join("none.json"))
	await _wait()
	check("none.json" in _panel.message.text, "It says: " + _panel.message.text)
	_shut()


func test_another_tree_of_strokes_is_shown_when_it_is_selected() -> void:
	await _open()
	await _draw_whole()
	var sketch: TreeSketch = TestSketch.small_sketch()
	sketch.remove_stroke(4)
	var node: TreeInstance3D = TreeInstance3D.new()
	node.reconstruction = TreeReconstructor.new().sketch_tree(sketch)
	_scene.add_child(node)
	_session.edit_node(node)
	await _wait()
	check_equal(_panel.get_sketch().strokes, sketch.strokes, "the strokes of the other tree")
	_session.edit_node(null)
	await _wait()
	check_equal(_panel.get_sketch().strokes.size(), 3, "strokes while nothing is selected")
	_session.edit_node(_added)
	await _wait()
	check_equal(_panel.get_sketch().strokes.size(), 4, "strokes of the first one")
	_shut()


func test_the_dock_leads_to_the_strokes() -> void:
	await _open()
	await _draw_whole()
	var dock: Dock = Dock.new(_session)
	tree.root.add_child(dock)
	dock.set_folded([])
	dock.update()
	var stages: Variant = dock.sections[&"stages"]
	check(stages._sketch.visible, "It doesn't lead to the strokes.")
	check(not stages._no_scan.visible, "It misses a scan.")
	for stage: StringName in [&"scan", &"clean", &"skeleton"]:
		check(not stages.rows[stage].visible, "It offers to do %s again." % stage)
	var wanted: Array[bool] = []
	_session.sketch_wanted.connect(func() -> void: wanted.append(true))
	stages._sketch.pressed.emit()
	check_equal(wanted.size(), 1, "times that the window was asked for")
	_added.reconstruction = grown_tree(3)
	await _frame()
	dock.update()
	check(not stages._sketch.visible, "A tree of no strokes leads to some.")
	check(stages.rows[&"scan"].visible, "Its stages are gone.")
	dock.close()
	dock.free()
	_shut()
