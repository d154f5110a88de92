@tool
extends RefCounted
## Small controls that the dock is made of, with icons and sizes of the editor's theme.

const _ICONS: StringName = &"EditorIcons"


## A button whose icon follows the editor's theme.
class IconButton:
	extends Button

	var icon_name: StringName:
		set(value):
			icon_name = value
			_show_icon()

	func _notification(what: int) -> void:
		if what == NOTIFICATION_THEME_CHANGED or what == NOTIFICATION_ENTER_TREE:
			_show_icon()

	func _show_icon() -> void:
		# Outside of the editor its icons don't exist.
		if is_inside_tree() and has_theme_icon(icon_name, _ICONS):
			icon = get_theme_icon(icon_name, _ICONS)


## A picture that follows the editor's theme.
class ThemeIcon:
	extends TextureRect

	var icon_name: StringName:
		set(value):
			icon_name = value
			_show_icon()

	func _init() -> void:
		stretch_mode = TextureRect.STRETCH_KEEP_CENTERED

	func _notification(what: int) -> void:
		if what == NOTIFICATION_THEME_CHANGED or what == NOTIFICATION_ENTER_TREE:
			_show_icon()

	func _show_icon() -> void:
		if icon_name == &"":
			texture = null
		elif is_inside_tree() and has_theme_icon(icon_name, _ICONS):
			texture = get_theme_icon(icon_name, _ICONS)


## What sizes are multiplied by.
static func get_scale() -> float:
	return EditorInterface.get_editor_scale() if Engine.is_editor_hint() else 1.0


## A size in whole pixels of the editor's scale.
static func px(size: float) -> int:
	return roundi(size * get_scale())


## A button with words, an icon, or both.
static func button(words: String, tip: String, icon: StringName = &"") -> IconButton:
	var made: IconButton = IconButton.new()
	made.text = words
	made.tooltip_text = tip
	made.icon_name = icon
	if words.is_empty():
		made.theme_type_variation = &"FlatButton"
	return made


## Words that are cut where there is no room.
static func words(text: String, tip: String) -> Label:
	var made: Label = Label.new()
	made.text = text
	made.tooltip_text = tip
	made.mouse_filter = Control.MOUSE_FILTER_PASS
	made.clip_text = true
	made.text_overrun_behavior = TextServer.OVERRUN_TRIM_ELLIPSIS
	made.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	return made


## A number or another short value at the right end of a line, shown wholly.
static func figure(tip: String, width: float = 0.0) -> Label:
	var made: Label = Label.new()
	made.tooltip_text = tip
	made.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	made.mouse_filter = Control.MOUSE_FILTER_PASS
	made.horizontal_alignment = HORIZONTAL_ALIGNMENT_RIGHT
	made.custom_minimum_size.x = px(width)
	return made


## A sentence that goes over as many lines as it needs. What it says is made elsewhere.
static func sentence(text: String = "") -> Label:
	var made: Label = Label.new()
	made.text = text
	made.autowrap_mode = TextServer.AUTOWRAP_WORD_SMART
	made.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	# Without a width of its own a wrapped label would ask for all the height.
	made.custom_minimum_size.x = px(60)
	return made


## A name to the left of a control, that share a line.
static func line(title: String, tip: String, control: Control) -> HBoxContainer:
	var made: HBoxContainer = HBoxContainer.new()
	var name: Label = words(title, tip)
	made.add_child(name)
	control.tooltip_text = tip
	control.size_flags_horizontal = Control.SIZE_EXPAND_FILL
	made.add_child(control)
	return made


## A number to type or turn.
static func number(low: float, high: float, step: float, suffix: String = "") -> SpinBox:
	var made: SpinBox = SpinBox.new()
	made.min_value = low
	made.max_value = high
	made.step = step
	made.suffix = suffix
	made.select_all_on_focus = true
	made.custom_minimum_size.x = px(70)
	return made


## A list to choose from; each entry's metadata is the one of [param values] at its place.
static func choice(titles: PackedStringArray, values: Array) -> OptionButton:
	var made: OptionButton = OptionButton.new()
	made.fit_to_longest_item = false
	made.clip_text = true
	for i: int in titles.size():
		made.add_item(titles[i])
		made.set_item_metadata(i, values[i])
	return made


## Chooses the entry with this metadata.
static func choose(list: OptionButton, value: Variant) -> void:
	for i: int in list.item_count:
		if (
			typeof(list.get_item_metadata(i)) == typeof(value)
			and list.get_item_metadata(i) == value
		):
			list.select(i)
			return
	list.select(-1)


## 12345 as 12,345.
static func grouped(count: int) -> String:
	var digits: String = str(absi(count))
	var parts: PackedStringArray = []
	while digits.length() > 3:
		parts.insert(0, digits.right(3))
		digits = digits.left(-3)
	parts.insert(0, digits)
	return ("-" if count < 0 else "") + ",".join(parts)


## A time as one reads it.
static func duration(milliseconds: float) -> String:
	if milliseconds < 1000.0:
		return "%d ms" % ceili(milliseconds)
	if milliseconds < 60_000.0:
		return "%.1f s" % (milliseconds / 1000.0)
	return "%d min %d s" % [int(milliseconds / 60_000.0), int(milliseconds / 1000.0) % 60]
