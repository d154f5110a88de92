@tool
extends "tool.gd"
## Selects nodes: by a click, with all that grows from them by a double click, by a box.
##
## A press on nothing may become a box or be a click on something else of the scene. So it waits:
## where the mouse does not move, the editor gets the click when the button is let go; unless it is
## so near to wood that it was meant for that.

const NO_NODE: int = TreeReconstruction.NO_NODE
# In pixels at the editor's scale of 1.
const _DRAGGED: float = 6.0

## Called with the events of a click that was not for the tree, to hand it to the editor.
var give_back: Callable

var _pressed: InputEventMouseButton
var _camera: Camera3D
var _box: Rect2
var _boxing: bool = false


func get_id() -> StringName:
	return &"select"


func get_title() -> String:
	return tr("Select")


func get_tooltip() -> String:
	return tr(
		(
			"Click on wood to select a node, double-click to select all that grows from it, drag over"
			+ " nothing to select what is in the box. Shift adds to the selection, Ctrl adds or takes"
			+ " away."
		)
	)


func get_icon() -> String:
	return "ToolSelect"


func get_key() -> Key:
	return KEY_Q


func stop() -> void:
	_forget()


func input(camera: Camera3D, event: InputEvent) -> bool:
	var button: InputEventMouseButton = event as InputEventMouseButton
	if button != null:
		return _press(camera, button)
	var motion: InputEventMouseMotion = event as InputEventMouseMotion
	if motion != null:
		return _pressed != null and _drag(camera, motion)
	if _boxing and event.is_action_pressed(&"ui_cancel"):
		_forget()
		return true
	return false


func draw(overlay: Control) -> void:
	if not _boxing or session.picker.get_camera_of(overlay) != _camera:
		return
	var color: Color = overlay.get_theme_color(&"box_selection_fill_color", &"Editor")
	var line: Color = overlay.get_theme_color(&"box_selection_stroke_color", &"Editor")
	overlay.draw_rect(_box.abs(), color)
	overlay.draw_rect(_box.abs(), line, false, maxf(1.0, roundf(session.picker.get_scale())))


func _press(camera: Camera3D, event: InputEventMouseButton) -> bool:
	if event.button_index != MOUSE_BUTTON_LEFT:
		if event.pressed and _boxing:
			_forget()
		return false
	if not event.pressed:
		return _pressed != null and _release(event)
	# With Alt the mouse moves the camera in some of the editor's schemes.
	if event.alt_pressed:
		return false
	var id: int = session.picker.pick(camera, event.position)
	if id == NO_NODE:
		if session.picker.is_on_arrows(camera, event.position):
			return false
		_pressed = event
		_camera = camera
		return true
	if event.double_click:
		var ids: PackedInt32Array = session.tree.select_nodes("below:%d" % id)
		session.select(ids, Session.How.ADD if _adds(event) else Session.How.REPLACE)
		# The one that was clicked is the active one.
		session.select([id], Session.How.ADD)
	else:
		session.select([id], _how(event))
	return true


func _drag(camera: Camera3D, event: InputEventMouseMotion) -> bool:
	if camera != _camera:
		return false
	if not event.button_mask & MOUSE_BUTTON_MASK_LEFT:
		# The button was let go elsewhere.
		_forget()
		return false
	_box = Rect2(_pressed.position, event.position - _pressed.position)
	if _box.size.length() > _DRAGGED * session.picker.get_scale():
		_boxing = true
	if _boxing:
		changed.emit()
	return true


func _release(event: InputEventMouseButton) -> bool:
	var pressed: InputEventMouseButton = _pressed
	var boxing: bool = _boxing
	var box: Rect2 = _box
	var camera: Camera3D = _camera
	_forget()
	if boxing:
		session.select(session.picker.pick_rect(camera, box), _how(event))
	elif session.picker.is_near(camera, pressed.position):
		# What is selected stays: the click was meant for wood.
		session.say(tr("There is no wood right there. Click a little nearer to it."))
	elif give_back.is_valid():
		give_back.call(pressed, event)
	return true


func _forget() -> void:
	_pressed = null
	if _boxing:
		_boxing = false
		changed.emit()


func _how(event: InputEventMouseButton) -> int:
	if event.is_command_or_control_pressed():
		return Session.How.TOGGLE
	return Session.How.ADD if event.shift_pressed else Session.How.REPLACE


func _adds(event: InputEventMouseButton) -> bool:
	return event.shift_pressed or event.is_command_or_control_pressed()
