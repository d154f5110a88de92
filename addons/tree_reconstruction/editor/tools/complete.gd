@tool
extends "wood_tool.gd"
## Finds a branch that the reconstruction missed: the user points at it (Zhang 2013, 8.2).

const Search := preload("branch_search.gd")

var _held: int = NO_NODE
var _pressed_at: Vector2
var _dragged: bool = false
var _search: Search


func get_id() -> StringName:
	return &"complete"


func get_title() -> String:
	return tr("Complete")


func get_tooltip() -> String:
	return tr(
		(
			"Drag from a node towards a branch that the scan shows and the tree lacks, and let go:"
			+ " it is found among the scan's points. Press P to see them."
		)
	)


func get_icon() -> String:
	return "res://addons/tree_reconstruction/icons/tools/complete.svg"


func get_key() -> Key:
	return KEY_H


func get_defaults() -> Dictionary[StringName, Variant]:
	return {&"reach": 0.0, &"angle": 35.0}


func make_settings() -> Control:
	_restore()
	var strip: Strip = Strip.new()
	strip.add_number(
		tr("Reach (m)"),
		tr("How far from the node the missing wood may begin. 0: a tenth of the tree's size."),
		0.0,
		5.0,
		0.05,
		values[&"reach"],
		set_setting.bind(&"reach")
	)
	strip.add_number(
		tr("Angle (°)"),
		tr("How far off the arrow it may lie."),
		5.0,
		90.0,
		1.0,
		values[&"angle"],
		set_setting.bind(&"angle")
	)
	return strip


func start() -> void:
	super()
	if _search == null:
		_search = Search.new(session)
		_search.ended.connect(_on_ended)
	# The points take a while: the sooner the better.
	session.scan.request()


func is_busy() -> bool:
	return _held != NO_NODE or (_search != null and _search.is_busy())


func is_held() -> bool:
	return _held != NO_NODE


func cancel() -> void:
	_held = NO_NODE
	_dragged = false
	if _search != null:
		_search.cancel()
	_queue()


func _press(button: InputEventMouseButton) -> bool:
	var id: int = pick()
	if id == NO_NODE:
		return false
	_held = id
	_pressed_at = button.position
	_dragged = false
	session.select([id])
	return true


func _move(motion: InputEventMouseMotion) -> bool:
	if not is_held():
		return false
	if not motion.button_mask & MOUSE_BUTTON_MASK_LEFT:
		_held = NO_NODE
		_queue()
		return false
	if motion.position.distance_to(_pressed_at) >= DRAG_FROM * get_scale():
		_dragged = true
	changed.emit()
	return true


func _release(_button: InputEventMouseButton) -> bool:
	if not is_held():
		return false
	var id: int = _held
	_held = NO_NODE
	if _dragged and session.tree.has_node(id):
		var place: Vector3 = session.tree.get_node_position(id)
		_search.find(
			get_title(),
			id,
			place_at(_pointer, place) - place,
			{"reach": values[&"reach"], "angle": deg_to_rad(values[&"angle"])}
		)
	_dragged = false
	_queue()
	return true


func accept() -> bool:
	return false


func _look_again() -> void:
	_clear()
	if is_held() or session.hovered == NO_NODE:
		return
	_refused = false
	_hint = tr("Drag from here towards the missing branch.")
	changed.emit()


func draw(overlay: Control) -> void:
	super(overlay)
	if not is_held() or not _dragged or not is_seen_on(overlay) or not session.tree.has_node(_held):
		return
	var from: Vector2 = seen_at(session.tree.get_node_position(_held))
	var way: Vector2 = (_pointer - from).normalized()
	var scale: float = get_scale()
	var head: Vector2 = _pointer - way * 14.0 * scale
	var side: Vector2 = way.orthogonal() * 7.0 * scale
	overlay.draw_line(from, head, MEANT, 3.0 * scale, true)
	overlay.draw_colored_polygon([_pointer, head + side, head - side], MEANT)


func _on_ended(added: PackedInt32Array) -> void:
	if not added.is_empty():
		session.select(added)
	_queue()
