@tool
extends RefCounted
## The bodies of the trees nearest to a camera, or to several.

const Stand := preload("stand.gd")
const Individual := preload("individual.gd")
const Collision := preload("../tree_collision.gd")
## Where a body keeps the number of its tree.
const META: StringName = &"tree"
# How far the camera moves before the nearest trees are looked for again, in metres.
const _STEP: float = 1.0

var parent: Node3D
var reach: float = 20.0
var most: int = 24
var layer: int = 1
var mask: int = 0

var _bodies: Dictionary[int, StaticBody3D] = {}
var _missing: PackedInt32Array = []
var _viewers: PackedVector3Array = []


## Frees all bodies.
func clear() -> void:
	for body: StaticBody3D in _bodies.values():
		body.queue_free()
	_bodies = {}
	_missing = []
	_viewers = []


## The trees have changed: they are looked for again.
func touch() -> void:
	_viewers = []


## Decides whose bodies should be there: of those trees that are nearest to any of [param viewers].
func look_from(viewers: PackedVector3Array, stand: Stand) -> void:
	if not _have_moved(viewers):
		return
	_viewers = viewers
	var near: PackedInt32Array = _find_near(stand)
	for id: int in _bodies.keys():
		if not near.has(id):
			_bodies[id].queue_free()
			_bodies.erase(id)
	_missing = []
	for id: int in near:
		if not _bodies.has(id):
			_missing.append(id)


## Makes the next body, of [param individual_of] the tree; [code]false[/code] when there is none.
func make_next(stand: Stand, individual_of: Callable) -> bool:
	if _missing.is_empty():
		return false
	var id: int = _missing[0]
	_missing.remove_at(0)
	var individual: Individual = individual_of.call(id)
	# It comes later; then the trees are looked for again.
	if individual == null or not stand.has(id):
		return true
	var frame: Transform3D = stand.frame_of(id)
	var body: StaticBody3D = StaticBody3D.new()
	body.set_meta(META, id)
	body.collision_layer = layer
	body.collision_mask = mask
	# Bodies can't be scaled, so what is in them is.
	var size: Vector3 = frame.basis.get_scale()
	Collision.fill(body, individual.capsules, Transform3D(Basis.from_scale(size), Vector3.ZERO))
	body.transform = frame.orthonormalized()
	parent.add_child(body, false, Node.INTERNAL_MODE_BACK)
	_bodies[id] = body
	return true


func _have_moved(viewers: PackedVector3Array) -> bool:
	if viewers.size() != _viewers.size() or viewers.is_empty():
		return true
	for i: int in viewers.size():
		if viewers[i].distance_to(_viewers[i]) >= _STEP:
			return true
	return false


func _find_near(stand: Stand) -> PackedInt32Array:
	var distances: Dictionary[int, float] = {}
	for viewer: Vector3 in _viewers:
		for id: int in stand.near(viewer, reach).slice(0, most):
			var away: float = stand.place_of(id).distance_to(viewer)
			distances[id] = minf(away, distances.get(id, INF))
	var near: Array[int] = distances.keys()
	near.sort_custom(
		func(a: int, b: int) -> bool:
			return distances[a] < distances[b] or (distances[a] == distances[b] and a < b)
	)
	return PackedInt32Array(near.slice(0, most))


## How many bodies there are.
func get_count() -> int:
	return _bodies.size()
