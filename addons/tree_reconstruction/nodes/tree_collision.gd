@tool
extends RefCounted
## Makes the shapes of physics bodies of a tree's wood.

## What the shapes are: see [enum TreeInstance3D.CollisionKind].
enum Kind { CAPSULES, CONVEX_PARTS, TRUNK_ONLY }

# However young a tree is, wood of so much of its base's radius is stout for it.
const _STOUT: float = 0.4


## What [method fill] makes shapes of: at most [param maximum], of wood that is at least [param
## minimum_radius] metres thick from its middle, or less where all of a tree is thin: its trunk
## collides in any case. It may run on any thread.
static func gather(
	of: TreeReconstruction, kind: int, maximum: int, minimum_radius: float
) -> Array[Dictionary]:
	if of.get_node_count() == 0:
		return []
	var least: float = minf(minimum_radius, _STOUT * of.get_node_radius(of.get_root()))
	if kind == Kind.CAPSULES:
		return of.build_capsules(maximum, least)
	return of.build_convex_parts(maximum, least, kind == Kind.TRUNK_ONLY)


## Gives [param body] a shape for each capsule (see [method TreeReconstruction.build_capsules]) or
## convex part (see [method TreeReconstruction.build_convex_parts]), in place of those that it has.
## [param frame] takes their places to the body's; capsules' radii follow its mean scale.
static func fill(
	body: CollisionObject3D, parts: Array[Dictionary], frame: Transform3D = Transform3D.IDENTITY
) -> void:
	for child: Node in body.get_children(true):
		if child is CollisionShape3D:
			body.remove_child(child)
			child.queue_free()
	for part: Dictionary in parts:
		var node: CollisionShape3D = CollisionShape3D.new()
		if part.has("points"):
			var shape: ConvexPolygonShape3D = ConvexPolygonShape3D.new()
			shape.points = frame * (part["points"] as PackedVector3Array)
			node.shape = shape
		else:
			_set_capsule(node, part, frame)
		body.add_child(node, false, Node.INTERNAL_MODE_BACK)


static func _set_capsule(node: CollisionShape3D, capsule: Dictionary, frame: Transform3D) -> void:
	var size: Vector3 = frame.basis.get_scale()
	var from: Vector3 = frame * (capsule["from"] as Vector3)
	var to: Vector3 = frame * (capsule["to"] as Vector3)
	var radius: float = capsule["radius"] * (size.x + size.y + size.z) / 3.0
	var shape: CapsuleShape3D = CapsuleShape3D.new()
	shape.radius = radius
	shape.height = from.distance_to(to) + 2.0 * radius
	node.shape = shape
	node.transform = Transform3D(upright_along(to - from), 0.5 * (from + to))


## A frame whose Y axis goes along [param way].
static func upright_along(way: Vector3) -> Basis:
	if way.is_zero_approx():
		return Basis.IDENTITY
	var up: Vector3 = way.normalized()
	var side: Vector3 = up.cross(Vector3.RIGHT if absf(up.x) < 0.9 else Vector3.BACK).normalized()
	return Basis(side, up, side.cross(up))
