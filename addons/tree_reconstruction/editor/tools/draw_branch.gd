@tool
extends "wood_tool.gd"
## Draws a branch that the scan did not see, or the reconstruction missed: one stroke along it, over
## the scan's points, over a photo, or over nothing (docs/sketch_branch.md).

const Pinhole := preload("pinhole.gd")
const BranchStrokes := preload("branch_strokes.gd")

# In pixels at the editor's scale of 1: places of a stroke that lie nearer are one.
const _STEP: float = 1.5
const _WIDTH: float = 3.0
# Of a stroke whose branch is being made.
const _WAITING: Color = Color(0.4, 0.75, 1.0, 0.45)
const _BESIDE: Color = Color(0.0, 0.0, 0.0, 0.55)
# A view that is moved on by less is the same.
const _SAME: float = 1e-4

## Called with the events of a click that was not for the tree, to hand it to the editor.
var give_back: Callable

var _pressed: InputEventMouseButton
var _positions: PackedVector2Array
var _pinhole: Pinhole
var _strokes: BranchStrokes


func get_id() -> StringName:
	return &"draw_branch"


func get_title() -> String:
	return tr("Draw a Branch")


func get_tooltip() -> String:
	return tr(
		(
			"Drag along a branch that the tree lacks, from the wood that it grows from: over the scan's"
			+ " points (P shows them), over a photo (F4), or where you know that one was. The scan's"
			+ " points tell how far away it is; where there are none, that is guessed from the tree's"
			+ " other branches. Escape gives up the stroke."
		)
	)


func get_icon() -> String:
	return "res://addons/tree_reconstruction/icons/tools/draw_branch.svg"


func get_key() -> Key:
	return KEY_Z


func get_defaults() -> Dictionary[StringName, Variant]:
	return {&"seed": 1, &"twigs": true}


func draws_over_photos() -> bool:
	return true


func make_settings() -> Control:
	_restore()
	var strip: Strip = Strip.new()
	strip.add_switch(
		tr("Twigs"),
		tr("The branch bears twigs as this tree's other branches do."),
		values[&"twigs"],
		set_setting.bind(&"twigs")
	)
	strip.add_number(
		tr("Seed"),
		tr("Each seed gives the branch other ones of the tree's twigs."),
		1,
		999,
		1,
		values[&"seed"],
		_on_seed_changed
	)
	return strip


func start() -> void:
	super()
	if _strokes == null:
		_strokes = BranchStrokes.new(session)
		_strokes.changed.connect(_on_strokes_changed)
		_strokes.grown.connect(_on_grown)
	_strokes.start()


func stop() -> void:
	super()
	if _strokes != null:
		_strokes.stop()


## Whether a stroke is drawn, or its branch being made.
func is_busy() -> bool:
	return is_held() or (_strokes != null and not _strokes.waiting.is_empty())


func is_held() -> bool:
	return _pressed != null


func cancel() -> void:
	if is_held():
		_forget()
	elif _strokes != null:
		_strokes.cancel()
	_queue()


func accept() -> bool:
	return false


func _press(button: InputEventMouseButton) -> bool:
	if pick() == NO_NODE and session.picker.call(&"is_on_arrows", _eye, button.position):
		return false
	_pressed = button
	_positions = [button.position]
	_pinhole = _look_through(_eye)
	# Its ring and label would hide where one draws.
	session.hovered = NO_NODE
	_clear()
	changed.emit()
	return true


func _move(motion: InputEventMouseMotion) -> bool:
	if not is_held():
		return false
	if not motion.button_mask & MOUSE_BUTTON_MASK_LEFT:
		# The button was let go elsewhere.
		_forget()
		return false
	if motion.position.distance_to(_positions[-1]) >= _STEP * get_scale():
		_positions.append(motion.position)
	if not _pinhole.sentence.is_empty() and _extent_of(_positions) >= DRAG_FROM * get_scale():
		session.say(_pinhole.sentence, session.Kind.WARNING)
		_forget()
	changed.emit()
	return true


