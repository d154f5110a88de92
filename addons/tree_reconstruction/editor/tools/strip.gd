@tool
extends HFlowContainer
## A tool's settings, in a row below the viewport.

const _SLIDER_WIDTH: float = 80.0


func _init() -> void:
	# As long a row as there is room for.
	size_flags_horizontal = Control.SIZE_EXPAND_FILL
	add_theme_constant_override(&"h_separation", int(10.0 * _scale()))


func add_text(text: String, tooltip: String = "") -> Label:
	var label: Label = Label.new()
	label.text = text
	label.tooltip_text = tooltip
	label.mouse_filter = Control.MOUSE_FILTER_PASS
	add_child(label)
	return label


## A slider and its number. [param change] is called with the new value.
func add_number(
	text: String,
	tooltip: String,
	low: float,
	high: float,
	step: float,
	value: float,
	change: Callable
) -> Range:
	var group: HBoxContainer = _group(text, tooltip)
	var slider: HSlider = HSlider.new()
	slider.min_value = low
	slider.max_value = high
	slider.step = step
	slider.value = value
	slider.tooltip_text = tooltip
	slider.scrollable = false
	slider.custom_minimum_size.x = _SLIDER_WIDTH * _scale()
	slider.size_flags_vertical = Control.SIZE_SHRINK_CENTER
	var number: SpinBox = SpinBox.new()
	number.tooltip_text = tooltip
	slider.share(number)
	group.add_child(slider)
	group.add_child(number)
	slider.value_changed.connect(change)
	return slider


func add_switch(text: String, tooltip: String, on: bool, change: Callable) -> CheckBox:
	var check: CheckBox = CheckBox.new()
	check.text = text
	check.tooltip_text = tooltip
	check.button_pressed = on
	check.toggled.connect(change)
	add_child(check)
	return check


## [param change] is called with the place of the chosen word.
func add_choice(
	text: String, tooltip: String, words: PackedStringArray, chosen: int, change: Callable
) -> OptionButton:
	var choice: OptionButton = OptionButton.new()
	for word: String in words:
		choice.add_item(word)
	choice.select(chosen)
	choice.item_selected.connect(change)
	add_labelled(text, tooltip, choice)
	return choice


func add_labelled(text: String, tooltip: String, control: Control) -> void:
	control.tooltip_text = tooltip
	_group(text, tooltip).add_child(control)


func add_button(text: String, tooltip: String, act: Callable) -> Button:
	var button: Button = Button.new()
	button.text = text
	button.tooltip_text = tooltip
	button.pressed.connect(act)
	# The viewport keeps the keys.
	button.focus_mode = Control.FOCUS_NONE
	add_child(button)
	return button


func _group(text: String, tooltip: String) -> HBoxContainer:
	var group: HBoxContainer = HBoxContainer.new()
	if not text.is_empty():
		var label: Label = Label.new()
		label.text = text
		label.tooltip_text = tooltip
		label.mouse_filter = Control.MOUSE_FILTER_PASS
		group.add_child(label)
	add_child(group)
	return group


static func _scale() -> float:
	return EditorInterface.get_editor_scale() if Engine.is_editor_hint() else 1.0
