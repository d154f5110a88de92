@tool
extends RefCounted
## Finds the places of a forest's trees: what has to be asked on the main thread first, then the
## scattering on a worker, then the rays, a few per frame.

const Scatter := preload("scatter.gd")
const Stand := preload("stand.gd")
const Leftovers := preload("leftovers.gd")
# Points of a curve are no farther apart, in metres.
const _CURVE_STEP: float = 0.5
const _TREES_BETWEEN_LOOKS: int = 16
const _NEVER: int = 0x7fffffffffffffff

## What there is in the end.
var stand: Stand
## How the trees are scattered.
var scatter: Scatter = Scatter.new()
## Where they stand instead, where [member is_given].
var given: Array[Transform3D] = []
var is_given: bool = false
## Whether rays look for the ground, for bodies in which layers, and how far up and down.
var rays: bool = false
var ray_mask: int = 1
var ray_depth: float = 0.0

var _space: PhysicsDirectSpaceState3D
var _frame: Transform3D
var _task: int = -1
var _rayed: int = 0
var _planted: int = 0
var _skipped: int = 0


## Reads from the scene what a worker can't: what [param place] (may be [code]null[/code]) is for
## the forest at [param forest].
func read_scene(forest: Node3D, place: Node3D) -> void:
	_frame = forest.global_transform
	_space = forest.get_world_3d().direct_space_state
	if not is_region(place):
		return
	var frame: Transform3D = Stand.into(_frame) * place.global_transform
	if place is MeshInstance3D:
		scatter.corners = frame * (place as MeshInstance3D).mesh.get_faces()
		return
	var curve: Curve3D = (place as Path3D).curve
	for point: Vector3 in curve.tessellate_even_length(5, _CURVE_STEP):
		var at: Vector3 = frame * point
		scatter.outline.append(Vector2(at.x, at.z))
		scatter.height += at.y
	scatter.height /= maxi(scatter.outline.size(), 1)


## Whether trees can stand in it.
static func is_region(node: Node) -> bool:
	if node is Path3D:
		return (node as Path3D).curve != null and (node as Path3D).curve.point_count > 2
	return node is MeshInstance3D and (node as MeshInstance3D).mesh != null


## Begins, on a worker or not.
func start(threaded: bool) -> void:
	if threaded:
		_task = WorkerThreadPool.add_task(_run.bind(_NEVER), false, "Find the places of a forest")


## Ends early. What a worker is at ends by itself.
func stop() -> void:
	scatter.stale = true
	if _task >= 0:
		Leftovers.leave(_task, self)
		_task = -1


## Goes on until [param deadline] (see [method Time.get_ticks_usec]); [code]true[/code] at the end.
func poll(deadline: int) -> bool:
	if _task >= 0:
		if not WorkerThreadPool.is_task_completed(_task):
			return false
		WorkerThreadPool.wait_for_task_completion(_task)
		_task = -1
	if not _run(deadline):
		return false
	if not rays or is_given:
		return true
	while _rayed < scatter.places.size():
		if Time.get_ticks_usec() >= deadline:
			return false
		_cast(scatter.places[_rayed])
		_rayed += 1
	return true


## Says, on the main thread, what was left out.
func tell() -> void:
	if _skipped > 0:
		push_error(
			(
				"%d of the forest's %d transforms bear no tree: they are not finite, or flat."
				% [_skipped, given.size()]
			)
		)


func _run(deadline: int) -> bool:
	if not is_given and not scatter.run(deadline):
		return false
	var count: int = given.size() if is_given else scatter.places.size()
	while _planted < count and (is_given or not rays) and not scatter.stale:
		if _planted % _TREES_BETWEEN_LOOKS == 0 and Time.get_ticks_usec() >= deadline:
			return false
		if is_given and not Stand.can_stand(given[_planted]):
			stand.skip()
			_skipped += 1
		elif is_given:
			stand.add(given[_planted])
		else:
			stand.plant(scatter.places[_planted], scatter.normals[_planted])
		_planted += 1
	return true


func _cast(place: Vector3) -> void:
	var query: PhysicsRayQueryParameters3D = PhysicsRayQueryParameters3D.create(
		_frame * (place + Vector3.UP * ray_depth),
		_frame * (place + Vector3.DOWN * ray_depth),
		ray_mask
	)
	var hit: Dictionary = _space.intersect_ray(query)
	if hit.is_empty():
		return
	var at: Vector3 = Stand.into(_frame) * (hit["position"] as Vector3)
	var normal: Vector3 = (Stand.into(_frame).basis * (hit["normal"] as Vector3)).normalized()
	if scatter.fits(at, normal):
		stand.plant(at, normal)
