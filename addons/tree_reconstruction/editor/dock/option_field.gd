@tool
extends HBoxContainer
## One option of a stage, with the control that suits its kind.

## The user changed it.
signal edited

const Widgets := preload("widgets.gd")
const _MOST: float = 1e6

var option: StringName
var _type: int
var _control: Control


## [param of] is an entry of [method TreeReconstructor.get_option_list].
func _init(of: Dictionary, title: String) -> void:
	option = of.name
	_type = of.type
	_control = _make_control(of)
	var tip: String = of.description
	if _control is CheckBox:
		(_control as CheckBox).text = title
		(_control as CheckBox).clip_text = true
	else:
		var label: Label = Widgets.words(title, tip)
		label.size_flags_stretch_ratio = 1.4
		add_child(label)
	_control.tooltip_text = tip
	_control.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	add_child(_control)


## Shows another value.
func set_value(value: Variant) -> void:
	if _control is CheckBox:
		(_control as CheckBox).set_pressed_no_signal(value)
	elif _control is OptionButton:
		Widgets.choose(_control as OptionButton, value)
	elif _control is SpinBox:
		(_control as SpinBox).set_value_no_signal(value)
	elif _type == TYPE_PACKED_FLOAT64_ARRAY:
		var numbers: PackedStringArray = []
		for number: float in value:
			numbers.append(String.num(number))
		(_control as LineEdit).text = ", ".join(numbers)
	else:
		(_control as LineEdit).text = value


## What it is set to.
func get_value() -> Variant:
	if _control is CheckBox:
		return (_control as CheckBox).button_pressed
	if _control is OptionButton:
		var list: OptionButton = _control as OptionButton
		return "" if list.selected < 0 else list.get_selected_metadata()
	if _control is SpinBox:
		var number: float = (_control as SpinBox).value
		return int(number) if _type == TYPE_INT else number
	var text: String = (_control as LineEdit).text.strip_edges()
	if _type == TYPE_PACKED_FLOAT64_ARRAY:
		# What is no number is left to the reconstruction, which says what it needs.
		var numbers: PackedFloat64Array = []
		for part: String in text.replace(";", ",").replace(" ", ",").split(",", false):
			numbers.append(part.to_float() if part.is_valid_float() else NAN)
		return numbers
	return text


func _make_control(of: Dictionary) -> Control:
	match _type:
		TYPE_BOOL:
			var box: CheckBox = CheckBox.new()
			box.toggled.connect(func(_on: bool) -> void: edited.emit())
			return box
		TYPE_INT, TYPE_FLOAT:
			return _make_number(of)
	if of.hint == PROPERTY_HINT_ENUM:
		var values: PackedStringArray = (of.hint_string as String).split(",")
		var titles: PackedStringArray = []
		for value: String in values:
			# Axes such as -y stay as they are.
			titles.append(value.capitalize() if value.length() > 2 else value.to_upper())
		var list: OptionButton = Widgets.choice(titles, Array(values))
		list.item_selected.connect(func(_index: int) -> void: edited.emit())
		return list
	var line: LineEdit = LineEdit.new()
	line.text_changed.connect(func(_text: String) -> void: edited.emit())
	return line


func _make_number(of: Dictionary) -> SpinBox:
	var low: float = 0.0
	var high: float = _MOST
	var step: float = 1.0 if _type == TYPE_INT else 0.001
	var suffix: String = ""
	var box: SpinBox = Widgets.number(low, high, step)
	if of.hint == PROPERTY_HINT_RANGE:
		var parts: PackedStringArray = (of.hint_string as String).split(",")
		low = parts[0].to_float()
		high = parts[1].to_float()
		if parts.size() > 2 and parts[2].is_valid_float():
			step = parts[2].to_float()
		box.allow_greater = "or_greater" in parts
		for part: String in parts:
			if part.begins_with("suffix:"):
				suffix = part.trim_prefix("suffix:")
	box.min_value = low
	box.max_value = high
	box.step = step
	box.suffix = suffix
	box.value_changed.connect(func(_value: float) -> void: edited.emit())
	return box
