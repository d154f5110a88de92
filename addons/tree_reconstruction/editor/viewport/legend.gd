@tool
extends RefCounted
## What the colors in the viewport mean, in its corner: those of the scan's points by a measure, and
## those of the tree by a channel of its wind.

const Session: GDScript = preload("../session.gd")
const Picker: GDScript = preload("picker.gd")
const PointView: GDScript = preload("point_view.gd")
const ViewState: GDScript = preload("../view_state.gd")
## As the library colors distances, the tolerance in the middle and three of it at the end.
const HEAT: PackedColorArray = [
	Color("2654a0"), Color("5ea4c8"), Color("f2dd82"), Color("ec8238"), Color("b01020")
]
const _GREY: PackedColorArray = [Color.BLACK, Color.WHITE]
const _AXES: PackedColorArray = [Color.RED, Color.GREEN, Color.BLUE]
# Of the bark and leaves that a channel has nothing for.
const _NOTHING: Color = Color(0.2, 0.2, 0.2)
# Orders of branches that are named.
const _MOST: int = 8
# In pixels at the editor's scale of 1. Below the panel the viewport says what its own tools do.
const _WIDTH: float = 190.0
const _BAR: float = 12.0
const _GAP: float = 6.0
const _BOTTOM: float = 34.0


## The meaning of one coloring.
class Meaning:
	extends RefCounted
	var title: String
	## A bar's colors in even steps, and what is written below it in even steps; or none.
	var ramp: PackedColorArray
	var values: PackedStringArray
	## Single colors and what each is.
	var swatches: PackedColorArray
	var words: PackedStringArray

	func _init(of: String) -> void:
		title = of

	func set_ramp(colors: PackedColorArray, marks: PackedStringArray) -> void:
		ramp = colors
		values = marks

	func add(color: Color, word: String) -> void:
		swatches.append(color)
		words.append(word)


## Of what is shown now.
var keys: Array[Meaning] = []

var _session: Session
var _points: PointView


func _init(session: Session, points: PointView) -> void:
	set_translation_domain(session.get_translation_domain())
	_session = session
	_points = points


## What is shown, the tree or the scan may have changed.
func update() -> void:
	keys.clear()
	if _session.tree == null:
		return
	if _points.layer.shown:
		_add_points()
	if _session.view.channel > 0:
		_add_channel(_session.view.channel)


## Draws into an overlay over a viewport.
func draw(overlay: Control) -> void:
	var scale: float = Picker.get_scale()
	var bottom: float = overlay.size.y - _BOTTOM * scale
	for key: Meaning in keys:
		var size: Vector2 = _measure(overlay, key, scale)
		_draw_key(overlay, key, Rect2(Vector2(_GAP * scale, bottom - size.y), size), scale)
		bottom -= size.y + _GAP * scale


func _add_points() -> void:
	if _points.colored_by == ViewState.PointColors.HEIGHT:
		var height: Meaning = Meaning.new(tr("Height"))
		height.set_ramp(PointView.HEIGHTS, [_height(_points.low), _height(_points.high)])
		keys.append(height)
	elif _points.colored_by == ViewState.PointColors.FIDELITY:
		var tolerance: float = _session.scan.TOLERANCE
		var distance: Meaning = Meaning.new(tr("Distance to the bark"))
		distance.set_ramp(
			HEAT, [_metres(0.0), _metres(tolerance), tr("%s or more") % _metres(3.0 * tolerance)]
		)
		if _session.scan.wood.size() < _session.scan.points.size():
			distance.add(_session.scan.LEAF_COLOR, tr("Leaves, not compared"))
		keys.append(distance)


func _add_channel(channel: int) -> void:
	var key: Meaning
	match channel:
		TreeWind.Channel.SWAY:
			key = Meaning.new(tr("Height"))
			key.set_ramp(_GREY, [_height(0.0), _height(_session.tree.get_aabb().end.y)])
		TreeWind.Channel.ALONG:
			key = Meaning.new(tr("Along the Branch"))
			key.set_ramp(_GREY, [tr("Base"), tr("Tip")])
		TreeWind.Channel.PHASE:
			key = Meaning.new(tr("Phase"))
			key.set_ramp(_hues(), ["0°", "180°", "360°"])
		TreeWind.Channel.OCCLUSION:
			key = Meaning.new(tr("Ambient Occlusion"))
			key.set_ramp(_GREY, [tr("Hidden"), tr("Open to the sky")])
		TreeWind.Channel.PIVOT:
			key = Meaning.new(tr("Pivot"))
			_add_axes(key, tr("%s, from 0 to 1 m and again"))
			key.add(_NOTHING, tr("Leaves, without one"))
		TreeWind.Channel.LEVEL:
			key = Meaning.new(tr("Branch Level"))
			_add_orders(key)
			key.add(_NOTHING, tr("Leaves, without one"))
		TreeWind.Channel.PRIMARY_BRANCH, TreeWind.Channel.SECONDARY_BRANCH:
			key = Meaning.new(
				(
					tr("Primary Branches")
					if channel == TreeWind.Channel.PRIMARY_BRANCH
					else tr("Secondary Branches")
				)
			)
			key.set_ramp(_GREY, [tr("Base"), tr("Far out")])
			for i: int in 3:
				key.add(_hue(i / 3.0), tr("One of them"))
		TreeWind.Channel.MOTION:
			key = Meaning.new(tr("Motion"))
			_add_axes(key, tr("%s, up to 10 cm"))
	keys.append(key)


