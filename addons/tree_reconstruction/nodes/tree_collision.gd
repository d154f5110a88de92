@tool
extends RefCounted
## Makes the shapes of physics bodies of a tree's capsules.


## Gives [param body] a shape for each capsule (see [method TreeReconstruction.build_capsules]), in
## place of those that it has. [param frame] takes the capsules' places to the body's; their radii
## follow its mean scale.
static func fill(
	body: CollisionObject3D, capsules: Array[Dictionary], frame: Transform3D = Transform3D.IDENTITY
) -> void:
	var size: Vector3 = frame.basis.get_scale()
	var mean: float = (size.x + size.y + size.z) / 3.0
	for child: Node in body.get_children(true):
		if child is CollisionShape3D:
			body.remove_child(child)
			child.queue_free()
	for capsule: Dictionary in capsules:
		var from: Vector3 = frame * (capsule["from"] as Vector3)
		var to: Vector3 = frame * (capsule["to"] as Vector3)
		var radius: float = capsule["radius"] * mean
		var shape: CapsuleShape3D = CapsuleShape3D.new()
		shape.radius = radius
		shape.height = from.distance_to(to) + 2.0 * radius
		var part: CollisionShape3D = CollisionShape3D.new()
		part.shape = shape
		part.transform = Transform3D(_upright_along(to - from), 0.5 * (from + to))
		body.add_child(part, false, Node.INTERNAL_MODE_BACK)


# A frame whose Y axis goes along `way`.
static func _upright_along(way: Vector3) -> Basis:
	if way.is_zero_approx():
		return Basis.IDENTITY
	var up: Vector3 = way.normalized()
	var side: Vector3 = up.cross(Vector3.RIGHT if absf(up.x) < 0.9 else Vector3.BACK).normalized()
	return Basis(side, up, side.cross(up))
