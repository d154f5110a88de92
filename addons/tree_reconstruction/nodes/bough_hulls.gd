@tool
extends RefCounted
## What of felled wood lies on the ground beside its stout branches: a hull around each bough, with
## its thin wood, which else would sink.

const Collision := preload("tree_collision.gd")

# The longest boughs have one each; those beyond share one on each side of the axis.
const _MOST: int = 24
const _SIDES: int = 6
# Shorter ones, in metres, and what is so near to the cut have none.
const _LEAST: float = 0.3
const _GAP: float = 0.05


## A part with [code]points[/code] for each bough: of all that leaves the main axis of [param of],
## in the tree's frame. None reaches below the cut that the wood begins with, nor to any of [param
## apart], capsules or convex parts of the same frame, which it must not push off.
static func gather(of: TreeReconstruction, apart: Array[Dictionary]) -> Array[Dictionary]:
	var root: int = of.get_root()
	var cut: Vector3 = of.get_node_position(root)
	var axis: PackedInt32Array = _find_axis(of, root)
	if axis.size() < 2:
		return []
	var up: Vector3 = (of.get_node_position(axis[1]) - cut).normalized()
	var boughs: Array[Dictionary] = []
	for i: int in axis.size():
		for child: int in of.get_node_children(axis[i]):
			if i + 1 < axis.size() and child == axis[i + 1]:
				continue
			var points: PackedVector3Array = _find_corners(of, child, cut, up)
			var away: Vector3 = _box_of(points).get_center() - of.get_node_position(axis[i])
			var size: float = _box_of(points).size.length()
			if size >= _LEAST:
				boughs.append({"points": points, "node": child, "size": size, "away": away})
	boughs.sort_custom(
		func(a: Dictionary, b: Dictionary) -> bool:
			return a.size > b.size or (a.size == b.size and a.node < b.node)
	)
	return _share(boughs, up).filter(
		func(part: Dictionary) -> bool: return not _reaches(_box_of(part.points), apart)
	)


# Puts what is beyond the most together, by the side that it is on.
static func _share(boughs: Array[Dictionary], up: Vector3) -> Array[Dictionary]:
	var axes: Basis = Collision.upright_along(up)
	var sides: Dictionary[int, Dictionary] = {}
	for bough: Dictionary in boughs.slice(_MOST):
		var away: Vector3 = bough.away * axes
		var side: int = int(fposmod(atan2(away.z, away.x), TAU) * _SIDES / TAU) % _SIDES
		if sides.has(side):
			var points: PackedVector3Array = sides[side].points
			points.append_array(bough.points)
			sides[side].points = points
		else:
			sides[side] = bough
	for side: int in sides:
		sides[side].points = _outermost(sides[side].points)
	return boughs.slice(0, _MOST) + sides.values()


# Of many points those that are the outermost in one of the ways.
static func _outermost(points: PackedVector3Array) -> PackedVector3Array:
	var found: PackedVector3Array = []
	for way: Vector3 in _find_ways():
		var best: Vector3 = points[0]
		for point: Vector3 in points:
			if point.dot(way) > best.dot(way):
				best = point
		found.append(best)
	return found


# To the corners and sides of a cube.
static func _find_ways() -> PackedVector3Array:
	var ways: PackedVector3Array = []
	for x: int in range(-1, 2):
		for y: int in range(-1, 2):
			for z: int in range(-1, 2):
				if absi(x) + absi(y) + absi(z) in [1, 3]:
					ways.append(Vector3(x, y, z).normalized())
	return ways


# Along the thickest child of each.
static func _find_axis(of: TreeReconstruction, root: int) -> PackedInt32Array:
	var axis: PackedInt32Array = [root]
	while true:
		var best: int = -1
		for child: int in of.get_node_children(axis[-1]):
			if best < 0 or of.get_node_radius(child) > of.get_node_radius(best):
				best = child
		if best < 0:
			break
		axis.append(best)
	return axis


# The outermost places of a bough's wood in each of 14 ways, and none for one that is all below the
# cut.
static func _find_corners(
	of: TreeReconstruction, bough: int, cut: Vector3, up: Vector3
) -> PackedVector3Array:
	var ways: PackedVector3Array = _find_ways()
	var reaches: PackedFloat32Array = []
	reaches.resize(ways.size())
	reaches.fill(-INF)
	var corners: PackedVector3Array = []
	corners.resize(ways.size())
	var open: PackedInt32Array = [bough]
	while not open.is_empty():
		var id: int = open[-1]
		open.resize(open.size() - 1)
		open.append_array(of.get_node_children(id))
		var at: Vector3 = of.get_node_position(id)
		var radius: float = of.get_node_radius(id)
		if (at - cut).dot(up) < _GAP + radius:
			continue
		for way: int in ways.size():
			var reach: float = at.dot(ways[way]) + radius
			if reach > reaches[way]:
				reaches[way] = reach
				corners[way] = at + radius * ways[way]
	return corners if reaches[0] > -INF else PackedVector3Array()


static func _box_of(points: PackedVector3Array) -> AABB:
	if points.is_empty():
		return AABB()
	var box: AABB = AABB(points[0], Vector3.ZERO)
	for point: Vector3 in points:
		box = box.expand(point)
	return box


static func _reaches(box: AABB, apart: Array[Dictionary]) -> bool:
	for part: Dictionary in apart:
		var other: AABB
		if part.has("points"):
			other = _box_of(part["points"])
		else:
			other = AABB(part["from"], Vector3.ZERO).expand(part["to"]).grow(part["radius"])
		if box.intersects(other):
			return true
	return false
