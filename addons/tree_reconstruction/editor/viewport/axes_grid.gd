@tool
extends RefCounted
## The tree's axes with a scale of metres, and squares of a metre at its base with a person beside
## it, as layers of the gizmo.

const Session: GDScript = preload("../session.gd")
const Gizmo: GDScript = preload("skeleton_gizmo.gd")
const Picker: GDScript = preload("picker.gd")
const _RIBBON: Shader = preload("ribbon.gdshader")
const _RIBBON_ON_TOP: Shader = preload("ribbon_on_top.gdshader")
const _FIGURE: Shader = preload("figure.gdshader")

const _X: Color = Color(0.96, 0.25, 0.33)
const _Y: Color = Color(0.53, 0.84, 0.10)
const _Z: Color = Color(0.20, 0.55, 0.98)
const _SQUARES: Color = Color(0.86, 0.88, 0.92)
const _MAXIMUM_SQUARES: int = 30
# Half of a person's outline in metres, from the crown of the head to the feet; 1.75 m tall.
const _OUTLINE: PackedVector2Array = [
	Vector2(0.0, 1.75),
	Vector2(0.06, 1.735),
	Vector2(0.1, 1.69),
	Vector2(0.105, 1.62),
	Vector2(0.085, 1.55),
	Vector2(0.055, 1.51),
	Vector2(0.06, 1.46),
	Vector2(0.17, 1.42),
	Vector2(0.225, 1.36),
	Vector2(0.25, 1.15),
	Vector2(0.265, 0.9),
	Vector2(0.25, 0.8),
	Vector2(0.21, 0.8),
	Vector2(0.195, 1.0),
	Vector2(0.175, 1.22),
	Vector2(0.155, 0.98),
	Vector2(0.175, 0.82),
	Vector2(0.155, 0.45),
	Vector2(0.125, 0.1),
	Vector2(0.145, 0.0),
	Vector2(0.035, 0.0),
	Vector2(0.03, 0.4),
	Vector2(0.0, 0.78)
]

## In the order in which they are drawn.
var layers: Array[Gizmo.Layer] = []
## How far the scale goes up, and its steps between figures, in metres.
var height: float = 0.0
var step: float = 1.0

var _session: Session
var _grid: Gizmo.Layer
var _figure: Gizmo.Layer
var _axes: Gizmo.Layer
# The box of the tree that the layers were built for.
var _box: AABB


func _init(session: Session) -> void:
	_session = session
	_grid = _add(_lines(_RIBBON, 1.0, 0.0, 0.7, -2))
	_figure = _add(ShaderMaterial.new())
	_figure.material.shader = _FIGURE
	_figure.material.render_priority = -1
	_axes = _add(_lines(_RIBBON_ON_TOP, 2.0, 0.8, 0.45, 1))
	_axes.material.next_pass = _lines(_RIBBON, 2.0, 0.8, 1.0, 2)


## The tree may have changed, or what is shown.
func update() -> void:
	var tree: TreeReconstruction = _session.tree
	_grid.shown = tree != null and _session.view.grid
	_figure.shown = _grid.shown
	_axes.shown = tree != null and _session.view.axes
	if not _grid.shown and not _axes.shown:
		return
	var box: AABB = tree.get_aabb()
	if box == _box:
		return
	_box = box
	height = maxf(ceilf(box.end.y), 1.0)
	step = 1.0 if height <= 12.0 else 5.0
	_build_axes()
	_build_grid()
	_build_figure()


## Draws figures at the axes' ends and along the scale.
func draw(overlay: Control, camera: Camera3D, picker: Picker) -> void:
	if not _axes.shown:
		return
	var marks: Dictionary[Vector3, String] = {}
	marks[Vector3(_reach() + 0.15, 0, 0)] = "X"
	marks[Vector3(0, 0, _reach() + 0.15)] = "Z"
	for i: int in range(1, int(height / step) + 1):
		marks[Vector3(0, i * step, 0)] = "%d m" % int(i * step)
	var font: Font = overlay.get_theme_default_font()
	var size: int = overlay.get_theme_default_font_size()
	# Figures that would stand upon each other are left out.
	var last: Vector2 = Vector2.INF
	for place: Vector3 in marks:
		var at: Vector2 = picker.project_place(camera, place)
		if not at.is_finite() or at.distance_to(last) < size * 1.5:
			continue
		last = at
		at += Vector2(size * 0.5, size * 0.35)
		overlay.draw_string_outline(
			font, at, marks[place], HORIZONTAL_ALIGNMENT_LEFT, -1, size, 4, Color(0, 0, 0, 0.8)
		)
		overlay.draw_string(font, at, marks[place], HORIZONTAL_ALIGNMENT_LEFT, -1, size)


