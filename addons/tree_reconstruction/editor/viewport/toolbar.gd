@tool
extends ScrollContainer
## The tools, beside the viewport.

const Session: GDScript = preload("../session.gd")
const Shortcuts: GDScript = preload("shortcuts.gd")
const Icons: GDScript = preload("icons.gd")

var _session: Session
var _shortcuts: Shortcuts
var _edit: Button
var _buttons: Dictionary[StringName, Button] = {}
var _column: VBoxContainer


func _init(session: Session, shortcuts: Shortcuts) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session
	_shortcuts = shortcuts
	name = &"TreeTools"
	horizontal_scroll_mode = SCROLL_MODE_DISABLED
	_column = VBoxContainer.new()
	_column.add_theme_constant_override(&"separation", 0)
	add_child(_column)
	_edit = _make_button(
		&"EditSkeleton",
		"Edit",
		tr("Edit skeleton: the mouse and the keys of the viewport are for the tree's wood.")
	)
	_edit.toggled.connect(func(on: bool) -> void: _session.view.editing = on)
	_column.add_child(HSeparator.new())
	var group: ButtonGroup = ButtonGroup.new()
	for id: StringName in session.tools:
		var tool: RefCounted = session.tools[id]
		var button: Button = _make_button(
			StringName(String(id).to_pascal_case()), tool.call(&"get_icon"), ""
		)
		button.button_group = group
		button.pressed.connect(_session.choose.bind(id))
		_buttons[id] = button
	update()


## Shows which tool is chosen, and the keys as the user has set them.
func update() -> void:
	_edit.set_pressed_no_signal(_session.view.editing)
	_edit.tooltip_text = _shortcuts.describe(
		tr("Edit skeleton: the mouse and the keys of the viewport are for the tree's wood."),
		&"edit_skeleton"
	)
	for id: StringName in _buttons:
		var tool: RefCounted = _session.tools[id]
		var button: Button = _buttons[id]
		button.disabled = not _session.view.editing
		button.set_pressed_no_signal(_session.tool == tool)
		button.tooltip_text = (
			_shortcuts.describe(tool.call(&"get_title"), Shortcuts.name_of_tool(id))
			+ "\n"
			+ tool.call(&"get_tooltip")
		)


func _notification(what: int) -> void:
	if what == NOTIFICATION_THEME_CHANGED and _column != null:
		_set_icons()


func _make_button(id: StringName, icon_name: String, tooltip: String) -> Button:
	var button: Button = Button.new()
	button.name = id
	button.toggle_mode = true
	button.theme_type_variation = &"FlatButton"
	button.focus_mode = Control.FOCUS_NONE
	button.tooltip_text = tooltip
	button.tooltip_auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	button.set_meta(&"icon_name", icon_name)
	_column.add_child(button)
	return button


func _set_icons() -> void:
	for child: Node in _column.get_children():
		if child is Button:
			(child as Button).icon = Icons.find(self, child.get_meta(&"icon_name"))
