@tool
extends RefCounted
## Strokes that are drawn right in a 3D view: on the sheet that a sketch's tree stands in, or, where
## none stands yet, on one that is put up where the first stroke comes down.
##
## It knows no viewport of the editor: whoever does gives it a camera, the size of its picture, and
## the events. Nothing is changed here: what should become of the sketch is said.

## A stroke grows: its points so far, in pixels of the canvas, and the pen's pressures.
signal drawing(points: PackedVector2Array, pressure: PackedFloat32Array)
## A stroke was drawn: what the sketch is with it.
signal drawn(sketch: TreeSketch)
## What was under way is given up.
signal cancelled
## A stroke was clicked at; 0 is none.
signal chosen(id: int)
## A sentence for the user.
signal said(sentence: String)
## It has to be drawn again.
signal changed

const Session := preload("../session.gd")
const Widgets := preload("../dock/widgets.gd")
const Canvas := preload("sketch_canvas.gd")
const ViewPlane := preload("view_plane.gd")

# On the screen, at the editor's scale of 1: a stroke that is shorter is a click, and how near it
# has to be.
const _SHORTEST: float = 6.0
const _NEAR: float = 9.0
# Where the base is on a canvas that nothing is drawn on, and so far off is a sheet without a
# ground.
const _BASE: Vector2 = Vector2(500.0, 960.0)
const _AHEAD: float = 10.0
# So many steps can be undone with the sheet of each known.
const _MOST: int = 64

## Whether strokes are drawn in the view.
var enabled: bool = false:
	set(value):
		cancel()
		enabled = value
		_session.view.drawing = value
		_over = weakref(null)
		changed.emit()
## Finds the ground under a place of the view: called with a camera, the size of its picture and the
## place, it returns a [Vector3] or, without ground, [code]null[/code].
var find_ground: Callable
## The strokes as they are, and what each was taken for.
var sketch: TreeSketch = TreeSketch.new()
var understood: Dictionary[int, Dictionary] = {}
## The paper's tool: the view is drawn on by that for drawing alone.
var tool: Canvas.Tool = Canvas.Tool.DRAW
var selected: int = 0
## The stroke under way, on the screen; [member camera] sees it.
var places: PackedVector2Array = []
var camera: Camera3D
## Where the tree that was made last has to stand in the world, a [Transform3D]; [code]null[/code]
## where any place will do.
var place: Variant

var _session: Session
var _pressure: PackedFloat32Array = []
var _size: Vector2
var _was_accumulated: bool = true
# The tree that stands, the strokes that it was made of, and their sheet in its space.
var _node: WeakRef = weakref(null)
var _base: TreeSketch
var _stem_base: Vector2
var _pixel: float = 0.0
# The sheets of sketches that no tree was made of yet: [sketch, sheet].
var _sheets: Array[Array] = []
# A node whose scan or photos are drawn over.
var _over: WeakRef = weakref(null)


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session


## Shows strokes. [param node] is that of the tree that stands, or [code]null[/code], and
## [param base] what that was made of.
func show_sketch(
	shown: TreeSketch,
	taken_for: Dictionary[int, Dictionary],
	node: TreeInstance3D,
	base: TreeSketch
) -> void:
	sketch = shown
	understood = taken_for
	_node = weakref(node)
	if base != _base:
		_base = base
		_pixel = 0.0
	changed.emit()


## What is known of the tree that stands: at which pixel of its canvas its base is, and how long a
## pixel is, in metres.
func set_scale_of_base(stem_base: Vector2, pixel: float) -> void:
	_stem_base = stem_base
	_pixel = pixel
	changed.emit()


## The sheet of a sketch, or [code]null[/code] where it isn't known.
func plane_of(of: TreeSketch) -> ViewPlane:
	var node: TreeInstance3D = _node.get_ref() as TreeInstance3D
	if is_same(of, _base) and _pixel > 0.0 and node != null and node.is_inside_tree():
		return ViewPlane.new(node.global_transform, _stem_base, _pixel)
	for i: int in range(_sheets.size() - 1, -1, -1):
		if is_same(_sheets[i][0], of):
			return _sheets[i][1]
	return null


