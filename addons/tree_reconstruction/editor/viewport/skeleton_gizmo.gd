@tool
extends EditorNode3DGizmoPlugin
## Draws what belongs to the edited tree into the editor's 3D viewports: its skeleton, what is
## selected, a tool's ghosts, the scan, axes.
##
## The engine moves a gizmo with its node, hides it with it, and takes it away when the node leaves
## the scene. So nothing is saved, duplicated, or left over. What is drawn are layers: a layer
## changes its mesh in place, without the gizmo being drawn anew.

const Session: GDScript = preload("../session.gd")
# The level of detail that clicks are tested against.
const _COLLISION_LOD: int = 2


## A mesh in the tree's space, and how it is drawn.
class Layer:
	extends RefCounted
	var mesh: ArrayMesh = ArrayMesh.new()
	var material: Material
	var shown: bool = true

	## Shows other surface arrays, or nothing if they are empty.
	func set_arrays(primitive: Mesh.PrimitiveType, arrays: Array, flags: int = 0) -> void:
		mesh.clear_surfaces()
		if not arrays.is_empty():
			mesh.add_surface_from_arrays(primitive, arrays, [], {}, flags)


## In the order in which they are drawn.
var layers: Array[Layer] = []

var _session: Session
# The edited node, and our gizmo of it.
var _node: TreeInstance3D
var _gizmo: EditorNode3DGizmo
# The ids of the nodes that have our gizmo alone.
var _alone: Dictionary[int, bool] = {}
# What clicks on a tree are tested against, by the id of the reconstruction: [bark revision, mesh].
var _collisions: Dictionary[int, Array] = {}


func set_session(session: Session) -> void:
	_session = session


func _get_gizmo_name() -> String:
	return "Tree skeleton"


func _has_gizmo(node: Node3D) -> bool:
	return node is TreeInstance3D


func _redraw(gizmo: EditorNode3DGizmo) -> void:
	gizmo.clear()
	var node: TreeInstance3D = gizmo.get_node_3d() as TreeInstance3D
	if _session == null or node == null:
		return
	if node.get_gizmos().size() > 1:
		_send_others_away.call_deferred(node.get_instance_id())
	if node == _session.node:
		_gizmo = gizmo
		for layer: Layer in layers:
			if layer.shown and layer.mesh.get_surface_count() > 0:
				gizmo.add_mesh(layer.mesh, layer.material)
	# Clicks on the wood are the tools' while the skeleton is edited.
	if node != _session.node or not _session.view.editing:
		var collision: TriangleMesh = _find_collision(node.reconstruction)
		if collision != null:
			gizmo.add_collision_triangles(collision)


## Draws the layers anew: one is shown that was not, or the other way.
func update_layers() -> void:
	if _gizmo != null and is_instance_valid(_session.node) and _session.node == _node:
		_redraw(_gizmo)


## Another node is edited, or its skeleton is edited now or no more.
func take(node: TreeInstance3D) -> void:
	var before: TreeInstance3D = _node if is_instance_valid(_node) else null
	_node = node
	_gizmo = null
	for changed: TreeInstance3D in [before, node]:
		if changed != null and changed.is_inside_tree():
			changed.update_gizmos()


## The plugin has come while a scene is open already, whose nodes know nothing of this one.
func join(root: Node) -> void:
	if root == null:
		return
	var nodes: Array[Node] = root.find_children("*", "MeshInstance3D", true, false)
	nodes.append(root)
	for node: Node in nodes:
		if node is TreeInstance3D and node.is_inside_tree():
			(node as TreeInstance3D).clear_gizmos()
			(node as TreeInstance3D).update_gizmos()


## The plugin goes, and this one has been removed: the engine's own gizmos come back.
func leave() -> void:
	for id: int in _alone:
		var node: TreeInstance3D = instance_from_id(id) as TreeInstance3D
		if node != null and node.is_inside_tree():
			node.clear_gizmos()
			node.update_gizmos()
	_alone.clear()


# The engine's own gizmo of a mesh makes a search tree of all its triangles for clicks after every
# rebuild, which takes a tenth of a second for a large tree. A coarse level of detail does as well.
func _send_others_away(id: int) -> void:
	var node: TreeInstance3D = instance_from_id(id) as TreeInstance3D
	if _session == null or node == null or not node.is_inside_tree():
		return
	for gizmo: Node3DGizmo in node.get_gizmos():
		var of_editor: EditorNode3DGizmo = gizmo as EditorNode3DGizmo
		if of_editor != null and of_editor.get_plugin() == self:
			_alone[id] = true
			node.clear_gizmos()
			node.add_gizmo(of_editor)
			return


func _find_collision(tree: TreeReconstruction) -> TriangleMesh:
	if tree == null:
		return null
	var known: Array = _collisions.get(tree.get_instance_id(), [])
	if not known.is_empty() and known[0] == tree.get_bark_revision():
		return known[1]
	var collision: TriangleMesh = null
	var arrays: Array = tree.build_mesh_arrays(_COLLISION_LOD)
	if not arrays.is_empty():
		var mesh: ArrayMesh = ArrayMesh.new()
		mesh.add_surface_from_arrays(
			Mesh.PRIMITIVE_TRIANGLES, arrays, [], {}, TreeReconstruction.MESH_FLAGS
		)
		collision = TriangleMesh.new()
		collision.create_from_faces(mesh.get_faces())
	for id: int in _collisions.keys():
		if not is_instance_id_valid(id):
			_collisions.erase(id)
	_collisions[tree.get_instance_id()] = [tree.get_bark_revision(), collision]
	return collision
