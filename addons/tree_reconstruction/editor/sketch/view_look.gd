@tool
extends RefCounted
## Draws a sketch's strokes over a 3D view, in the colors that they have on the paper, with what is
## wrong with those that were not understood.

const Widgets := preload("../dock/widgets.gd")
const CanvasLook := preload("canvas_look.gd")
const ViewPlane := preload("view_plane.gd")
const ViewStrokes := preload("view_strokes.gd")

# Around lines, so that they are seen on bark and on the sky.
const _HALO: Color = Color(0.965, 0.953, 0.92, 0.75)
const _GROUND: Color = Color(0.965, 0.953, 0.92, 0.5)
const _BOX: Color = Color(0.08, 0.09, 0.1, 0.82)
const _WORDS: Color = Color(0.95, 0.95, 0.92)
# How far down the viewport's own buttons reach, at the editor's scale of 1.
const _BUTTONS: float = 50.0
# How wide a sentence is at most.
const _WIDTH: float = 320.0


## Draws into [param overlay], which lies over the picture of [param camera].
static func draw(overlay: Control, camera: Camera3D, view: ViewStrokes) -> void:
	var plane: ViewPlane = view.plane_of(view.sketch)
	if plane != null:
		_draw_ground(overlay, camera, plane)
		var named: PackedStringArray = []
		for stroke: Dictionary in view.sketch.strokes:
			_draw_stroke(overlay, camera, view, plane, stroke)
		for stroke: Dictionary in view.sketch.strokes:
			_draw_fault(overlay, camera, view, plane, stroke, named)
	elif view.sketch.strokes.is_empty() and not view.is_busy():
		_draw_words(
			overlay,
			Vector2(overlay.size.x * 0.6, Widgets.px(_BUTTONS)),
			view.tr(
				(
					"Drag to draw the trunk up from the ground, then branches and the crown's"
					+ " outline, in any order."
				)
			)
		)
	if view.is_busy() and view.camera == camera:
		_draw_line(overlay, view.places, CanvasLook.INK, Widgets.px(2.5))


# Where the sheet stands on the ground.
static func _draw_ground(overlay: Control, camera: Camera3D, plane: ViewPlane) -> void:
	var away: Vector2 = Vector2(ViewPlane.CANVAS.x * 0.3, 0.0)
	var line: PackedVector2Array = plane.line_to_screen(
		camera, overlay.size, [plane.stem_base - away, plane.stem_base, plane.stem_base + away]
	)
	if line.size() == 3:
		overlay.draw_dashed_line(line[0], line[2], _GROUND, Widgets.px(1), Widgets.px(6))


static func _draw_stroke(
	overlay: Control, camera: Camera3D, view: ViewStrokes, plane: ViewPlane, stroke: Dictionary
) -> void:
	var id: int = stroke["id"]
	var known: Dictionary = view.understood.get(id, {})
	var role: String = known.get("role", "")
	var color: Color = CanvasLook.ROLES.get(role, CanvasLook.INK)
	if not (known.get("fault", "") as String).is_empty():
		color = CanvasLook.FAULT
	elif known.get("left_out", false):
		color.a = 0.45
	var line: PackedVector2Array = plane.line_to_screen(camera, overlay.size, stroke["points"])
	if id == view.selected and line.size() > 1:
		overlay.draw_polyline(line, CanvasLook.LIT, Widgets.px(11), true)
	_draw_line(overlay, line, color, Widgets.px(4.0 if role == "trunk" else 2.5))


static func _draw_line(
	overlay: Control, line: PackedVector2Array, color: Color, width: float
) -> void:
	if line.size() == 1:
		overlay.draw_circle(line[0], width / 2.0, color)
	elif line.size() > 1:
		overlay.draw_polyline(line, _HALO * Color(1, 1, 1, color.a), width + Widgets.px(2.5), true)
		overlay.draw_polyline(line, color, width, true)


# Each sentence once.
static func _draw_fault(
	overlay: Control,
	camera: Camera3D,
	view: ViewStrokes,
	plane: ViewPlane,
	stroke: Dictionary,
	named: PackedStringArray
) -> void:
	var fault: String = view.understood.get(stroke["id"], {}).get("fault", "")
	var line: PackedVector2Array = plane.line_to_screen(camera, overlay.size, stroke["points"])
	if fault.is_empty() or fault in named or line.is_empty():
		return
	named.append(fault)
	@warning_ignore("integer_division")
	var middle: Vector2 = line[line.size() / 2]
	_draw_words(overlay, middle + Vector2(0.0, Widgets.px(10)), fault)


# A sentence below a place, in the middle.
static func _draw_words(overlay: Control, at: Vector2, words: String) -> void:
	var font: Font = overlay.get_theme_default_font()
	var font_size: int = overlay.get_theme_default_font_size()
	var width: float = minf(Widgets.px(_WIDTH), overlay.size.x * 0.8)
	var size: Vector2 = font.get_multiline_string_size(
		words, HORIZONTAL_ALIGNMENT_CENTER, width, font_size
	)
	var margin: Vector2 = Vector2(Widgets.px(8), Widgets.px(4))
	var box: Rect2 = Rect2(at - Vector2(size.x * 0.5, 0.0), size).grow_individual(
		margin.x, margin.y, margin.x, margin.y
	)
	box.position = box.position.clamp(Vector2.ZERO, (overlay.size - box.size).max(Vector2.ZERO))
	overlay.draw_rect(box, _BOX)
	overlay.draw_multiline_string(
		font,
		box.position + margin + Vector2(0.0, font.get_ascent(font_size)),
		words,
		HORIZONTAL_ALIGNMENT_CENTER,
		size.x,
		font_size,
		-1,
		_WORDS
	)