## A changed sketch stays on the sheet on which it was before.
func carry(from: TreeSketch, to: TreeSketch) -> void:
	if enabled and not is_same(from, to) and plane_of(to) == null:
		_keep(to, plane_of(from))


## The sheet on which the tree of a sketch has to stand where it was drawn; [code]null[/code] where
## it stands as its height says.
func wanted_plane(of: TreeSketch) -> ViewPlane:
	return plane_of(of) if enabled else null


## Whether a stroke is being drawn.
func is_busy() -> bool:
	return not places.is_empty()


## Gives up the stroke under way.
func cancel() -> void:
	if is_busy():
		_stop()
		cancelled.emit()


## The node whose scan or photos are drawn over, or [code]null[/code].
func get_over() -> TreeInstance3D:
	var over: TreeInstance3D = _over.get_ref() as TreeInstance3D
	return over if over != null and over.is_inside_tree() else null


## Takes an event over the picture of a camera, or returns whether it is for somebody else.
func input(from: Camera3D, size: Vector2, event: InputEvent) -> bool:
	var button: InputEventMouseButton = event as InputEventMouseButton
	if not enabled:
		return false
	if is_busy():
		return _go_on(event)
	# With these the mouse moves the camera in some of the editor's schemes.
	if (
		button == null
		or button.button_index != MOUSE_BUTTON_LEFT
		or not button.pressed
		or button.alt_pressed
		or button.ctrl_pressed
		or button.meta_pressed
	):
		return false
	_press(from, size, button.position)
	return true


# With the stroke under way: the camera stays as long as it is drawn.
func _go_on(event: InputEvent) -> bool:
	var button: InputEventMouseButton = event as InputEventMouseButton
	var motion: InputEventMouseMotion = event as InputEventMouseMotion
	if button != null:
		if button.button_index == MOUSE_BUTTON_LEFT and not button.pressed:
			_release()
		elif button.button_index == MOUSE_BUTTON_RIGHT and button.pressed:
			cancel()
	elif motion != null:
		if motion.button_mask & MOUSE_BUTTON_MASK_LEFT:
			_move(motion.position, motion.pressure)
		else:
			# It was let go elsewhere.
			_release()
	elif event.is_action_pressed(&"ui_cancel"):
		cancel()
	else:
		return false
	return true


## What the pen pressed so far, or nothing where no pen is at work: a mouse presses evenly.
func get_pressure() -> PackedFloat32Array:
	var least: float = 1.0
	var most: float = 0.0
	for value: float in _pressure:
		least = minf(least, value)
		most = maxf(most, value)
	return _pressure if most - least > 0.01 else PackedFloat32Array()


## The stroke that is seen at a place of a camera's picture, by its id, or 0.
func find_stroke(from: Camera3D, size: Vector2, at: Vector2) -> int:
	var plane: ViewPlane = plane_of(sketch)
	var nearest: float = Widgets.px(_NEAR)
	var found: int = 0
	if plane == null:
		return found
	for stroke: Dictionary in sketch.strokes:
		var line: PackedVector2Array = plane.line_to_screen(from, size, stroke["points"])
		if line.is_empty():
			continue
		var away: float = Canvas.distance_to(line, at)
		if away < nearest:
			nearest = away
			found = stroke["id"]
	return found


func _press(from: Camera3D, size: Vector2, at: Vector2) -> void:
	if is_busy():
		return
	var sentence: String = _why_not(from)
	if not sentence.is_empty():
		said.emit(sentence)
		return
	_was_accumulated = Input.use_accumulated_input
	# Every point of a pen is wanted, not one a frame.
	Input.use_accumulated_input = false
	camera = from
	_size = size
	places = [at]
	_pressure = [0.0]
	changed.emit()