# How far the grid goes to each side.
func _reach() -> float:
	var widest: float = 0.0
	for end: Vector3 in [_box.position, _box.end]:
		widest = maxf(widest, maxf(absf(end.x), absf(end.z)))
	return clampf(ceilf(widest), 2.0, _MAXIMUM_SQUARES)


func _build_axes() -> void:
	var ends: PackedVector3Array = []
	var colors: PackedColorArray = []
	var reach: float = _reach()
	_line(ends, colors, Vector3.ZERO, Vector3(reach, 0, 0), _X)
	_line(ends, colors, Vector3.ZERO, Vector3(0, 0, reach), _Z)
	_line(ends, colors, Vector3.ZERO, Vector3(0, height, 0), _Y)
	for i: int in range(1, int(height) + 1):
		var long: float = 0.12 if i % 5 == 0 else 0.06
		_line(ends, colors, Vector3(-long, i, 0), Vector3(long, i, 0), _Y)
		_line(ends, colors, Vector3(0, i, -long), Vector3(0, i, long), _Y)
	_show(_axes, ends, colors)


func _build_grid() -> void:
	var ends: PackedVector3Array = []
	var colors: PackedColorArray = []
	var reach: int = int(_reach())
	for i: int in range(-reach, reach + 1):
		var color: Color = _SQUARES if i % 5 == 0 else _SQUARES.darkened(0.45)
		_line(ends, colors, Vector3(i, 0, -reach), Vector3(i, 0, reach), color)
		_line(ends, colors, Vector3(-reach, 0, i), Vector3(reach, 0, i), color)
	_show(_grid, ends, colors)


func _build_figure() -> void:
	var outline: PackedVector2Array = _OUTLINE.duplicate()
	for i: int in range(_OUTLINE.size() - 2, 0, -1):
		outline.append(Vector2(-_OUTLINE[i].x, _OUTLINE[i].y))
	var places: PackedVector3Array = []
	var feet: PackedVector2Array = []
	for corner: Vector2 in outline:
		places.append(Vector3(corner.x, corner.y, 0))
		feet.append(Vector2(1.5, 0.5))
	var arrays: Array = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = places
	arrays[Mesh.ARRAY_TEX_UV] = feet
	arrays[Mesh.ARRAY_INDEX] = Geometry2D.triangulate_polygon(outline)
	_figure.set_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
	# The shader moves it.
	_figure.mesh.custom_aabb = AABB(Vector3(-1, -1, -2), Vector3(5, 4, 5))


func _add(material: ShaderMaterial) -> Gizmo.Layer:
	var layer: Gizmo.Layer = Gizmo.Layer.new()
	layer.material = material
	layer.shown = false
	layers.append(layer)
	return layer


static func _line(
	ends: PackedVector3Array, colors: PackedColorArray, from: Vector3, to: Vector3, color: Color
) -> void:
	ends.append_array([from, to])
	colors.append_array([color, color])


static func _show(layer: Gizmo.Layer, ends: PackedVector3Array, colors: PackedColorArray) -> void:
	var arrays: Array = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = ends
	arrays[Mesh.ARRAY_COLOR] = colors
	layer.set_arrays(Mesh.PRIMITIVE_TRIANGLES, TreeReconstruction.widen_lines(arrays))


static func _lines(
	shader: Shader, width: float, edge: float, opacity: float, priority: int
) -> ShaderMaterial:
	var material: ShaderMaterial = ShaderMaterial.new()
	material.shader = shader
	material.render_priority = priority
	material.set_shader_parameter(&"width", width * Picker.get_scale())
	material.set_shader_parameter(&"edge", edge * Picker.get_scale())
	material.set_shader_parameter(&"opacity", opacity)
	return material
