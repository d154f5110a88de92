@tool
extends RefCounted
## Shows how the bark of the edited tree grew, a step at a time, in the rendering server alone. The
## tree is hidden meanwhile (see ViewState.growing).

const BuildJob := preload("../../nodes/tree_build_job.gd")
const Session := preload("../session.gd")

var _session: Session
var _mesh: ArrayMesh
var _instance: RID


func _init(session: Session) -> void:
	_session = session


## Shows what [param bark] is, as [method TreeReconstructor.get_growth_frames] tells of it.
func show(bark: PackedByteArray) -> void:
	var node: TreeInstance3D = _session.node
	if node == null or not node.is_inside_tree():
		clear()
		return
	_mesh = BuildJob.bark_mesh(TreeReconstructor.draw_grown_bark(node.reconstruction, bark))
	if _mesh.get_surface_count() > 0 and node.mesh != null and node.mesh.get_surface_count() > 0:
		_mesh.surface_set_material(0, node.get_active_material(0))
	if not _instance.is_valid():
		_instance = RenderingServer.instance_create2(_mesh.get_rid(), node.get_world_3d().scenario)
		# It stands still.
		RenderingServer.instance_geometry_set_shader_parameter(_instance, &"tree_wind", 0.0)
	RenderingServer.instance_set_base(_instance, _mesh.get_rid())
	RenderingServer.instance_set_transform(_instance, node.global_transform)
	_session.view.growing = true


## How many triangles are shown.
func get_triangle_count() -> int:
	return BuildJob.triangles(_mesh)


## Shows the tree again.
func clear() -> void:
	if _instance.is_valid():
		RenderingServer.free_rid(_instance)
		_instance = RID()
	_mesh = null
	_session.view.growing = false


func _notification(what: int) -> void:
	if what == NOTIFICATION_PREDELETE and _instance.is_valid():
		RenderingServer.free_rid(_instance)
