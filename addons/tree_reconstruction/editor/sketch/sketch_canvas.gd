@tool
extends Control
## The paper that strokes are drawn on, with mouse or pen, rubbed out and bent.
##
## It shows a sketch and says what the user does to it; nothing is changed here.

## A stroke grows: its points so far, in pixels of the sketch's canvas, and the pen's pressures.
signal drawing(points: PackedVector2Array, pressure: PackedFloat32Array)
signal drawn(points: PackedVector2Array, pressure: PackedFloat32Array)
signal bending(id: int, points: PackedVector2Array)
signal bent(id: int, points: PackedVector2Array)
signal erased(ids: PackedInt32Array)
## What was under way is given up.
signal cancelled
## A stroke was clicked at; 0 is none.
signal chosen(id: int)

enum Tool { DRAW, ERASE, RESHAPE }

const Widgets := preload("../dock/widgets.gd")
const StrokeCurve := preload("stroke_curve.gd")
const Look := preload("canvas_look.gd")
# On the screen, at the editor's scale of 1.
const _NEAR: float = 9.0
# A stroke that is shorter, in pixels of the canvas, is a click.
const _SHORTEST: float = 8.0

var tool: Tool = Tool.DRAW:
	set(value):
		cancel()
		tool = value
		_fit()
		queue_redraw()
## The stroke that was clicked at, by its id, or 0.
var selected: int = 0:
	set(value):
		selected = value
		_fit()
		queue_redraw()
## What is shown. It isn't changed afterwards: another sketch comes.
var sketch: TreeSketch = TreeSketch.new():
	set(value):
		sketch = value
		strokes = sketch.strokes
		if sketch.find_stroke(selected) < 0:
			selected = 0
		_fit()
		queue_redraw()
## The strokes of [member sketch].
var strokes: Array[Dictionary] = []
## What was made of each stroke, by its id, as in the report of
## [method TreeReconstructor.sketch_tree].
var understood: Dictionary[int, Dictionary] = {}:
	set(value):
		understood = value
		queue_redraw()
## Of the selected stroke, while it is reshaped; else [code]null[/code].
var curve: StrokeCurve
## The stroke under way, and strokes that are rubbed out, by their ids.
var points: PackedVector2Array = []
var pressure: PackedFloat32Array = []
var gone: PackedInt32Array = []

var _look: Look = Look.new(self)
var _drawing: bool = false
var _erasing: bool = false
# The handle that is dragged, or -1.
var _handle: int = -1
var _bent: bool = false
var _last: Vector2
# The pen lies upside down.
var _inverted: bool = false
var _was_accumulated: bool = true


func _init() -> void:
	focus_mode = Control.FOCUS_ALL
	clip_contents = true
	mouse_default_cursor_shape = Control.CURSOR_CROSS
	custom_minimum_size = Vector2(Widgets.px(320), Widgets.px(320))
	tooltip_text = "Draw with the left button or a pen. The right button or the pen's eraser erases."


## Whether a stroke is being drawn, bent or rubbed out.
func is_busy() -> bool:
	return _drawing or _erasing or _handle >= 0


## Gives up what is under way.
func cancel() -> void:
	if is_busy():
		_stop()
		_fit()
		cancelled.emit()


## Where the paper lies in this control.
func get_paper() -> Rect2:
	var canvas: Vector2 = sketch.canvas_size
	var scale: float = minf(size.x / canvas.x, size.y / canvas.y)
	return Rect2((size - canvas * scale) / 2.0, canvas * scale)


## A place of the sketch's canvas in this control.
func to_control(at: Vector2) -> Vector2:
	var paper: Rect2 = get_paper()
	return paper.position + at * paper.size.y / sketch.canvas_size.y


## A place in this control on the sketch's canvas.
func to_canvas(at: Vector2) -> Vector2:
	var paper: Rect2 = get_paper()
	return (at - paper.position) * sketch.canvas_size.y / maxf(paper.size.y, 1.0)


## The id of the stroke at a place in this control, or 0.
func find_stroke(at: Vector2) -> int:
	var place: Vector2 = to_canvas(at)
	var nearest: float = _reach()
	var found: int = 0
	for stroke: Dictionary in strokes:
		if stroke["id"] in gone:
			continue
		var away: float = distance_to(stroke["points"], place)
		if away < nearest:
			nearest = away
			found = stroke["id"]
	return found


## The distance of a place to a line through points.
static func distance_to(line: PackedVector2Array, place: Vector2) -> float:
	var nearest: float = line[0].distance_to(place)
	for i: int in range(1, line.size()):
		var on_line: Vector2 = Geometry2D.get_closest_point_to_segment(place, line[i - 1], line[i])
		nearest = minf(nearest, on_line.distance_to(place))
	return nearest


