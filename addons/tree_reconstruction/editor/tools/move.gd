@tool
extends "wood_tool.gd"
## Moves nodes with the mouse: in the plane of the view, or along its axis.

const _WHEEL_FACTOR: float = 1.15
const _LEAST_FALLOFF: float = 0.05

# The pressed node, and where it was.
var _held: int = NO_NODE
var _place: Vector3
var _pressed_at: Vector2
var _last_at: Vector2
var _by: Vector3
# X, Y or Z: it moves along this one alone.
var _axis: Vector3
var _nodes: String
var _moved: bool = false
var _was_selected: bool = false
# The command of the drag so far.
var _done: String = ""


func get_id() -> StringName:
	return &"move"


func get_title() -> String:
	return tr("Move")


func get_tooltip() -> String:
	return tr(
		(
			"Drag a node to move it, with what grows from it unless you say otherwise below."
			+ " Hold Ctrl to move it towards you or away, press X, Y or Z to keep to an axis,"
			+ " and turn the wheel while dragging to bend more or less of the wood around it."
		)
	)


func get_icon() -> String:
	return "ToolMove"


func get_key() -> Key:
	return KEY_W


func get_defaults() -> Dictionary[StringName, Variant]:
	return {&"subtree": true, &"falloff": 0.0}


func make_settings() -> Control:
	_restore()
	var strip: Strip = Strip.new()
	strip.add_choice(
		"",
		tr("Whether what grows from a moved node goes with it."),
		[tr("With what grows from it"), tr("The node alone")],
		0 if values[&"subtree"] else 1,
		_on_subtree_chosen
	)
	strip.add_number(
		tr("Falloff (m)"),
		tr(
			"Within so many metres along the wood the rest follows, less and less. 0: nothing else."
		),
		0.0,
		5.0,
		0.01,
		values[&"falloff"],
		set_setting.bind(&"falloff")
	)
	return strip


func is_busy() -> bool:
	return _held != NO_NODE


func cancel() -> void:
	if _moved:
		session.cancel_drag()
	_let_go()


func _press(button: InputEventMouseButton) -> bool:
	var id: int = pick()
	if id == NO_NODE:
		return false
	_was_selected = id in session.selection
	var more: bool = button.shift_pressed or button.is_command_or_control_pressed()
	if more or not _was_selected:
		session.select([id], session.How.ADD if more else session.How.REPLACE)
	_held = id
	_place = session.tree.get_node_position(id)
	_pressed_at = button.position
	_last_at = button.position
	_nodes = session.get_selection_words()
	return true


func _move(motion: InputEventMouseMotion) -> bool:
	if _held == NO_NODE:
		return false
	if not motion.button_mask & MOUSE_BUTTON_MASK_LEFT:
		# It was released where the viewport didn't see it.
		_finish_drag()
		return false
	if not _moved:
		if motion.position.distance_to(_pressed_at) < DRAG_FROM * get_scale():
			return true
		_moved = true
		session.begin_drag(get_title())
	var place: Vector3 = _place + _by
	if motion.is_command_or_control_pressed():
		# Up is away.
		var way: float = (_last_at.y - motion.position.y) / pixels_per_metre(place)
		_by += view_direction(Vector3.FORWARD) * way
	else:
		_by += place_at(motion.position, place) - place_at(_last_at, place)
	_last_at = motion.position
	_queue()
	return true


func _wheel(steps: int, _button: InputEventMouseButton) -> bool:
	if not is_busy():
		return false
	var falloff: float = maxf(values[&"falloff"], _LEAST_FALLOFF) * _WHEEL_FACTOR ** steps
	values[&"falloff"] = 0.0 if falloff < _LEAST_FALLOFF else minf(falloff, 100.0)
	_queue()
	changed.emit()
	return true


func _press_key(key: InputEventKey) -> bool:
	if not is_busy() or not key.keycode in [KEY_X, KEY_Y, KEY_Z]:
		return false
	var axis: Vector3 = Vector3.ZERO
	axis[key.keycode - KEY_X] = 1.0
	_axis = Vector3.ZERO if axis == _axis else axis
	_queue()
	return true


func _release(button: InputEventMouseButton) -> bool:
	if not is_busy():
		return false
	if not _moved and _was_selected:
		# A click: as the Select tool has it.
		if button.is_command_or_control_pressed():
			session.select([_held], session.How.REMOVE)
		elif not button.shift_pressed:
			session.select([_held])
	_finish_drag()
	return true


## Nothing is done to the selection without a drag.
func accept() -> bool:
	if is_busy():
		_finish_drag()
	return false


func _look_again() -> void:
	if not _moved:
		return
	if not session.is_dragging():
		# Something else was done meanwhile.
		_let_go()
		return
	var command: String = (
		"move nodes=%s by=%s with=%s falloff=%s"
		% [
			_nodes,
			words_of(_by if _axis == Vector3.ZERO else _by.project(_axis)),
			"subtree" if values[&"subtree"] else "alone",
			String.num(values[&"falloff"], 4)
		]
	)
	if command != _done:
		_done = command
		session.drag(command)
		changed.emit()


func draw(overlay: Control) -> void:
	super(overlay)
	var falloff: float = values.get(&"falloff", 0.0)
	if not is_busy() or not is_seen_on(overlay) or falloff <= 0.0:
		return
	var place: Vector3 = session.tree.get_node_position(_held)
	overlay.draw_arc(
		seen_at(place),
		falloff * pixels_per_metre(place),
		0.0,
		TAU,
		64,
		MEANT,
		2.0 * get_scale(),
		true
	)


func _finish_drag() -> void:
	if _moved:
		_look_again()
		session.end_drag()
	_let_go()


func _let_go() -> void:
	_held = NO_NODE
	_moved = false
	_by = Vector3.ZERO
	_axis = Vector3.ZERO
	_done = ""
	changed.emit()


func _on_subtree_chosen(index: int) -> void:
	set_setting(index == 0, &"subtree")
