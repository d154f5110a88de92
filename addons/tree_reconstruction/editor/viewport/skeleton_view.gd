@tool
extends RefCounted
## The edited tree's skeleton as layers of the gizmo: its lines and joints, what is selected, and
## the ghosts of what a tool would do. Only what changed is built again.

const Session: GDScript = preload("../session.gd")
const Gizmo: GDScript = preload("skeleton_gizmo.gd")
const Picker: GDScript = preload("picker.gd")
const _RIBBON: Shader = preload("ribbon.gdshader")
const _RIBBON_ON_TOP: Shader = preload("ribbon_on_top.gdshader")
const _DOT: Shader = preload("dot.gdshader")

const NO_NODE: int = TreeReconstruction.NO_NODE
const SELECTED: Color = Color(0.35, 0.85, 1.0)
const ACTIVE: Color = Color(1.0, 1.0, 1.0)
const GHOST: Color = Color(0.55, 1.0, 0.6)
# So many selected nodes get a dot; of more, the lines tell enough.
const _MAXIMUM_DOTS: int = 3000
# So many are dots from however far.
const _FEW: int = 40

## In the order in which they are drawn.
var layers: Array[Gizmo.Layer] = []

var _session: Session
var _lines: Gizmo.Layer
var _joints: Gizmo.Layer
var _selected: Gizmo.Layer
var _selected_dots: Gizmo.Layer
var _active: Gizmo.Layer
var _ghosts: Gizmo.Layer
# What the lines were built of, and the mean length of one in metres.
var _built_of: Array = []
var _spacing: float = 0.1


func _init(session: Session) -> void:
	_session = session
	_lines = _add(_ribbon(2.0, 1.0, Color.WHITE, 0.0, 0.4, 1))
	_lines.material.next_pass = _on_surface(_lines.material)
	_joints = _add(_dots(6.0, Color(1.0, 1.0, 1.0, 0.9), 4))
	_selected = _add(_ribbon(4.0, 1.2, SELECTED, 1.0, 0.9, 5))
	_ghosts = _add(_ribbon(2.5, 0.8, GHOST, 0.0, 0.75, 6))
	_selected_dots = _add(_dots(9.0, SELECTED, 7))
	_active = _add(_dots(14.0, ACTIVE, 8))


## The wood may have changed, or what is shown.
func update_tree() -> void:
	var tree: TreeReconstruction = _session.tree
	var wanted: bool = tree != null and _session.view.skeleton
	_lines.shown = wanted
	_joints.shown = wanted and _session.view.editing
	var of: Array = [tree, tree.get_bark_revision()] if tree != null else []
	if not wanted or of == _built_of:
		return
	_built_of = of
	var lines: Array = tree.build_skeleton_lines()
	_lines.set_arrays(Mesh.PRIMITIVE_TRIANGLES, TreeReconstruction.widen_lines(lines))
	_joints.set_arrays(Mesh.PRIMITIVE_POINTS, _points(tree.get_positions()))
	_spacing = _mean_length(lines)
	for material: Material in [
		_joints.material, _lines.material, _lines.material.next_pass, _selected.material
	]:
		(material as ShaderMaterial).set_shader_parameter(&"spacing", _spacing)


## Other nodes are selected, or they stand elsewhere.
func update_selection() -> void:
	var tree: TreeReconstruction = _session.tree
	var ids: PackedInt32Array = _session.selection
	if tree == null:
		ids = PackedInt32Array()
	var shown: bool = not ids.is_empty() and _session.view.editing
	_selected.shown = shown
	_selected_dots.shown = shown and ids.size() <= _MAXIMUM_DOTS
	_active.shown = shown
	if not shown:
		return
	_selected.set_arrays(
		Mesh.PRIMITIVE_TRIANGLES, TreeReconstruction.widen_lines(tree.build_selection_lines(ids))
	)
	if _selected_dots.shown:
		var places: PackedVector3Array = []
		for id: int in ids:
			places.append(tree.get_node_position(id))
		_selected_dots.set_arrays(Mesh.PRIMITIVE_POINTS, _points(places))
		# Many would be one blot from afar, where the lines tell it.
		_selected_dots.material.set_shader_parameter(
			&"spacing", 0.0 if ids.size() <= _FEW else 2.0 * _spacing
		)
	_active.set_arrays(
		Mesh.PRIMITIVE_POINTS, _points([tree.get_node_position(_session.get_active())])
	)


## The tool wants to show something else.
func update_ghosts() -> void:
	var lines: Array = []
	if _session.tool != null and _session.tree != null and _session.view.editing:
		lines = _session.tool.call(&"get_ghosts")
	_ghosts.shown = not lines.is_empty()
	if not _ghosts.shown:
		return
	var colored: bool = lines[Mesh.ARRAY_COLOR] != null
	_ghosts.material.set_shader_parameter(&"tint", Color(GHOST, 0.0 if colored else 1.0))
	_ghosts.set_arrays(Mesh.PRIMITIVE_TRIANGLES, TreeReconstruction.widen_lines(lines))


func _add(material: Material) -> Gizmo.Layer:
	var layer: Gizmo.Layer = Gizmo.Layer.new()
	layer.material = material
	layer.shown = false
	layers.append(layer)
	return layer


static func _ribbon(
	width: float, edge: float, color: Color, tint: float, opacity: float, priority: int
) -> ShaderMaterial:
	var material: ShaderMaterial = ShaderMaterial.new()
	material.shader = _RIBBON_ON_TOP
	material.render_priority = priority
	var scale: float = Picker.get_scale()
	material.set_shader_parameter(&"width", width * scale)
	material.set_shader_parameter(&"edge", edge * scale)
	material.set_shader_parameter(&"tint", Color(color, tint))
	material.set_shader_parameter(&"opacity", opacity)
	return material


# The same lines again at full strength, where nothing stands before them: so one sees which of
# them are behind other wood.
static func _on_surface(material: ShaderMaterial) -> ShaderMaterial:
	var second: ShaderMaterial = material.duplicate() as ShaderMaterial
	second.shader = _RIBBON
	second.render_priority = material.render_priority + 1
	second.set_shader_parameter(&"opacity", 1.0)
	return second


static func _dots(size: float, color: Color, priority: int) -> ShaderMaterial:
	var material: ShaderMaterial = ShaderMaterial.new()
	material.shader = _DOT
	material.render_priority = priority
	material.set_shader_parameter(&"size", size * Picker.get_scale())
	material.set_shader_parameter(&"color", color)
	return material


static func _points(places: PackedVector3Array) -> Array:
	if places.is_empty():
		return []
	var arrays: Array = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = places
	return arrays


# Of some of the lines: it decides how near one must come to see the joints.
static func _mean_length(lines: Array) -> float:
	if lines.is_empty():
		return 1.0
	var ends: PackedVector3Array = lines[Mesh.ARRAY_VERTEX]
	var sum: float = 0.0
	var count: int = 0
	@warning_ignore("integer_division")
	for i: int in range(0, ends.size(), maxi(2, ends.size() / 400 * 2)):
		sum += ends[i].distance_to(ends[i + 1])
		count += 1
	return sum / count
