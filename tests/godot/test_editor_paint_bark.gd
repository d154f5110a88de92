extends "./tools_suite.gd"
## The tool Paint Bark: clicks, drags, the wheel and keys on the bark, and what grows of them.

const BarkFeatures := preload("res://addons/tree_reconstruction/editor/bark/bark_features.gd")
const BarkWork := preload("res://addons/tree_reconstruction/editor/bark/bark_work.gd")
const PaintBark := preload("res://addons/tree_reconstruction/editor/tools/paint_bark.gd")
const Recipe := preload("res://addons/tree_reconstruction/editor/dock/growth_recipe.gd")
const GrownBark := preload("./test_grown_bark.gd")

var _of: TreeReconstruction


# With long edges, so that it is quick.
func _paint(grows: bool = false, edge: float = 0.08) -> PaintBark:
	_of = GrownBark.stout()
	_of.growth_recipe = "edges longest=%s\n" % edge
	_begin(_of, &"paint_bark")
	var tool: PaintBark = _session.tool as PaintBark
	tool.set_setting(0, &"kind")
	tool.set_setting(1.0, &"size")
	tool._on_grow_toggled(grows)
	return tool


func _work() -> BarkWork:
	return BarkWork.of(_session) as BarkWork


# Where the trunk's bark is seen at a height.
func _seen(height: float) -> Vector2:
	return _session.picker.project_place(_camera, Vector3(0.05 * height, height, 0.0))


func _features() -> Array[Recipe.Line]:
	return Recipe.new(_of.growth_recipe).get_features()


func _drag(from: Vector2, to: Vector2) -> void:
	_button(from, true)
	_hover(from.lerp(to, 0.5), true)
	_hover(to, true)
	_button(to, false)


func _grown() -> void:
	while not _session.jobs.get_running().is_empty():
		await _frame()


func test_the_bark_under_the_mouse_is_found() -> void:
	var tool: PaintBark = _paint()
	for height: float in [0.4, 0.8, 1.3]:
		var at: Vector2 = _seen(height)
		var place: Dictionary = tool.pick_place(_camera, at)
		check(not place.is_empty(), "There is no bark at %s." % at)
		if place.is_empty():
			continue
		check_equal(place.node, _of.get_root(), "the node of the trunk")
		check_near(place.along, height, 0.06, "metres along")
		var seen: Vector2 = _session.picker.project_place(_camera, place.position)
		check(seen.distance_to(at) < 2.0, "It is seen at %s instead of %s." % [seen, at])
		# What is written leads back to the same place.
		var line: String = "burl along=%f around=%f radius=0.1" % [place.along, place.around]
		var found: Array[Dictionary] = tool._worker.find_bark(_of, line)
		check(
			(found[0].position as Vector3).distance_to(place.position) < 1e-3,
			"%s and %s" % [found[0], place]
		)
	check(tool.pick_place(_camera, Vector2(3, 3)).is_empty(), "The sky has bark.")
	# A branch.
	var branch: Dictionary = tool.pick_place(_camera, _at(13))
	check(
		not branch.is_empty() and branch.node != _of.get_root(),
		"The branch is not found: %s" % branch
	)
	_end()


func test_a_click_places_what_is_chosen_as_one_step() -> void:
	for kind: int in BarkFeatures.KINDS.size():
		var tool: PaintBark = _paint()
		tool.set_setting(kind, &"kind")
		_hover(_seen(0.8))
		check(not tool._hint.is_empty(), "Nothing is said of what a click does.")
		check(_click(_seen(0.8)), "The click is not taken.")
		check_equal(_features().size(), 1, "features")
		check_equal(BarkFeatures.kind_of(_features()[0]), BarkFeatures.KINDS[kind], "the kind")
		check_near(_features()[0].values["along"].to_float(), 0.8, 0.06, "along")
		check_equal(_undo.get_history_count(), 1, "steps")
		check(_of.growth_pending, "It seems to be grown.")
		_undo.undo()
		await _frame()
		check_equal(_features().size(), 0, "features after undo")
		check(not _of.growth_pending, "Something is to grow after undo.")
		_undo.redo()
		await _frame()
		check_equal(_features().size(), 1, "features after redo")
		# The recipe is one that grows.
		var worker: TreeReconstructor = TreeReconstructor.new()
		var made: TreeReconstruction = worker.grow_bark(_of, _of.growth_recipe)
		check(made != null, "%s: %s" % [BarkFeatures.KINDS[kind], worker.get_error_message()])
		_end()


