@tool
extends "wood_tool.gd"
## Grows new wood: to the right of the view, as in the paper, or towards where the mouse is dragged.

var _held: int = NO_NODE
var _pressed_at: Vector2
var _target: Vector3
var _dragged: bool = false


func get_id() -> StringName:
	return &"grow"


func get_title() -> String:
	return tr("Grow")


func get_tooltip() -> String:
	return tr(
		(
			"Drag from a node to grow a branch to where you let go, or click it to grow one to the right"
			+ " of the view. The new node is selected; the tool's key or Enter goes on from there."
		)
	)


func get_icon() -> String:
	return "res://addons/tree_reconstruction/icons/tools/grow.svg"


func get_key() -> Key:
	return KEY_N


func get_defaults() -> Dictionary[StringName, Variant]:
	return {&"length": 0.0, &"count": 3}


func make_settings() -> Control:
	_restore()
	var strip: Strip = Strip.new()
	strip.add_number(
		tr("Length of a click (m)"),
		tr("How long the wood of a click is. 0: as long as the wood below it."),
		0.0,
		2.0,
		0.01,
		values[&"length"],
		set_setting.bind(&"length")
	)
	strip.add_number(
		tr("Nodes of a drag"),
		tr("How many nodes share the way of a drag."),
		1,
		20,
		1,
		values[&"count"],
		_on_count_changed
	)
	return strip


func get_command_at(id: int) -> String:
	return (
		"grow node=%d direction=%s length=%s"
		% [id, words_of(view_direction(Vector3.RIGHT)), String.num(values[&"length"], 4)]
	)


func is_busy() -> bool:
	return _held != NO_NODE


func cancel() -> void:
	_held = NO_NODE
	_dragged = false
	_queue()


func _press(button: InputEventMouseButton) -> bool:
	var id: int = pick()
	if id == NO_NODE:
		return false
	_held = id
	_pressed_at = button.position
	_dragged = false
	return true


func _move(motion: InputEventMouseMotion) -> bool:
	if not is_busy():
		return false
	if not motion.button_mask & MOUSE_BUTTON_MASK_LEFT:
		cancel()
		return false
	if motion.position.distance_to(_pressed_at) >= DRAG_FROM * get_scale():
		_dragged = true
	if _dragged:
		_target = place_at(motion.position, session.tree.get_node_position(_held))
		_queue()
	return true


func _release(_button: InputEventMouseButton) -> bool:
	if not is_busy():
		return false
	var command: String = _command_of_drag() if _dragged else get_command_at(_held)
	_held = NO_NODE
	_dragged = false
	if session.tree != null:
		_finish(session.run(get_title(), command))
	return true


## From the active node alone: it goes on from there.
func accept() -> bool:
	var active: int = session.get_active()
	if active == NO_NODE or session.tree == null:
		return false
	_click(active)
	return true


func _finish(edit: TreeEdit) -> void:
	if edit != null and not edit.get_result_nodes().is_empty():
		session.select([edit.get_result_nodes()[-1]])
	super(edit)


func _look_again() -> void:
	if _dragged and session.tree.has_node(_held):
		show_command(_command_of_drag())
	else:
		super()


func _command_of_drag() -> String:
	var way: Vector3 = _target - session.tree.get_node_position(_held)
	return (
		"grow node=%d direction=%s length=%s count=%d"
		% [_held, words_of(way), String.num(way.length(), 6), values[&"count"]]
	)


func _on_count_changed(value: float) -> void:
	set_setting(int(value), &"count")
