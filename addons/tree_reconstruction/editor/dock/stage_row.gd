@tool
extends VBoxContainer
## One stage on the way from the scan to the tree: how it went, its options, and a button that does
## it again.

## The user wants it done again.
signal run_requested

enum State { NONE, DONE, CHANGED, RUNNING, FAILED }

const Widgets := preload("widgets.gd")
const OptionField := preload("option_field.gd")
const _ICONS: Dictionary[State, StringName] = {
	State.NONE: &"GuiRadioUnchecked",
	State.DONE: &"StatusSuccess",
	State.CHANGED: &"StatusWarning",
	State.RUNNING: &"Progress1",
	State.FAILED: &"StatusError",
}

var state: State = State.NONE
var run: Button

var _icon: Widgets.ThemeIcon = Widgets.ThemeIcon.new()
var _head: Button
var _count: Label
var _time: Label
var _options: VBoxContainer = VBoxContainer.new()
var _fields: Dictionary[StringName, OptionField] = {}
# What the tree was made with.
var _values: Dictionary = {}
var _known: bool = true
var _failed: bool = false
var _running: bool = false


func _init(title: String, tip: String, run_tip: String) -> void:
	_head = Widgets.button(title, tip, &"GuiTreeArrowRight")
	_head.flat = true
	_head.toggle_mode = true
	_head.alignment = HORIZONTAL_ALIGNMENT_LEFT
	_head.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	_head.size_flags_stretch_ratio = 0.6
	_head.toggled.connect(_on_toggled)
	_count = Widgets.figure("", 56)
	_time = Widgets.figure("", 56)
	_time.modulate.a = 0.7
	run = Widgets.button("", run_tip, &"Play")
	run.flat = true
	run.pressed.connect(func() -> void: run_requested.emit())
	var line: HBoxContainer = HBoxContainer.new()
	for part: Control in [_icon, _head, _count, _time, run]:
		line.add_child(part)
	_icon.custom_minimum_size = Vector2.ONE * Widgets.px(16)
	_icon.mouse_filter = Control.MOUSE_FILTER_PASS
	add_child(line)
	var margin: MarginContainer = MarginContainer.new()
	margin.add_theme_constant_override(&"margin_left", Widgets.px(22))
	margin.add_child(_options)
	margin.visible = false
	add_child(margin)


## Adds an option.
func add_field(field: OptionField) -> void:
	_fields[field.option] = field
	_options.add_child(field)
	field.edited.connect(_show_state)


## Shows the options that the tree was made with, where the user has not changed them.
func set_values(values: Dictionary) -> void:
	var changed: Dictionary = get_changed()
	for option: StringName in _fields:
		# As the field shows it: numbers are rounded to its step.
		_fields[option].set_value(values[option])
		_values[option] = _fields[option].get_value()
		if changed.has(String(option)):
			_fields[option].set_value(changed[String(option)])
	_show_state()


## Forgets what the user changed.
func reset() -> void:
	for option: StringName in _fields:
		if _values.has(option):
			_fields[option].set_value(_values[option])
	_show_state()


## All options as the user has set them.
func get_values() -> Dictionary:
	var values: Dictionary = {}
	for option: StringName in _fields:
		values[String(option)] = _fields[option].get_value()
	return values


## The options that differ from those that the tree was made with.
func get_changed() -> Dictionary:
	var changed: Dictionary = {}
	for option: StringName in _fields:
		var value: Variant = _fields[option].get_value()
		if _values.has(option) and value != _values[option]:
			changed[String(option)] = value
	return changed


## The field of an option, or [code]null[/code].
func get_field(option: StringName) -> OptionField:
	return _fields.get(option)


## What it made, and how long that took. Without a count it was not done.
func show_result(count: String, count_tip: String, milliseconds: float) -> void:
	_known = not count.is_empty()
	_count.text = count
	_count.tooltip_text = count_tip
	_time.text = Widgets.duration(milliseconds) if milliseconds > 0.0 else ""
	_time.tooltip_text = tr("How long this stage took.")
	_show_state()


## It is being done.
func set_running(on: bool) -> void:
	_running = on
	if on:
		_failed = false
	_show_state()


## It could not be done.
func set_failed(on: bool) -> void:
	_failed = on
	_show_state()


func _on_toggled(open: bool) -> void:
	(_options.get_parent() as Control).visible = open
	(_head as Widgets.IconButton).icon_name = &"GuiTreeArrowDown" if open else &"GuiTreeArrowRight"


func _show_state() -> void:
	var tip: String
	if _running:
		state = State.RUNNING
		tip = tr("This stage is being done.")
	elif _failed:
		state = State.FAILED
		tip = tr("This stage failed; the tree is as it was.")
	elif not get_changed().is_empty():
		state = State.CHANGED
		tip = tr("Its options were changed since. Press the button on the right to apply them.")
	elif _known:
		state = State.DONE
		tip = tr("Done with these options.")
	else:
		state = State.NONE
		tip = tr("This tree was made without this stage.")
	_icon.icon_name = _ICONS[state]
	_icon.tooltip_text = tip
