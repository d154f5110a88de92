@tool
extends RefCounted
## Finds where trees stand that are added without a place: on the ground that one looks at, beside
## what trees are there.

const SceneAdder: GDScript = preload("./scene_adder.gd")

# Between crowns, in metres; how far to go from one try to the next, in widths; and how often.
const _GAP: float = 0.5
const _STEP: float = 0.125
const _TRIES: int = 400


## The place of the first of [param trees], which stand side by side, in the 3D view.
static func in_view(trees: Array[TreeReconstruction]) -> Vector3:
	var place: Vector3 = SceneAdder.call(&"place_in_view")
	var root: Node = EditorInterface.get_edited_scene_root()
	var viewport: SubViewport = EditorInterface.get_editor_viewport_3d(0)
	var camera: Camera3D = null if viewport == null else viewport.get_camera_3d()
	if root == null or camera == null or trees.is_empty():
		return place
	var middle: Vector2 = viewport.get_visible_rect().size * 0.5
	var from: Vector3 = camera.project_ray_origin(middle)
	var nearest: float = from.distance_to(place)
	var looked_at: Vector3 = place
	var taken: Array[Rect2] = []
	for found: Node in root.find_children("*", "TreeInstance3D", true, false) + [root]:
		var other: TreeInstance3D = found as TreeInstance3D
		if other == null or other.reconstruction == null or not other.is_visible_in_tree():
			continue
		var box: AABB = other.global_transform * other.reconstruction.get_aabb()
		taken.append(footprint(box))
		var hit: Variant = box.intersects_segment(from, place)
		if hit != null and from.distance_to(hit) < nearest:
			# Who looks at a tree means the ground that it stands on, not that behind it.
			nearest = from.distance_to(hit)
			looked_at = other.global_position
	var needed: Rect2 = Rect2()
	var offsets: PackedVector3Array = SceneAdder.call(&"side_by_side", trees)
	for i: int in trees.size():
		var own: Rect2 = footprint(
			AABB(offsets[i], Vector3.ZERO).merge(_moved(trees[i], offsets[i]))
		)
		needed = own if i == 0 else needed.merge(own)
	var free: Vector3 = beside(looked_at, needed, taken, camera.global_basis.x)
	if free == place or camera.is_position_behind(free):
		return free
	# Ground need not be level.
	var ground: Vector3 = SceneAdder.call(&"place_under", camera, camera.unproject_position(free))
	var aside: Vector3 = ground - free
	return ground if Vector2(aside.x, aside.z).length() < _GAP else free


## The place nearest to [param place] on both sides [param along] the view where [param needed],
## seen from above and measured from the place, meets nothing of [param taken].
static func beside(place: Vector3, needed: Rect2, taken: Array[Rect2], along: Vector3) -> Vector3:
	var way: Vector2 = Vector2(along.x, along.z).normalized()
	if way == Vector2.ZERO:
		way = Vector2.RIGHT
	var step: float = maxf(_STEP * maxf(needed.size.x, needed.size.y), 0.05)
	for i: int in _TRIES:
		for side: float in [1.0, -1.0]:
			var off: Vector2 = way * (side * step * i)
			var own: Rect2 = needed.grow(_GAP)
			own.position += Vector2(place.x, place.z) + off
			if not taken.any(func(other: Rect2) -> bool: return other.intersects(own)):
				return place + Vector3(off.x, 0.0, off.y)
	return place


## What a box takes of the ground.
static func footprint(box: AABB) -> Rect2:
	return Rect2(box.position.x, box.position.z, box.size.x, box.size.z)


static func _moved(tree: TreeReconstruction, offset: Vector3) -> AABB:
	var box: AABB = tree.get_aabb()
	box.position += offset
	return box
