extends "./view_suite.gd"
## The viewport's part of the editor, without an editor: finding nodes on the screen, selecting by
## mouse events, keys, and what is drawn.


func test_nodes_are_found_where_they_are_seen() -> void:
	_open(grown_tree(3))
	var id: int = _lone_node()
	check(id >= 0, "No node stands alone.")
	var at: Vector2 = _session.picker.project(_camera, id)
	var place: Vector3 = _session.node.global_transform * _session.tree.get_node_position(id)
	check(at.distance_to(_camera.unproject_position(place)) < 0.1, "It is seen elsewhere.")
	check_equal(_session.picker.pick(_camera, at), id, "the node there")
	check_equal(_session.picker.pick(_camera, _nothing()), -1, "the node far from wood")
	check_equal(
		_session.picker.project_place(_camera, Vector3(0, 0, 900)), Vector2.INF, "behind the camera"
	)
	var through: Vector3 = _session.tree.get_node_position(id)
	check(
		_session.picker.ray_plane(_camera, at, through).distance_to(through) < 0.002,
		"The ray misses the node."
	)
	var beside: Vector3 = _session.picker.ray_plane(_camera, at + Vector2(50, 20), through)
	check(
		_session.picker.project_place(_camera, beside).distance_to(at + Vector2(50, 20)) < 0.1,
		"The ray goes elsewhere."
	)
	# A metre to the side of the view is as many pixels as it is said to be.
	var side: Vector3 = _session.node.global_basis.inverse() * _camera.global_basis.x
	var metre: Vector2 = _session.picker.project_place(_camera, through + side.normalized()) - at
	check_near(
		metre.length() / _session.picker.pixels_per_metre(_camera, through), 1.0, 0.01, "a metre"
	)
	_close()


func test_clicks_select() -> void:
	_open(grown_tree(3))
	var id: int = _lone_node()
	var at: Vector2 = _session.picker.project(_camera, id)
	check_equal(_router.input(_camera, _button(at, true)), STOP, "the answer to a press on wood")
	_router.input(_camera, _button(at, false))
	check_equal(_session.selection, PackedInt32Array([id]), "the selection")
	var other: int = _session.tree.get_root()
	_session.select([other])
	var adding: InputEventMouseButton = _button(at, true)
	adding.shift_pressed = true
	_router.input(_camera, adding)
	check_equal(_session.selection, PackedInt32Array([other, id]), "the selection with Shift")
	var toggling: InputEventMouseButton = _button(at, true)
	toggling.ctrl_pressed = true
	_router.input(_camera, toggling)
	check_equal(_session.selection, PackedInt32Array([other]), "the selection with Ctrl")
	_router.input(_camera, _button(at, true, true))
	var wanted: PackedInt32Array = _session.tree.select_nodes("below:%d" % id)
	var got: PackedInt32Array = _session.selection.duplicate()
	check_equal(_session.get_active(), id, "the active node after a double click")
	wanted.sort()
	got.sort()
	check_equal(got, wanted, "the selection after a double click")
	check(_given_back.is_empty(), "A click on wood went to the editor, too.")
	check_equal(_undo.get_history_count(), 0, "steps of the history")
	_close()


func test_a_box_selects_what_is_in_it() -> void:
	_open(grown_tree(3))
	var redraws: Array[int] = [0]
	_session.tool.changed.connect(func() -> void: redraws[0] += 1)
	check_equal(_router.input(_camera, _button(Vector2(5, 5), true)), STOP, "the press")
	check_equal(_router.input(_camera, _motion(Vector2(400, 300))), STOP, "the drag")
	check(redraws[0] > 0, "The box isn't drawn.")
	_router.input(_camera, _button(Vector2(400, 300), false))
	check(_session.selection.size() > 3, "Hardly anything is selected.")
	check(_given_back.is_empty(), "The box was a click.")
	for id: int in _session.tree.get_node_ids():
		var at: Vector2 = _session.picker.project(_camera, id)
		check_equal(
			id in _session.selection,
			Rect2(5, 5, 395, 295).has_point(at),
			"whether node %d at %s is selected" % [id, at]
		)
	# Escape ends a box; the next release is nobody's.
	_router.input(_camera, _button(Vector2(5, 5), true))
	_router.input(_camera, _motion(Vector2(700, 500)))
	var before: PackedInt32Array = _session.selection
	check_equal(_router.input(_camera, _key(KEY_ESCAPE)), STOP, "Escape")
	_router.input(_camera, _button(Vector2(700, 500), false))
	check_equal(_session.selection, before, "the selection after Escape")
	_close()


