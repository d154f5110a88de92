extends "./tools_suite.gd"
## The viewport's tools, driven as the viewport does it: by mouse and key events and a camera.

const Slice := preload("res://addons/tree_reconstruction/editor/tools/slice.gd")


# Every tool has its words and controls, and no key twice.
func test_tools_tell_what_they_do() -> void:
	_begin(grown_tree(1), &"")
	var keys: Array[int] = []
	for id: StringName in _session.tools:
		var tool: RefCounted = _session.tools[id]
		check_equal(tool.call(&"get_id"), id, "the id")
		check(not (tool.call(&"get_title") as String).is_empty(), "%s has no title." % id)
		check_sentence(tool.call(&"get_tooltip"), "the tooltip of %s" % id)
		var key: int = tool.call(&"get_key")
		check(key != KEY_NONE and not key in keys, "The key of %s is missing or taken." % id)
		keys.append(key)
		var icon: String = tool.call(&"get_icon")
		check(
			not icon.begins_with("res://") or ResourceLoader.exists(icon), "No picture %s." % icon
		)
		_session.choose(id)
		var strip: Control = tool.call(&"make_settings")
		if strip != null:
			tree.root.add_child(strip)
			_check_tooltips(strip, id)
			await _frame()
			strip.free()
		await _frame()
		_check_untouched("choosing %s" % id)
	check(_session.tools.size() >= 14, "There are %d tools." % _session.tools.size())
	_end()


func _check_tooltips(control: Control, id: StringName) -> void:
	for child: Node in control.get_children():
		var of: Control = child as Control
		if of is Range or of is BaseButton or of is LineEdit:
			check(not of.tooltip_text.is_empty(), "%s in %s has no tooltip." % [of, id])
		elif of is Container:
			_check_tooltips(of, id)


# A click on the sky, the wheel there and Escape are the editor's.
func test_what_is_nothing_is_left_to_the_editor() -> void:
	_begin(grown_tree(2), &"")
	var sky: Vector2 = Vector2(6, 6)
	check_equal(_session.picker.pick(_camera, sky), NO_NODE, "what is in the corner")
	for id: StringName in _session.tools:
		_session.choose(id)
		await _frame()
		_hover(sky)
		# A line may begin anywhere; a box too, and the Select tool hands a click on. So does Draw a
		# Branch, whose stroke may begin beside the wood.
		if id not in [&"slice", &"select", &"draw_branch"]:
			check(not _click(sky), "%s takes a click on nothing." % id)
		check(not _wheel(sky, MOUSE_BUTTON_WHEEL_UP), "%s takes the wheel." % id)
		check(not _button(sky, true, MOUSE_BUTTON_RIGHT), "%s takes the right button." % id)
		check(not _button(sky, true, MOUSE_BUTTON_MIDDLE), "%s takes the middle button." % id)
		check(not _key(KEY_ESCAPE), "%s takes Escape with nothing to cancel." % id)
		check(not _key(KEY_F), "%s takes F." % id)
		await _frame()
		_check_untouched("nothing with %s" % id)
	_end()


# Each tool that a click is enough for.
func test_a_click_is_one_step() -> void:
	for id: StringName in [
		&"prune", &"cut", &"grow", &"twig_left", &"twig_right", &"graft", &"smooth", &"simplify"
	]:
		_begin(grown_tree(3), id)
		await _frame()
		var node: int = _find(_has_two_above)
		_hover(_at(node))
		await _frame()
		var ghosts: Array = _session.tool.call(&"get_ghosts")
		check(not ghosts.is_empty(), "%s shows nothing before the click." % id)
		if not ghosts.is_empty():
			var lines: PackedVector3Array = ghosts[Mesh.ARRAY_VERTEX]
			var colors: PackedColorArray = ghosts[Mesh.ARRAY_COLOR]
			check_equal(lines.size() % 2, 0, "half lines of %s" % id)
			check_equal(colors.size(), lines.size(), "colours of %s" % id)
		_check_untouched("hovering with %s" % id)
		var at: Vector2 = _at(node)
		check(_click(at), "%s leaves a click on wood." % id)
		await _frame()
		ghosts = _session.tool.call(&"get_ghosts")
		check(ghosts.is_empty(), "%s hides what it did behind what it would do." % id)
		_hover(at + Vector2(1, 1))
		await _frame()
		ghosts = _session.tool.call(&"get_ghosts")
		check(ghosts.is_empty(), "A mouse at rest shows ghosts of %s." % id)
		_check_one_step(id)
		_session.choose(&"")
		check((_session.tools[id].call(&"get_ghosts") as Array).is_empty(), "%s left ghosts." % id)
		_end()


