@tool
extends HFlowContainer
## The tools of the sketch's paper, and what is done with all strokes.

## A tool was chosen: a Tool of sketch_canvas.gd.
signal tool_chosen(tool: int)
## Strokes are to be drawn right in the 3D view, or no more.
signal in_view_chosen(enabled: bool)

const Widgets := preload("../dock/widgets.gd")
const Canvas := preload("sketch_canvas.gd")

var in_view: Button
var begin: Button
var load_file: Button
var save_file: Button
var clear: Button

var _tools: Array[Button] = []


func _init() -> void:
	var group: ButtonGroup = ButtonGroup.new()
	_tools = [
		Widgets.button(
			"Draw",
			"Draws strokes. A click on a stroke selects it; Escape ends one under way.",
			&"Edit"
		),
		Widgets.button(
			"Erase",
			"Erases the strokes that it is drawn over, as the right button does.",
			&"Eraser"
		),
		Widgets.button(
			"Reshape",
			"Shows a few handles of the stroke that is clicked at. Drag them to bend it.",
			&"CurveEdit"
		),
	]
	var keys: Array[Key] = [KEY_D, KEY_E, KEY_R]
	for i: int in _tools.size():
		var tool: Button = _tools[i]
		tool.toggle_mode = true
		tool.button_group = group
		tool.focus_mode = Control.FOCUS_NONE
		tool.shortcut = _shortcut(keys[i])
		tool.pressed.connect(_on_tool.bind(i))
		add_child(tool)
	_tools[0].set_pressed_no_signal(true)
	in_view = (
		Widgets
		. button(
			"Draw in the 3D View",
			(
				"Draws strokes right in the 3D view, over nothing, a scan or a photo, on the upright plane"
				+ " through the tree's base that faced you with the first stroke. Drag with the left button;"
				+ " the others move the view as always. The tree becomes as large as it was drawn."
			),
			&"3D"
		)
	)
	in_view.toggle_mode = true
	in_view.focus_mode = Control.FOCUS_NONE
	in_view.toggled.connect(_on_in_view)
	add_child(in_view)
	add_child(VSeparator.new())
	begin = Widgets.button(
		"New", "Begins another tree on an empty sheet. The tree in the scene stays.", &"New"
	)
	load_file = Widgets.button(
		"Load…", "Reads strokes from a JSON, SVG or PNG file, in the place of these.", &"Load"
	)
	save_file = Widgets.button(
		"Save…", "Writes the strokes to a JSON file. With the scene they are saved anyway.", &"Save"
	)
	clear = Widgets.button(
		"Clear", "Takes all strokes off. The tree stays until new ones make another.", &"Clear"
	)
	for button: Button in [begin, load_file, save_file, clear]:
		button.focus_mode = Control.FOCUS_NONE
		add_child(button)


## Shows what can be done with the strokes there are: without any they are drawn.
func update(has_strokes: bool) -> void:
	if not has_strokes:
		_draw_strokes()
	save_file.disabled = not has_strokes
	clear.disabled = not has_strokes


## The button of a tool.
func get_tool_button(tool: Canvas.Tool) -> Button:
	return _tools[tool]


static func _shortcut(key: Key) -> Shortcut:
	var event: InputEventKey = InputEventKey.new()
	event.keycode = key
	var shortcut: Shortcut = Shortcut.new()
	shortcut.events = [event]
	return shortcut


func _on_tool(index: int) -> void:
	tool_chosen.emit(index)


func _on_in_view(on: bool) -> void:
	if on:
		# The other tools are those of the paper.
		_draw_strokes()
	in_view_chosen.emit(on)


func _draw_strokes() -> void:
	var draw: Button = get_tool_button(Canvas.Tool.DRAW)
	if draw.button_pressed:
		return
	draw.button_pressed = true
	tool_chosen.emit(Canvas.Tool.DRAW)
