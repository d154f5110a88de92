extends PanelContainer
## The controls of a demo scene at the left edge of the window, one below the other.

const _START: String = "res://scenes/start.tscn"
const _WIDTH: float = 300.0

var _rows: VBoxContainer = VBoxContainer.new()
var _notes: Label


func _init() -> void:
	position = Vector2(16.0, 16.0)
	custom_minimum_size.x = _WIDTH
	var look: StyleBoxFlat = StyleBoxFlat.new()
	look.bg_color = Color(0.09, 0.11, 0.1, 0.82)
	look.set_corner_radius_all(8)
	look.set_content_margin_all(14.0)
	add_theme_stylebox_override(&"panel", look)
	_rows.add_theme_constant_override(&"separation", 6)
	add_child(_rows)


## What the scene shows, and a way back to the others.
func begin(title: String, sentence: String, with_way_back: bool = true) -> void:
	var top: HBoxContainer = HBoxContainer.new()
	_rows.add_child(top)
	var heading: Label = Label.new()
	heading.text = title
	heading.size_flags_horizontal = SIZE_EXPAND_FILL
	heading.add_theme_font_size_override(&"font_size", 20)
	top.add_child(heading)
	set_process_unhandled_key_input(with_way_back)
	if with_way_back:
		var back: Button = Button.new()
		back.text = "All scenes"
		back.tooltip_text = "Goes back to the list of scenes (Escape)."
		back.pressed.connect(_go_back)
		top.add_child(back)
	_rows.add_child(_sentence(sentence))


## The figures below the controls.
func note(text: String) -> void:
	if _notes == null:
		_notes = _sentence("")
		_notes.modulate = Color(0.75, 0.86, 0.7)
		_rows.add_child(_notes)
	_notes.text = text


## A row with a slider. `changed` gets the number.
func slider(
	title: String, tip: String, numbers: Vector3, value: float, changed: Callable
) -> HSlider:
	var control: HSlider = HSlider.new()
	control.min_value = numbers.x
	control.max_value = numbers.y
	control.step = numbers.z
	control.value = value
	control.size_flags_vertical = SIZE_SHRINK_CENTER
	control.value_changed.connect(changed)
	_row(title, tip, control)
	return control


func choice(
	title: String, tip: String, names: PackedStringArray, chosen: int, changed: Callable
) -> OptionButton:
	var control: OptionButton = OptionButton.new()
	for entry: String in names:
		control.add_item(entry.capitalize())
	control.select(chosen)
	control.item_selected.connect(changed)
	_row(title, tip, control)
	return control


func check(title: String, tip: String, on: bool, changed: Callable) -> CheckButton:
	var control: CheckButton = CheckButton.new()
	control.text = title
	control.tooltip_text = tip
	control.button_pressed = on
	control.toggled.connect(changed)
	_rows.add_child(control)
	return control


func button(title: String, tip: String, pressed: Callable) -> Button:
	var control: Button = Button.new()
	control.text = title
	control.tooltip_text = tip
	control.pressed.connect(pressed)
	_rows.add_child(control)
	return control


func _unhandled_key_input(event: InputEvent) -> void:
	if event.is_action_pressed(&"ui_cancel"):
		_go_back()


func _row(title: String, tip: String, control: Control) -> void:
	var row: HBoxContainer = HBoxContainer.new()
	var name_of_it: Label = Label.new()
	name_of_it.text = title
	name_of_it.custom_minimum_size.x = 0.36 * _WIDTH
	name_of_it.tooltip_text = tip
	name_of_it.mouse_filter = MOUSE_FILTER_STOP
	control.tooltip_text = tip
	control.size_flags_horizontal = SIZE_EXPAND_FILL
	row.add_child(name_of_it)
	row.add_child(control)
	_rows.add_child(row)


func _sentence(text: String) -> Label:
	var label: Label = Label.new()
	label.text = text
	label.autowrap_mode = TextServer.AUTOWRAP_WORD_SMART
	label.custom_minimum_size.x = _WIDTH - 28.0
	label.add_theme_font_size_override(&"font_size", 14)
	label.modulate = Color(0.85, 0.87, 0.85)
	return label


func _go_back() -> void:
	get_tree().change_scene_to_file(_START)