# Enter, and the tool's own key, do it to what is selected.
func test_enter_takes_the_selection() -> void:
	for id: StringName in [&"prune", &"cut", &"twig_left", &"graft", &"smooth", &"simplify"]:
		for key: int in [KEY_ENTER, KEY_NONE]:
			_begin(grown_tree(4), id)
			await _frame()
			check(not _key(KEY_ENTER), "%s takes Enter without a selection." % id)
			var some: PackedInt32Array = []
			var inner: PackedInt32Array = _made.select_nodes("!leaves&!trunk")
			for i: int in range(0, 60, 12):
				some.append(inner[i])
			_session.select(some)
			await _frame()
			var own: int = _session.tool.call(&"get_key")
			check(_key(key if key != KEY_NONE else own), "%s leaves the key." % id)
			await _frame()
			_check_one_step("%s of the selection" % id)
			_end()


func test_twigs_grow_at_once_to_their_side() -> void:
	for left: bool in [true, false]:
		_begin(grown_tree(5), &"")
		_session.choose(&"move")
		_hover(Vector2(3, 3))
		var host: int = _find(_is_middle)
		_session.select([host])
		_session.choose(&"twig_left" if left else &"twig_right")
		await _frame()
		_check_one_step("choosing the tool")
		var twig: int = _session.get_active()
		check(twig != host and _made.has_node(twig), "The twig is not selected.")
		check_equal(_made.get_node_parent(twig), host, "the twig's parent")
		check(
			(_at(twig).x < _at(host).x) == left,
			"It went from %v to %v, left: %s." % [_at(host), _at(twig), left]
		)
		_end()


func test_a_node_follows_the_mouse() -> void:
	_begin(grown_tree(6), &"move")
	var id: int = _find(_is_tip)
	var from: Vector2 = _at(id)
	check(_button(from, true), "The press was left.")
	for i: int in range(1, 6):
		check(_hover(from + Vector2(12, -6) * i, true), "The drag was left.")
		await _frame()
	var to: Vector2 = from + Vector2(60, -30)
	check(_at(id).distance_to(to) < 0.5, "It is at %v instead of %v." % [_at(id), to])
	check_equal(_undo.get_history_count(), 0, "steps before the release")
	check(_button(to, false), "The release was left.")
	_check_one_step("a drag")
	check_equal(_session.selection, PackedInt32Array([id]), "the selection")
	check_equal(_made.edit_log.split("\n", false).size(), 3, "lines of the log")
	_end()


func test_a_drag_is_taken_back() -> void:
	for key: bool in [true, false]:
		_begin(grown_tree(7), &"move")
		var id: int = _find(_is_middle)
		_button(_at(id), true)
		_hover(_at(id) + Vector2(30, 30), true)
		await _frame()
		check(_made.skeleton != _before, "Nothing moved.")
		if key:
			check(_key(KEY_ESCAPE), "Escape was left.")
		else:
			check(_button(_at(id), true, MOUSE_BUTTON_RIGHT), "The right button was left.")
		await _frame()
		_check_untouched("a cancelled drag")
		# The button is still down.
		_hover(Vector2(200, 200), true)
		_button(Vector2(200, 200), false)
		await _frame()
		_check_untouched("what followed it")
		_end()


