@tool
extends EditorNode3DGizmoPlugin
## Draws what belongs to the edited tree into the editor's 3D viewports: its skeleton, what is
## selected, a tool's ghosts, the scan, axes.
##
## The engine moves a gizmo with its node, hides it with it, and takes it away when the node leaves
## the scene. So nothing is saved, duplicated, or left over. What is drawn are layers: a layer
## changes its mesh in place, without the gizmo being drawn anew.

const Session: GDScript = preload("../session.gd")


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
# The node whose gizmos were taken in hand, and our own gizmo of it.
var _node: TreeInstance3D
var _gizmo: EditorNode3DGizmo
# Whether our gizmo is to be the only one of the node.
var _alone: bool = false


func set_session(session: Session) -> void:
	_session = session


func _get_gizmo_name() -> String:
	return "Tree skeleton"


func _has_gizmo(node: Node3D) -> bool:
	return node is TreeInstance3D


func _redraw(gizmo: EditorNode3DGizmo) -> void:
	gizmo.clear()
	if _session == null or gizmo.get_node_3d() != _session.node:
		return
	_gizmo = gizmo
	if _alone and _node == _session.node and _node.get_gizmos().size() > 1:
		_send_others_away.call_deferred()
	for layer: Layer in layers:
		if layer.shown and layer.mesh.get_surface_count() > 0:
			gizmo.add_mesh(layer.mesh, layer.material)


## Draws the layers anew: one is shown that was not, or the other way.
func update_layers() -> void:
	if _gizmo != null and is_instance_valid(_session.node) and _session.node == _node:
		_redraw(_gizmo)


## Another node is edited, or its skeleton is edited now or no more.
##
## While the skeleton is edited, the bark's own gizmo goes: it makes a search tree of the bark's
## triangles for clicks after every rebuild, which takes a tenth of a second for a large tree, and
## clicks on the wood are ours then.
func take(node: TreeInstance3D, editing: bool) -> void:
	if is_instance_valid(_node) and _node.is_inside_tree() and _alone:
		_node.clear_gizmos()
		_node.update_gizmos()
	_node = node
	_alone = editing and node != null
	_gizmo = null
	if node != null and node.is_inside_tree():
		node.update_gizmos()


func _send_others_away() -> void:
	if not _alone or not is_instance_valid(_node) or not _node.is_inside_tree():
		return
	if _gizmo != null and _node.get_gizmos().size() > 1:
		_node.clear_gizmos()
		_node.add_gizmo(_gizmo)
