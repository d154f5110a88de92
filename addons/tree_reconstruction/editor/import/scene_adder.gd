@tool
extends RefCounted
## Adds trees to the scene that is edited: one step of its undo history, wherever they come from.

## Trees were put into the scene, and are selected.
signal added(nodes: Array[TreeInstance3D])

const ScanFiles: GDScript = preload("./scan_files.gd")
const PhotoBark := preload("../photos/photo_bark.gd")
const PhotoLeaves := preload("../photos/photo_leaves.gd")

# How far away the view may look at the ground, in metres.
const _REACH: float = 200.0
# Where a tree stands if the view looks elsewhere.
const _AHEAD: float = 10.0
const _GAP: float = 0.5
const _MESH_LIMIT: int = 200000

## Knows the files that stand for scans.
var finder: RefCounted

var _undo_redo: EditorUndoRedoManager


func _init(undo_redo: EditorUndoRedoManager) -> void:
	_undo_redo = undo_redo


## The same files, but for scans that something else stands for, as [code]oak.treescan[/code] for
## [code]oak.txt[/code]: that has their tree.
func resolved(paths: PackedStringArray) -> PackedStringArray:
	var files: PackedStringArray = []
	for path: String in paths:
		var stand_in: String = finder.call(&"get_stand_in", path)
		var file: String = path if stand_in.is_empty() else stand_in
		if file not in files:
			files.append(file)
	return files


## Whether the file is a tree, or a scan that was imported as one. Does not load it.
static func is_tree_file(path: String) -> bool:
	if path.is_empty() or path.ends_with("/"):
		return false
	var files: EditorFileSystem = EditorInterface.get_resource_filesystem()
	if files.get_file_type(path) != "TreeReconstruction":
		return false
	# A scan that could not be imported has the type all the same.
	var folder: EditorFileSystemDirectory = files.get_filesystem_path(path.get_base_dir())
	var index: int = -1 if folder == null else folder.find_file_index(path.get_file())
	return index < 0 or folder.get_file_import_is_valid(index)


## Those of the files that are trees.
static func tree_files(paths: PackedStringArray) -> PackedStringArray:
	var trees: PackedStringArray = []
	for path: String in paths:
		if is_tree_file(path):
			trees.append(path)
	return trees


## The trees of files, loaded; what cannot be loaded is left out, with an error.
static func load_trees(paths: PackedStringArray) -> Array[TreeReconstruction]:
	var trees: Array[TreeReconstruction] = []
	for path: String in tree_files(paths):
		var tree: TreeReconstruction = load(path) as TreeReconstruction
		if tree == null:
			push_error("'%s' could not be loaded." % path)
		else:
			trees.append(tree)
	return trees


## Adds a node for each tree, side by side from [param place] (in the world), under the selected
## 3D node or else the root of the edited scene. Where no scene is open, one is begun. Returns the
## nodes.
func add(trees: Array[TreeReconstruction], place: Vector3) -> Array[TreeInstance3D]:
	var nodes: Array[TreeInstance3D] = []
	if trees.is_empty():
		return nodes
	var root: Node = EditorInterface.get_edited_scene_root()
	if root == null:
		var made: Node3D = Node3D.new()
		made.name = "Trees"
		EditorInterface.add_root_node(made)
		root = made
	var parent: Node = _parent_for(root)
	var title: String = tr("Add Tree to Scene") if trees.size() == 1 else tr("Add Trees to Scene")
	_undo_redo.create_action(title, UndoRedo.MERGE_DISABLE, root)
	var offsets: PackedVector3Array = side_by_side(trees)
	for i: int in trees.size():
		var node: TreeInstance3D = TreeInstance3D.new()
		node.reconstruction = trees[i]
		node.bark_material = PhotoBark.of(trees[i])
		node.leaf_material = PhotoLeaves.of(trees[i])
		node.name = _name_of(trees[i])
		node.position = place + offsets[i]
		if parent is Node3D:
			# The tree stands upright and in metres, whatever its parent does.
			var to_parent: Transform3D = (parent as Node3D).global_transform.affine_inverse()
			node.transform = to_parent * Transform3D(Basis.IDENTITY, place + offsets[i])
		_undo_redo.add_do_method(parent, &"add_child", node, true)
		_undo_redo.add_do_property(node, &"owner", root)
		_undo_redo.add_do_reference(node)
		_undo_redo.add_undo_method(parent, &"remove_child", node)
		nodes.append(node)
	_undo_redo.commit_action()
	var selection: EditorSelection = EditorInterface.get_selection()
	selection.clear()
	for node: TreeInstance3D in nodes:
		selection.add_node(node)
	added.emit(nodes)
	return nodes


