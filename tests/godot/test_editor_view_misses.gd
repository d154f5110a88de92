extends "./view_suite.gd"
## What of the viewport's events is whose, and where trees that are added and looked at are.


func test_a_click_on_nothing_is_the_editors() -> void:
	_open(grown_tree(3))
	_session.select([0])
	_router.input(_camera, _button(_nothing(), true))
	check(_given_back.is_empty(), "It was given back before it was known to be a click.")
	_router.input(_camera, _button(_nothing(), false))
	check_equal(_given_back.size(), 2, "events given back")
	check(_given_back[0].is_pressed() and not _given_back[1].is_pressed(), "In a wrong order.")
	check_equal(_session.selection, PackedInt32Array([0]), "the selection")
	# A press beside the tree's base is for the arrows that move the node.
	var base: Vector2 = _session.picker.project_place(_camera, Vector3.ZERO)
	check_equal(
		_router.input(_camera, _button(base + Vector2(60, 0), true)), PASS, "beside the base"
	)
	# With Alt it may be a move of the camera.
	var orbiting: InputEventMouseButton = _button(_nothing(), true)
	orbiting.alt_pressed = true
	check_equal(_router.input(_camera, orbiting), PASS, "with Alt")
	var wheel: InputEventMouseButton = _button(_nothing(), true)
	wheel.button_index = MOUSE_BUTTON_WHEEL_UP
	check_equal(_router.input(_camera, wheel), PASS, "the wheel")
	_session.view.editing = false
	var at: Vector2 = _session.picker.project(_camera, _lone_node())
	check_equal(_router.input(_camera, _button(at, true)), PASS, "a click while not editing")
	check_equal(_router.input(_camera, _key(KEY_X)), PASS, "a key while not editing")
	_close()


func test_the_key_f_looks_at_the_selected_wood_or_at_the_tree() -> void:
	_open(grown_tree(3, 20))
	var asked: Array[StringName] = []
	_router.asked.connect(func(action: StringName) -> void: asked.append(action))
	# The editor would look at the tree's base.
	for selected: PackedInt32Array in [PackedInt32Array(), PackedInt32Array([2])]:
		for editing: bool in [true, false]:
			_session.select(selected)
			_session.view.editing = editing
			asked.clear()
			check_equal(_router.input(_camera, _key(KEY_F)), EditorPlugin.AFTER_GUI_INPUT_STOP, "F")
			check_equal(asked, [&"view_selection"] as Array[StringName], "what was asked for")
	_close()


func _near_miss() -> Vector2:
	var wood: Vector2 = _session.picker.project(_camera, _lone_node())
	for reach: int in range(4, 19):
		for turn: int in 16:
			var at: Vector2 = wood + Vector2.from_angle(turn * TAU / 16.0) * reach
			if _session.picker.pick(_camera, at) == -1:
				return at
	check(false, "There is no such place.")
	return wood


func test_a_near_miss_leaves_neither_the_tool_nor_the_tree() -> void:
	_open(grown_tree(3))
	# They are put away while the skeleton is edited.
	_session.picker.are_arrows_shown = func() -> bool: return false
	var missed: Array[InputEvent] = []
	_router.missed.connect(
		func(press: InputEventMouseButton, release: InputEventMouseButton) -> void:
			missed.append_array([press, release])
	)
	var near: Vector2 = _near_miss()
	var stop: int = EditorPlugin.AFTER_GUI_INPUT_STOP
	for id: StringName in _session.tools:
		_session.choose(id)
		_session.select([1, 2])
		# Twigs to a side are made as soon as they are chosen.
		await tree.process_frame
		var selected: PackedInt32Array = _session.selection
		var count: int = _undo.get_history_count()
		check_equal(_router.input(_camera, _button(near, true)), stop, "%s: a press" % id)
		check_equal(_router.input(_camera, _button(near, false)), stop, "%s: its end" % id)
		check(missed.is_empty() and _given_back.is_empty(), "%s leaves a near miss." % id)
		check_equal(_session.tool, _session.tools[id], "the tool after it")
		check_equal(_session.selection, selected, "%s: the selection" % id)
		check_equal(_undo.get_history_count(), count, "%s: steps" % id)
		if id in [&"select", &"slice", &"draw_branch"]:
			# Their drags begin beside the tree.
			continue
		# Nor does a drag become the editor's box, wherever it begins.
		for from: Vector2 in [near, _nothing()]:
			check_equal(_router.input(_camera, _button(from, true)), stop, "%s: a press" % id)
			var to: Vector2 = from - Vector2(40, 30)
			check_equal(_router.input(_camera, _motion(to)), stop, "%s: a drag" % id)
			check_equal(_router.input(_camera, _button(to, false)), stop, "%s: its end" % id)
			check(missed.is_empty(), "%s leaves a drag." % id)
		# What is farther off may be something else of the scene.
		_router.input(_camera, _button(_nothing(), true))
		check(missed.is_empty(), "It was given back before it was known to be a click.")
		_router.input(_camera, _button(_nothing(), false))
		check_equal(missed.size(), 2, "%s: events of a click far from wood" % id)
		missed.clear()
	_close()