func test_no_other_key_reaches_the_editor_while_something_is_dragged() -> void:
	_begin(grown_tree(7), &"move")
	var id: int = _find(_is_middle)
	check(not _key(KEY_Z), "Z is taken without a drag.")
	_button(_at(id), true)
	_hover(_at(id) + Vector2(30, 30), true)
	check(_key(KEY_Z), "The editor may undo in the middle of a drag.")
	_button(_at(id), false)
	check(not _key(KEY_Z), "Z is taken after the drag.")
	_check_one_step("the drag")
	_end()


func test_ctrl_moves_along_the_view_and_keys_along_axes() -> void:
	_begin(grown_tree(8), &"move")
	var id: int = _find(_is_tip)
	var place: Vector3 = _made.get_node_position(id)
	var seen: Vector2 = _at(id)
	_button(seen, true)
	_hover(seen + Vector2(0, -10), true, true)
	_hover(seen + Vector2(0, -60), true, true)
	await _frame()
	var frame: Transform3D = _session.node.global_transform
	var moved: Vector3 = frame.basis * (_made.get_node_position(id) - place)
	var forward: Vector3 = -_camera.global_basis.z
	check(moved.dot(forward) > 0.05, "It did not go away: %v" % moved)
	check(moved.normalized().dot(forward) > 0.999, "It went aside: %v" % moved)
	_key(KEY_ESCAPE)
	seen = _at(id)
	_button(seen, true)
	_hover(seen + Vector2(40, 40), true)
	check(_key(KEY_Y), "Y was left while dragging.")
	await _frame()
	moved = _made.get_node_position(id) - place
	check(absf(moved.y) > 0.01 and absf(moved.x) + absf(moved.z) < 1e-6, "It went %v." % moved)
	_button(seen, false)
	_check_one_step("a move along an axis")
	check(not _key(KEY_Y), "Y is taken without a drag.")
	_end()


func test_falloff_takes_the_neighbours_along() -> void:
	_begin(grown_tree(9), &"move")
	_session.tool.get(&"values")[&"subtree"] = false
	var id: int = _find(_is_middle)
	var parent: int = _made.get_node_parent(id)
	var place: Vector3 = _made.get_node_position(parent)
	var seen: Vector2 = _at(id)
	_button(seen, true)
	_hover(seen + Vector2(50, 0), true)
	await _frame()
	check_equal(_made.get_node_position(parent), place, "the neighbour without falloff")
	for i: int in 24:
		check(_wheel(seen, MOUSE_BUTTON_WHEEL_UP), "The wheel was left.")
	await _frame()
	check(_made.get_node_position(parent) != place, "The neighbour stays with a falloff.")
	_button(seen + Vector2(50, 0), false)
	_check_one_step("a move with falloff")
	_end()


func test_grow_goes_where_it_is_drawn_and_on_from_there() -> void:
	_begin(grown_tree(10), &"grow")
	var id: int = _find(_is_tip)
	var target: Vector2 = _at(id) + Vector2(-40, -50)
	_button(_at(id), true)
	_hover(target, true)
	await _frame()
	check(not (_session.tool.call(&"get_ghosts") as Array).is_empty(), "Nothing is shown.")
	_check_untouched("drawing")
	_button(target, false)
	_check_one_step("growing")
	var tip: int = _session.get_active()
	check(_at(tip).distance_to(target) < 1.0, "It ends at %v, not %v." % [_at(tip), target])
	# As in the paper: on to the right of the view.
	check(_key(KEY_N), "The tool's key was left.")
	check_equal(_made.get_node_parent(_session.get_active()), tip, "where it goes on")
	check(_at(_session.get_active()).x > _at(tip).x + 1.0, "It did not grow to the right.")
	check_equal(_undo.get_history_count(), 2, "steps")
	var after: Dictionary = _made.skeleton
	_button(_at(tip), true)
	_hover(Vector2(40, 40), true)
	check(_key(KEY_ESCAPE), "Escape was left.")
	_button(Vector2(40, 40), false)
	await _frame()
	check_equal(_made.skeleton, after, "the tree after Escape")
	_end()