func _release(button: InputEventMouseButton) -> bool:
	if not is_held():
		return false
	var press: InputEventMouseButton = _pressed
	if button.position != _positions[-1]:
		_positions.append(button.position)
	var stroke: BranchStrokes.Stroke = BranchStrokes.Stroke.new()
	stroke.positions = _positions
	stroke.pinhole = _pinhole
	stroke.options = {"seed": values[&"seed"], "twigs": values[&"twigs"]}
	_forget()
	if _extent_of(stroke.positions) < DRAG_FROM * get_scale():
		_click_at(press, button)
	elif not _is_same(stroke.pinhole, _look_through(_eye)):
		session.say(
			tr("The view was moved while the branch was drawn. Draw it again."),
			session.Kind.WARNING
		)
	else:
		_strokes.add(get_title(), stroke)
	return true


# Meanwhile the view stays as it is.
func _wheel(_steps: int, _button: InputEventMouseButton) -> bool:
	return is_held()


func draw(overlay: Control) -> void:
	super(overlay)
	if is_seen_on(overlay):
		draw_strokes(overlay)


## Draws the strokes over the view that the mouse was in last.
func draw_strokes(on: CanvasItem) -> void:
	if _eye == null or session.node == null:
		return
	if _strokes != null and not _strokes.waiting.is_empty():
		# Where the view has been moved they would lie beside their branches.
		var now: Pinhole = _look_through(_eye)
		for stroke: BranchStrokes.Stroke in _strokes.waiting:
			if _is_same(stroke.pinhole, now):
				_draw_line(on, stroke.positions, _WAITING)
	_draw_line(on, _positions, MEANT)


func _look_again() -> void:
	_clear()
	if is_busy() or session.hovered == NO_NODE:
		return
	_hint = tr("Drag from here along the missing branch.")
	changed.emit()


# A click on wood selects it, and one on nothing is the editor's.
func _click_at(press: InputEventMouseButton, release: InputEventMouseButton) -> void:
	var id: int = pick()
	if id != NO_NODE:
		session.select([id])
	elif session.picker.call(&"is_near", _eye, press.position):
		session.say(tr("Hold the button and drag along the missing branch."))
	elif give_back.is_valid() and _is_editor_s(_eye):
		give_back.call(press, release)


func _forget() -> void:
	_pressed = null
	_pinhole = null
	_positions = []
	changed.emit()


func _look_through(camera: Camera3D) -> Pinhole:
	return Pinhole.new(
		camera,
		session.picker.call(&"get_size", camera),
		session.node.global_transform,
		session.tree.get_aabb(),
		get_translation_domain()
	)


func _on_seed_changed(value: float) -> void:
	set_setting(int(value), &"seed")


func _on_strokes_changed() -> void:
	_queue()
	changed.emit()


func _on_grown(added: PackedInt32Array) -> void:
	session.select(added)


static func _is_same(a: Pinhole, b: Pinhole) -> bool:
	if a.camera.is_empty() or b.camera.is_empty() or a.camera["size"] != b.camera["size"]:
		return false
	var pose: Transform3D = a.camera["transform"]
	var other: Transform3D = b.camera["transform"]
	return (
		pose.origin.distance_to(other.origin) <= _SAME * maxf(1.0, pose.origin.length())
		and pose.basis.is_equal_approx(other.basis)
		and is_equal_approx(a.camera["focal"], b.camera["focal"])
		and (a.camera["principal"] as Vector2).is_equal_approx(b.camera["principal"])
	)


static func _is_editor_s(camera: Camera3D) -> bool:
	for i: int in 4:
		if EditorInterface.get_editor_viewport_3d(i).get_camera_3d() == camera:
			return true
	return false


static func _extent_of(positions: PackedVector2Array) -> float:
	var box: Rect2 = Rect2(positions[0], Vector2.ZERO)
	for position: Vector2 in positions:
		box = box.expand(position)
	return box.size.length()


func _draw_line(on: CanvasItem, positions: PackedVector2Array, color: Color) -> void:
	if positions.size() < 2:
		return
	var scale: float = get_scale()
	on.draw_polyline(positions, _BESIDE, (_WIDTH + 2.0) * scale, true)
	on.draw_polyline(positions, color, _WIDTH * scale, true)
