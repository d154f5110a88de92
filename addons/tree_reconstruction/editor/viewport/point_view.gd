@tool
extends "scan_layer.gd"
## The scan of the edited tree as a layer of the gizmo.

const Picker: GDScript = preload("picker.gd")
const ViewState: GDScript = preload("../view_state.gd")
const _CLOUD: Shader = preload("cloud.gdshader")

## Reads on bright and dark grounds, also for those who see red and green alike.
const HEIGHTS: PackedColorArray = [
	Color(0.30, 0.28, 0.70),
	Color(0.16, 0.50, 0.73),
	Color(0.15, 0.69, 0.55),
	Color(0.66, 0.80, 0.26),
	Color(0.98, 0.86, 0.30)
]

## By what the points that are there are coloured: a ViewState.PointColors, or -1 where none are.
var colored_by: int = -1
## How low and how high they are, in metres.
var low: float = 0.0
var high: float = 0.0

var _material: ShaderMaterial = ShaderMaterial.new()


func _init(session: Session) -> void:
	super(session)
	_material.shader = _CLOUD
	var ramp: GradientTexture1D = GradientTexture1D.new()
	ramp.gradient = Gradient.new()
	ramp.gradient.offsets = [0.0, 0.25, 0.5, 0.75, 1.0]
	ramp.gradient.colors = HEIGHTS
	_material.set_shader_parameter(&"heights", ramp)
	layer.material = _material


## What is shown, or how, may have changed. Asks for the scan where it is to be shown and isn't
## there yet.
func update() -> void:
	if not _show_if(_session.view.points):
		return
	if _session.view.point_colors == ViewState.PointColors.FIDELITY:
		if _session.scan.fidelity == null:
			_session.scan.measure()
	if colored_by != _wanted_colors():
		rebuild()
	_material.set_shader_parameter(
		&"size", maxf(_session.view.point_size * Picker.get_scale(), 1.0)
	)
	_material.set_shader_parameter(&"by_height", _wanted_colors() == ViewState.PointColors.HEIGHT)


## The points or their colours changed.
func rebuild() -> void:
	colored_by = -1
	layer.shown = _session.view.points and not _session.scan.points.is_empty()
	if not layer.shown:
		layer.set_arrays(Mesh.PRIMITIVE_POINTS, [])
		return
	var arrays: Array = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = _session.scan.points
	colored_by = _wanted_colors()
	match colored_by:
		ViewState.PointColors.SCAN:
			arrays[Mesh.ARRAY_COLOR] = _session.scan.colors
		ViewState.PointColors.FIDELITY:
			arrays[Mesh.ARRAY_COLOR] = _session.scan.get_heat_colors()
	layer.set_arrays(Mesh.PRIMITIVE_POINTS, arrays)
	var box: AABB = layer.mesh.get_aabb()
	low = box.position.y
	high = box.end.y
	_material.set_shader_parameter(&"low", low)
	_material.set_shader_parameter(&"high", high)
	_material.set_shader_parameter(&"by_height", colored_by == ViewState.PointColors.HEIGHT)


# Scans without colours are coloured by height; so are all until the fidelity is known.
func _wanted_colors() -> int:
	var wanted: int = _session.view.point_colors
	if wanted == ViewState.PointColors.SCAN and _session.scan.colors.is_empty():
		return ViewState.PointColors.HEIGHT
	if wanted == ViewState.PointColors.FIDELITY and _session.scan.fidelity == null:
		return ViewState.PointColors.HEIGHT
	return wanted