func test_a_whole_branch_is_cut_at_its_joint() -> void:
	_begin(grown_tree(11), &"cut")
	await _frame()
	var id: int = _find(
		func(node: int) -> bool: return _made.select_nodes("branch:%d" % node).find(node) > 1
	)
	var first: int = _made.select_nodes("branch:%d" % id)[0]
	_click(_at(id))
	check(_made.has_node(id) == false, "The clicked node stays.")
	check(not _made.has_node(first) or _made.is_trunk(first), "The branch's beginning stays.")
	_check_one_step("a cut")
	_end()


func test_what_is_picked_is_grafted() -> void:
	_begin(grown_tree(12), &"pick")
	await _frame()
	var picked: Array = []
	_session.string_picked.connect(func(text: String, id: int) -> void: picked.append([text, id]))
	var id: int = _find(_has_two_above)
	_hover(_at(id))
	await _frame()
	check(not (_session.tool.call(&"get_ghosts") as Array).is_empty(), "Nothing is shown.")
	check(_click(_at(id)), "The click was left.")
	check_equal(picked, [[_made.take_branch(id), id]], "what was picked")
	_check_untouched("picking")
	_session.choose(&"graft")
	await _frame()
	var tip: int = _find(_is_tip)
	_hover(_at(tip))
	await _frame()
	var ghosts: Array = _session.tool.call(&"get_ghosts")
	check(_wheel(_at(tip), MOUSE_BUTTON_WHEEL_DOWN), "The wheel was left.")
	await _frame()
	var others: Array = _session.tool.call(&"get_ghosts")
	check(ghosts[Mesh.ARRAY_VERTEX] != others[Mesh.ARRAY_VERTEX], "The wheel shows no other one.")
	check(_wheel(_at(tip), MOUSE_BUTTON_WHEEL_DOWN, true), "Ctrl and the wheel were left.")
	await _frame()
	var shown: PackedVector3Array = _session.tool.call(&"get_ghosts")[Mesh.ARRAY_VERTEX]
	check(shown != others[Mesh.ARRAY_VERTEX], "It was not rolled.")
	var count: int = _made.get_node_count()
	_click(_at(tip))
	check_equal(_made.get_node_count() - count, shown.size() / 2, "nodes that were grafted")
	_check_one_step("a graft")
	_end()


func test_the_whole_tree_by_the_buttons() -> void:
	for id: StringName in [&"prune", &"smooth", &"simplify"]:
		_begin(grown_tree(13), id)
		var strip: Control = _session.tool.call(&"make_settings")
		tree.root.add_child(strip)
		for child: Node in strip.get_children():
			if child is Button and "whole" in (child as Button).text:
				(child as Button).pressed.emit()
		await _frame()
		_check_one_step("%s for the whole tree" % id)
		strip.free()
		_end()


func test_a_line_cuts_what_lies_beyond_it() -> void:
	for backwards: bool in [false, true]:
		_begin(grown_tree(14), &"slice")
		var height: float = _at(_find(_has_two_above)).y
		var from: Vector2 = Vector2(770.0 if backwards else 30.0, height)
		var to: Vector2 = Vector2(800.0 - from.x, height)
		check(_button(from, true), "The press was left.")
		_hover(to, true)
		await _frame()
		check(not (_session.tool.call(&"get_ghosts") as Array).is_empty(), "Nothing is shown.")
		_button(to, false)
		await _frame()
		_check_untouched("drawing a line")
		check(not (_session.tool.call(&"get_ghosts") as Array).is_empty(), "Nothing would go.")
		check(_key(KEY_ENTER), "Enter was left.")
		var lower: int = 0
		for id: int in _made.get_node_ids():
			check(_at(id).y > height - 1.0, "Node %d stays above the line." % id)
			lower += int(_at(id).y > height + 1.0)
		check(lower > 1, "What lies below the line went.")
		_check_one_step("a cut along a line")
		_end()