func _why_not(from: Camera3D) -> String:
	if tool != Canvas.Tool.DRAW:
		return tr(
			"Strokes are erased and reshaped on the paper. Choose Draw there to draw in the 3D view."
		)
	var plane: ViewPlane = plane_of(sketch)
	if ViewPlane.is_steep(from.global_transform):
		return tr(
			(
				"The view looks up or down too steeply to draw an upright tree. Turn it until you see the"
				+ " tree from the side."
			)
		)
	if plane != null and plane.is_slanted(from.global_transform):
		return tr(
			"The strokes are seen from the side here. Turn the view until you see them from the front."
		)
	return ""


func _move(at: Vector2, pressed: float) -> void:
	if at == places[-1]:
		return
	if places.size() == 1:
		_pressure[0] = pressed
	places.append(at)
	_pressure.append(pressed)
	changed.emit()
	var plane: ViewPlane = plane_of(sketch)
	if plane == null or not is_instance_valid(camera) or not camera.is_inside_tree():
		return
	var line: PackedVector2Array = _on_canvas(plane)
	if line.size() == places.size():
		drawing.emit(line, get_pressure())


func _release() -> void:
	var length: float = 0.0
	for i: int in range(1, places.size()):
		length += places[i].distance_to(places[i - 1])
	if not is_instance_valid(camera) or not camera.is_inside_tree():
		cancel()
		return
	if length < Widgets.px(_SHORTEST):
		var at: Vector2 = places[0]
		cancel()
		chosen.emit(find_stroke(camera, _size, at))
		return
	var made: TreeSketch = _with_stroke()
	if made == null:
		cancel()
		said.emit(tr("The tree's upright plane isn't seen there: nothing can be drawn on it."))
		return
	_stop()
	drawn.emit(made)


func _stop() -> void:
	Input.use_accumulated_input = _was_accumulated
	places = []
	_pressure = []
	changed.emit()


# The stroke under way on a sheet's canvas.
func _on_canvas(plane: ViewPlane) -> PackedVector2Array:
	var line: PackedVector2Array = []
	for at: Vector2 in places:
		var point: Vector2 = plane.to_canvas(camera, _size, at)
		if point.is_finite():
			line.append(point)
	return line


# The strokes with the one under way, on the sheet on which they belong, which is kept.
func _with_stroke() -> TreeSketch:
	var before: ViewPlane = plane_of(sketch)
	var plane: ViewPlane = before
	if before == null or _comes_lower(before):
		plane = _put_up(before)
	var made: TreeSketch = sketch.duplicate() as TreeSketch
	if plane != before and before != null:
		# From here all looks as it did.
		_change_points(made, _through_camera.bind(before, plane))
	var line: PackedVector2Array = _on_canvas(plane)
	if line.size() < 2:
		return null
	made.add_stroke(line, get_pressure() if line.size() == places.size() else PackedFloat32Array())
	var by: Transform2D = ViewPlane.fit(_box_of(made))
	if by != Transform2D.IDENTITY or made.canvas_size != ViewPlane.CANVAS:
		_change_points(made, func(point: Vector2) -> Vector2: return by * point)
		made.canvas_size = ViewPlane.CANVAS
		plane = plane.fitted(by)
	_keep(made, plane)
	return made


# Whether the stroke under way comes down to the ground where none of the others did: a crown that
# was drawn first floats before it, until it is known where its tree stands.
func _comes_lower(plane: ViewPlane) -> bool:
	for stroke: Dictionary in sketch.strokes:
		var known: Dictionary = understood.get(stroke["id"], {})
		if known.get("role", "") == "trunk" or int(stroke["role"]) == TreeSketch.ROLE_TRUNK:
			return false
		for at: Vector2 in plane.line_to_screen(camera, _size, stroke["points"]):
			if at.y >= _lowest().y:
				return false
	return get_over() == null


func _lowest() -> Vector2:
	var lowest: Vector2 = places[0]
	for at: Vector2 in places:
		if at.y > lowest.y:
			lowest = at
	return lowest


