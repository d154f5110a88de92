@tool
extends RefCounted
## Decides who gets an event of the 3D viewport: the tool at hand, one of our keys, or the editor.
##
## While the skeleton is edited the tool is asked first. What it does not take goes to our keys, and
## the rest to the editor: so orbiting, panning and zooming, and a click on another node, are what
## they always are. A press beside the wood waits until the button is let go: a click close to wood,
## and a drag, would have been the tool's, and are nobody's; any other click is the editor's.

## One of our keys was pressed.
signal asked(action: StringName)
## The mouse was moved over the viewport of this camera.
signal moved(camera: Camera3D)
## A click that the tool did not take was not for the tree.
signal missed(press: InputEventMouseButton, release: InputEventMouseButton)

const Session: GDScript = preload("../session.gd")
const Shortcuts: GDScript = preload("shortcuts.gd")
const Picker: GDScript = preload("picker.gd")
# In pixels at the editor's scale of 1: the mouse goes so far before it drags.
const _DRAGGED: float = 6.0

## The camera that the mouse was over last, and where.
var camera: Camera3D
var position: Vector2

var _session: Session
var _shortcuts: Shortcuts
var _hover_due: bool = false
# Whether the events that come are ones that were given back to the editor.
var _giving_back: bool = false
# The press beside the wood that waits.
var _pressed: InputEventMouseButton
var _dragged: bool = false
# The turns of the wheel, by its direction, that a tool took. The editor would zoom by the end of
# each, too.
var _turned: Dictionary[MouseButton, bool] = {}


func _init(session: Session, shortcuts: Shortcuts) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session
	_shortcuts = shortcuts


## Takes an event, or leaves it to the editor: returns what [method
## EditorPlugin._forward_3d_gui_input] has to return.
func input(from: Camera3D, event: InputEvent) -> int:
	if _giving_back or _session.node == null or _session.tree == null:
		return EditorPlugin.AFTER_GUI_INPUT_PASS
	var mouse: InputEventMouse = event as InputEventMouse
	if mouse != null:
		camera = from
		position = mouse.position
		_hover_due = true
	if _is_flying():
		return EditorPlugin.AFTER_GUI_INPUT_PASS
	if _session.view.editing and _session.tool != null and _ask_tool(from, event):
		return EditorPlugin.AFTER_GUI_INPUT_STOP
	var key: InputEventKey = event as InputEventKey
	if key != null and key.pressed and _press(key):
		return EditorPlugin.AFTER_GUI_INPUT_STOP
	return EditorPlugin.AFTER_GUI_INPUT_PASS


## What is under the mouse may be another one, though it stands still.
func look_again() -> void:
	_hover_due = true


## To be called once a frame: what is under the mouse is looked for once, however often it moved.
func update() -> void:
	if not _hover_due:
		return
	_hover_due = false
	if not is_instance_valid(camera) or _session.tree == null:
		return
	var editing: bool = _session.view.editing and _session.view.skeleton
	editing = editing and (_session.tool == null or _session.tool.call(&"picks_nodes"))
	var busy: bool = Input.get_mouse_button_mask() != 0 and Engine.is_editor_hint()
	if not editing:
		_session.hovered = TreeReconstruction.NO_NODE
	elif not busy:
		_session.hovered = _session.picker.pick(camera, position)
	moved.emit(camera)


## Hands events to the editor that a tool had taken before it knew that they were not for it.
func give_back(to: Control, events: Array[InputEvent]) -> void:
	_giving_back = true
	for event: InputEvent in events:
		to.gui_input.emit(event)
	_giving_back = false


func _ask_tool(from: Camera3D, event: InputEvent) -> bool:
	var button: InputEventMouseButton = event as InputEventMouseButton
	if button != null and button.button_index >= MOUSE_BUTTON_WHEEL_UP:
		return _turn_wheel(from, button)
	if _pressed != null and event is InputEventMouse:
		return _wait(from, event as InputEventMouse)
	if _session.tool.call(&"input", from, event):
		return true
	if button == null or button.button_index != MOUSE_BUTTON_LEFT or not button.pressed:
		return false
	# With Alt the mouse moves the camera in some of the editor's schemes.
	if button.alt_pressed or _session.picker.call(&"is_on_arrows", from, button.position):
		return false
	_pressed = button
	_dragged = false
	return true


func _turn_wheel(from: Camera3D, button: InputEventMouseButton) -> bool:
	if not button.pressed:
		return _turned.erase(button.button_index)
	var taken: bool = _session.tool.call(&"input", from, button)
	if taken:
		_turned[button.button_index] = true
	else:
		_turned.erase(button.button_index)
	return taken


# For what becomes of the press beside the wood.
func _wait(from: Camera3D, event: InputEventMouse) -> bool:
	var at: Vector2 = _pressed.position
	_dragged = _dragged or event.position.distance_to(at) > _DRAGGED * Picker.get_scale()
	var button: InputEventMouseButton = event as InputEventMouseButton
	if button == null:
		if not event.button_mask & MOUSE_BUTTON_MASK_LEFT:
			# It was let go elsewhere.
			_pressed = null
		return true
	if button.button_index != MOUSE_BUTTON_LEFT:
		return false
	var press: InputEventMouseButton = _pressed
	_pressed = null
	if button.pressed:
		# The end of the first click was seen elsewhere.
		return _ask_tool(from, button)
	if _dragged or _session.picker.call(&"is_near", from, at):
		_session.say(tr("There is no wood right there. Click a little nearer to it."))
	else:
		missed.emit(press, button)
	return true


# Returns whether the key is one of ours.
func _press(event: InputEventKey) -> bool:
	var action: StringName = _shortcuts.find(event)
	if action == Shortcuts.NONE:
		return false
	if event.echo and action not in [&"grow_selection", &"shrink_selection"]:
		return true
	if action == &"cancel":
		return _cancel()
	if action not in [&"edit_skeleton", &"view_selection"] and not _session.view.editing:
		# The editor's own keys, as those of its tools, are not touched then. But it would look at
		# the tree's base alone.
		return false
	asked.emit(action)
	return true


# Escape: first what is selected goes, then the tool; with neither it is the editor's.
func _cancel() -> bool:
	if not _session.view.editing:
		return false
	if _session.is_dragging():
		_session.cancel_drag()
	elif not _session.selection.is_empty():
		_session.clear_selection()
	elif _session.tool != null and _session.tool.call(&"get_id") != &"select":
		_session.choose(&"select")
	else:
		return false
	return true


# Whether the mouse looks around while keys move the camera.
static func _is_flying() -> bool:
	return (
		Input.is_mouse_button_pressed(MOUSE_BUTTON_RIGHT)
		or Input.mouse_mode == Input.MOUSE_MODE_CAPTURED
	)
