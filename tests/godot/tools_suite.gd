extends "./suite.gd"
## What files of tests of the viewport's tools extend: a session whose tools get mouse and key
## events as the viewport sends them.

const Session := preload("res://addons/tree_reconstruction/editor/session.gd")
const Picker := preload("res://addons/tree_reconstruction/editor/viewport/picker.gd")
const AllTools := preload("res://addons/tree_reconstruction/editor/tools/all_tools.gd")
const NO_NODE: int = TreeReconstruction.NO_NODE

var _undo: UndoRedo
var _said: PackedStringArray = []
var _viewport: SubViewport
var _camera: Camera3D
var _session: Session
var _made: TreeReconstruction
var _before: Dictionary


# A session whose tree a camera sees from the front.
func _begin(made: TreeReconstruction, tool: StringName) -> void:
	_undo = UndoRedo.new()
	_made = made
	_viewport = SubViewport.new()
	_viewport.size = Vector2i(800, 600)
	tree.root.add_child(_viewport)
	var node: TreeInstance3D = TreeInstance3D.new()
	node.reconstruction = made
	# Places of the tree and of the scene differ.
	node.transform = Transform3D(
		Basis(Vector3.UP, 0.4).scaled(Vector3.ONE * 1.5), Vector3(3, 1, -2)
	)
	_viewport.add_child(node)
	_camera = Camera3D.new()
	_viewport.add_child(_camera)
	var middle: Vector3 = node.global_transform * made.get_aabb().get_center()
	var size: float = made.get_aabb().size.length() * 1.5
	_camera.look_at_from_position(middle + Vector3(0.2, 0.1, 1.2) * size, middle)
	_camera.current = true
	_session = Session.new(_undo)
	_session.picker = Picker.new(_session)
	AllTools.add_to(_session)
	_session.said.connect(func(sentence: String, _kind: int) -> void: _said.append(sentence))
	_session.edit_node(node)
	_session.choose(tool)
	_before = made.skeleton


func _end() -> void:
	_session.choose(&"")
	_session.shut_down()
	_session.tools.clear()
	_session.picker = null
	_session = null
	_undo.clear_history()
	_undo.free()
	_viewport.free()


func _frame() -> void:
	await tree.process_frame
	_session.update()


# A node that is picked where it is seen, that `fits`.
func _find(fits: Callable) -> int:
	for id: int in _made.get_node_ids():
		if fits.call(id) and _session.picker.pick(_camera, _at(id)) == id:
			return id
	check(false, "There is no such node to click.")
	return NO_NODE


func _has_two_above(id: int) -> bool:
	return _made.select_nodes("below:%d" % id).size() > 3 and not _made.is_trunk(id)


func _is_tip(id: int) -> bool:
	return _made.get_node_children(id).is_empty()


func _is_middle(id: int) -> bool:
	return not _is_tip(id) and id != _made.get_root()


func _at(id: int) -> Vector2:
	return _session.picker.project(_camera, id)


func _button(at: Vector2, down: bool, index: MouseButton = MOUSE_BUTTON_LEFT) -> bool:
	var event: InputEventMouseButton = InputEventMouseButton.new()
	event.button_index = index
	event.pressed = down
	event.position = at
	return _session.tool.call(&"input", _camera, event)


func _click(at: Vector2) -> bool:
	var taken: bool = _button(at, true)
	_button(at, false)
	return taken


# As the viewport's router does it.
func _hover(at: Vector2, held: bool = false, ctrl: bool = false) -> bool:
	var event: InputEventMouseMotion = InputEventMouseMotion.new()
	event.position = at
	event.button_mask = MOUSE_BUTTON_MASK_LEFT if held else 0
	event.ctrl_pressed = ctrl
	var taken: bool = _session.tool.call(&"input", _camera, event)
	if not held:
		_session.hovered = _session.picker.pick(_camera, at)
	return taken


func _wheel(at: Vector2, index: MouseButton, ctrl: bool = false) -> bool:
	var event: InputEventMouseButton = InputEventMouseButton.new()
	event.button_index = index
	event.pressed = true
	event.position = at
	event.ctrl_pressed = ctrl
	return _session.tool.call(&"input", _camera, event)


func _key(code: Key) -> bool:
	var event: InputEventKey = InputEventKey.new()
	event.keycode = code
	event.pressed = true
	return _session.tool.call(&"input", _camera, event)


# What was done is one step, and undone to the same bytes.
func _check_one_step(what: String) -> void:
	check_equal(_undo.get_history_count(), 1, "steps of " + what)
	var after: Dictionary = _made.skeleton
	check(after != _before, "Nothing came of %s: %s" % [what, _said])
	_undo.undo()
	check_equal(_made.skeleton, _before, "the skeleton after undoing " + what)
	_undo.redo()
	check_equal(_made.skeleton, after, "the skeleton after redoing " + what)


func _check_untouched(what: String) -> void:
	check_equal(_undo.get_history_count(), 0, "steps of " + what)
	check_equal(_made.skeleton, _before, "the skeleton after " + what)