func test_hovering_looks_once_a_frame() -> void:
	_open(grown_tree(3))
	var id: int = _lone_node()
	var changes: Array[int] = [0]
	_session.hover_changed.connect(func() -> void: changes[0] += 1)
	var motion: InputEventMouseMotion = InputEventMouseMotion.new()
	for at: Vector2 in [Vector2(3, 3), _session.picker.project(_camera, id)]:
		motion.position = at
		check_equal(_router.input(_camera, motion), PASS, "a motion")
	check_equal(_session.hovered, -1, "what is hovered before the frame ends")
	_router.update()
	check_equal(_session.hovered, id, "what is hovered")
	check_equal(changes[0], 1, "changes")
	_session.view.editing = false
	_router.input(_camera, motion)
	_router.update()
	check_equal(_session.hovered, -1, "what is hovered while not editing")
	_close()


func test_no_key_is_taken_twice() -> void:
	_open(grown_tree(3, 20))
	var taken: Dictionary[String, StringName] = {}
	for action: StringName in _shortcuts.get_actions():
		for event: InputEventKey in _shortcuts.get_shortcut(action).events:
			var key: String = event.as_text()
			check(not taken.has(key), "%s is for %s and %s" % [key, taken.get(key), action])
			taken[key] = action
			check_equal(_shortcuts.find(_pressed(event)), action, "what %s does" % key)
	check(taken.size() > 20, "There are %d keys." % taken.size())
	for id: StringName in _session.tools:
		check(not _shortcuts.get_key_text(Shortcuts.name_of_tool(id)).is_empty(), "%s: no key" % id)
	_close()


# A place beside a lone node's wood that no click finds, though it is close to it.
# The editor zooms by the end of a turn as well as by its begin.
func test_what_is_seen_well_needs_no_other_view() -> void:
	_open(grown_tree(3))
	var views: CameraViews = CameraViews.new(_session)
	var id: int = _lone_node()
	var branch: PackedInt32Array = _session.tree.select_nodes("below:%d" % id)
	var box: AABB = _session.get_box_of(branch)
	for node: int in branch:
		check(
			box.grow(1e-4).has_point(_session.tree.get_node_position(node)),
			"The box leaves node %d out." % node
		)
	var joint: int = _session.tree.get_node_parent(id)
	check(box.grow(1e-4).has_point(_session.tree.get_node_position(joint)), "And the joint.")
	check_equal(_session.get_box_of([]), _session.tree.get_aabb(), "the box of nothing")
	var middle: Vector3 = _session.node.global_transform * box.get_center()
	var reach: float = views.get_reach(box) * 1.2
	var way: Vector3 = Vector3(0.3, 0.2, 1.0).normalized()
	var near: float = 2.5 * reach / tan(deg_to_rad(_camera.fov) * 0.5)
	_camera.look_at_from_position(middle + way * near, middle)
	check(views.is_well_seen(box, _camera), "It is in the middle of the picture.")
	_camera.look_at_from_position(middle + way * near * 8.0, middle)
	check(not views.is_well_seen(box, _camera), "It is far away.")
	_camera.look_at_from_position(middle + way * near * 0.3, middle)
	check(not views.is_well_seen(box, _camera), "It is larger than the picture.")
	_camera.look_at_from_position(middle + way * near, middle + way * near * 2.0)
	check(not views.is_well_seen(box, _camera), "It is behind the camera.")
	_camera.look_at_from_position(middle + way * near, middle)
	_camera.translate_object_local(Vector3(reach * 2.6, 0, 0))
	check(not views.is_well_seen(box, _camera), "It is at the border.")
	_close()


func _pressed(like: InputEventKey) -> InputEventKey:
	var event: InputEventKey = _key(like.keycode)
	event.ctrl_pressed = like.command_or_control_autoremap
	return event


func test_keys_do_what_they_say() -> void:
	_open(grown_tree(3))
	var actions: Actions = Actions.new(_session)
	_router.asked.connect(func(action: StringName) -> void: actions.run(action, _camera))
	for action: StringName in Actions.SHOWN:
		var property: StringName = Actions.SHOWN[action]
		var before: bool = _session.view.get(property)
		var event: InputEventKey = _shortcuts.get_shortcut(action).events[0]
		check_equal(_router.input(_camera, _pressed(event)), STOP, "the answer to %s" % action)
		check_equal(_session.view.get(property), not before, "%s" % property)
		_router.input(_camera, _pressed(event))
		check_equal(_session.view.get(property), before, "%s again" % property)
	var all: InputEventKey = _key(KEY_A)
	all.ctrl_pressed = true
	_router.input(_camera, all)
	check_equal(_session.selection.size(), _session.tree.get_node_count(), "all selected")
	check_equal(_router.input(_camera, _key(KEY_ESCAPE)), STOP, "Escape with a selection")
	check(_session.selection.is_empty(), "Escape left something selected.")
	check_equal(_router.input(_camera, _key(KEY_ESCAPE)), PASS, "Escape with nothing to cancel")
	var said: PackedStringArray = []
	_session.said.connect(func(sentence: String, _kind: int) -> void: said.append(sentence))
	check_equal(_router.input(_camera, _key(KEY_DELETE)), STOP, "Delete without a selection")
	check_sentence(said[0], "what is said then")
	var id: int = _lone_node()
	_session.select([id])
	_router.input(_camera, _key(KEY_DELETE))
	check(not _session.tree.has_node(id), "Delete left the node.")
	check_equal(_undo.get_history_count(), 1, "steps")
	_undo.undo()
	check(_session.tree.has_node(id), "Undo did not bring it back.")
	_router.input(_camera, _key(KEY_TAB))
	check(not _session.view.editing, "Tab does not end editing.")
	_router.input(_camera, _key(KEY_TAB))
	check(_session.view.editing, "Tab does not begin editing.")
	_close()


