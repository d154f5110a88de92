@tool
extends RefCounted
## Cuts a tree in two, and gives what comes off the body of a thing that falls.

const BoughHulls := preload("bough_hulls.gd")
const Collision := preload("tree_collision.gd")

# Properties that the fallen piece takes over.
const _COPIED: PackedStringArray = [
	"lod",
	"levels",
	"level_distances",
	"leaves",
	"bark_material",
	"leaf_material",
	"layers",
	"cast_shadow",
	"gi_mode",
	"collision_kind",
	"collision_shapes",
	"collision_minimum_radius",
	"collision_layer",
	"collision_mask",
]
# Metres between the flat ends of the piece's shape and the stump's.
const _GAP: float = 0.03
# Of a node's flags in a skeleton.
const _TRUNK: int = 1


## See [method TreeInstance3D.fell].
static func fell(tree: TreeInstance3D, id: int, density: float, stump_body: bool) -> RigidBody3D:
	if not _can_fall(tree, density):
		return null
	var stump: TreeReconstruction = tree.reconstruction.duplicate() as TreeReconstruction
	var edit: TreeEdit = stump.edit("cut node=%d" % id)
	if edit == null:
		return null
	# With the leaves, rules and seed of the whole.
	var top: TreeReconstruction = tree.reconstruction.duplicate() as TreeReconstruction
	top.skeleton = _lying((edit.get_removed_wood()[0] as TreeReconstruction).skeleton)
	top.edit_log = ""
	top.growth_recipe = ""
	top.growth_meshes = {}
	top.growth_pending = false
	top.grown_bark = []
	var fallen: TreeInstance3D = TreeInstance3D.new()
	for property: String in _COPIED:
		if property in tree:
			fallen.set(property, tree.get(property))
	fallen.wind = false
	fallen.fallen = true
	fallen.reconstruction = top
	var body: RigidBody3D = RigidBody3D.new()
	body.collision_layer = tree.collision_layer
	body.collision_mask = tree.collision_mask
	body.add_child(fallen)
	# So that it is saved with its body.
	fallen.owner = body
	# A piece of what has fallen already: both halves go on as bodies.
	var holder: RigidBody3D = tree.get_parent() as RigidBody3D
	var beside: Node3D = holder if holder != null else tree
	var place: Transform3D = tree.transform
	if holder != null:
		place = holder.transform * tree.transform
	# What collides of the stump must not throw the piece off.
	var rest: Array[Dictionary] = []
	if tree.collision or stump_body or holder != null:
		rest = Collision.gather(
			stump, tree.collision_kind, tree.collision_shapes, tree.collision_minimum_radius
		)
	var parts: Array[Dictionary] = _parts_of(fallen, rest)
	_mount(body, fallen, place, parts, density)
	if holder != null:
		_share_motion(holder, body)
		var before: Vector3 = holder.transform.origin
		tree.reconstruction = stump
		_mount(holder, tree, place, _parts_of(tree), density)
		holder.linear_velocity += holder.angular_velocity.cross(holder.transform.origin - before)
	else:
		tree.reconstruction = stump
		if stump_body:
			tree.collision = true
		# At once: the piece must not meet the shapes of the whole tree.
		tree.update_collision_now()
	beside.add_sibling(body)
	return body


## See [method TreeInstance3D.make_body].
static func make_body(tree: TreeInstance3D, density: float) -> RigidBody3D:
	if not _can_fall(tree, density):
		return null
	tree.fallen = true
	tree.wind = false
	tree.collision = false
	tree.update_collision_now()
	var body: RigidBody3D = tree.get_parent() as RigidBody3D
	if body != null:
		_mount(body, tree, body.transform * tree.transform, _parts_of(tree), density)
		return body
	body = RigidBody3D.new()
	body.collision_layer = tree.collision_layer
	body.collision_mask = tree.collision_mask
	var place: Transform3D = tree.transform
	tree.add_sibling(body)
	tree.owner = null
	tree.reparent(body, false)
	tree.owner = body
	_mount(body, tree, place, _parts_of(tree), density)
	return body


## Gives the body of felled wood its shapes, unless it has some. They are not saved with it.
static func restore_shapes(tree: TreeInstance3D) -> void:
	if not tree.is_inside_tree() or tree.reconstruction == null:
		return
	var body: RigidBody3D = tree.get_parent() as RigidBody3D
	if body == null:
		return
	for child: Node in body.get_children(true):
		if child is CollisionShape3D or child is CollisionPolygon3D:
			return
	Collision.fill(body, _parts_of(tree), tree.transform)