func test_a_turn_of_the_wheel_belongs_to_the_tool_until_its_end() -> void:
	_open(grown_tree(3))
	_session.choose(&"graft")
	var id: int = _lone_node()
	var at: Vector2 = _session.picker.project(_camera, id)
	for over: bool in [true, false]:
		var wanted: int = (
			EditorPlugin.AFTER_GUI_INPUT_STOP if over else EditorPlugin.AFTER_GUI_INPUT_PASS
		)
		_session.hovered = id if over else -1
		for index: MouseButton in [MOUSE_BUTTON_WHEEL_UP, MOUSE_BUTTON_WHEEL_DOWN]:
			for pressed: bool in [true, false]:
				var turn: InputEventMouseButton = _button(at if over else _nothing(), pressed)
				turn.button_index = index
				check_equal(_router.input(_camera, turn), wanted, "wheel, pressed: %s" % pressed)
	_close()


func test_the_whole_tree_is_framed_with_its_leaves() -> void:
	_open(grown_tree(3))
	var views: CameraViews = CameraViews.new(_session)
	var turned: Basis = _camera.global_basis.orthonormalized()
	_session.tree.leaf_rule = LeafRule.from_preset("palm")
	var with_leaves: float = views.call(&"_distance_for", turned, _camera)
	_session.view.leaves = false
	var bare: float = views.call(&"_distance_for", turned, _camera)
	check(with_leaves > bare * 1.05, "Leaves take %.2f m, wood %.2f m." % [with_leaves, bare])
	var middle: Vector3 = _session.node.global_transform * _session.tree.get_aabb().get_center()
	_camera.global_position = middle + turned.z * with_leaves
	for id: int in _session.tree.get_node_ids():
		var at: Vector2 = _session.picker.project(_camera, id)
		check(Rect2(Vector2.ZERO, Vector2(_SIZE)).has_point(at), "Node %d is at %s." % [id, at])
	_close()


func test_trees_that_are_added_stand_beside_others() -> void:
	var random: RandomNumberGenerator = RandomNumberGenerator.new()
	random.seed = 5
	for i: int in 200:
		var taken: Array[Rect2] = []
		for k: int in random.randi() % 8:
			var at: Vector2 = Vector2(random.randf_range(-9, 9), random.randf_range(-9, 9))
			taken.append(Rect2(at, Vector2(random.randf_range(1, 6), random.randf_range(1, 6))))
		var needed: Rect2 = Rect2(-2.0, -1.5, 4.0, 3.5)
		var place: Vector3 = Vector3(random.randf_range(-5, 5), 1.0, random.randf_range(-5, 5))
		var along: Vector3 = Vector3.RIGHT.rotated(Vector3.UP, random.randf() * TAU)
		var free: Vector3 = FreePlace.beside(place, needed, taken, along)
		var own: Rect2 = needed
		own.position += Vector2(free.x, free.z)
		for other: Rect2 in taken:
			check(not other.intersects(own), "%s meets %s." % [own, other])
		check_equal(free.y, place.y, "its height")
		check(absf((free - place).dot(along.cross(Vector3.UP))) < 1e-3, "It is not aside.")
		if taken.is_empty():
			check_equal(free, place, "a place that is free")