func _add_axes(key: Meaning, what: String) -> void:
	for i: int in 3:
		key.add(_AXES[i], what % "XYZ"[i])


func _add_orders(key: Meaning) -> void:
	var orders: Array = _session.tree.measure().orders
	for order: int in mini(orders.size(), _MOST + 1):
		key.add(_hue(0.21 * order), tr("trunk") if order == 0 else tr("branch of order %d") % order)


# --- drawing --------------------------------------------------------------------------------------


static func _measure(overlay: Control, key: Meaning, scale: float) -> Vector2:
	var line: float = _line(overlay)
	var width: float = _WIDTH * scale
	width = maxf(width, _width_of(overlay, key.title))
	for word: String in key.words:
		width = maxf(width, _width_of(overlay, word) + line)
	# What stands in even steps has as much room as the widest needs.
	var widest: float = 0.0
	for value: String in key.values:
		widest = maxf(widest, _width_of(overlay, value) + 2.0 * _GAP * scale)
	width = maxf(width, widest * key.values.size())
	var height: float = line * (1 + key.words.size())
	if not key.ramp.is_empty():
		height += (_BAR + 0.5 * _GAP) * scale + line
	return Vector2(width, height) + Vector2.ONE * 2.0 * _GAP * scale


static func _draw_key(overlay: Control, key: Meaning, box: Rect2, scale: float) -> void:
	# On a ground of its own, whatever is behind.
	var ground: Color = Color(0.08, 0.09, 0.1)
	var ink: Color = Color(0.95, 0.95, 0.92)
	if overlay.has_theme_color(&"base_color", &"Editor"):
		ground = overlay.get_theme_color(&"base_color", &"Editor")
		ink = overlay.get_theme_color(&"font_color", &"Label")
	overlay.draw_rect(box, Color(ground, 0.9))
	var line: float = _line(overlay)
	var inner: Rect2 = box.grow(-_GAP * scale)
	var at: Vector2 = inner.position
	_write(overlay, key.title, at, ink)
	at.y += line
	if not key.ramp.is_empty():
		at.y += 0.25 * _GAP * scale
		_draw_bar(overlay, key.ramp, Rect2(at, Vector2(inner.size.x, _BAR * scale)), ink)
		at.y += (_BAR + 0.25 * _GAP) * scale
		for i: int in key.values.size():
			var share: float = float(i) / (key.values.size() - 1)
			var off: float = share * (inner.size.x - _width_of(overlay, key.values[i]))
			_write(overlay, key.values[i], at + Vector2(off, 0.0), ink)
		at.y += line
	for i: int in key.words.size():
		var swatch: Rect2 = Rect2(at, Vector2.ONE * line).grow(-0.2 * line)
		overlay.draw_rect(swatch, key.swatches[i])
		overlay.draw_rect(swatch, Color(ink, 0.6), false, 1.0)
		_write(overlay, key.words[i], at + Vector2(line, 0.0), ink)
		at.y += line


static func _draw_bar(overlay: Control, colors: PackedColorArray, box: Rect2, ink: Color) -> void:
	var width: float = box.size.x / (colors.size() - 1)
	for i: int in colors.size() - 1:
		var from: Vector2 = box.position + Vector2(i * width, 0.0)
		var to: Vector2 = from + Vector2(width, box.size.y)
		overlay.draw_polygon(
			[from, Vector2(to.x, from.y), to, Vector2(from.x, to.y)],
			[colors[i], colors[i + 1], colors[i + 1], colors[i]]
		)
	overlay.draw_rect(box, Color(ink, 0.6), false, 1.0)


static func _write(overlay: Control, text: String, at: Vector2, color: Color) -> void:
	var font: Font = overlay.get_theme_default_font()
	var size: int = overlay.get_theme_default_font_size()
	var baseline: Vector2 = at + Vector2(0.0, font.get_ascent(size))
	overlay.draw_string(font, baseline, text, HORIZONTAL_ALIGNMENT_LEFT, -1, size, color)


static func _width_of(overlay: Control, text: String) -> float:
	var size: int = overlay.get_theme_default_font_size()
	return (
		overlay
		. get_theme_default_font()
		. get_string_size(text, HORIZONTAL_ALIGNMENT_LEFT, -1, size)
		. x
	)


static func _line(overlay: Control) -> float:
	return overlay.get_theme_default_font().get_height(overlay.get_theme_default_font_size())


# --- values and colors ----------------------------------------------------------------------------


# As elsewhere in the editor; nothing is below the ground by less than is shown.
static func _height(above: float) -> String:
	return "%.2f m" % (snappedf(above, 0.01) + 0.0)


static func _metres(length: float) -> String:
	if absf(length) < 1.0 and length != 0.0:
		return "%s cm" % String.num(100.0 * length, 1).trim_suffix(".0")
	return "%s m" % String.num(length, 1).trim_suffix(".0")


# As tree_channels.gdshader colors numbers.
static func _hue(number: float) -> Color:
	return Color(
		0.5 + 0.5 * cos(TAU * number),
		0.5 + 0.5 * cos(TAU * (number + 0.33)),
		0.5 + 0.5 * cos(TAU * (number + 0.67))
	)


static func _hues() -> PackedColorArray:
	var colors: PackedColorArray = []
	for i: int in 13:
		colors.append(_hue(i / 12.0))
	return colors