# A sheet for strokes that have none, or that come down elsewhere than on that: through the base of
# the scan or of the photos' tree that they are drawn over, else through the ground below them.
func _put_up(before: ViewPlane) -> ViewPlane:
	var over: TreeInstance3D = _find_over()
	_over = weakref(over)
	var stem_base: Vector3
	if over != null:
		var tree: TreeReconstruction = over.reconstruction
		stem_base = over.global_transform * tree.get_node_position(tree.get_root())
	else:
		var ground: Variant = (
			find_ground.call(camera, _size, _lowest()) if find_ground.is_valid() else null
		)
		if ground == null and before != null:
			return before
		stem_base = ground if ground != null else _ahead()
		if ground == null:
			(
				said
				. emit(
					tr(
						"There is no ground below this stroke. Draw the trunk down to where the tree should stand."
					)
				)
			)
	var frame: Transform3D = ViewPlane.facing(camera.global_transform, stem_base)
	if before != null and not before.is_slanted(camera.global_transform):
		# It faces who drew the first stroke.
		frame.basis = before.frame.basis.orthonormalized()
	# As high as the picture there, so that strokes are neither tiny nor huge on the paper.
	var unit: ViewPlane = ViewPlane.new(frame, Vector2.ZERO, 1.0)
	var seen: float = 0.0
	for at: Vector2 in [Vector2(_size.x * 0.5, 0.0), Vector2(_size.x * 0.5, _size.y * 0.5)]:
		var high: Vector2 = unit.to_canvas(camera, _size, at)
		if high.is_finite():
			seen = maxf(seen, absf(high.y))
	return ViewPlane.new(frame, _BASE, clampf(seen, 0.1, 100.0) / ViewPlane.CANVAS.y)


func _find_over() -> TreeInstance3D:
	var over: TreeInstance3D = get_over()
	if over != null:
		return over
	var node: TreeInstance3D = _session.node
	if node == null or node.reconstruction == null:
		return null
	var tree: TreeReconstruction = node.reconstruction
	if tree.provenance.get("sketch") is TreeSketch or tree.get_node_count() == 0:
		return null
	var is_scanned: bool = not Session.ScanData.source_of(tree).is_empty()
	return node if is_scanned or _session.view.stage != null else null


# Where the lowest place is seen, so far off.
func _ahead() -> Vector3:
	var there: Transform3D = camera.global_transform
	there.origin -= there.basis.z.normalized() * _AHEAD
	var sheet: ViewPlane = ViewPlane.new(ViewPlane.facing(there, there.origin), Vector2.ZERO, 1.0)
	var at: Vector2 = sheet.to_canvas(camera, _size, _lowest())
	return sheet.to_world(at) if at.is_finite() else there.origin


func _through_camera(point: Vector2, from: ViewPlane, to: ViewPlane) -> Vector2:
	var at: Vector2 = from.to_screen(camera, _size, point)
	var moved: Vector2 = to.to_canvas(camera, _size, at) if at.is_finite() else Vector2.INF
	return moved if moved.is_finite() else point


func _keep(of: TreeSketch, plane: ViewPlane) -> void:
	if plane == null:
		return
	_sheets.append([of, plane])
	if _sheets.size() > _MOST:
		_sheets.pop_front()


static func _change_points(of: TreeSketch, change: Callable) -> void:
	var strokes: Array[Dictionary] = []
	for stroke: Dictionary in of.strokes:
		var changed_stroke: Dictionary = stroke.duplicate()
		var line: PackedVector2Array = []
		for point: Vector2 in stroke["points"]:
			line.append(change.call(point))
		changed_stroke["points"] = line
		strokes.append(changed_stroke)
	of.strokes = strokes


static func _box_of(of: TreeSketch) -> Rect2:
	var box: Rect2 = Rect2(of.strokes[-1]["points"][0], Vector2.ZERO)
	for stroke: Dictionary in of.strokes:
		for point: Vector2 in stroke["points"]:
			box = box.expand(point)
	return box
