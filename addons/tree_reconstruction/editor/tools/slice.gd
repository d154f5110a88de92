@tool
extends "wood_tool.gd"
## Cuts along a line that is drawn over the view, takes what a rectangle of it shows, or what lies
## in a box.

enum Shape { LINE, RECTANGLE, BOX }

const Handles := preload("box_handles.gd")

# While the mouse draws: where it began; INF otherwise.
var _from: Vector2 = Vector2.INF
# What was drawn, to be looked at before it is done: two places of the plane and its normal, towards
# what goes, in the tree's space; or the nodes in a rectangle.
var _ends: PackedVector3Array = []
var _normal: Vector3
var _ids: PackedInt32Array = []
# Or a box along the tree's axes, whose faces the mouse drags.
var _handles: Handles = Handles.new()
var _rect: Rect2


func get_id() -> StringName:
	return &"slice"


func get_title() -> String:
	return tr("Cut along a line")


func get_tooltip() -> String:
	return tr(
		(
			"Drag a line over the tree to cut off what lies beyond it, seen from the base, or a rectangle"
			+ " around what shall go. It is shown in red; Enter cuts it, Escape lets it be. The faces"
			+ " of a box have handles to drag them."
		)
	)


func get_icon() -> String:
	return "res://addons/tree_reconstruction/icons/tools/slice.svg"


func get_key() -> Key:
	return KEY_B


func get_defaults() -> Dictionary[StringName, Variant]:
	return {&"shape": int(Shape.LINE), &"exact": true}


func make_settings() -> Control:
	_restore()
	var strip: Strip = Strip.new()
	var shapes: PackedStringArray = [tr("Line"), tr("Rectangle"), tr("Box")]
	var explained: String = tr(
		(
			"A line cuts through the whole tree as the view sees it. A rectangle takes the nodes in it,"
			+ " and what grows from them. A box cuts at its faces, which lie along the tree's axes:"
			+ " draw it in the view from the front, the right or the top, and drag its handles."
		)
	)
	strip.add_choice("", explained, shapes, values[&"shape"], _on_shape_chosen)
	strip.add_switch(
		tr("Right at the cut"),
		tr("Branches end right at the line or the box; otherwise at their last node before it."),
		values[&"exact"],
		set_setting.bind(&"exact")
	)
	strip.add_button(tr("Cut"), tr("Cuts the red wood away."), accept)
	return strip


func is_busy() -> bool:
	return is_held() or not _ends.is_empty() or not _ids.is_empty() or _handles.has_box()


func is_held() -> bool:
	return _from != Vector2.INF or _handles.dragged != Handles.NO_FACE


## Lets the face go that is dragged, or all that is drawn.
func cancel() -> void:
	if _handles.dragged != Handles.NO_FACE:
		_handles.let_go(false)
		_queue()
		return
	_from = Vector2.INF
	_forget()
	_queue()


func _press(button: InputEventMouseButton) -> bool:
	if _handles.take(self, button.position):
		return true
	# Wherever it begins: lines begin beside the tree.
	cancel()
	_from = button.position
	return true


func _move(motion: InputEventMouseMotion) -> bool:
	if not is_held():
		var over: int = _handles.find(self, motion.position)
		if over != _handles.hovered:
			_handles.hovered = over
			changed.emit()
		return false
	if not motion.button_mask & MOUSE_BUTTON_MASK_LEFT:
		# The button was let go elsewhere.
		_handles.let_go(true)
		_from = Vector2.INF
		return false
	if _handles.dragged != Handles.NO_FACE:
		_handles.drag(self, motion.position)
		_queue()
	elif motion.position.distance_to(_from) >= DRAG_FROM * get_scale():
		_queue()
	return true


func _release(_button: InputEventMouseButton) -> bool:
	if not is_held():
		return false
	if _handles.dragged != Handles.NO_FACE:
		_handles.let_go(true)
		return true
	if _pointer.distance_to(_from) >= DRAG_FROM * get_scale():
		_take_shape()
	_from = Vector2.INF
	_queue()
	return true


## Does what is drawn.
func accept() -> bool:
	if session.tree == null:
		return false
	# In few words, since the log keeps them.
	_ids = get_lowest_of(_ids)
	var command: String = get_command()
	if command.is_empty():
		return false
	var edit: TreeEdit = session.run(get_title(), command)
	if edit != null:
		cancel()
		_clear()
	return true


