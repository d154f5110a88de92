@tool
extends RefCounted
## Keeps a scan in sight while a tree is drawn in it: that tree is edited then, and not the one that
## was made of the scan. What the user had hidden of that stays hidden.
##
## All of it is in the rendering server alone: the scene knows nothing of it.

const Session := preload("../session.gd")
const PointView: GDScript = preload("../viewport/point_view.gd")
const LeafNodes: GDScript = preload("../../nodes/tree_leaf_nodes.gd")

var _session: Session
var _node: TreeInstance3D
# Its points, and how they are drawn, as long as it was edited.
var _points: PointView
var _instance: RID
var _bark: bool = true
var _leaves: bool = true


func _init(session: Session) -> void:
	_session = session


## To be called once a frame, with the node whose scan is drawn over, or [code]null[/code].
func update(over: TreeInstance3D) -> void:
	if over != _node:
		leave()
		_node = over
		# Once: a tree that is added is shown with all that it has, of whatever had been hidden.
		_bark = _session.view.mesh
		_leaves = _session.view.leaves
	if over == null:
		return
	if _session.node == over:
		_hide()
		_remember()
	elif not _instance.is_valid():
		_show()
	else:
		RenderingServer.instance_set_transform(_instance, _node.global_transform)


## Ends it: all is as it was.
func leave() -> void:
	_hide()
	_node = null
	_points = null


## Whether the points are seen though their tree isn't edited.
func is_shown() -> bool:
	return _instance.is_valid()


func _remember() -> void:
	if _points == null:
		_points = PointView.new(_session)
	if _points.layer.shown != (_session.view.points and not _session.scan.points.is_empty()):
		_points.rebuild()
		_points.update()


func _show() -> void:
	if _points == null:
		return
	_instance = RenderingServer.instance_create()
	if _points.layer.shown:
		RenderingServer.instance_set_base(_instance, _points.layer.mesh.get_rid())
		RenderingServer.instance_geometry_set_material_override(
			_instance, _points.layer.material.get_rid()
		)
	RenderingServer.instance_set_scenario(_instance, _node.get_world_3d().scenario)
	RenderingServer.instance_set_transform(_instance, _node.global_transform)
	_set_visible(_bark, _leaves)


func _hide() -> void:
	if not _instance.is_valid():
		return
	RenderingServer.free_rid(_instance)
	_instance = RID()
	if is_instance_valid(_node) and _node.is_inside_tree() and _session.node != _node:
		_set_visible(true, true)


func _set_visible(bark: bool, leaves: bool) -> void:
	var seen: bool = _node.is_visible_in_tree()
	RenderingServer.instance_set_visible(_node.get_instance(), seen and bark)
	var foliage: LeafNodes = _node.get(&"_foliage")
	for bearer: GeometryInstance3D in foliage.nodes:
		RenderingServer.instance_set_visible(bearer.get_instance(), seen and leaves)
