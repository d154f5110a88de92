@tool
extends RefCounted
## How burls would lift the bark, and the mouths of hollows, drawn over the tree at once, while
## nothing has grown yet.

const Session := preload("../session.gd")
const _MOUTH: Shader = preload("mouth.gdshader")

# Where the tree's own bark has no picture.
const _COLOR: Color = Color(0.36, 0.29, 0.235)

var _mesh: ArrayMesh = ArrayMesh.new()
var _material: StandardMaterial3D = StandardMaterial3D.new()
var _wood: ShaderMaterial = ShaderMaterial.new()
var _instance: RID
var _shown: String = ""


func _init() -> void:
	_material.roughness = 1.0
	_material.metallic_specular = 0.1
	_wood.shader = _MOUTH


## Shows the burls and hollows of a recipe on the edited tree; none with an empty one.
func show(session: Session, worker: TreeReconstructor, recipe: String) -> void:
	if recipe.is_empty() or session.node == null or not session.node.is_inside_tree():
		clear()
		return
	var key: String = "%s\n%d" % [recipe, session.tree.get_bark_revision()]
	if not _instance.is_valid() or key != _shown:
		_shown = key
		_mesh.clear_surfaces()
		var arrays: Array = worker.lift_bark(session.tree, recipe)
		if not arrays.is_empty():
			_mesh.add_surface_from_arrays(Mesh.PRIMITIVE_TRIANGLES, arrays)
			_look_like(session.node.get_active_material(0) as ShaderMaterial)
			_mesh.surface_set_material(0, _material)
		arrays = worker.sink_bark(session.tree, recipe)
		if not arrays.is_empty():
			_mesh.add_surface_from_arrays(
				Mesh.PRIMITIVE_TRIANGLES, arrays, [], {}, TreeReconstruction.MESH_FLAGS
			)
			_mesh.surface_set_material(_mesh.get_surface_count() - 1, _wood)
	if not _instance.is_valid():
		_instance = RenderingServer.instance_create2(
			_mesh.get_rid(), session.node.get_world_3d().scenario
		)
	RenderingServer.instance_set_transform(_instance, session.node.global_transform)


## How many triangles are shown.
func get_triangle_count() -> int:
	var count: int = 0
	if _instance.is_valid():
		for surface: int in _mesh.get_surface_count():
			count += _mesh.surface_get_array_index_len(surface) / 3
	return count


func clear() -> void:
	if _instance.is_valid():
		RenderingServer.free_rid(_instance)
		_instance = RID()
	_shown = ""


# With the picture of the tree's bark, in its scale.
func _look_like(bark: ShaderMaterial) -> void:
	var picture: Texture2D = null
	if bark != null:
		picture = bark.get_shader_parameter(&"albedo_texture") as Texture2D
	_material.albedo_texture = picture
	_material.albedo_color = _COLOR if picture == null else Color.WHITE
	if picture == null:
		return
	var size: Vector3 = Vector3.ONE
	var names: Array[StringName] = [&"repeat_width", &"repeat_length"]
	for axis: int in 2:
		var repeat: Variant = bark.get_shader_parameter(names[axis])
		size[axis] = 1.0 / (repeat as float if repeat is float else [0.6, 1.0][axis] as float)
	_material.uv1_scale = size


func _notification(what: int) -> void:
	if what == NOTIFICATION_PREDELETE and _instance.is_valid():
		RenderingServer.free_rid(_instance)
