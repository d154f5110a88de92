@tool
extends RefCounted
## What trees are for the baking of navigation meshes: few faces around the wood that stands in
## somebody's way, of all trees of a forest, near the camera or not. What the engine would take
## instead, the meshes that are drawn and the bodies near the camera, is taken out again.

const Collision := preload("tree_collision.gd")
# How far up wood is in the way, in metres: most agents are lower.
const _REACH: float = 4.0
const _SHAPES: int = 12
const _LEAST_RADIUS: float = 0.03
const _SIDES: int = 6

static var _parser: RID
static var _users: int = 0
# Of the parse that is under way: its frame, its data, and how much of it is to stay.
static var _frame: int = -1
static var _data: int = 0
static var _vertices: int = 0
static var _indices: int = 0


## A tree or a forest tells of itself: what it is notified of.
static func notify(what: int) -> void:
	if what == Node.NOTIFICATION_ENTER_TREE:
		_users += 1
		if not _parser.is_valid():
			_parser = NavigationServer3D.source_geometry_parser_create()
			NavigationServer3D.source_geometry_parser_set_callback(_parser, _parse)
	elif what == Node.NOTIFICATION_EXIT_TREE:
		_users -= 1
		if _users == 0:
			NavigationServer3D.free_rid(_parser)
			_parser = RID()


# The engine calls it for every node after it has taken what it knows of it.
static func _parse(
	navigation: NavigationMesh, data: NavigationMeshSourceGeometryData3D, node: Node
) -> void:
	if _frame != Engine.get_process_frames() or _data != data.get_instance_id():
		_frame = Engine.get_process_frames()
		_data = data.get_instance_id()
		_vertices = 0
		_indices = 0
	var tree: TreeInstance3D = node as TreeInstance3D
	var forest: TreeVariantSpawner3D = node as TreeVariantSpawner3D
	if tree != null:
		_take_back(data)
		if _is_asked(navigation, tree.collision, tree.collision_layer):
			_add_tree(data, tree)
	elif forest != null and _is_asked(navigation, forest.collision, forest.collision_layer):
		_add_forest(data, forest)
	elif _is_part(node):
		# The last of a tree's own parts, which come after all that others have put there.
		var parent: Node = node.get_parent()
		while parent != null and not _is_ours(parent):
			parent = parent.get_parent()
		var last: Node = parent
		while last.get_child_count(true) > 0:
			last = last.get_child(-1, true)
		if node == last:
			_take_back(data)
		return
	_vertices = data.get_vertices().size()
	_indices = data.get_indices().size()


static func _is_ours(node: Node) -> bool:
	return node is TreeInstance3D or node is TreeVariantSpawner3D


# Whether a tree has made the node to be drawn or to collide.
static func _is_part(node: Node) -> bool:
	var part: Node = node
	while part.get_parent() != null:
		if _is_ours(part.get_parent()):
			return not part in part.get_parent().get_children(false)
		part = part.get_parent()
	return false


static func _is_asked(navigation: NavigationMesh, collides: bool, layer: int) -> bool:
	var drawn: bool = (
		navigation.geometry_parsed_geometry_type != NavigationMesh.PARSED_GEOMETRY_STATIC_COLLIDERS
	)
	return drawn or (collides and navigation.geometry_collision_mask & layer != 0)


static func _take_back(data: NavigationMeshSourceGeometryData3D) -> void:
	if data.get_vertices().size() > _vertices:
		var vertices: PackedFloat32Array = data.get_vertices().slice(0, _vertices)
		var indices: PackedInt32Array = data.get_indices().slice(0, _indices)
		# Setting them would be refused where more corners than coordinates are shared.
		data.set_indices([])
		data.set_vertices([])
		data.append_arrays(vertices, indices)


static func _add_tree(data: NavigationMeshSourceGeometryData3D, tree: TreeInstance3D) -> void:
	if tree.reconstruction != null:
		_add(data, _capsules_of(tree.reconstruction), tree.global_transform)


static func _add_forest(
	data: NavigationMeshSourceGeometryData3D, forest: TreeVariantSpawner3D
) -> void:
	if forest.is_building():
		push_warning(
			(
				"The forest %s is still being made: bake the navigation mesh when it has finished."
				% forest.name
			)
		)
	var known: Dictionary[int, Array] = {}
	for id: int in forest.find_trees(Vector3.ZERO, INF):
		var index: int = forest.get_tree_variant(id)
		if not known.has(index):
			known[index] = _capsules_of(forest.get_variant(index))
		_add(data, known[index], forest.global_transform * forest.get_tree_transform(id))


static func _capsules_of(tree: TreeReconstruction) -> Array[Dictionary]:
	return Collision.gather(tree, Collision.Kind.CAPSULES, _SHAPES, _LEAST_RADIUS)


# A prism around each capsule that is low enough.
static func _add(
	data: NavigationMeshSourceGeometryData3D, capsules: Array, frame: Transform3D
) -> void:
	var up: float = frame.basis.get_scale().y
	for capsule: Dictionary in capsules:
		var from: Vector3 = capsule["from"]
		var to: Vector3 = capsule["to"]
		if up * minf(from.y, to.y) > _REACH:
			continue
		var arrays: Array = []
		arrays.resize(Mesh.ARRAY_MAX)
		# As wide as the capsule at its sides, not only at its corners.
		arrays[Mesh.ARRAY_VERTEX] = _prism(from, to, capsule["radius"] / cos(PI / _SIDES))
		arrays[Mesh.ARRAY_INDEX] = _prism_indices()
		data.add_mesh_array(arrays, frame)


static func _prism(from: Vector3, to: Vector3, radius: float) -> PackedVector3Array:
	var axes: Basis = Collision.upright_along(to - from)
	var points: PackedVector3Array = []
	for end: Vector3 in [from, to]:
		for side: int in _SIDES:
			var turn: float = TAU * side / _SIDES
			points.append(end + radius * (axes.x * cos(turn) + axes.z * sin(turn)))
	return points


static func _prism_indices() -> PackedInt32Array:
	var indices: PackedInt32Array = []
	for side: int in _SIDES:
		var next: int = (side + 1) % _SIDES
		indices.append_array([side, side + _SIDES, next, next, side + _SIDES, next + _SIDES])
	for side: int in range(1, _SIDES - 1):
		indices.append_array([0, side, side + 1])
		indices.append_array([_SIDES, _SIDES + side + 1, _SIDES + side])
	return indices
