@tool
extends Control
## The circle of photos around the tree, seen from above: where each was taken from, and where there
## is a gap.

const Widgets := preload("../dock/widgets.gd")

# A gap that hides a side of the tree, in degrees.
const _WIDE: float = 45.0
const _ARC: int = 48

var _cameras: Array = []
var _gap: Dictionary = {}


func _init() -> void:
	custom_minimum_size = Vector2.ONE * Widgets.px(140)
	visible = false


## Shows the [code]photos[/code] of a report (see [method TreeReconstructor.get_report]).
func show_report(photos: Dictionary) -> void:
	_cameras = photos.get("cameras", [])
	var gap: Variant = photos.get("widest_gap")
	_gap = gap if gap is Dictionary and float(gap["degrees"]) > _WIDE else {}
	visible = _cameras.size() > 1
	tooltip_text = tr("Where the photos were taken from, seen from above.")
	if not _gap.is_empty():
		tooltip_text = (
			tr("Nothing was seen from here: add photos between %s and %s.")
			% [_gap["from"], _gap["to"]]
		)
	queue_redraw()


func _draw() -> void:
	var ink: Color = get_theme_color(&"font_color", &"Label")
	var middle: Vector2 = size * 0.5
	var most: float = 0.0
	for camera: Dictionary in _cameras:
		most = maxf(most, camera["away"])
	if most <= 0.0:
		return
	var reach: float = minf(size.x, size.y) * 0.5 - Widgets.px(8)
	if not _gap.is_empty():
		_draw_gap(middle, reach)
	draw_circle(middle, Widgets.px(5), Color(0.45, 0.65, 0.3))
	for camera: Dictionary in _cameras:
		var at: Vector2 = middle + _way(camera["degrees"]) * (reach * float(camera["away"]) / most)
		var ahead: Vector2 = (middle - at).normalized() * Widgets.px(6)
		var aside: Vector2 = ahead.orthogonal() * 0.55
		draw_colored_polygon(PackedVector2Array([at - aside, at + aside, at + ahead]), ink)


func _draw_gap(middle: Vector2, reach: float) -> void:
	var from: float = NAN
	for camera: Dictionary in _cameras:
		if camera["name"] == _gap["from"]:
			from = camera["degrees"]
	if is_nan(from):
		return
	var warning: Color = get_theme_color(&"warning_color", &"Editor")
	warning.a = 0.5
	var fan: PackedVector2Array = [middle]
	for i: int in _ARC + 1:
		fan.append(middle + _way(from + float(_gap["degrees"]) * i / _ARC) * reach)
	draw_colored_polygon(fan, warning)


static func _way(degrees: float) -> Vector2:
	return Vector2.from_angle(-deg_to_rad(degrees))
