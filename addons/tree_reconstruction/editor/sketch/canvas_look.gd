@tool
extends RefCounted
## How the sketch's canvas is drawn: strokes in the colours of what they were recognised as, those
## that can't be understood in red.

const Widgets := preload("../dock/widgets.gd")

const PAPER: Color = Color(0.965, 0.953, 0.92)
const EDGE: Color = Color(0.78, 0.75, 0.68)
const GROUND: Color = Color(0.62, 0.57, 0.48, 0.55)
const INK: Color = Color(0.2, 0.2, 0.22)
const FAULT: Color = Color(0.86, 0.15, 0.13)
const LIT: Color = Color(0.25, 0.55, 0.95, 0.3)
const HANDLE: Color = Color(0.12, 0.42, 0.85)
const ROLES: Dictionary[String, Color] = {
	"outline": Color(0.29, 0.55, 0.2),
	"trunk": Color(0.39, 0.24, 0.12),
	"branch": Color(0.66, 0.44, 0.22),
}
# Where the ground is, as a share of the canvas from above.
const _GROUND_AT: float = 0.96

# The canvas, whose script knows this one.
var _canvas: Variant


func _init(canvas: Control) -> void:
	_canvas = weakref(canvas)


## What a stroke is taken for, and what is wrong with it.
func describe(id: int) -> String:
	var canvas: Variant = _canvas.get_ref()
	var known: Dictionary = canvas.understood.get(id, {})
	var sentence: String = known.get("fault", "")
	if not sentence.is_empty():
		return sentence
	match known.get("role", ""):
		"outline":
			return canvas.tr("The crown's outline. Reshape bends it, the right button erases it.")
		"trunk":
			return canvas.tr("The trunk. Reshape bends it, the right button erases it.")
		"branch":
			return canvas.tr("A branch. Reshape bends it, the right button erases it.")
	return canvas.tr("A stroke. Reshape bends it, the right button erases it.")


func draw() -> void:
	var canvas: Variant = _canvas.get_ref()
	var paper: Rect2 = canvas.get_paper()
	canvas.draw_rect(paper, PAPER)
	canvas.draw_rect(paper, EDGE, false, Widgets.px(1))
	var ground: float = paper.position.y + paper.size.y * _GROUND_AT
	canvas.draw_dashed_line(
		Vector2(paper.position.x, ground),
		Vector2(paper.end.x, ground),
		GROUND,
		Widgets.px(1),
		Widgets.px(6)
	)
	if canvas.strokes.is_empty() and canvas.points.is_empty():
		_draw_hint(canvas, paper)
	for stroke: Dictionary in canvas.strokes:
		if not stroke["id"] in canvas.gone:
			_draw_stroke(canvas, stroke)
	for stroke: Dictionary in canvas.strokes:
		_draw_attachment(canvas, stroke["id"])
	if not canvas.points.is_empty():
		_draw_line(canvas, canvas.points, canvas.get_pressure(), INK, 2.0)
	if canvas.curve != null:
		_draw_handles(canvas)
	if canvas.has_focus():
		canvas.draw_rect(paper.grow(Widgets.px(1)), HANDLE * Color(1, 1, 1, 0.6), false, 1.0)


func _draw_hint(canvas: Variant, paper: Rect2) -> void:
	var font: Font = canvas.get_theme_default_font()
	var font_size: int = canvas.get_theme_default_font_size()
	var width: float = paper.size.x * 0.6
	var words: String = canvas.tr(
		"Draw the crown's outline, the trunk and its branches, in any order"
	)
	canvas.draw_multiline_string(
		font,
		paper.position + Vector2(paper.size.x * 0.2, paper.size.y * 0.45),
		words,
		HORIZONTAL_ALIGNMENT_CENTER,
		width,
		font_size,
		-1,
		INK * Color(1, 1, 1, 0.6)
	)


func _draw_stroke(canvas: Variant, stroke: Dictionary) -> void:
	var id: int = stroke["id"]
	var known: Dictionary = canvas.understood.get(id, {})
	var role: String = known.get("role", "")
	var color: Color = ROLES.get(role, INK)
	if not (known.get("fault", "") as String).is_empty():
		color = FAULT
	elif known.get("left_out", false):
		color.a = 0.45
	var line: PackedVector2Array = stroke["points"]
	if id == canvas.selected and canvas.curve != null:
		line = canvas.curve.get_points()
	if id == canvas.selected:
		_draw_line(canvas, line, [], LIT, 9.0)
	_draw_line(canvas, line, stroke["pressure"], color, 4.0 if role == "trunk" else 2.5)


func _draw_line(
	canvas: Variant,
	line: PackedVector2Array,
	pressure: PackedFloat32Array,
	color: Color,
	width: float
) -> void:
	var places: PackedVector2Array = []
	for point: Vector2 in line:
		places.append(canvas.to_control(point))
	width = Widgets.px(width)
	if places.size() == 1:
		canvas.draw_circle(places[0], width / 2.0, color)
	elif pressure.size() != places.size():
		canvas.draw_polyline(places, color, width, true)
	else:
		for i: int in range(1, places.size()):
			var pressed: float = (pressure[i - 1] + pressure[i]) / 2.0
			canvas.draw_line(places[i - 1], places[i], color, width * (0.4 + 1.2 * pressed), true)


# Where a branch meets the trunk: for one that was repaired, that isn't where it was drawn.
func _draw_attachment(canvas: Variant, id: int) -> void:
	var known: Dictionary = canvas.understood.get(id, {})
	var place: Variant = known.get("attach")
	if not place is Array or (place as Array).size() != 2 or id in canvas.gone:
		return
	var at: Vector2 = canvas.to_control(Vector2(place[0], place[1]))
	var repairs: Array = known.get("repairs", [])
	canvas.draw_circle(
		at, Widgets.px(3 if repairs.is_empty() else 5), ROLES["trunk"] * Color(1, 1, 1, 0.45)
	)


func _draw_handles(canvas: Variant) -> void:
	var curve: Variant = canvas.curve
	for i: int in curve.get_count():
		if not curve.is_knot(i):
			canvas.draw_line(
				canvas.to_control(curve.handles[i]),
				canvas.to_control(curve.handles[curve.get_knot_of(i)]),
				HANDLE * Color(1, 1, 1, 0.5),
				Widgets.px(1),
				true
			)
	for i: int in curve.get_count():
		var at: Vector2 = canvas.to_control(curve.handles[i])
		if curve.is_knot(i):
			canvas.draw_circle(at, Widgets.px(6), PAPER)
			canvas.draw_circle(at, Widgets.px(6), HANDLE, false, Widgets.px(2), true)
		else:
			canvas.draw_circle(at, Widgets.px(4), HANDLE)
