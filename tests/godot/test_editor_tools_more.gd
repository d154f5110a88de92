extends "./tools_suite.gd"
## What the Graft tool offers, and the box of the Slice tool.

const Slice := preload("res://addons/tree_reconstruction/editor/tools/slice.gd")
const BoxHandles := preload("res://addons/tree_reconstruction/editor/tools/box_handles.gd")


func _texts_of(choice: OptionButton) -> PackedStringArray:
	var texts: PackedStringArray = []
	for item: int in choice.item_count:
		texts.append(choice.get_item_text(item))
	return texts


func _find_scion(choice: OptionButton, scion: String) -> int:
	for item: int in choice.item_count:
		if choice.get_item_metadata(item) == scion:
			return item
	return -1


func test_branches_to_graft_are_chosen_from_a_list() -> void:
	_begin(grown_tree(12), &"pick")
	await _frame()
	var ids: PackedInt32Array = []
	for id: int in _made.select_nodes("order:1.."):
		if _made.select_nodes("below:%d" % id).size() > 3 and ids.size() < 2:
			ids.append(id)
	for id: int in ids:
		_session.select([id])
		check(_session.tool.call(&"accept"), "Node %d can't be picked." % id)
	var first: String = _made.take_branch(ids[0])
	var second: String = _made.take_branch(ids[1])
	_session.choose(&"graft")
	var strip: Control = _session.tool.call(&"make_settings")
	tree.root.add_child(strip)
	var choice: OptionButton = strip.find_children("*", "OptionButton", true, false)[0]
	check_equal(choice.get_selected_metadata(), second, "what is chosen")
	# A twig of the library, and back: what was picked is still there.
	for scion: String in ["twig=oak", first, "twig=birch", second]:
		var item: int = _find_scion(choice, scion)
		check(item >= 0, "%s isn't offered." % scion.left(30))
		choice.select(item)
		choice.item_selected.emit(item)
		await _frame()
		check_equal(_session.scion, scion, "what is grafted")
		check_equal(choice.get_selected_metadata(), scion, "what is shown")
	# The tree's own branches come when somebody looks.
	var before: int = choice.item_count
	choice.get_popup().about_to_popup.emit()
	check(choice.item_count > before + 2, "The tree's own branches are missing.")
	check_equal(choice.get_selected_metadata(), second, "what is chosen then")
	var own: int = _texts_of(choice).find("Of this tree") + 1
	check(own > 0, "There is no heading.")
	var sizes: Array[int] = []
	while choice.get_item_metadata(own) is String:
		var scion: String = choice.get_item_metadata(own)
		sizes.append(TreeReconstruction.measure_branch(scion)["node_count"])
		check(choice.get_item_icon(own) != null, "A branch has no picture.")
		check(not _made.check_edit('graft node=%d string="%s"' % [ids[0], scion]), "It is none.")
		own += 1
	var sorted: Array[int] = sizes.duplicate()
	sorted.sort()
	check(sizes == sorted and sizes.size() >= 2, "From small to large: %s" % [sizes])
	# To write one stays chosen while nothing else is.
	choice.select(choice.item_count - 1)
	choice.item_selected.emit(choice.item_count - 1)
	await _frame()
	check_equal(choice.selected, choice.item_count - 1, "what is chosen while one writes")
	var line: LineEdit = strip.find_children("*", "LineEdit", false, false)[0]
	check(line.visible, "One can't write.")
	line.text_submitted.emit("!(0.01) F(0.3) F(0.2)")
	await _frame()
	check_equal(choice.selected, choice.item_count - 1, "what is chosen once it is written")
	check_equal(_session.scion, "!(0.01) F(0.3) F(0.2)", "what was written")
	_check_untouched("choosing")
	strip.free()
	_end()


func _middle_of(face: int) -> Vector2:
	var handles: BoxHandles = (_session.tool as Slice)._handles
	return handles.get_seen(_session.tool, face)


func test_the_faces_of_a_box_are_dragged() -> void:
	_begin(grown_tree(14), &"slice")
	await _frame()
	var tool: Slice = _session.tool as Slice
	tool.set_setting(Slice.Shape.BOX, &"shape")
	var seen: Rect2 = Rect2(_at(_made.get_root()), Vector2.ZERO)
	for id: int in _made.get_node_ids():
		seen = seen.expand(_at(id))
	var from: Vector2 = seen.get_center()
	_button(from, true)
	_hover(seen.position - Vector2(20, 20), true)
	await _frame()
	_button(seen.position - Vector2(20, 20), false)
	await _frame()
	var handles: BoxHandles = tool._handles
	check(handles.has_box(), "There is no box.")
	# The view looks along z, nearly, so that the near face covers the one behind.
	for face: int in 4:
		check(_middle_of(face).is_finite(), "Face %d has no handle." % face)
	check(not _middle_of(4).is_finite(), "The handle of the far face is seen end on.")
	for face: int in 4:
		var before: AABB = handles.box
		var at: Vector2 = _middle_of(face)
		# Towards the middle of the box, by a third.
		var to: Vector2 = at.lerp(_middle_of(face ^ 1), 0.33)
		_hover(at)
		check_equal(handles.hovered, face, "the face under the mouse")
		check(_button(at, true), "The press on face %d was left." % face)
		check(_hover(to, true), "The drag was left.")
		await _frame()
		var axis: int = face >> 1
		var here: Vector2 = _middle_of(face)
		check(here.distance_to(to) < 3.0, "Face %d is at %v, not at %v." % [face, here, to])
		var opposite: float = before.position[axis] if face & 1 else before.end[axis]
		var now: float = handles.box.position[axis] if face & 1 else handles.box.end[axis]
		check_near(now, opposite, 1e-5, "the opposite face")
		for other: int in 3:
			if other != axis:
				check_near(handles.box.size[other], before.size[other], 1e-5, "another axis")
		# The right button lets it be; the box stays.
		check(_button(to, true, MOUSE_BUTTON_RIGHT), "The right button was left.")
		check(handles.box.is_equal_approx(before), "The face did not go back.")
		_button(to, false)
		_button(_middle_of(face), true)
		_hover(to, true)
		_button(to, false)
		check(handles.box.get_volume() < before.get_volume() * 0.75, "The face did not stay.")
		# Beyond the opposite face it does not go.
		_button(_middle_of(face), true)
		_hover(_middle_of(face).lerp(_middle_of(face ^ 1), 3.0), true)
		check(handles.has_box() and handles.box.size[axis] > 0.0, "The box is turned inside out.")
		_key(KEY_ESCAPE)
		check(handles.box.get_volume() > 0.0, "Escape took the whole box.")
		_button(at, false)
	_check_untouched("dragging faces")
	var box: AABB = handles.box
	check(not tool.get_ghosts().is_empty(), "Nothing is shown.")
	handles.box = _made.get_aabb().grow(0.1)
	handles.box.position.y += 0.5 * handles.box.size.y
	box = handles.box
	check(_key(KEY_ENTER), "Enter was left.")
	for id: int in _made.get_node_ids():
		check(not box.grow(-0.01).has_point(_made.get_node_position(id)), "Node %d is left." % id)
	check(not handles.has_box(), "The box is left.")
	_check_one_step("a box whose faces were dragged")
	_end()