func test_a_handle_is_dragged_resized_and_deleted() -> void:
	var tool: PaintBark = _paint()
	_click(_seen(0.6))
	await _frame()
	var before: Dictionary = _features()[0].values
	var handle: Vector2 = tool.get_handle(0)
	check(handle.distance_to(_seen(0.6)) < 3.0, "The handle is at %s." % handle)
	_drag(handle, _seen(1.2))
	await _frame()
	check_near(_features()[0].values["along"].to_float(), 1.2, 0.06, "along after the drag")
	check_equal(_features()[0].values["radius"], before["radius"], "the radius after the drag")
	check_equal(_undo.get_history_count(), 2, "steps")
	check_equal(_undo.get_action_name(1), "Move on the Bark", "the step")
	# The wheel turns over the handle alone.
	check(not _wheel(Vector2(3, 3), MOUSE_BUTTON_WHEEL_UP), "The view can't be zoomed.")
	check(_wheel(tool.get_handle(0), MOUSE_BUTTON_WHEEL_UP), "The wheel is not taken.")
	var larger: float = _features()[0].values["radius"].to_float()
	check_near(larger, before["radius"].to_float() * 1.12, 2e-3, "the radius after the wheel")
	check(_wheel(tool.get_handle(0), MOUSE_BUTTON_WHEEL_UP), "The wheel is not taken.")
	check_equal(_undo.get_history_count(), 3, "steps after two turns of the wheel")
	check(_key(KEY_BRACKETLEFT), "The key is not taken.")
	check_near(_features()[0].values["radius"].to_float(), larger, 2e-3, "the radius after a key")
	await _frame()
	check(_key(KEY_DELETE), "Delete is not taken.")
	check_equal(_features().size(), 0, "features after Delete")
	check(_of.has_node(5), "Wood was deleted.")
	check(not _key(KEY_DELETE), "Delete is taken without anything selected.")
	while _undo.has_undo():
		_undo.undo()
	check_equal(_features().size(), 0, "features after all is undone")
	_end()


func test_a_drag_that_is_given_up_leaves_nothing() -> void:
	var tool: PaintBark = _paint()
	_click(_seen(0.6))
	await _frame()
	var text: String = _of.growth_recipe
	_button(tool.get_handle(0), true)
	_hover(_seen(1.2), true)
	check(tool.is_busy(), "Nothing is dragged.")
	_key(KEY_ESCAPE)
	check(not tool.is_busy(), "It is dragged still.")
	_button(_seen(1.2), false)
	check_equal(_of.growth_recipe, text, "the recipe")
	check_equal(_undo.get_history_count(), 1, "steps")
	# A click on a handle selects it and does nothing else.
	_work().selected = BarkWork.NONE
	_click(tool.get_handle(0))
	check_equal(_work().selected, 0, "what is selected")
	check_equal(_undo.get_history_count(), 1, "steps after a click")
	_end()


func test_the_lump_is_seen_while_it_is_dragged() -> void:
	var tool: PaintBark = _paint()
	_button(_seen(0.6), true)
	check(tool._preview.get_triangle_count() > 100, "Nothing is shown.")
	var began: int = Time.get_ticks_usec()
	for i: int in 20:
		_hover(_seen(0.6 + 0.03 * i), true)
	var each: float = (Time.get_ticks_usec() - began) / 20e3
	print("        %.2f ms per move" % each)
	check(tool._preview.get_triangle_count() > 100, "Nothing is shown after a move.")
	_button(_seen(1.1), false)
	check(tool._preview.get_triangle_count() > 100, "What waits to grow is not shown.")
	_session.choose(&"select")
	check_equal(tool._preview.get_triangle_count(), 0, "triangles of another tool")
	_end()


func test_nothing_stays_of_a_tree_that_is_deleted() -> void:
	var tool: PaintBark = _paint()
	_click(_seen(0.6))
	check(tool._preview.get_triangle_count() > 100, "Nothing is shown.")
	_session.node.free()
	await _frame()
	check_equal(tool._preview.get_triangle_count(), 0, "triangles of a tree that is gone")
	_end()


