@tool
extends "scan_layer.gd"
## The voxels that hold points of the edited tree's scan (Zhang 2013, 8.1.4) as a layer of the
## gizmo: what the voxel flood goes through.

## The voxels are there.
signal built

const Jobs: GDScript = preload("../jobs.gd")
const _VOXELS: Shader = preload("voxels.gdshader")
# Of the scan's largest extent, where the tree wasn't made by voxels of a stated size.
const _SHARE: float = 1.0 / 200.0
# Voxels that are drawn at most; larger ones are taken instead.
const _MOST: int = 100_000
# Cells along an axis that a key has room for.
const _ROOM: int = 1 << 20
const _SIDES: Array[Vector3i] = [
	Vector3i.RIGHT, Vector3i.LEFT, Vector3i.UP, Vector3i.DOWN, Vector3i.BACK, Vector3i.FORWARD
]

## Edge of the voxels that are shown, in metres; 0 where none are.
var edge: float = 0.0
## How many there are.
var count: int = 0

var _job: Jobs.Job
# What the mesh that is there, or is being made, was made of.
var _built_of: PackedVector3Array
var _built_edge: float = 0.0


func _init(session: Session) -> void:
	super(session)
	var material: ShaderMaterial = ShaderMaterial.new()
	material.shader = _VOXELS
	layer.material = material


## What is shown, or the scan, may have changed. Asks for the scan where it isn't there yet, and
## builds the voxels on a thread.
func update() -> void:
	if not _show_if(_session.view.voxels):
		return
	var asked: float = _asked_edge()
	# The same array: it is not copied, so that comparing it costs nothing.
	if is_same(_built_of, _session.scan.points) and is_equal_approx(asked, _built_edge):
		return
	if _job != null:
		_session.jobs.cancel(_job)
	_built_of = _session.scan.points
	_built_edge = asked
	layer.set_arrays(Mesh.PRIMITIVE_TRIANGLES, [])
	var points: PackedVector3Array = _built_of
	_job = _session.jobs.start(
		tr("Building voxels"), func(_of: Jobs.Job) -> Array: return build(points, asked), _on_built
	)


## The edge in metres and the number of the voxels, and the surface arrays of those of their sides
## that no other one hides.
static func build(points: PackedVector3Array, asked: float) -> Array:
	if points.is_empty():
		return [0.0, 0, []]
	var box: AABB = AABB(points[0], Vector3.ZERO)
	for point: Vector3 in points:
		box = box.expand(point)
	var size: float = maxf(asked, box.get_longest_axis_size() / (_ROOM - 2.0))
	if size <= 0.0:
		size = 0.01
	var cells: Dictionary[Vector3i, bool] = _cells_of(points, box.position, size)
	while cells.size() > _MOST:
		size *= 1.5
		cells = _cells_of(points, box.position, size)
	var places: PackedVector3Array = []
	var normals: PackedVector3Array = []
	var indices: PackedInt32Array = []
	for cell: Vector3i in cells:
		for side: Vector3i in _SIDES:
			if cells.has(cell + side):
				continue
			var out: Vector3 = Vector3(side)
			# Two directions of the side's plane, so that its corners go around clockwise from outside.
			var right: Vector3 = Vector3(out.y, out.z, out.x).abs()
			var up: Vector3 = out.cross(right)
			var middle: Vector3 = box.position + size * (Vector3(cell) + 0.5 * (Vector3.ONE + out))
			var first: int = places.size()
			for corner: Vector2 in [Vector2(-1, -1), Vector2(-1, 1), Vector2(1, 1), Vector2(1, -1)]:
				places.append(middle + 0.5 * size * (corner.x * right + corner.y * up))
				normals.append(out)
			indices.append_array([first, first + 1, first + 2, first, first + 2, first + 3])
	var arrays: Array = []
	arrays.resize(Mesh.ARRAY_MAX)
	arrays[Mesh.ARRAY_VERTEX] = places
	arrays[Mesh.ARRAY_NORMAL] = normals
	arrays[Mesh.ARRAY_INDEX] = indices
	return [size, cells.size(), arrays]


static func _cells_of(
	points: PackedVector3Array, low: Vector3, size: float
) -> Dictionary[Vector3i, bool]:
	var cells: Dictionary[Vector3i, bool] = {}
	for point: Vector3 in points:
		cells[Vector3i(((point - low) / size).floor())] = true
	return cells


# What the tree was made by, or what suits the scan's size.
func _asked_edge() -> float:
	var options: Dictionary = _session.tree.provenance.get("options", {})
	var stated: float = options.get("voxel", 0.0)
	if stated > 0.0:
		return stated
	return _session.tree.get_aabb().get_longest_axis_size() * _SHARE


func _on_built(made: Array, job: Jobs.Job) -> void:
	if job != _job:
		return
	_job = null
	edge = made[0]
	count = made[1]
	layer.set_arrays(Mesh.PRIMITIVE_TRIANGLES, made[2])
	built.emit()
