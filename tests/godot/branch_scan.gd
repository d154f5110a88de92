extends RefCounted
## A tree that lacks a branch of its scan, and what there is to draw it anew.

var tree: TreeReconstruction
## The scan's points, in the tree's space.
var points: PackedVector3Array
## The branch's axis, from the joint to the tip.
var axis: PackedVector3Array
## The node that it grew from.
var joint: int
## The share of the points that the tree explained with it.
var explained: float


func _init(scan: String) -> void:
	var reconstructor: TreeReconstructor = TreeReconstructor.new()
	tree = reconstructor.reconstruct_file(scan)
	points = reconstructor.get_cloud_points()
	explained = tree.measure_fidelity(points)["explained"]
	# The longest one that nothing grows from.
	var first: int = TreeReconstruction.NO_NODE
	for tip: int in tree.get_leaves():
		var at: int = tip
		var places: PackedVector3Array = [tree.get_node_position(tip)]
		while tree.get_node_children(tree.get_node_parent(at)).size() == 1:
			at = tree.get_node_parent(at)
			places.append(tree.get_node_position(at))
		var base: int = tree.get_node_parent(at)
		places.append(tree.get_node_position(base))
		places.reverse()
		if axis.is_empty() or _length(places) > _length(axis):
			axis = places
			joint = base
			first = at
	tree.edit("remove nodes=%d" % first)


## A camera of [method TreeReconstructor.sketch_branch] that sees all of the tree.
func look(from: Vector3) -> Dictionary:
	var middle: Vector3 = tree.get_aabb().get_center()
	var pose: Transform3D = Transform3D(Basis.IDENTITY, middle + from * 6.0).looking_at(middle)
	return {"transform": pose, "focal": 900.0, "size": Vector2i(800, 900)}


## The axis in the pixels of such a camera.
func stroke(camera: Dictionary) -> PackedVector2Array:
	var to_camera: Transform3D = (camera["transform"] as Transform3D).affine_inverse()
	var middle: Vector2 = Vector2(camera["size"] as Vector2i) * 0.5
	var line: PackedVector2Array = []
	for i: int in axis.size() - 1:
		for part: int in 4:
			var seen: Vector3 = to_camera * axis[i].lerp(axis[i + 1], part / 4.0)
			line.append(middle + Vector2(seen.x, -seen.y) * ((camera["focal"] as float) / -seen.z))
	return line


## How far a place lies from the axis.
func distance_to(place: Vector3) -> float:
	var least: float = INF
	for i: int in axis.size() - 1:
		var near: Vector3 = Geometry3D.get_closest_point_to_segment(place, axis[i], axis[i + 1])
		least = minf(least, near.distance_to(place))
	return least


static func _length(line: PackedVector3Array) -> float:
	var length: float = 0.0
	for i: int in line.size() - 1:
		length += line[i].distance_to(line[i + 1])
	return length