# The outline is as high as what grows: equation 6 with the branch's radius.
func test_the_preview_is_as_high_as_the_growth() -> void:
	var tool: PaintBark = _paint()
	var line: String = "burl along=0.8 around=0 radius=0.2 inner=0.1 growth=0.5"
	var arrays: Array = tool._worker.lift_bark(_of, line)
	var places: PackedVector3Array = arrays[Mesh.ARRAY_VERTEX]
	var place: Dictionary = tool._worker.find_bark(_of, line)[0]
	var highest: float = 0.0
	for at: Vector3 in places:
		highest = maxf(highest, (at - place.axis as Vector3).dot(place.out))
	check_near(highest, place.radius * 1.5, 0.01, "the height over the axis")
	_end()


func test_it_grows_of_itself_within_the_same_step() -> void:
	var tool: PaintBark = _paint(true, 0.045)
	_click(_seen(0.8))
	check(_work().is_growing(), "Nothing grows.")
	check(tool._preview.get_triangle_count() > 100, "What waits to grow is not shown.")
	var coarse_edges: int = 0
	while not _session.jobs.get_running().is_empty():
		await _frame()
		if coarse_edges == 0 and _of.has_grown_bark():
			coarse_edges = _of.grown_bark.size()
			check(_of.growth_pending, "The coarse bark is taken for the whole one.")
	while _session.node.is_rebuilding():
		await _frame()
	check_equal(tool._preview.get_triangle_count(), 0, "triangles over grown bark")
	check(_of.has_grown_bark() and not _of.growth_pending, "It has not grown: %s" % _said)
	check(coarse_edges > 0, "There was no coarse bark.")
	check(_of.grown_bark.size() > 2 * coarse_edges, "The bark is no finer than the coarse one.")
	check_equal(_undo.get_history_count(), 1, "steps")
	var grown: PackedByteArray = _of.grown_bark
	_undo.undo()
	await _frame()
	check(not _of.has_grown_bark(), "Undo leaves bark.")
	check_equal(_session.jobs.get_running().size(), 0, "what grows after undo")
	_undo.redo()
	await _frame()
	check_equal(_of.grown_bark, grown, "the bark after redo")
	check(not _of.growth_pending, "It is to grow again after redo.")
	check_equal(_session.jobs.get_running().size(), 0, "what grows after redo")
	_end()


func test_the_newest_change_counts() -> void:
	_paint(true, 0.045)
	_click(_seen(0.5))
	await _frame()
	_click(_seen(1.2))
	check_equal(_features().size(), 2, "features")
	await _grown()
	check_equal(_features().size(), 2, "features that have grown")
	check(_of.has_grown_bark() and not _of.growth_pending, "It has not grown: %s" % _said)
	check_equal(_undo.get_history_count(), 2, "steps")
	# What is undone while it grows does not come back.
	_click(_seen(0.9))
	await _frame()
	_undo.undo()
	await _frame()
	await _grown()
	check_equal(_features().size(), 2, "features after undo")
	check(not _of.growth_pending, "Something is to grow.")
	_end()


func test_what_is_cancelled_does_not_begin_again() -> void:
	_paint(true, 0.015)
	_click(_seen(0.8))
	await _frame()
	_session.jobs.cancel(_session.jobs.get_running()[0])
	await _grown()
	for i: int in 3:
		await _frame()
	check_equal(_session.jobs.get_running().size(), 0, "what grows")
	check(_of.growth_pending and not _of.has_grown_bark(), "It has grown.")
	_end()


func test_presets_are_scaled_to_the_trunk() -> void:
	var of: TreeReconstruction = GrownBark.stout()
	var names: PackedStringArray = []
	for preset: Dictionary in TreeReconstructor.get_growth_presets():
		names.append(preset.name)
		check(not (preset.description as String).is_empty(), "%s says nothing." % preset.name)
		var text: String = TreeReconstructor.scale_growth_preset(preset.name, of)
		check(not Recipe.new(text).get_features().is_empty(), text)
	check_equal(
		names,
		PackedStringArray(["fence_post_swallowed", "hollow_refuge", "old_oak", "spiral_grain"]),
		"presets"
	)