func _gui_input(event: InputEvent) -> void:
	var motion: InputEventMouseMotion = event as InputEventMouseMotion
	var button: InputEventMouseButton = event as InputEventMouseButton
	if motion != null:
		_inverted = motion.pen_inverted
		if _inverted and _drawing and points.size() == 1:
			# Only now it is known which end of the pen came down.
			points = []
			_begin_erasing(_last)
			_drawing = false
		_move(motion.position, motion.pressure)
	elif button != null and button.button_index == MOUSE_BUTTON_LEFT:
		if not button.pressed:
			_release()
		elif not is_busy():
			_press(button.position)
		accept_event()
	elif button != null and button.button_index == MOUSE_BUTTON_RIGHT:
		if button.pressed and is_busy() and not _erasing:
			cancel()
		elif button.pressed:
			_begin_erasing(button.position)
		elif _erasing:
			_release()
		accept_event()
	elif event.is_action_pressed(&"ui_cancel") and is_busy():
		cancel()
		accept_event()


func _get_tooltip(at: Vector2) -> String:
	var id: int = find_stroke(at)
	if id != 0:
		return _look.describe(id)
	# Where there are strokes, it would only be in the way of more.
	return tr(tooltip_text) if strokes.is_empty() else ""


func _draw() -> void:
	_look.draw()


func _notification(what: int) -> void:
	if what == NOTIFICATION_RESIZED:
		queue_redraw()
	elif what == NOTIFICATION_VISIBILITY_CHANGED and not is_visible_in_tree():
		cancel()
	elif what == NOTIFICATION_EXIT_TREE:
		_stop()


func _press(at: Vector2) -> void:
	grab_focus()
	if _inverted or tool == Tool.ERASE:
		_begin_erasing(at)
	elif tool == Tool.DRAW:
		_begin()
		_drawing = true
		points = [_clamped(to_canvas(at))]
		pressure = [0.0]
	else:
		_grab(at)
	_last = at


# Every point of a pen is wanted, not one a frame.
func _begin() -> void:
	if not is_busy():
		_was_accumulated = Input.use_accumulated_input
	Input.use_accumulated_input = false


func _begin_erasing(at: Vector2) -> void:
	_begin()
	_erasing = true
	gone = []
	_last = at
	_erase(at, at)


# A handle of the stroke that is reshaped, or another stroke.
func _grab(at: Vector2) -> void:
	if curve != null:
		var nearest: float = Widgets.px(_NEAR) * 1.3
		for i: int in curve.get_count():
			var away: float = to_control(curve.handles[i]).distance_to(at)
			if away < nearest:
				nearest = away
				_handle = i
	if _handle >= 0:
		_begin()
		_bent = false
	else:
		_choose(find_stroke(at))


func _move(at: Vector2, pressed: float) -> void:
	if _drawing:
		var place: Vector2 = _clamped(to_canvas(at))
		if place != points[-1]:
			if points.size() == 1:
				pressure[0] = pressed
			points.append(place)
			pressure.append(pressed)
			drawing.emit(points, get_pressure())
	elif _erasing:
		_erase(_last, at)
	elif _handle >= 0:
		_bent = true
		curve.move(_handle, _clamped(to_canvas(at)))
		bending.emit(selected, curve.get_points())
	else:
		return
	_last = at
	queue_redraw()


func _erase(from: Vector2, to: Vector2) -> void:
	var steps: int = maxi(ceili(from.distance_to(to) / Widgets.px(_NEAR)), 1)
	for i: int in steps + 1:
		var id: int = find_stroke(from.lerp(to, float(i) / steps))
		if id != 0:
			gone.append(id)
	queue_redraw()


func _release() -> void:
	var ids: PackedInt32Array = gone
	var line: PackedVector2Array = points
	var pressures: PackedFloat32Array = get_pressure()
	var was_drawing: bool = _drawing
	var was_erasing: bool = _erasing
	var was_bent: bool = _handle >= 0 and _bent
	_stop()
	if was_drawing:
		if StrokeCurve.length_of(line) >= _SHORTEST:
			drawn.emit(line, pressures)
		else:
			cancelled.emit()
			_choose(find_stroke(to_control(line[0])))
	elif was_erasing and not ids.is_empty():
		erased.emit(ids)
	elif was_bent:
		bent.emit(selected, curve.get_points())
	queue_redraw()


## What the pen pressed so far, or nothing where no pen is at work: a mouse presses evenly.
func get_pressure() -> PackedFloat32Array:
	var least: float = 1.0
	var most: float = 0.0
	for value: float in pressure:
		least = minf(least, value)
		most = maxf(most, value)
	return pressure if most - least > 0.01 else PackedFloat32Array()


func _stop() -> void:
	if is_busy():
		Input.use_accumulated_input = _was_accumulated
	_drawing = false
	_erasing = false
	_handle = -1
	points = []
	pressure = []
	gone = []
	queue_redraw()


func _choose(id: int) -> void:
	selected = id
	chosen.emit(id)


# Gives the selected stroke its handles.
func _fit() -> void:
	curve = null
	var index: int = sketch.find_stroke(selected)
	if tool != Tool.RESHAPE or index < 0:
		return
	var line: PackedVector2Array = strokes[index]["points"]
	if StrokeCurve.length_of(line) >= _SHORTEST:
		curve = StrokeCurve.new(line)


func _clamped(at: Vector2) -> Vector2:
	return at.clamp(Vector2.ZERO, sketch.canvas_size)


func _reach() -> float:
	return Widgets.px(_NEAR) * sketch.canvas_size.y / maxf(get_paper().size.y, 1.0)