## Where each of several trees stands beside the first, so that their crowns do not meet.
static func side_by_side(trees: Array[TreeReconstruction]) -> PackedVector3Array:
	var offsets: PackedVector3Array = []
	var edge: float = 0.0
	for i: int in trees.size():
		var box: AABB = trees[i].get_aabb()
		var x: float = 0.0 if i == 0 else edge + _GAP - box.position.x
		offsets.append(Vector3(x, 0.0, 0.0))
		edge = x + box.end.x
	return offsets


## What the middle of the 3D view looks at on the ground, or the origin where there is no view.
static func place_in_view() -> Vector3:
	var viewport: SubViewport = EditorInterface.get_editor_viewport_3d(0)
	var camera: Camera3D = null if viewport == null else viewport.get_camera_3d()
	if camera == null or EditorInterface.get_edited_scene_root() == null:
		return Vector3.ZERO
	return place_under(camera, viewport.get_visible_rect().size * 0.5)


## The ground under a point of a view: what is hit first of bodies and meshes, else the plane
## through the origin, else a place ahead.
static func place_under(camera: Camera3D, point: Vector2) -> Vector3:
	var from: Vector3 = camera.project_ray_origin(point)
	var along: Vector3 = camera.project_ray_normal(point)
	var best: float = _REACH
	var world: World3D = camera.get_world_3d()
	var space: PhysicsDirectSpaceState3D = null if world == null else world.direct_space_state
	if space != null:
		var hit: Dictionary = space.intersect_ray(
			PhysicsRayQueryParameters3D.create(from, from + along * _REACH)
		)
		if not hit.is_empty():
			best = from.distance_to(hit["position"])
	best = _mesh_distance(world, from, along, best)
	if best < _REACH:
		return from + along * best
	var ground: Variant = Plane(Vector3.UP).intersects_ray(from, along)
	if ground != null and from.distance_to(ground) < _REACH:
		return ground
	var ahead: Vector3 = from + along * _AHEAD
	return Vector3(ahead.x, 0.0, ahead.z)


# How far away the ray meets a mesh of the edited scene, or `best` where nothing is nearer. Trees
# are nothing to stand on.
static func _mesh_distance(world: World3D, from: Vector3, along: Vector3, best: float) -> float:
	if world == null:
		return best
	var ids: PackedInt64Array = RenderingServer.instances_cull_ray(
		from, from + along * best, world.scenario
	)
	var root: Node = EditorInterface.get_edited_scene_root()
	for id: int in ids:
		var instance: MeshInstance3D = instance_from_id(id) as MeshInstance3D
		if instance == null or instance is TreeInstance3D or instance.mesh == null:
			continue
		if root == null or not (instance == root or root.is_ancestor_of(instance)):
			continue
		var inverse: Transform3D = instance.global_transform.affine_inverse()
		var triangles: TriangleMesh = _triangles(instance.mesh)
		if triangles == null:
			continue
		var hit: Dictionary = triangles.intersect_ray(inverse * from, inverse.basis * along)
		if not hit.is_empty():
			best = minf(best, from.distance_to(instance.global_transform * hit["position"]))
	return best


static func _triangles(mesh: Mesh) -> TriangleMesh:
	var array_mesh: ArrayMesh = mesh as ArrayMesh
	if array_mesh != null:
		var count: int = 0
		for surface: int in array_mesh.get_surface_count():
			count += array_mesh.surface_get_array_index_len(surface)
		if count > 3 * _MESH_LIMIT:
			return null
	return mesh.generate_triangle_mesh()


static func _parent_for(root: Node) -> Node:
	var selected: Array[Node] = EditorInterface.get_selection().get_selected_nodes()
	if selected.size() == 1 and selected[0] is Node3D and not selected[0] is TreeInstance3D:
		var node: Node = selected[0]
		# What is inside of another scene is not saved with this one.
		if node == root or (node.owner == root and node.scene_file_path.is_empty()):
			return node
	return root


static func _name_of(tree: TreeReconstruction) -> String:
	var path: String = tree.resource_path
	var name: String = tree.resource_name
	if name.is_empty() and not path.is_empty():
		name = path.get_file().get_basename()
	name = name.validate_node_name().strip_edges()
	return "Tree" if name.is_empty() else name.to_pascal_case()
