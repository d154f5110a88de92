@tool
extends RefCounted
## Gives the shaders the four spheres of TreePusher3D that are nearest to the camera.

const SLOTS: int = 4
# Seconds in which a sphere comes to its size, and in which what it bent springs back.
const _RISE: float = 0.15
const _FALL: float = 0.5
const _LEAST: float = 0.002

static var _pushers: Array[TreePusher3D] = []
static var _slots: Array[Slot] = []
static var _running: bool = false
# What the shaders were given: telling the server again would make the editor draw.
static var _written: Dictionary[int, Vector4] = {}


# One of the shaders' spheres.
class Slot:
	extends RefCounted
	## Empty where its pusher has gone, and only the branches still swing back.
	var pusher: TreePusher3D
	var place: Vector3
	var size: float = 0.0
	var speed: float = 0.0

	func step(delta: float) -> void:
		var wanted: float = 0.0
		if pusher != null:
			# A place that is none would push all trees of the world there.
			if pusher.global_position.is_finite():
				place = pusher.global_position
			wanted = pusher.radius * pusher.strength if pusher.is_visible_in_tree() else 0.0
		if wanted > size:
			speed = 0.0
			size = minf(size + maxf(wanted, 0.1) * delta / _RISE, wanted)
			return
		# A critically damped spring: no sphere is less than none.
		var rate: float = 4.0 / _FALL
		speed += ((wanted - size) * rate * rate - 2.0 * rate * speed) * minf(delta, 0.05)
		size = maxf(size + speed * minf(delta, 0.05), wanted)


static func add(pusher: TreePusher3D) -> void:
	_pushers.append(pusher)
	if not _running:
		_running = true
		(Engine.get_main_loop() as SceneTree).process_frame.connect(_step)


static func remove(pusher: TreePusher3D) -> void:
	_pushers.erase(pusher)
	for slot: Slot in _slots:
		if slot.pusher == pusher:
			slot.pusher = null


## The spheres as the shaders have them now: place, and radius.
static func get_spheres() -> Array[Vector4]:
	var spheres: Array[Vector4] = []
	for slot: Slot in _slots:
		spheres.append(Vector4(slot.place.x, slot.place.y, slot.place.z, slot.size))
	return spheres


# The nearest first. Without a camera, in the order in which they came.
static func _nearest() -> Array[TreePusher3D]:
	var sorted: Array[TreePusher3D] = _pushers.duplicate()
	if sorted.size() <= SLOTS:
		return sorted
	var camera: Camera3D = sorted[0].get_viewport().get_camera_3d()
	if camera != null:
		var eye: Vector3 = camera.global_position
		sorted.sort_custom(
			func(a: TreePusher3D, b: TreePusher3D) -> bool:
				return (
					eye.distance_squared_to(a.global_position)
					< eye.distance_squared_to(b.global_position)
				)
		)
	return sorted.slice(0, SLOTS)


static func _step() -> void:
	var main: SceneTree = Engine.get_main_loop() as SceneTree
	var delta: float = main.root.get_process_delta_time()
	var nearest: Array[TreePusher3D] = _nearest()
	for slot: Slot in _slots:
		if slot.pusher != null and slot.pusher not in nearest:
			slot.pusher = null
	for pusher: TreePusher3D in nearest:
		_seat(pusher)
	for i: int in _slots.size():
		_slots[i].step(delta)
		_write(i, Vector4(_slots[i].place.x, _slots[i].place.y, _slots[i].place.z, _slots[i].size))
	if _pushers.is_empty() and _slots.all(func(slot: Slot) -> bool: return slot.size < _LEAST):
		for i: int in _slots.size():
			_write(i, Vector4.ZERO)
		_slots.clear()
		_running = false
		main.process_frame.disconnect(_step)


# Gives it a slot: a free one, or that whose branches have swung back furthest.
static func _seat(pusher: TreePusher3D) -> void:
	var free: Slot = null
	for slot: Slot in _slots:
		if slot.pusher == pusher:
			return
		if slot.pusher == null and (free == null or slot.size < free.size):
			free = slot
	if _slots.size() < SLOTS and (free == null or free.size >= _LEAST):
		free = Slot.new()
		_slots.append(free)
	if free != null:
		free.pusher = pusher
		free.size = minf(free.size, _LEAST)
		free.speed = 0.0


static func _write(slot: int, sphere: Vector4) -> void:
	if _written.get(slot) != sphere:
		_written[slot] = sphere
		RenderingServer.global_shader_parameter_set(StringName("tree_push_%d" % slot), sphere)