func test_only_what_changed_is_built_again() -> void:
	_open(grown_tree(3))
	var view: SkeletonView = SkeletonView.new(_session)
	view.update_tree()
	view.update_selection()
	var lines: ArrayMesh = view.layers[0].mesh
	var count: int = _session.tree.get_node_count()
	check_equal(lines.surface_get_array_len(0), 4 * (count - 1), "corners")
	var surfaces: Array[int] = [0]
	lines.changed.connect(func() -> void: surfaces[0] += 1)
	view.update_tree()
	_session.select([5])
	view.update_selection()
	_session.tree.leaf_size = 0.4
	view.update_tree()
	check_equal(surfaces[0], 0, "changes of the lines without an edit")
	_session.run("Cut", "remove nodes=%d" % _session.tree.get_leaves()[0])
	view.update_tree()
	check(surfaces[0] > 0, "An edit doesn't change the lines.")
	check_equal(lines.surface_get_array_len(0), 4 * (count - 2), "corners after an edit")
	_session.view.skeleton = false
	view.update_tree()
	check(not view.layers[0].shown, "The skeleton is shown.")
	_close()


func test_the_scan_is_drawn_in_three_colours() -> void:
	_open(grown_tree(3))
	var view: PointView = PointView.new(_session)
	view.update()
	check(not view.layer.shown, "Points are shown that there are none of.")
	_session.scan.points = [Vector3.ZERO, Vector3(0, 2, 0), Vector3(0, 1, 1)]
	_session.view.points = true
	view.update()
	check(view.layer.shown, "No points are shown.")
	var material: ShaderMaterial = view.layer.material
	check(material.get_shader_parameter(&"by_height"), "Points without colours aren't coloured.")
	check_equal(material.get_shader_parameter(&"high"), 2.0, "the highest point")
	_session.scan.colors = [Color.RED, Color.GREEN, Color.BLUE]
	view.rebuild()
	check(not material.get_shader_parameter(&"by_height"), "The scan's colours aren't used.")
	check_equal(view.layer.mesh.surface_get_arrays(0)[Mesh.ARRAY_COLOR][1], Color.GREEN, "a colour")
	_session.view.point_colors = ViewState.PointColors.HEIGHT
	_session.view.point_size = 5.0
	view.update()
	check(material.get_shader_parameter(&"by_height"), "They aren't coloured by height.")
	check_equal(material.get_shader_parameter(&"size"), 5.0, "their size")
	_session.scan.points = PackedVector3Array()
	view.rebuild()
	check(not view.layer.shown, "Points that went are shown.")
	_session.view.points = false
	_close()


func test_axes_and_grid_reach_around_the_tree() -> void:
	_open(grown_tree(3))
	var view: AxesGrid = AxesGrid.new(_session)
	_session.view.axes = true
	_session.view.grid = true
	view.update()
	var box: AABB = _session.tree.get_aabb()
	for layer: RefCounted in view.layers:
		check(layer.shown and layer.mesh.get_surface_count() == 1, "A layer isn't shown.")
	var grid: AABB = view.layers[0].mesh.get_aabb()
	check(grid.position.x <= box.position.x and grid.end.z >= box.end.z, "The grid is too small.")
	check(view.height >= box.end.y, "The scale ends below the tree's top.")
	_session.view.axes = false
	_session.view.grid = false
	view.update()
	for layer: RefCounted in view.layers:
		check(not layer.shown, "A layer is still shown.")
	_close()


func test_a_scan_that_is_not_there_is_told_of_once() -> void:
	_open(grown_tree(3))
	var said: Array[String] = []
	_session.said.connect(func(sentence: String, _kind: int) -> void: said.append(sentence))
	var view: PointView = PointView.new(_session)
	_session.view.points = true
	for colors: int in [0, 2, 2]:
		_session.view.point_colors = colors as ViewState.PointColors
		view.update()
	check_equal(said.size(), 1, "sentences while an edit follows another")
	check_sentence(said[0], "what is said of a tree without a scan")
	_session.view.points = false
	view.update()
	_session.view.points = true
	view.update()
	check_equal(said.size(), 2, "sentences after it was asked for again")
	_close()