static func _can_fall(tree: TreeInstance3D, density: float) -> bool:
	if (
		tree.reconstruction == null
		or tree.reconstruction.get_node_count() < 2
		or tree.get_parent() == null
	):
		push_error("Only a tree in a scene can be felled.")
		return false
	if not (density > 0.0 and is_finite(density)):
		push_error("Wood weighs more than 0 kg per cubic metre; green wood about 800.")
		return false
	var place: Transform3D = tree.transform
	if not place.is_finite() or absf(place.basis.determinant()) < 1e-9:
		push_error("The tree can't be felled: its transform is not finite, or flat.")
		return false
	return true


# Wood that lies has no base in the ground.
static func _lying(skeleton: Dictionary) -> Dictionary:
	var wood: Dictionary = skeleton.duplicate()
	var flags: PackedByteArray = wood["flags"]
	for i: int in flags.size():
		flags[i] &= ~_TRUNK
	wood["flags"] = flags
	return wood


# However thin it is, it has a shape: else it would fall through the ground.
static func _parts_of(tree: TreeInstance3D, apart: Array[Dictionary] = []) -> Array[Dictionary]:
	var of: TreeReconstruction = tree.reconstruction
	var parts: Array[Dictionary] = Collision.gather(
		of, tree.collision_kind, tree.collision_shapes, tree.collision_minimum_radius
	)
	if parts.is_empty():
		parts = Collision.gather(of, tree.collision_kind, 1, 0.0)
	if tree.fallen:
		_shorten(parts, of.get_node_position(of.get_root()))
		if tree.collision_kind != Collision.Kind.TRUNK_ONLY:
			parts.append_array(BoughHulls.gather(of, apart))
	return parts


# The piece's first shape must not reach into the stump's last one, which would throw it off: round
# ends would, and flat ones that touch exactly are not sure to be taken for apart.
static func _shorten(parts: Array[Dictionary], cut: Vector3) -> void:
	for part: Dictionary in parts:
		if part.has("points"):
			_lift_end(part, cut)
		elif (part["from"] as Vector3).is_equal_approx(cut):
			var way: Vector3 = part["to"] - part["from"]
			var most: float = maxf(way.length() - 0.01, 0.0)
			part["from"] += way.normalized() * minf(2.0 * part["radius"], most)


static func _lift_end(part: Dictionary, cut: Vector3) -> void:
	var points: PackedVector3Array = part["points"]
	@warning_ignore("integer_division")
	var sides: int = points.size() / 2
	var low: Vector3 = Vector3.ZERO
	var high: Vector3 = Vector3.ZERO
	for i: int in sides:
		low += points[i] / sides
		high += points[sides + i] / sides
	if low.distance_to(cut) > 1e-3:
		return
	for i: int in sides:
		points[i] += (high - low) * minf(_GAP / low.distance_to(high), 0.5)
	part["points"] = points


# Puts the body where the wood's centre of mass is, along its principal axes, so that it turns as
# the wood would, and the tree into it where it is. `place`: of the tree, beside the body. Bodies
# can't be scaled, so what is in them is.
static func _mount(
	body: RigidBody3D,
	tree: TreeInstance3D,
	place: Transform3D,
	parts: Array[Dictionary],
	density: float
) -> void:
	var wood: Dictionary = tree.reconstruction.weigh(density)
	var size: Vector3 = place.basis.get_scale()
	var volume: float = size.x * size.y * size.z
	var axes: Basis = wood["axes"]
	body.transform = Transform3D(
		place.basis.orthonormalized() * axes, place * (wood["center"] as Vector3)
	)
	tree.transform = body.transform.affine_inverse() * place
	Collision.fill(body, parts, tree.transform)
	body.mass = maxf(wood["mass"] * volume, 0.1)
	body.center_of_mass_mode = RigidBody3D.CENTER_OF_MASS_MODE_CUSTOM
	body.center_of_mass = Vector3.ZERO
	# Of a thread, an engine's solver can make nothing.
	var least: float = 1e-3 * body.mass
	body.inertia = (((wood["inertia"] as Vector3) * pow(volume, 5.0 / 3.0)).max(
		Vector3.ONE * least
	))


# What comes off a body that moves goes on moving as it did.
static func _share_motion(from: RigidBody3D, to: RigidBody3D) -> void:
	to.angular_velocity = from.angular_velocity
	var apart: Vector3 = to.transform.origin - from.transform.origin
	to.linear_velocity = from.linear_velocity + from.angular_velocity.cross(apart)