## What is drawn, as an edit command; empty if nothing is.
func get_command() -> String:
	if not _ids.is_empty():
		return "remove nodes=%s" % words_of_nodes(_ids)
	var exact: String = "yes" if values[&"exact"] else "no"
	if _handles.has_box():
		var box: AABB = _handles.box
		return (
			"prune_box from=%s to=%s exact=%s" % [words_of(box.position), words_of(box.end), exact]
		)
	if _ends.is_empty():
		return ""
	return (
		"prune_side place=%s towards=%s exact=%s" % [words_of(_ends[0]), words_of(_normal), exact]
	)


func _look_again() -> void:
	if _from != Vector2.INF:
		_take_shape()
	show_command(get_command())
	if _handles.has_box():
		_show_box()


func draw(overlay: Control) -> void:
	super(overlay)
	if not is_seen_on(overlay):
		return
	var width: float = 2.0 * get_scale()
	_handles.draw(self, overlay)
	if not _ends.is_empty():
		_draw_line(overlay, width)
	elif not _ids.is_empty() or (_from != Vector2.INF and values[&"shape"] != Shape.LINE):
		overlay.draw_rect(_rect, Color(GONE, 0.12))
		overlay.draw_rect(_rect, GONE, false, width)


func _draw_line(overlay: Control, width: float) -> void:
	var from: Vector2 = seen_at(_ends[0])
	var to: Vector2 = seen_at(_ends[1])
	if not from.is_finite() or not to.is_finite() or from.distance_to(to) < 1.0:
		return
	overlay.draw_line(from, to, GONE, width, true)
	# Arrows towards what goes.
	var middle: Vector3 = (_ends[0] + _ends[1]) / 2.0
	var away: Vector2 = seen_at(middle + _normal * _ends[0].distance_to(_ends[1]) * 0.05)
	away = (away - seen_at(middle)).limit_length(1.0) * 16.0 * get_scale()
	for share: float in [0.25, 0.5, 0.75]:
		var at: Vector2 = from.lerp(to, share)
		var side: Vector2 = away.orthogonal() * 0.35
		overlay.draw_line(at, at + away, GONE, width, true)
		overlay.draw_colored_polygon([at + away * 1.5, at + away + side, at + away - side], GONE)


func _take_shape() -> void:
	_forget()
	if session.tree == null or _pointer.distance_to(_from) < 1.0:
		return
	_rect = Rect2(_from, _pointer - _from).abs()
	var middle: Vector3 = session.tree.get_aabb().get_center()
	match values[&"shape"]:
		Shape.RECTANGLE:
			_ids = session.picker.call(&"pick_rect", _eye, _rect)
		Shape.BOX:
			_take_box(place_at(_from, middle), place_at(_pointer, middle))
		_:
			_take_line(place_at(_from, middle), place_at(_pointer, middle))


func _forget() -> void:
	_ends = []
	_ids = []
	_handles.box = AABB()


func _take_line(from: Vector3, to: Vector3) -> void:
	_ends = [from, to]
	var sight: Vector3 = view_direction(Vector3.FORWARD)
	if _eye.projection != Camera3D.PROJECTION_ORTHOGONAL:
		sight = _ends[0] - session.node.global_transform.affine_inverse() * _eye.global_position
	_normal = (_ends[1] - _ends[0]).cross(sight).normalized()
	if _normal == Vector3.ZERO:
		_ends = []
		return
	# The base stays: what lies on its side of the line can't go.
	var base: Vector3 = session.tree.get_node_position(session.tree.get_root())
	if _normal.dot(base - _ends[0]) > 0.0:
		_normal = -_normal


# As deep as the whole tree along the axis that the view looks along.
func _take_box(from: Vector3, to: Vector3) -> void:
	var box: AABB = AABB(from, Vector3.ZERO).expand(to)
	var axis: int = view_direction(Vector3.FORWARD).abs().max_axis_index()
	var whole: AABB = session.tree.get_aabb().grow(0.1)
	box.position[axis] = whole.position[axis]
	box.size[axis] = whole.size[axis]
	_handles.box = box


# Its edges, too.
func _show_box() -> void:
	var edges: PackedVector3Array = []
	for i: int in 8:
		for bit: int in [1, 2, 4]:
			if not i & bit:
				edges.append(_handles.box.get_endpoint(i))
				edges.append(_handles.box.get_endpoint(i | bit))
	var wood: PackedVector3Array = [] if _ghosts.is_empty() else _ghosts[Mesh.ARRAY_VERTEX]
	set_ghosts(wood + edges, [])


func _on_shape_chosen(index: int) -> void:
	values[&"shape"] = index
	cancel()