func test_a_drawn_line_can_be_let_be() -> void:
	_begin(grown_tree(15), &"slice")
	_button(Vector2(30, 300), true)
	_hover(Vector2(700, 250), true)
	_button(Vector2(700, 250), false)
	await _frame()
	check(_key(KEY_ESCAPE), "Escape was left.")
	check(not _key(KEY_ENTER), "Enter was taken after Escape.")
	await _frame()
	check((_session.tool.call(&"get_ghosts") as Array).is_empty(), "Ghosts are left.")
	_click(Vector2(300, 300))
	check(not _key(KEY_ENTER), "A click without a drag made a line.")
	_check_untouched("a line that was let be")
	_end()


func test_a_rectangle_takes_what_it_shows() -> void:
	_begin(grown_tree(16), &"slice")
	_session.tool.get(&"values")[&"shape"] = 1
	var id: int = _find(_has_two_above)
	var from: Vector2 = _at(id) - Vector2(30, 30)
	_button(from, true)
	_hover(from + Vector2(60, 60), true)
	_button(from + Vector2(60, 60), false)
	await _frame()
	check(_key(KEY_ENTER), "Enter was left.")
	var left: PackedInt32Array = _session.picker.pick_rect(_camera, Rect2(from, Vector2(60, 60)))
	check(left.is_empty() or left == PackedInt32Array([_made.get_root()]), "Left: %s" % left)
	_check_one_step("a rectangle")
	_end()


func test_a_box_cuts_at_its_faces() -> void:
	_begin(grown_tree(18), &"slice")
	_session.tool.get(&"values")[&"shape"] = 2
	var middle: Vector2 = _at(_find(_has_two_above))
	_button(middle - Vector2(60, 60), true)
	_hover(middle + Vector2(40, 20), true)
	_button(middle + Vector2(40, 20), false)
	await _frame()
	var box: AABB = (_session.tool as Slice)._handles.box
	check(box.has_volume(), "No box was drawn.")
	var shown: PackedVector3Array = _session.tool.call(&"get_ghosts")[Mesh.ARRAY_VERTEX]
	for corner: int in 8:
		check(shown.has(box.get_endpoint(corner)), "A corner of the box is not shown.")
	var inside: int = 0
	for place: Vector3 in _made.get_positions():
		inside += int(box.has_point(place))
	check(inside > 3, "The box holds %d nodes." % inside)
	_check_untouched("drawing a box")
	check(_key(KEY_ENTER), "Enter was left.")
	for place: Vector3 in _made.get_positions():
		check(not box.grow(-1e-4).has_point(place), "%v stays in the box." % place)
	_check_one_step("a box")
	_end()


func test_leaves_change_while_a_slider_moves() -> void:
	_begin(grown_tree(17), &"leaf_rule")
	var tool: RefCounted = _session.tool
	var strip: Control = tool.call(&"make_settings")
	tree.root.add_child(strip)
	tool.call(&"choose_preset", "maple")
	check(_made.leaf_rule != null and _made.leaf_rule.look == "maple", "It has no maple leaves.")
	var size: float = _made.leaf_rule.leaf_size
	for i: int in range(1, 8):
		tool.call(&"set_rule", &"leaf_size", size + 0.05 * i)
	check_near(_made.leaf_rule.leaf_size, size + 0.35, 1e-6, "the size")
	check_equal(_undo.get_history_count(), 2, "steps")
	await _frame()
	_undo.undo()
	check_near(_made.leaf_rule.leaf_size, size, 1e-6, "the size after undo")
	await _frame()
	# The sliders follow, and make no step of it.
	check_equal(_undo.get_history_count(), 2, "steps after undo")
	check(_undo.has_redo(), "The slider's following was a step of its own.")
	_undo.undo()
	check(_made.leaf_rule == null, "The rule stays after undo.")
	await _frame()
	strip.free()
	_end()
