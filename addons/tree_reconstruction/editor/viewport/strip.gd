@tool
extends PanelContainer
## The strip below the viewport: the settings of the tool, those of the scan's points, and what was
## said last.

const Session: GDScript = preload("../session.gd")
const ViewState: GDScript = preload("../view_state.gd")
const Picker: GDScript = preload("picker.gd")
# Seconds that a sentence stays before the tool's hint comes back.
const _STAYS: float = 12.0
# Always as many lines, so that the viewport above keeps its size.
const _LINES: int = 2

var _session: Session
var _title: Label
var _settings: Control
var _place: HBoxContainer
var _points: HBoxContainer
var _size: HSlider
var _colors: OptionButton
var _status: Label
var _left: float = 0.0


func _init(session: Session) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session
	name = &"TreeStrip"
	theme_type_variation = &"PanelForeground"
	var margin: MarginContainer = MarginContainer.new()
	for side: String in ["left", "right"]:
		margin.add_theme_constant_override("margin_" + side, int(8 * Picker.get_scale()))
	for side: String in ["top", "bottom"]:
		margin.add_theme_constant_override("margin_" + side, int(3 * Picker.get_scale()))
	add_child(margin)
	var rows: VBoxContainer = VBoxContainer.new()
	margin.add_child(rows)
	_place = HBoxContainer.new()
	_place.add_theme_constant_override(&"separation", int(10 * Picker.get_scale()))
	rows.add_child(_place)
	_title = Label.new()
	_title.theme_type_variation = &"HeaderSmall"
	_place.add_child(_title)
	_make_points()
	_place.add_child(_points)
	_status = Label.new()
	_status.name = &"Status"
	_status.text_overrun_behavior = TextServer.OVERRUN_TRIM_ELLIPSIS
	_status.autowrap_mode = TextServer.AUTOWRAP_WORD_SMART
	_status.max_lines_visible = _LINES
	_status.mouse_filter = Control.MOUSE_FILTER_PASS
	_status.auto_translate_mode = Node.AUTO_TRANSLATE_MODE_DISABLED
	rows.add_child(_status)
	session.said.connect(say)
	update_tool()
	update_view()


## Another tool was chosen: its settings come, the other ones go.
func update_tool() -> void:
	if _settings != null:
		_settings.queue_free()
		_settings = null
	var tool: RefCounted = _session.tool
	if tool != null and _session.view.editing:
		_settings = tool.call(&"make_settings")
		_title.text = tool.call(&"get_title")
	_title.visible = _settings != null
	if _settings != null:
		# As wide as it can be, since it breaks into rows.
		_settings.size_flags_horizontal = Control.SIZE_EXPAND_FILL
		_settings.size_flags_vertical = Control.SIZE_SHRINK_CENTER
		_place.add_child(_settings)
		_place.move_child(_settings, 1)
	_left = 0.0
	_show_hint()


## What is shown changed.
func update_view() -> void:
	_points.visible = _session.view.points
	_size.set_value_no_signal(_session.view.point_size)
	_colors.select(_session.view.point_colors)
	var colorless: bool = _session.scan.colors.is_empty() and not _session.scan.points.is_empty()
	_colors.set_item_disabled(ViewState.PointColors.SCAN, colorless)
	if colorless and _session.view.point_colors == ViewState.PointColors.SCAN:
		_colors.select(ViewState.PointColors.HEIGHT)


## Shows a sentence for a while.
func say(sentence: String, kind: Session.Kind) -> void:
	_left = _STAYS
	_status.text = sentence
	_status.tooltip_text = sentence
	_status.add_theme_color_override(&"font_color", _color_of(kind))


## Takes a sentence back that no longer holds, if it is the last one that was said.
func forget(sentence: String) -> void:
	if _left > 0.0 and _status.text == sentence:
		_left = 0.0
		_show_hint()


## To be called once a frame.
func update(delta: float) -> void:
	if _left > 0.0:
		_left -= delta
		if _left <= 0.0:
			_show_hint()


func _notification(what: int) -> void:
	if what == NOTIFICATION_THEME_CHANGED and _status != null:
		var line: float = get_theme_font(&"font", &"Label").get_height(
			get_theme_font_size(&"font_size", &"Label")
		)
		var between: int = get_theme_constant(&"line_spacing", &"Label")
		var border: float = get_theme_stylebox(&"normal", &"Label").get_minimum_size().y
		_status.custom_minimum_size.y = _LINES * (line + between) + border


func _show_hint() -> void:
	var hint: String = tr("Press Tab or switch 'Edit skeleton' on to edit the tree's wood.")
	if _session.view.editing:
		hint = ""
		if _session.tool != null:
			hint = "%s: %s" % [_session.tool.call(&"get_title"), _session.tool.call(&"get_tooltip")]
	_status.text = hint
	_status.tooltip_text = hint
	_status.add_theme_color_override(&"font_color", _color_of(Session.Kind.INFO))


func _make_points() -> void:
	_points = HBoxContainer.new()
	_points.size_flags_horizontal = Control.SIZE_SHRINK_END | Control.SIZE_EXPAND
	_points.size_flags_vertical = Control.SIZE_SHRINK_CENTER
	_points.name = &"Points"
	var label: Label = Label.new()
	label.text = tr("Points:")
	_points.add_child(label)
	_colors = OptionButton.new()
	_colors.tooltip_text = tr(
		(
			"By what the scan's points are coloured. By distance to the bark, blue points lie on it"
			+ " and red ones off it: there the tree misses something."
		)
	)
	_colors.add_item(tr("Colors of the scan"), ViewState.PointColors.SCAN)
	_colors.add_item(tr("By height"), ViewState.PointColors.HEIGHT)
	_colors.add_item(tr("By distance to the bark"), ViewState.PointColors.FIDELITY)
	_colors.focus_mode = Control.FOCUS_NONE
	_colors.item_selected.connect(
		func(index: int) -> void: _session.view.point_colors = index as ViewState.PointColors
	)
	_points.add_child(_colors)
	_size = HSlider.new()
	_size.tooltip_text = tr("How large the scan's points are drawn.")
	_size.min_value = 1.0
	_size.max_value = 10.0
	_size.step = 0.5
	_size.focus_mode = Control.FOCUS_NONE
	_size.custom_minimum_size.x = 100 * Picker.get_scale()
	_size.size_flags_vertical = Control.SIZE_SHRINK_CENTER
	_size.value_changed.connect(func(value: float) -> void: _session.view.point_size = value)
	_points.add_child(_size)


func _color_of(kind: Session.Kind) -> Color:
	match kind:
		Session.Kind.WARNING:
			return get_theme_color(&"warning_color", &"Editor")
		Session.Kind.ERROR:
			return get_theme_color(&"error_color", &"Editor")
	return get_theme_color(&"font_color", &"Label")
