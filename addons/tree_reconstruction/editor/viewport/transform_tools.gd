@tool
extends RefCounted
## Puts the editor's tools for moving and turning the whole node away while the skeleton is edited:
## their arrows and rings stand right on the trunk. Whoever chooses one of them keeps it.

const _SELECT: String = "spatial_editor/tool_select"
const _OTHERS: PackedStringArray = [
	"spatial_editor/tool_transform",
	"spatial_editor/tool_move",
	"spatial_editor/tool_rotate",
	"spatial_editor/tool_scale",
]

# By the name of its shortcut; empty where this version of the editor has other ones.
var _buttons: Dictionary[String, Button] = {}
# The one that was chosen before, or null.
var _before: Button


## Looks for the editor's buttons among those of its 3D screen.
func find(viewport: SubViewport) -> void:
	_buttons.clear()
	var screen: Node = viewport
	while screen != null and screen.get_class() != "Node3DEditor":
		screen = screen.get_parent()
	if screen == null:
		return
	var settings: EditorSettings = EditorInterface.get_editor_settings()
	for found: Node in screen.find_children("*", "Button", true, false):
		var button: Button = found as Button
		if button.shortcut == null or not button.toggle_mode:
			continue
		for path: String in _OTHERS + PackedStringArray([_SELECT]):
			if button.shortcut == settings.get_shortcut(path):
				_buttons[path] = button


## Whether arrows and rings are shown.
func are_shown() -> bool:
	var select: Button = _buttons.get(_SELECT)
	return not is_instance_valid(select) or not select.button_pressed


## The skeleton is edited.
func put_away() -> void:
	var select: Button = _buttons.get(_SELECT)
	if _before != null or not is_instance_valid(select) or select.button_pressed:
		return
	for path: String in _OTHERS:
		var button: Button = _buttons.get(path)
		if is_instance_valid(button) and button.button_pressed:
			_before = button
	if _before != null:
		select.pressed.emit()


## It is edited no more.
func bring_back() -> void:
	if is_instance_valid(_before) and not are_shown():
		_before.pressed.emit()
	_before = null
