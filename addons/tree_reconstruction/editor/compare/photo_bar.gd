@tool
extends PanelContainer
## The controls over a comparison with photos: which photo, what lies over what, and the way out.

## The user wants the photo of this index.
signal chosen(index: int)
## The user wants other photos before or after the one that is shown.
signal stepped(by: int)
signal mode_chosen(mode: int)
signal opacity_chosen(opacity: float)
## The user wants to show where something is.
signal folder_wanted
signal left

const Session: GDScript = preload("../session.gd")
const Picker: GDScript = preload("../viewport/picker.gd")
const Icons: GDScript = preload("../viewport/icons.gd")
const Source: GDScript = preload("photo_source.gd")

var _previous: Button
var _next: Button
var _names: OptionButton
var _count: Label
var _modes: OptionButton
var _opacity: HSlider
var _close: Button
var _message: Label
var _folder: Button
var _below: HBoxContainer
# The views whose names are listed.
var _listed: Array[Dictionary] = []


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	name = &"PhotoBar"
	theme_type_variation = &"PanelForeground"
	var margin: MarginContainer = MarginContainer.new()
	for side: String in ["left", "right", "top", "bottom"]:
		margin.add_theme_constant_override("margin_" + side, int(4 * Picker.get_scale()))
	add_child(margin)
	var rows: VBoxContainer = VBoxContainer.new()
	margin.add_child(rows)
	var row: HFlowContainer = HFlowContainer.new()
	rows.add_child(row)
	_add_photos(row)
	_add_look(row)
	_close = _make_button(
		&"Leave", tr("Leave the photos (Escape). The view is as before."), "Close"
	)
	_close.pressed.connect(left.emit)
	row.add_child(_close)
	_below = HBoxContainer.new()
	rows.add_child(_below)
	_message = Label.new()
	_message.name = &"Message"
	_message.autowrap_mode = TextServer.AUTOWRAP_WORD_SMART
	_message.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	_message.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	_message.mouse_filter = Control.MOUSE_FILTER_PASS
	_below.add_child(_message)
	_folder = Button.new()
	_folder.name = &"ChooseFolder"
	_folder.focus_mode = Control.FOCUS_NONE
	_folder.pressed.connect(folder_wanted.emit)
	_below.add_child(_folder)


## Shows what [param source] has read, and what it lacks. [param note] is said where nothing
## else is wrong.
func update(source: Source, note: String) -> void:
	if not is_same(source.views, _listed):
		_listed = source.views
		_names.clear()
		for view: Dictionary in _listed:
			_names.add_item(view["name"])
	var any: bool = source.index >= 0
	for control: BaseButton in [_previous, _next, _names]:
		control.disabled = not any
	_opacity.editable = source.picture != null
	_modes.disabled = source.picture == null
	_names.select(source.index)
	_count.text = tr("%d of %d") % [source.index + 1, _listed.size()] if any else ""
	var said: String = note if source.sentence.is_empty() else source.sentence
	_below.visible = not said.is_empty()
	_message.text = said
	_message.tooltip_text = said
	_folder.visible = source.lack != Source.Lack.NOTHING
	if source.lack == Source.Lack.MODEL:
		_folder.text = tr("Choose Cameras…")
		_folder.tooltip_text = tr(
			"The folder of COLMAP's model: the one with cameras.bin, or one with sparse/0 in it."
		)
	else:
		_folder.text = tr("Choose Photos…")
		_folder.tooltip_text = tr("The folder of the photos that the tree was made of.")


## Shows what is set.
func set_look(mode: int, opacity: float) -> void:
	_modes.select(mode)
	_opacity.set_value_no_signal(opacity)


func _add_photos(row: Container) -> void:
	_previous = _make_button(&"Previous", tr("The photo before (Left)."), "Back")
	_previous.pressed.connect(stepped.emit.bind(-1))
	row.add_child(_previous)
	_names = OptionButton.new()
	_names.name = &"Photos"
	_names.focus_mode = Control.FOCUS_NONE
	_names.clip_text = true
	_names.custom_minimum_size.x = 150 * Picker.get_scale()
	_names.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	_names.tooltip_text = tr("Which of the photos is looked at, by its name.")
	_names.item_selected.connect(chosen.emit)
	row.add_child(_names)
	_next = _make_button(&"Next", tr("The photo after it (Right)."), "Forward")
	_next.pressed.connect(stepped.emit.bind(1))
	row.add_child(_next)
	_count = Label.new()
	_count.name = &"Count"
	_count.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	row.add_child(_count)


# In the order of photo_stage.gd's Mode.
func _add_look(row: Container) -> void:
	_modes = OptionButton.new()
	_modes.name = &"Modes"
	_modes.focus_mode = Control.FOCUS_NONE
	_modes.add_item(tr("Photo behind"))
	_modes.add_item(tr("Photo in front"))
	_modes.add_item(tr("Difference"))
	_modes.tooltip_text = tr(
		(
			"Where the photo lies: behind the tree, or before it. The difference is dark where the"
			+ " tree has the photo's colors, and bright where it has others, as where wood lies on"
			+ " the photo's sky; beside the tree the photo is dim."
		)
	)
	_modes.item_selected.connect(mode_chosen.emit)
	row.add_child(_modes)
	var label: Label = Label.new()
	label.text = tr("Photo:")
	row.add_child(label)
	_opacity = HSlider.new()
	_opacity.name = &"Opacity"
	_opacity.max_value = 1.0
	_opacity.step = 0.01
	_opacity.focus_mode = Control.FOCUS_NONE
	_opacity.custom_minimum_size.x = 110 * Picker.get_scale()
	_opacity.size_flags_vertical = Control.SIZE_SHRINK_CENTER
	_opacity.tooltip_text = tr("How much of the photo is seen.")
	_opacity.value_changed.connect(opacity_chosen.emit)
	row.add_child(_opacity)


func _make_button(id: StringName, tooltip: String, icon_name: String) -> Button:
	var button: Button = Button.new()
	button.name = id
	button.theme_type_variation = &"FlatButton"
	button.focus_mode = Control.FOCUS_NONE
	button.tooltip_text = tooltip
	button.tooltip_auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	button.set_meta(&"icon_name", icon_name)
	return button


func _notification(what: int) -> void:
	if what == NOTIFICATION_THEME_CHANGED and _folder != null:
		_message.add_theme_color_override(
			&"font_color", get_theme_color(&"warning_color", &"Editor")
		)
		for button: Button in [_previous, _next, _close]:
			button.icon = Icons.find(self, button.get_meta(&"icon_name"))
