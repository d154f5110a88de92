@tool
extends RefCounted
## The scan of the edited tree as a layer of the gizmo.

const Session: GDScript = preload("../session.gd")
const Gizmo: GDScript = preload("skeleton_gizmo.gd")
const Picker: GDScript = preload("picker.gd")
const ViewState: GDScript = preload("../view_state.gd")
const _CLOUD: Shader = preload("cloud.gdshader")

var layer: Gizmo.Layer = Gizmo.Layer.new()

var _session: Session
var _material: ShaderMaterial = ShaderMaterial.new()
# The tree whose scan was asked for.
var _asked_of: TreeReconstruction
# How the mesh that is there was coloured.
var _built_as: int = -1


func _init(session: Session) -> void:
	_session = session
	_material.shader = _CLOUD
	var ramp: GradientTexture1D = GradientTexture1D.new()
	ramp.gradient = Gradient.new()
	# Reads on bright and dark grounds, also for those who see red and green alike.
	ramp.gradient.offsets = [0.0, 0.25, 0.5, 0.75, 1.0]
	ramp.gradient.colors = [
		Color(0.30, 0.28, 0.70),
		Color(0.16, 0.50, 0.73),
		Color(0.15, 0.69, 0.55),
		Color(0.66, 0.80, 0.26),
		Color(0.98, 0.86, 0.30)
	]
	_material.set_shader_parameter(&"heights", ramp)
	layer.material = _material
	layer.shown = false


## What is shown, or how, may have changed. Asks for the scan where it is to be shown and isn't
## there yet.
func update() -> void:
	var wanted: bool = _session.tree != null and _session.view.points
	if not wanted:
		_asked_of = null
	elif _session.scan.points.is_empty() and _asked_of != _session.tree:
		# Once: what can't be read is not tried again after every edit.
		_asked_of = _session.tree
		_session.scan.request()
	layer.shown = wanted and not _session.scan.points.is_empty()
	if not layer.shown:
		return
	if _session.view.point_colors == ViewState.PointColors.FIDELITY:
		if _session.scan.fidelity == null:
			_session.scan.measure()
	if _built_as != _wanted_colors():
		rebuild()
	_material.set_shader_parameter(
		&"size", maxf(_session.view.point_size * Picker.get_scale(), 1.0)
	)
	_material.set_shader_parameter(&"by_height", _wanted_colors() == ViewState.PointColors.HEIGHT)


## The points or their colours changed.
func rebuild() -> void:
	_built_as = -1
	layer.shown = _session.view.points and not _session.scan.points.is_empty()
	if not layer.shown:
		layer.set_arrays(Mesh.PRIMITIVE_POINTS, [])
		return
	var arrays: Array = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = _session.scan.points
	_built_as = _wanted_colors()
	match _built_as:
		ViewState.PointColors.SCAN:
			arrays[Mesh.ARRAY_COLOR] = _session.scan.colors
		ViewState.PointColors.FIDELITY:
			arrays[Mesh.ARRAY_COLOR] = _session.scan.get_heat_colors()
	layer.set_arrays(Mesh.PRIMITIVE_POINTS, arrays)
	var box: AABB = layer.mesh.get_aabb()
	_material.set_shader_parameter(&"low", box.position.y)
	_material.set_shader_parameter(&"high", box.end.y)
	_material.set_shader_parameter(&"by_height", _built_as == ViewState.PointColors.HEIGHT)


# Scans without colours are coloured by height; so are all until the fidelity is known.
func _wanted_colors() -> int:
	var wanted: int = _session.view.point_colors
	if wanted == ViewState.PointColors.SCAN and _session.scan.colors.is_empty():
		return ViewState.PointColors.HEIGHT
	if wanted == ViewState.PointColors.FIDELITY and _session.scan.fidelity == null:
		return ViewState.PointColors.HEIGHT
	return wanted
