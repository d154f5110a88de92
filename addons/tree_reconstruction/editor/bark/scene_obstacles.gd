@tool
extends RefCounted
## Nodes of the scene as obstacles of bark.
##
## The recipe's line has the node's path, for the editor, and where it stands as seen from the tree;
## its triangles are kept with the tree under a name that changes with them. So bark grows the same
## wherever the tree is opened, also without that scene, and undo brings the place back with the
## text.

const Recipe := preload("../dock/growth_recipe.gd")
## What may be chosen.
const TYPES: Array[StringName] = [&"Node3D"]
const MOST_TRIANGLES: int = 200_000
# Of a basis's volume: below, it is flat.
const _FLAT: float = 1e-12
# Metres, and of longer ways a share of them: what lies nearer is one place.
const _SAME: float = 1e-5


## What became of a node.
class Found:
	extends RefCounted

	## Three corners for each triangle, in the node's space.
	var corners: PackedVector3Array = []
	## Why there are none.
	var sentence: String = ""


## Whether a line is of a node of the scene.
static func is_one(line: Recipe.Line) -> bool:
	return line.command == "obstacle" and line.values.has("scene")


## The node of a line, or [code]null[/code] where it is not in the scene any more.
static func node_of(line: Recipe.Line, tree: Node) -> Node3D:
	if tree == null or not tree.is_inside_tree():
		return null
	return tree.get_node_or_null(NodePath(line.get_word("scene"))) as Node3D


## The name of a line's node.
static func name_of(line: Recipe.Line) -> String:
	var path: NodePath = NodePath(line.get_word("scene"))
	var last: String = path.get_name(path.get_name_count() - 1) if path.get_name_count() > 0 else ""
	return line.get_word("mesh").get_slice("-", 0) if last in ["", ".."] else last


## The triangles of a node, and of what is below it.
func find(node: Node3D, tree: Node3D) -> Found:
	var found: Found = Found.new()
	if node == tree or tree.is_ancestor_of(node):
		found.sentence = (
			tr("'%s' belongs to the tree itself: it can't stand in its way.") % node.name
		)
		return found
	if node.is_ancestor_of(tree):
		found.sentence = (
			tr("The tree is below '%s': choose a node that stands beside it.") % node.name
		)
		return found
	if not (
		node.global_transform.is_finite()
		and absf(node.global_basis.determinant()) > _FLAT
		and absf(tree.global_basis.determinant()) > _FLAT
	):
		found.sentence = (tr("'%s' or the tree has a scale of 0: give it another one.") % node.name)
		return found
	var meshes: Array[Array] = []
	_gather(node, node.global_transform.affine_inverse(), false, meshes)
	if meshes.is_empty():
		_gather(node, node.global_transform.affine_inverse(), true, meshes)
	var count: int = 0
	for pair: Array in meshes:
		count += _count(pair[0] as Mesh)
	if count > MOST_TRIANGLES:
		found.sentence = (
			tr(
				(
					"'%s' has %d triangles, and an obstacle can have %d: choose a simpler mesh, such as its"
					+ " collision shape."
				)
			)
			% [node.name, count, MOST_TRIANGLES]
		)
		return found
	for pair: Array in meshes:
		found.corners.append_array((pair[1] as Transform3D) * _corners(pair[0] as Mesh))
	if found.corners.is_empty():
		found.sentence = (
			tr("'%s' has no triangles: choose a MeshInstance3D, a CSG shape or a CollisionShape3D.")
			% node.name
		)
	return found


## What triangles are called in recipes.
static func mesh_name(node: Node, corners: PackedVector3Array) -> String:
	var plain: String = String(node.name).to_snake_case().replace(" ", "_").replace("#", "_")
	return "%s-%08x" % [plain.replace("-", "_"), hash(corners)]


## Writes where a node stands, as seen from the tree.
static func place(line: Recipe.Line, node: Node3D, tree: Node3D) -> void:
	var at: Transform3D = tree.global_transform.affine_inverse() * node.global_transform
	line.values["middle"] = _written(at.origin)
	line.values["x"] = _written(at.basis.x)
	line.values["y"] = _written(at.basis.y)
	line.values["z"] = _written(at.basis.z)


## Whether a node stands where its line has it.
static func is_at(line: Recipe.Line, node: Node3D, tree: Node3D) -> bool:
	var at: Transform3D = tree.global_transform.affine_inverse() * node.global_transform
	var written: Array[Vector3] = []
	for name: String in ["middle", "x", "y", "z"]:
		var numbers: PackedFloat64Array = line.get_word(name).split_floats(",")
		if numbers.size() != 3:
			return false
		written.append(Vector3(numbers[0], numbers[1], numbers[2]))
	var now: Array[Vector3] = [at.origin, at.basis.x, at.basis.y, at.basis.z]
	for i: int in now.size():
		if now[i].distance_to(written[i]) > _SAME * maxf(now[i].length(), 1.0):
			return false
	return true


# Meshes and where they are, from a transform on; of collision shapes where they are wanted.
func _gather(node: Node, from: Transform3D, shapes: bool, into: Array[Array]) -> void:
	var at: Transform3D = from
	if node is Node3D:
		at = from * (node as Node3D).global_transform
	if node is CSGShape3D and not shapes:
		var parts: Array = (node as CSGShape3D).get_meshes()
		if parts.size() == 2:
			into.append([parts[1], at * (parts[0] as Transform3D)])
		if (node as CSGShape3D).is_root_shape():
			# What is below is part of it.
			return
	elif node is MeshInstance3D and not shapes and not node is TreeInstance3D:
		if (node as MeshInstance3D).mesh != null:
			into.append([(node as MeshInstance3D).mesh, at])
	elif node is CollisionShape3D and shapes:
		var mesh: Mesh = _mesh_of_shape((node as CollisionShape3D).shape)
		if mesh != null:
			into.append([mesh, at])
	for child: Node in node.get_children():
		_gather(child, from, shapes, into)


# What the editor fills such a shape with, whatever its kind.
static func _mesh_of_shape(shape: Shape3D) -> Mesh:
	# It would go on to infinity.
	if shape == null or shape is WorldBoundaryShape3D:
		return null
	var filled: CollisionShape3D = CollisionShape3D.new()
	# Of its own, since that is a setting of the shape.
	filled.shape = shape.duplicate() as Shape3D
	filled.debug_fill = true
	var mesh: Mesh = filled.shape.get_debug_mesh()
	filled.free()
	return mesh


static func _count(mesh: Mesh) -> int:
	var count: int = 0
	if mesh is ArrayMesh:
		var made: ArrayMesh = mesh
		for surface: int in made.get_surface_count():
			if made.surface_get_primitive_type(surface) == Mesh.PRIMITIVE_TRIANGLES:
				var indices: int = made.surface_get_array_index_len(surface)
				@warning_ignore("integer_division")
				count += (indices if indices > 0 else made.surface_get_array_len(surface)) / 3
		return count
	@warning_ignore("integer_division")
	return mesh.get_faces().size() / 3


# Counter-clockwise from outside, as recipes have them.
static func _corners(mesh: Mesh) -> PackedVector3Array:
	var corners: PackedVector3Array = mesh.get_faces()
	for i: int in range(0, corners.size() - 2, 3):
		var second: Vector3 = corners[i + 1]
		corners[i + 1] = corners[i + 2]
		corners[i + 2] = second
	return corners


static func _written(v: Vector3) -> String:
	return "%s,%s,%s" % [String.num(v.x, 6), String.num(v.y, 6), String.num(v.z, 6)]
